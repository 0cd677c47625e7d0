"""Tests of the benchmark tools: what they read, derive and show, with synthetic numbers."""
import copy
import math
import json

import pytest

import cost_model
import lammps
import machine
import measure
import parts
import run
import summary

LOG = """Per MPI rank memory allocation (min/avg/max) = 5.355 | 5.355 | 5.355 Mbytes
Step PotEng KinEng 
       0 38.5 0 
      10 35.25 2.5 
Loop time of 0.5 on 1 procs for 10 steps with 10192 atoms

100.0% CPU use with 1 MPI tasks x 1 OpenMP threads
run 10
Step PotEng KinEng 
      10 35.25 2.5 
      20 35.764000872804388 -2.5e-3 
Loop time of 0.25 on 1 procs for 10 steps with 10192 atoms
Total wall time: 0:00:01
"""

HELP = """Large-scale Atomic/Molecular Massively Parallel Simulator - 29 Sep 2021 - Update 2

* Pair styles:

harmonic/cut    morse/opt

* Bond styles:

class2          fene            harmonic        harmonic/intel
harmonic/omp    harmonic/shift  zero            

* Angle styles:

harmonic        harmonic/opt
"""

LSCPU = {"lscpu": [
    {"field": "Architecture:", "data": "x86_64", "children": [{"field": "CPU(s):", "data": "2"}]},
    {"field": "Vendor ID:", "data": "X", "children": [{"field": "Model name:", "data": "Swift 9", "children": [
        {"field": "CPU family:", "data": "26"}, {"field": "Flags:", "data": "sse2 avx2"}]}]},
    {"field": "Caches (sum of all):", "data": None, "children": [{"field": "L2 cache:", "data": "2 MiB (2 instances)"}]}]}

KERNEL = {"context": {"instruction_set": "AVX2"}, "benchmarks": [
    {"run_type": "iteration", "run_name": "step/everything/10000", "name": "x", "sites": 10192., "s/site": 9e-9},
    {"run_type": "iteration", "run_name": "formulas", "name": "x", "sites": 128., "s/site": 3e-9},
    {"run_type": "iteration", "run_name": "reference/10000", "name": "x", "sites": 10192., "s/site": 3e-7},
    {"run_type": "iteration", "run_name": "step/everything/10000", "name": "x", "sites": 10192., "s/site": 8e-9},
    {"run_type": "aggregate", "run_name": "step/everything/10000", "name": "x_mean", "sites": 10192., "s/site": 8.5e-9}]}


def sizes_row(sites, threads, nanoseconds, memory, stages=0):
    best = 1e-8 * nanoseconds * sites
    return {"sites": sites, "stages": stages, "threads": threads, "evaluations": 10, "seconds": [1.1 * best, best], "peak_memory_bytes": memory}


SIZES = {"rows": [sizes_row(1_000_000, 1, 8., 250e6), sizes_row(1_000_000, 2, 5., 260e6), sizes_row(10_000, 1, 4., 5e6),
                  sizes_row(10_000, 2, 2., 5e6), sizes_row(100_000, 1, 7., 70e6), sizes_row(100_000, 2, 3.5, 70e6),
                  *(sizes_row(sites, threads, ns, 1e3 * sites, stages=7) for sites, threads, ns in (
                      (100_000, 1, 8.), (100_000, 2, 4.), (1_000_000, 1, 10.), (1_000_000, 2, 6.)))]}

