"""A run leaves the same files, byte for byte, on two ranks, and where it continues from their checkpoint on one rank with two threads.

Runs that are killed: tests/faults.
"""
import json

import pytest

from program import CASES, checkpoints, expect_same, files, latcon, latcon_on_ranks, read_json

QUICK = ["fracture", CASES / "quick.prm", "--skip-verification", "--no-report"]
SPECTRUM = ["fracture", CASES / "spectrum.prm", *QUICK[2:]]
SHEET = {"Sheet/length": "2.5 cm", "Sheet/height": "1.5 cm", "Near tip/interval": 4e-6, "Contact/present": "true", "Output/energy interval": 50,
         "Output/frame interval": "0.1 ms", "Checkpoints/steps": 160, "Time/end": "0.3 ms"}
# Strains that change while the upper edge rolls along x.
HISTORY = {"Loading/history times": "0.1 ms, 0.25 ms", "Loading/history strain y": "1.5, 1.8", "Top edge/displacement x": "free"}
VISCOUS = {"Sheet/length": "2.5 cm", "Sheet/height": "1 cm", "Output/frame interval": "0.1 ms", "Near tip/interval": 2e-5, "Time/end": "0.3 ms"}
DISORDER = {"Disorder/strength": "weibull", "Disorder/strength width": 0.05, "Disorder/stiffness": "normal", "Disorder/stiffness width": 0.2}
LONG_STEPS = {"Time/integrator": "runge-kutta-chebyshev", "Checkpoints/steps": 40, "Output/energy interval": 10}
LAW = {f"{bonds}/{name}": value for bonds in ("Nearest neighbours", "Next-nearest neighbours") for name, value in (
    ("law", "expression"), ("psi", "a*(lam^2/2 + 1/lam) + k/2*(2*lam + lam^-2)"), ("parameters", "k = 0.15 MPa"))}
NONLOCAL = {"Sheet/spacing": "1 mm", "Sheet/length": "30 mm", "Sheet/height": "16 mm", "Fracture/seed sites": 8, "Time/end": "3 ms",
            "Fracture/stop position": 0.45, "Output/frame interval": "0.2 ms", **LONG_STEPS, "Checkpoints/steps": 20}
# Command and entries.
RUNS = {
    "absorbing end": (QUICK, {**SHEET, "Fracture/right end": "absorbing", "Time/end": "0.8 ms"}),
    "history and expression": (QUICK, {**SHEET, **HISTORY, **LAW}),
    "branches and disorder": (SPECTRUM, {**VISCOUS, **DISORDER, "Checkpoints/steps": 200, "Output/energy interval": 50}),
    "expression and branches in long steps": (SPECTRUM, {**VISCOUS, **LAW, **LONG_STEPS}),
    "scattered points": ([*QUICK, "--side", "continuum"], {**NONLOCAL, "Nonlocal/scatter": 0.5}),
    "motion": (["lattice", CASES / "quick.prm"], {"Lattice/solution": "motion", "Time/end": "0.1 ms", "Output/frame interval": "0.05 ms",
                                                  "Checkpoints/steps": 32}),
}


@pytest.mark.parametrize("name", RUNS)
def test_ranks_threads_and_restarts_leave_the_same_files(tmp_path, name):
    case, entries = RUNS[name]
    command = [*case, "--quiet", *(word for entry in entries.items() for word in ("--set", "{}={}".format(*entry)))]
    alone, shared = tmp_path / "alone", tmp_path / "shared"
    run = latcon(*command, "--threads", 1, "--output-dir", alone, expect=(0, 3))
    expected = files(alone)
    assert "lattice-0002.vtp" in expected
    if case[0] == "fracture":
        assert json.loads(expected["crack.json"])["bonds_broken"] > 10
    if name in ("absorbing end", "scattered points"):
        assert json.loads(expected["near_tip.json"])["samples"] > 5
    latcon_on_ranks(2, *command, "--threads", 1, "--output-dir", shared, expect=run.returncode)
    expect_same(shared, expected)
    *_, before, last = checkpoints(shared)
    last.unlink()
    latcon(*command, "--threads", 2, "--resume", "--output-dir", shared, expect=run.returncode)
    assert read_json(shared / "run.json")["resumed_from"]["step"] == int(before.stem.rpartition("-")[2])
    expect_same(shared, expected)
