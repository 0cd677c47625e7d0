"""Tests of cases with Maxwell branches: energy ledger, restart, step and memory. Files on ranks: same_files_test.py."""
import re
import shutil

import numpy as np
import pytest

from program import CASES, checkpoints, files, latcon, latcon_on_ranks, numbers, read_json, settings

SPECTRUM = CASES / "spectrum.prm"
STRIP = ["fracture", SPECTRUM, "--skip-verification", "--no-report", "--quiet",
         *settings("Sheet/length=2.5 cm", "Sheet/height=1 cm", "Near tip/interval=0")]
MOTION = settings(
    "Continuum/solution=motion", "Continuum/law=cauchy-born", "Continuum/gradient=none", "Continuum/cells x=6", "Continuum/cells y=4",
    "Continuum/degree=2", "Continuum/time step=5 us", "Initial state/base=loading", "Initial state/velocity y=20*sin(pi*x/0.03)*sin(pi*y/0.015)",
    "Time/end=0.1 ms", "Output/frame interval=0.05 ms", "Checkpoints/steps=7")
BRANCHES = [f"{shell}_branch_{i}" for shell in ("nearest", "next_nearest") for i in (1, 2, 3)]


def branch_ledger(out, *columns):
    """First and last row of a ledger with these columns and those of the branches, in which energy is stored and lost."""
    ledger = numbers(out / "energy.csv")
    assert list(ledger) == ["t", "elastic", "kinetic", *columns, "imbalance",
                             *(f"{name}_{what}" for name in BRANCHES for what in ("stored", "dissipated"))]
    first, last = ({key: column[row] for key, column in ledger.items()} for row in (0, -1))
    for name in BRANCHES:
        assert first[f"{name}_dissipated"] == 0
        assert last[f"{name}_stored"] > 0
        assert last[f"{name}_dissipated"] > 0
    assert sum(last[f"{name}_dissipated"] for name in BRANCHES) < last["viscous"]
    return first, last


def test_crack_records_them(out):
    latcon(*STRIP, "--set", "Time/end=0.3 ms", "--output-dir", out, expect=(0, 3))
    first, last = branch_ledger(out, "viscous", "broken", "boundary_work", "contact")
    assert sum(last[f"{name}_stored"] for name in BRANCHES) < last["elastic"]
    assert abs(last["imbalance"]) < 1e-4 * first["elastic"]


def test_checkpoint_of_another_disorder_or_other_branches_is_refused(out):
    short = [*STRIP, "--set", "Time/end=0.05 ms", "--set", "Checkpoints/steps=10", "--output-dir", out]
    latcon(*short, expect=(0, 3))
    for entry, said in (("Disorder/seed=2", "Disorder/seed = 1"), ("Nearest neighbours/relaxation times=0.02 ms, 0.1 ms, 0.6 ms",
                                                                   "Nearest neighbours/relaxation times = 2e-05, 1e-04, 5e-04")):
        run = latcon(*short, "--resume", "--set", entry, expect=2)
        assert f"another case: {said} in the checkpoint" in run.stderr


def test_automatic_step_of_finite_elements_resolves_waves_and_relaxation():
    end, shortest, longitudinal_speed = 1e-2, 2e-5, 40.34778  # that of tests/verification/bridge/homogenisation_test.cc
    own = ("Continuum/time step", "Continuum/cells", "Time/end")
    shells = ("Nearest neighbours", "Next-nearest neighbours")
    motion = [*(entry for entry in MOTION[1::2] if not entry.startswith(own)), f"Time/end={end}", "Continuum/cells x=24",
              "Continuum/cells y=12", *(f"{shell}/area factor={2 / 3}" for shell in shells)]
    elastic = [f"{shell}/{entry}=" for shell in shells for entry in ("branch moduli", "relaxation times")]
    for entries, expected in (([], 0.1 * shortest), (elastic, 0.5 * 0.015 / 12 / longitudinal_speed)):
        run = latcon("continuum", SPECTRUM, "--dry-run", *settings(*motion, *entries))
        step = float(re.search(r"^# motion: time step (\S+) s", run.stdout, re.M).group(1))
        assert step <= expected * (1 + 1e-5)
        assert 1 / expected * (1 - 1e-5) < 1 / step < 1 / expected + 1 / end  # the last step ends at the end


def test_motion_of_finite_elements_records_and_resumes_branches(out, tmp_path):
    latcon("continuum", SPECTRUM, *MOTION, "--output-dir", out)
    first, last = branch_ledger(out, "micro_inertia", "viscous", "boundary_work")
    assert not any(first[f"{name}_stored"] for name in BRANCHES)
    # The step resolves the motion to (w h)^2 / 12 with w h = 0.3 for waves as long as two cells.
    assert abs(last["imbalance"]) < 0.01 * first["kinetic"]
    stopped = shutil.copytree(out, tmp_path / "stopped")
    for late in checkpoints(stopped)[1:]:
        late.unlink()
    latcon("continuum", SPECTRUM, *MOTION, "--resume", "--output-dir", stopped)
    assert read_json(stopped / "run.json")["resumed_from"]["step"] > 0
    expected, found = files(out), files(stopped)
    for name in ("energy.csv", "results.csv", "results.json"):
        assert found[name] == expected[name], name
    assert sorted(found) == sorted(expected)
    # Ranks sum in another order.
    shared = tmp_path / "shared"
    latcon_on_ranks(2, "continuum", SPECTRUM, *MOTION, "--output-dir", shared)
    ours, theirs = numbers(out / "energy.csv"), numbers(shared / "energy.csv")
    for key, column in ours.items():
        np.testing.assert_allclose(theirs[key], column, rtol=0., atol=1e-9 * first["elastic"], err_msg=key)


def test_memory_is_estimated():
    def estimate(n):
        """Sites, and bytes beside those of the program, of a sheet whose bonds have n branches each."""
        lists = [f"{section}/{key}={', '.join([value] * n)}" for section in ("Nearest neighbours", "Next-nearest neighbours")
                 for key, value in (("branch moduli", "1 MPa"), ("relaxation times", "1 ms"))]
        text = latcon("fracture", SPECTRUM, "--dry-run", *settings("Sheet/length=30 cm", "Sheet/height=15 cm", *lists)).stdout
        peak, own = re.search(r"^# memory: about (\d+) bytes .* itself takes (\d+) bytes", text, re.M).groups()
        return int(re.search(r"^# lattice: (\d+) sites", text, re.M)[1]), int(peak) - int(own)
    (sites, none), (_, three), (_, sixteen) = map(estimate, (0, 3, 16))
    # n + 1 numbers for each of six bonds per place of the state, of its snapshot and of three frames that are not yet written, of
    # which some have no site: 960 bytes for three branches.
    places = (three - none) / 960
    assert sites < places < 1.06 * sites
    assert sixteen - none == pytest.approx(5 * 17 * 6 * 8 * places, abs=10)