FEM = {"seconds": 5., "assembly": 1., "preconditioner": 1.5, "linear_solve": 2., "bytes_per_unknown": 900.}
AGREEMENT = {"lammps": 1., "latcon": 1., "difference": 3e-13}
DOCUMENT = {
    "machine": {"date": "2000-01-01", "commit": "abc", "processor": machine.processor(LSCPU), "memory_bytes": 2**34,
                "compiler": "c++ 1", "build_type": "Release"},
    "quick": False, "skipped": {"smoke": "no reason"}, "failed": {"mirrors": "all broken"},
    "parts": {
        "kernel": {"rows": parts.kernel_rows(KERNEL, "")},
        "lammps": {"version": "2021", "suffixes": ["none", "omp"], "rows": [
            {"sites": 1000, "steps": 100, "suffix": "omp", "lammps_seconds": {"none": [0.01], "omp": [0.009, 0.008]},
             "linear_seconds": [0.0005, 0.0006], "everything_seconds": [0.001], "tolerance": 1e-12,
             "potential_energy": AGREEMENT, "kinetic_energy": dict(AGREEMENT, difference=4e-13)}]},
        "sizes": SIZES,
        "ranks": {"rows": [
            {"command": "lattice", "case": "a.prm", "ranks": ranks, "threads": threads, "seconds": seconds}
            for ranks, threads, seconds in ((1, 1, [4., 4.4]), (1, 2, [2.5]), (2, 1, [2.]))]},
        "fig1": {"case": "fig1.prm", "rows": [
            {"command": "crack alone", "seconds": [16., 15.5], "phases": {"fracture": 10.}},
            {"command": "crack alone, Runge-Kutta-Chebyshev", "seconds": [5.], "phases": {"fracture": 4.}},
            {"command": "with the claims", "seconds": [30.], "phases": {"fracture": 10.}}]},
        "integrator": {"case": "fig1.prm", "rows": [
            {"integrator": name, "seconds": [seconds], "sites": 1000, "time_step": step, "stages": stages,
             "crack": {"pattern": "oscillating", "end_time": 2e-3, "speed_lagrangian": 20.25,
                       "speed_lagrangian_uncertainty": 1., "wavelength": 0.023, "wavelength_uncertainty": 2e-4}}
            for name, seconds, step, stages in (("velocity-verlet", 10., 1e-7, 1), ("runge-kutta-chebyshev", 4., 1e-6, 3))]},
        "fem": {"problems": [
            {"unknowns": 100_000, "degree": 2, "ratio": 4., "energy_difference": 2e-9,
             "latcon": dict(FEM, krylov_iterations=[3, 4]), "latcon_2_ranks": {"seconds": 2.5},
             "dolfinx": {"seconds": 20., "bytes_per_unknown": 2500.}},
            {"unknowns": 400_000, "degree": 2, "latcon": dict(FEM, krylov_iterations=[3])}]},
        "messages": {"allreduce_seconds": [2e-7], "exchanges": [{"bytes": 8, "seconds": [3e-7, 2e-7]},
                                                                 {"bytes": 65536, "seconds": [2e-5, 1e-5]}]}}}


def test_a_log_gives_each_run_with_its_last_energies():
    first, second = lammps.read_log(LOG)
    assert first == {"steps": 10, "seconds": 0.5, "potential_energy": 35.25, "kinetic_energy": 2.5}
    assert second == {"steps": 10, "seconds": 0.25, "potential_energy": 35.764000872804388, "kinetic_energy": -2.5e-3}


def test_a_log_that_is_not_whole_or_of_several_processes_is_refused():
    for text in ("", LOG.replace("Total wall time", "ERROR"), LOG.replace("1 procs", "2 procs")):
        with pytest.raises(measure.Failed):
            lammps.read_log(text)


def test_versions_of_the_bond_style_are_those_of_bonds():
    assert lammps.suffixes(HELP) == ["none", "intel", "omp"]
    assert lammps.version(HELP) == "29 Sep 2021 - Update 2"
    with pytest.raises(measure.Failed):
        lammps.suffixes("* Pair styles:\n\nharmonic\n")


def test_input_has_the_same_step_to_the_last_bit_and_one_run_more_than_is_timed():
    text = lammps.input_text("sheet.data", 0.1 + 0.2, 50, 3)
    assert "timestep 0.30000000000000004\n" in text
    assert text.count("\nrun 50") == 4
    assert "read_data sheet.data\n" in text


def test_energies_may_differ_by_round_off():
    assert lammps.energy_tolerance(1000, 10, 100) == (6000 + 4000) * 2.**-53


def test_google_benchmark_gives_repetitions_of_each_case():
    assert parts.kernel_rows(KERNEL, "avx2") == [
        {"work": "everything", "sites": 10192, "target": "avx2", "used": "AVX2", "seconds_per_site": [9e-9, 8e-9]},
        {"work": "formulas", "sites": 128, "target": "avx2", "used": "AVX2", "seconds_per_site": [3e-9]},
        {"work": "reference", "sites": 10192, "target": "avx2", "used": "AVX2", "seconds_per_site": [3e-7]}]
    broken = copy.deepcopy(KERNEL)
    broken["benchmarks"][1].update(error_occurred=True, error_message="no memory")
    with pytest.raises(measure.Failed, match="no memory"):
        parts.kernel_rows(broken, "")


