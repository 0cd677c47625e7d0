"""Tests of cases with Maxwell branches and disorder: same files for ranks and threads, restart, energy ledger, refusals."""
import json
import re
import shutil

import pytest

from program import CASES, expect_same, files, latcon, latcon_on_ranks, read_csv

SPECTRUM = CASES / "spectrum.prm"
STRIP = ["fracture", SPECTRUM, "--skip-verification", "--no-report", "--quiet", "--set", "Sheet/length=2.5 cm", "--set",
         "Sheet/height=1 cm", "--set", "Output/frame interval=0.1 ms", "--set", "Near tip/interval=2e-5"]
END = ["--set", "Time/end=0.3 ms"]
VERLET = ["--set", "Checkpoints/steps=200", "--set", "Output/energy interval=50"]
MOTION = [word for entry in (
    "Continuum/solution=motion", "Continuum/law=cauchy-born", "Continuum/gradient=none", "Continuum/cells x=6",
    "Continuum/cells y=4", "Continuum/degree=2", "Continuum/time step=5 us", "Initial state/base=loading",
    "Initial state/velocity y=20*sin(pi*x/0.03)*sin(pi*y/0.015)", "Time/end=0.1 ms", "Output/frame interval=0.05 ms",
    "Checkpoints/steps=7") for word in ("--set", entry)]
CHEBYSHEV = ["--set", "Time/integrator=runge-kutta-chebyshev", "--set", "Checkpoints/steps=40", "--set",
             "Output/energy interval=10"]


DISORDER = ["--set", "Disorder/strength=weibull", "--set", "Disorder/strength width=0.05", "--set", "Disorder/stiffness=normal",
            "--set", "Disorder/stiffness width=0.2"]


# Long steps miss waves that breaking bonds emit.
@pytest.mark.parametrize("entries, allowed", [([*VERLET, *DISORDER], 1e-4), (CHEBYSHEV, 1e-3)], ids=["verlet, disorder", "chebyshev"])
def test_crack(out, tmp_path, entries, allowed):
    """Runs the crack on one rank and thread, then on two ranks, then from a checkpoint on these with two threads each."""
    strip = [*STRIP, *END, *entries]
    alone = latcon(*strip, "--threads", "1", "--output-dir", out)
    assert alone.returncode in (0, 3), alone.stderr
    expected = files(out)
    assert json.loads(expected["crack.json"])["bonds_broken"] > 30
    folder = tmp_path / "two"
    run = latcon_on_ranks(2, *strip, "--threads", "1", "--output-dir", folder)
    assert run.returncode == alone.returncode, run.stderr
    expect_same(folder, expected)
    # From the checkpoint before the last.
    stopped = tmp_path / "stopped"
    shutil.copytree(out, stopped)
    sorted((stopped / "checkpoints").glob("*.h5"))[-1].unlink()
    run = latcon_on_ranks(2, *strip, "--resume", "--threads", "2", "--output-dir", stopped)
    assert run.returncode == alone.returncode, run.stderr
    assert json.loads((stopped / "run.json").read_text())["resumed_from"]["step"] > 0
    expect_same(stopped, expected)
    rows = read_csv(out / "energy.csv")
    names = [f"{shell}_branch_{i}" for shell in ("nearest", "next_nearest") for i in (1, 2, 3)]
    assert list(rows[0]) == ["t", "elastic", "kinetic", "viscous", "broken", "boundary_work", "contact", "imbalance",
                                     *(f"{name}_{what}" for name in names for what in ("stored", "dissipated"))]
    first, last = ({key: float(value) for key, value in row.items()} for row in (rows[0], rows[-1]))
    for name in names:
        assert first[f"{name}_dissipated"] == 0
        assert last[f"{name}_stored"] > 0
        assert last[f"{name}_dissipated"] > 0
    assert sum(last[f"{name}_dissipated"] for name in names) < last["viscous"]
    assert sum(last[f"{name}_stored"] for name in names) < last["elastic"]
    assert abs(last["imbalance"]) < allowed * first["elastic"]


def test_checkpoint_of_another_disorder_or_other_branches_is_refused(out):
    short = [*STRIP, *DISORDER, "--set", "Time/end=0.05 ms", "--set", "Checkpoints/steps=10", "--output-dir", out]
    run = latcon(*short)
    assert run.returncode in (0, 3), run.stderr
    for entry, said in (("Disorder/seed=2", "Disorder/seed = 1"), ("Nearest neighbours/relaxation times=0.02 ms, 0.1 ms, 0.6 ms",
                                                                   "Nearest neighbours/relaxation times = 2e-05, 1e-04, 5e-04")):
        run = latcon(*short, "--resume", "--set", entry)
        assert run.returncode == 2, run.stderr
        assert f"another case: {said} in the checkpoint" in run.stderr


