"""Tests of what the benchmark tools read and judge; what they measure is run by Benchmarks.RunInTheirQuickVersions."""
import math

import pytest

import cost_model
import lammps
import measure
import parts
import run
import summary

LOG = """Step PotEng KinEng
      10 35.25 2.5
Loop time of 0.5 on 1 procs for 10 steps with 10192 atoms
run 10
Step PotEng KinEng
      10 35.25 2.5
      20 35.764000872804388 -2.5e-3
Loop time of 0.25 on 1 procs for 10 steps with 10192 atoms
Total wall time: 0:00:01
"""


def test_a_log_gives_each_run_with_its_last_energies():
    assert lammps.read_log(LOG) == [
        {"steps": 10, "seconds": 0.5, "potential_energy": 35.25, "kinetic_energy": 2.5},
        {"steps": 10, "seconds": 0.25, "potential_energy": 35.764000872804388, "kinetic_energy": -2.5e-3}]


@pytest.mark.parametrize("text", ["", LOG.replace("Total wall time", "ERROR"), LOG.replace("1 procs", "2 procs")])
def test_a_log_that_is_not_whole_or_of_several_processes_is_refused(text):
    with pytest.raises(measure.Failed):
        lammps.read_log(text)


def test_a_repetition_that_failed_is_refused():
    case = {"run_type": "iteration", "run_name": "formulas", "name": "x", "sites": 128., "s/site": 3e-9}
    found = {"context": {"instruction_set": "AVX2"}, "benchmarks": [case, dict(case, run_type="aggregate"), case]}
    assert parts.kernel_rows(found, "avx2") == [
        {"work": "formulas", "sites": 128, "target": "avx2", "used": "AVX2", "seconds_per_site": [3e-9, 3e-9]}]
    case.update(error_occurred=True, error_message="no memory")
    with pytest.raises(measure.Failed, match="no memory"):
        parts.kernel_rows(found, "")


def sizes(*last_seconds):
    """Times of velocity Verlet on one and two threads: 10 evaluations of 1e5 sites in 1e-2 s, and of 1e6 sites."""
    return {"rows": [{"sites": sites, "stages": 0, "threads": threads, "evaluations": 10, "seconds": seconds, "peak_memory_bytes": 1e8}
                     for threads in (1, 2) for sites, seconds in ((100_000, [1e-2]), (1_000_000, list(last_seconds)))]}


@pytest.mark.parametrize("seconds, judged", [((0.114,), ["0.14", "<= 0.15", ""]), ((0.12, 0.13), ["0.2", "<= 0.15", "missed"]),
                                             ((0.1, math.nan), ["nan", "<= 0.15", "missed"]), ((), ["nan", "<= 0.15", "missed"])])
def test_growth_misses_its_target_where_it_is_too_large_or_no_number(seconds, judged):
    rows = {row[0]: row[1:] for row in summary.rows({"sizes": sizes(*seconds)})}
    assert rows["growth of the time per site from 10^5 sites on, velocity Verlet"] == judged


def test_parts_measured_before_stay_under_the_same_conditions_alone(tmp_path):
    conditions, path = {"machine": {"commit": "abc"}, "quick": False}, tmp_path / "benchmarks.json"
    path.write_text('{"machine": {"commit": "abc"}, "quick": false, "parts": {"kernel": {}, "fem": {}}, "skipped": {}, "failed": {}}')
    assert list(run.begun(path, conditions, ["kernel"])["parts"]) == ["fem"]
    assert run.begun(path, {"machine": {"commit": "def"}, "quick": False}, ["kernel"])["parts"] == {}


def test_a_step_costs_sites_halo_and_sum():
    here = cost_model.Machine(site_seconds=1e-8, latency=1e-6, bandwidth=1e9, reduction=2e-6)
    # 64 kB to either side take 65 us with the latency, and the sum over eight ranks three rounds.
    assert cost_model.step_seconds(here, 10_000, 1000, 8) == pytest.approx(100e-6 + 2 * 65e-6 + 6e-6, abs=1e-15)
    assert cost_model.efficiency(here, 10_000, 1000, 8) == pytest.approx(100. / 236., abs=1e-12)