def test_time_stepping_is_read_from_the_plan_of_a_run():
    text = "set x = 1\n# lattice: 3 sites\n# time step: 1.28e-07 s, 78125 steps at most{}\n# memory: about 1 MB\n"
    assert parts.time_stepping(text.format("")) == {"sites": 3, "time_step": 1.28e-7, "stages": 1}
    expected = ", 30056 if the crack is as fast as shear waves of the unloaded sheet"
    assert parts.time_stepping(text.format(expected)) == {"sites": 3, "time_step": 1.28e-7, "stages": 1}
    assert parts.time_stepping(text.format(" of 12 stages each" + expected)) == ({"sites": 3, "time_step": 1.28e-7, "stages": 12})
    with pytest.raises(measure.Failed):
        parts.time_stepping("# memory: about 1 MB\n")


def test_variants_take_turns():
    calls = []
    results = measure.interleaved({name: lambda name=name: calls.append(name) or len(calls) for name in "ab"}, 2)
    assert calls == ["a", "b", "a", "b"]
    assert results == {"a": [1, 3], "b": [2, 4]}


def test_spread_is_that_of_the_median():
    assert measure.spread([2., 5., 2.5]) == pytest.approx(0.25, abs=1e-15)


def test_programs_that_are_not_there_are_skipped_and_those_that_fail_are_not():
    with pytest.raises(measure.Skipped, match="not installed"):
        measure.run(["/no/such/program"])
    with pytest.raises(measure.Failed, match="ended with 3: oh no"):
        measure.run(["/bin/sh", "-c", "echo oh no >&2; exit 3"])


def test_growth_and_memory_are_those_of_one_thread():
    assert list(summary.by_size(SIZES, 0)) == [10_000, 100_000, 1_000_000]
    assert list(summary.by_size(SIZES, 7)) == [100_000, 1_000_000]
    assert summary.per_site(SIZES["rows"][0]) == pytest.approx(8e-9, abs=1e-23)
    assert summary.growth(SIZES, 0) == pytest.approx(8. / 7. - 1., abs=1e-14)
    assert summary.growth(SIZES, 7) == pytest.approx(0.25, abs=1e-14)
    assert summary.bytes_per_site(SIZES, 0) == pytest.approx(200., abs=1e-12)


def test_what_falls_short_is_said():
    rows = {row[0]: row[1:] for row in summary.rows(DOCUMENT["parts"])}
    assert rows["step with everything over root, quotient and force law alone, 10,192 sites"] == ["2.67", "<= 2", "missed"]
    assert rows["speed-up on 2 threads, velocity Verlet, 100,000 sites"] == ["2", ">= 1.8", ""]
    assert rows["speed-up on 2 threads, Runge-Kutta-Chebyshev of 7 stages, 1,000,000 sites"] == ["1.67", ">= 1.8", "missed"]
    assert rows["growth of the time per site from 10^5 sites on, velocity Verlet"] == ["0.143", "<= 0.15", ""]
    assert rows["growth of the time per site from 10^5 sites on, Runge-Kutta-Chebyshev of 7 stages"] == (
        ["0.25", "<= 0.15", "missed"])
    assert rows["speed-up on 2 ranks, latcon lattice, a.prm"] == ["2", ">= 1.8", ""]
    assert rows["speed-up on 2 threads, latcon lattice, a.prm"] == ["1.6", ">= 1.8", "missed"]
    assert rows["fig1.prm, crack alone [s]"] == ["15.5", "<= 10", "missed"]
    assert rows["fig1.prm, crack alone, Runge-Kutta-Chebyshev [s]"] == ["5", "<= 6", ""]
    assert "fig1.prm, with the claims [s]" not in rows
    # 80 ns for a site and step, 1000 sites, 2 ms in steps of 0.1 us, 4 s.
    assert rows["time to solution, LAMMPS-like stepping over latcon, fig1.prm"] == ["0.4", ">= 12", "missed"]
    assert rows["dolfinx over latcon, 100,000 unknowns"] == ["4", ">= 3", ""]
    assert rows["bytes per unknown, 400,000 unknowns"] == ["900", "<= 1800", ""]
    assert "dolfinx over latcon, 400,000 unknowns" not in rows