@pytest.mark.parametrize("entries, key, words", [
    (["stiffness=uniform", "stiffness width=0.6"], "stiffness width", "below 0.577"),
    (["strength=normal", "strength width=0.33"], "strength width", "below 0.328"),
    (["strength=weibull", "strength width=1.1"], "strength width", "<= 1"),
    (["strength=weibull", "strength width=0"], "strength width", ">= 1e-04"),
    (["strength=weibull", "strength width=nan"], "strength width", "<= 1"),
    (["stiffness=weibul"], "stiffness", "perhaps weibull"),
    (["seed=-1"], "seed", "whole number")])
def test_bad_disorder_is_refused_by_name(entries, key, words):
    run = latcon("fracture", SPECTRUM, "--dry-run", *(word for entry in entries for word in ("--set", f"Disorder/{entry}")))
    assert run.returncode == 2, run.stderr
    assert f"Disorder/{key}" in run.stderr
    assert words in run.stderr


def test_cases_without_branches_have_their_columns(out):
    run = latcon("lattice", CASES / "quick.prm", "--quiet", "--set", "Lattice/solution=motion", "--set", "Time/end=2e-6",
                 "--output-dir", out)
    assert run.returncode == 0, run.stderr
    assert (out / "energy.csv").read_text().partition("\n")[0] == (
        "t,elastic,kinetic,viscous,broken,boundary_work,contact,imbalance")


@pytest.mark.parametrize("entries, key, words", [
    (["relaxation times=0.02 ms, 0.1 ms"], "relaxation times", "3 moduli and 2 times"),
    (["relaxation times="], "relaxation times", "3 moduli and 0 times"),
    (["branch moduli="], "relaxation times", "0 moduli and 3 times"),
    (["relaxation times=" + ", ".join(["1 ms"] * 17), "branch moduli=" + ", ".join(["1 MPa"] * 17)], "branch moduli",
     "at most 16"),
    (["relaxation times=0.02 ms, 0 ms, 0.5 ms"], "relaxation times", "1e-20"),
    (["relaxation times=0.02 ms, -1 ms, 0.5 ms"], "relaxation times", "1e-20"),
    (["branch moduli=0.3 MPa, nan MPa, 0.5 MPa"], "branch moduli", "1e-20"),
    (["branch moduli=0.3 MPa, inf MPa, 0.5 MPa"], "branch moduli", "1e-20"),
    (["relaxation times=1e-9 s, 0.1 ms, 0.5 ms"], "relaxation times", "within one time step")])
def test_bad_branches_are_refused_by_name(entries, key, words):
    section = "Next-nearest neighbours" if "relaxation times=" in entries[0] else "Nearest neighbours"
    run = latcon("fracture", SPECTRUM, "--dry-run", *(word for entry in entries for word in ("--set", f"{section}/{entry}")))
    assert run.returncode == 2, run.stderr
    assert f"{section}/{key}" in run.stderr
    assert words in run.stderr


def test_motion_of_finite_elements_refuses_branches_that_relax_within_a_step():
    own = ("Continuum/time step", "Continuum/cells")
    motion = [word for entry in MOTION[1::2] if not entry.startswith(own) for word in ("--set", entry)]
    cells = ["--set", "Continuum/cells x=2", "--set", "Continuum/cells y=2"]
    run = latcon("continuum", SPECTRUM, "--dry-run", *motion, *cells, "--set", "Continuum/time step=0.03 ms")
    assert run.returncode == 2, run.stderr
    for section in ("Nearest neighbours", "Next-nearest neighbours"):
        assert f"{section}/relaxation times" in run.stderr
    assert "smaller Continuum/time step" in run.stderr
    assert latcon("continuum", SPECTRUM, "--dry-run").returncode == 0


