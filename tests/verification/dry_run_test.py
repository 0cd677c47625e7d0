"""Checks that a dry run and the run refuse the same cases, with the same exit code and reason and without output files."""
import atexit

import pytest

from forked import Forked
from program import CASES, LATCON

PROGRAM = Forked(LATCON)
atexit.register(PROGRAM.close)
MOTION = ["Continuum/solution=motion", "Time/end=0.01 ms", "Continuum/cells x=3", "Continuum/cells y=2", "Continuum/degree=2"]
# Command, entries, a part of the message.
REFUSED = [
    ("continuum", [*MOTION, "Top edge/displacement x=1e-4*x"], "the initial displacement of a boundary"),
    ("continuum", [*MOTION, "Initial state/displacement x=1e-4*y"], "the initial displacement of a boundary"),
    ("continuum", [*MOTION, "Initial state/base=equilibrium", "Initial state/displacement x=1e-4*y"],
     "the initial displacement of a boundary"),
    ("continuum", [*MOTION, "Initial state/base=undeformed"], "the initial displacement of a boundary"),
    ("continuum", [*MOTION, "Initial state/displacement x=1/x"], "is no finite number"),
    ("continuum", [*MOTION, "Initial state/velocity y=1/y"], "is no finite number"),
    ("continuum", [*MOTION, "Continuum/time step=1e-20"], "more than the"),
    ("continuum", ["Continuum/mesh file=none.msh"], "none.msh"),
    ("continuum", ["Damage/length=1 mm"], "Damage/length = 1 mm: `latcon continuum` does not support damage"),
    ("continuum", ["Damage/threshold energy=1e6"], "Damage/threshold energy = 1e6: `latcon continuum` does not support damage"),
    ("continuum", ["Damage/residual stiffness=1e-5"],
     "Damage/residual stiffness = 1e-5: `latcon continuum` does not support damage"),
    ("lattice", ["Lattice/solution=motion", "Time/end=0"], "needs an end time"),
    ("lattice", ["Lattice/solution=motion", "Time/end=1", "Time/step=1e-20"], "more than the"),
    ("lattice", ["Sheet/spacing=1e-9"], ""),
    ("fracture", ["Fracture/right end=absorbing", "Loading/strain x=-0.9", "Loading/strain y=0"], ""),
    ("fracture", ["Contact/distance=5e-324"], "Contact/distance"),
    ("fracture", ["Time/step=1"], "Time/step"),
    ("fracture", ["Near tip/ahead=1e-9"], "Near tip/ahead"),
    ("fracture", ["Fracture/seed position=0.9", "Fracture/stop position=0.1"], "Fracture/"),
]
GOOD = [("continuum", [*MOTION]), ("continuum", [*MOTION, "Initial state/base=equilibrium"]),
        ("continuum", [*MOTION, "Initial state/displacement x=1e-6*sin(pi*x/0.04)*(y-0.01)*(y+0.01)",
                       "Left edge/condition=free", "Right edge/condition=free"])]


def both(out, command, entries):
    """@return exit code and standard error of the dry run, and of the run"""
    words = [command, str(CASES / "quick.prm"), "--quiet", "--threads", "1",
             *(["--skip-verification", "--no-report"] if command == "fracture" else []),
             *(word for entry in entries for word in ("--set", entry))]
    dry = PROGRAM.run([*words, "--dry-run"], out, 60)
    assert not out.exists()
    return dry, PROGRAM.run(words, out, 60)


@pytest.mark.parametrize("command, entries, reason", REFUSED)
def test_refuses_what_the_run_refuses(out, command, entries, reason):
    dry, run = both(out, command, entries)
    assert (dry[0], run[0]) == (2, 2), dry[1] + run[1]
    assert dry[1] == run[1]
    assert reason in run[1]
    assert not out.exists()


@pytest.mark.parametrize("command, entries", GOOD)
def test_refuses_nothing_else(out, command, entries):
    dry, run = both(out, command, entries)
    assert (dry[0], run[0]) == (0, 0), dry[1] + run[1]
    assert (out / "results.json").exists()