def test_number_that_is_none_misses_its_target():
    document = copy.deepcopy(DOCUMENT)
    document["parts"]["fig1"]["rows"][0]["seconds"] = [math.nan]
    document["parts"]["fem"]["problems"][0]["ratio"] = math.nan
    rows = {row[0]: row[1:] for row in summary.rows(document["parts"])}
    for name in ("fig1.prm, crack alone [s]", "dolfinx over latcon, 100,000 unknowns"):
        assert (rows[name][0], rows[name][2]) == ("nan", "missed")


def test_growth_misses_its_target_without_a_number_for_each_size():
    name = "growth of the time per site from 10^5 sites on, Runge-Kutta-Chebyshev of 7 stages"
    for change in (lambda rows: rows[-2].update(seconds=[0.1, math.nan]), lambda rows: rows[-2].update(seconds=[]),
                   lambda rows: rows.__delitem__(slice(-2, None))):
        document = copy.deepcopy(DOCUMENT)
        change(document["parts"]["sizes"]["rows"])
        assert [row[1:] for row in summary.rows(document["parts"]) if row[0] == name] == [["nan", "<= 0.15", "missed"]]


def test_steps_are_compared_with_formulas_of_the_same_instruction_set():
    document = copy.deepcopy(DOCUMENT)
    document["parts"]["kernel"]["rows"].insert(0, {"work": "formulas", "sites": 64, "target": "SCALAR", "used": "SCALAR",
                                                   "seconds_per_site": [3e-8]})
    assert summary.kernel_rows(document["parts"])[0][1] == pytest.approx(8. / 3., abs=1e-14)


def test_target_of_two_parts_needs_both():
    document = copy.deepcopy(DOCUMENT)
    del document["parts"]["lammps"]
    assert not any("time to solution" in row[0] for row in summary.rows(document["parts"]))


def test_processor_is_found_at_any_depth():
    assert machine.processor(LSCPU) == {
        "model": "Swift 9", "family": "26", "cores": 2, "threads_per_core": 1,
        "caches": {"L2": "2 MiB (2 instances)"}, "vectors": "AVX2"}


def test_parts_measured_before_stay_under_the_same_conditions_alone(tmp_path):
    conditions = {"machine": DOCUMENT["machine"], "quick": False}
    path = tmp_path / "benchmarks.json"
    empty = dict(conditions, parts={}, skipped={}, failed={})
    assert run.begun(path, conditions, ["kernel"]) == empty
    path.write_text(json.dumps(DOCUMENT), encoding="utf-8")
    kept = run.begun(path, conditions, ["kernel", "smoke"])
    assert list(kept["parts"]) == [name for name in DOCUMENT["parts"] if name != "kernel"]
    assert (kept["skipped"], kept["failed"]) == ({}, DOCUMENT["failed"])
    other = dict(conditions, machine=dict(conditions["machine"], commit="def"))
    assert run.begun(path, other, ["kernel"]) == dict(empty, **other)


def test_a_step_costs_sites_halo_and_sum():
    here = cost_model.Machine(site_seconds=1e-8, latency=1e-6, bandwidth=1e9, reduction=2e-6)
    # 64 kB to either side take 65 us with the latency, and the sum over eight ranks three rounds.
    assert cost_model.step_seconds(here, 10_000, 1000, 8) == pytest.approx(100e-6 + 2 * 65e-6 + 6e-6, abs=1e-15)
    assert cost_model.efficiency(here, 10_000, 1000, 8) == pytest.approx(100. / 236., abs=1e-12)
    assert cost_model.efficiency(here, 10_000, 1000, 1) == 1.


def test_bandwidth_is_that_of_a_halo():
    latency, bandwidth = cost_model.message_times([(8, 2e-7), (32768, 4e-6), (524288, 1e-4), (8388608, 1.)])
    assert latency == 2e-7
    assert bandwidth == pytest.approx(5.24288e9, abs=1e-3)