def test_automatic_step_of_finite_elements_resolves_waves_and_relaxation():
    end, shortest, longitudinal_speed = 1e-2, 2e-5, 40.34778  # that of tests/verification/bridge/homogenisation_test.cc
    own = ("Continuum/time step", "Continuum/cells", "Time/end")
    shells = ("Nearest neighbours", "Next-nearest neighbours")
    motion = [*(entry for entry in MOTION[1::2] if not entry.startswith(own)), f"Time/end={end}", "Continuum/cells x=24",
              "Continuum/cells y=12", *(f"{shell}/area factor={2 / 3}" for shell in shells)]
    elastic = [f"{shell}/{entry}=" for shell in shells for entry in ("branch moduli", "relaxation times")]
    for entries, expected in (([], 0.1 * shortest), (elastic, 0.5 * 0.015 / 12 / longitudinal_speed)):
        words = [word for entry in motion + entries for word in ("--set", entry)]
        run = latcon("continuum", SPECTRUM, "--dry-run", *words)
        assert run.returncode == 0, run.stderr
        step = float(re.search(r"^# motion: time step (\S+) s", run.stdout, re.M).group(1))
        assert step <= expected * (1 + 1e-5)
        assert 1 / step > 1 / expected * (1 - 1e-5)
        assert 1 / step < 1 / expected + 1 / end  # the last step ends at the end


def test_motion_of_finite_elements_records_and_resumes_branches(out, tmp_path):
    alone = latcon("continuum", SPECTRUM, *MOTION, "--output-dir", out)
    assert alone.returncode == 0, alone.stderr
    rows = read_csv(out / "energy.csv")
    names = [f"{shell}_branch_{i}" for shell in ("nearest", "next_nearest") for i in (1, 2, 3)]
    assert list(rows[0]) == ["t", "elastic", "kinetic", "micro_inertia", "viscous", "boundary_work", "imbalance",
                                     *(f"{name}_{what}" for name in names for what in ("stored", "dissipated"))]
    first, last = ({key: float(value) for key, value in row.items()} for row in (rows[0], rows[-1]))
    for name in names:
        assert (first[f"{name}_stored"], first[f"{name}_dissipated"]) == (0, 0)
        assert last[f"{name}_stored"] > 0
        assert last[f"{name}_dissipated"] > 0
    assert sum(last[f"{name}_dissipated"] for name in names) < last["viscous"]
    # The step resolves the motion to (w h)^2 / 12 with w h = 0.3 for waves as long as two cells.
    assert abs(last["imbalance"]) < 0.01 * first["kinetic"]
    stopped = tmp_path / "stopped"
    shutil.copytree(out, stopped)
    for late in sorted((stopped / "checkpoints").glob("*.h5"))[1:]:
        late.unlink()
    run = latcon("continuum", SPECTRUM, *MOTION, "--resume", "--output-dir", stopped)
    assert run.returncode == 0, run.stderr
    assert json.loads((stopped / "run.json").read_text())["resumed_from"]["step"] > 0
    expected, found = files(out), files(stopped)
    for name in ("energy.csv", "results.csv", "results.json"):
        assert found[name] == expected[name], name
    assert sorted(found) == sorted(expected)
    # Ranks sum in another order.
    shared = tmp_path / "shared"
    run = latcon_on_ranks(2, "continuum", SPECTRUM, *MOTION, "--output-dir", shared)
    assert run.returncode == 0, run.stderr
    for ours, theirs in zip(rows, read_csv(shared / "energy.csv")):
        for key, value in ours.items():
            assert float(theirs[key]) == pytest.approx(float(value), abs=1e-9 * first["elastic"]), key


def test_memory_is_estimated():
    def estimate(n):
        """Sites, and bytes beside those of the program, of a sheet whose bonds have n branches each."""
        lists = {"branch moduli": ", ".join(["1 MPa"] * n), "relaxation times": ", ".join(["1 ms"] * n)}
        entries = [word for section in ("Nearest neighbours", "Next-nearest neighbours") for key, value in lists.items()
                   for word in ("--set", f"{section}/{key}={value}")]
        text = latcon("fracture", SPECTRUM, "--dry-run", "--set", "Sheet/length=30 cm", "--set", "Sheet/height=15 cm",
                      *entries).stdout
        peak, own = re.search(r"^# memory: about (\d+) bytes .* itself takes (\d+) bytes", text, re.M).groups()
        return int(re.search(r"^# lattice: (\d+) sites", text, re.M)[1]), int(peak) - int(own)

    (sites, none), (_, three), (_, sixteen) = map(estimate, (0, 3, 16))
    # n + 1 numbers for each of six bonds per place of the state, of its snapshot and of three frames that are not yet written, of
    # which some have no site: 960 bytes for three branches.
    places = (three - none) / 960
    assert places > sites
    assert places < 1.06 * sites
    assert sixteen - none == pytest.approx(5 * 17 * 6 * 8 * places, abs=10)
