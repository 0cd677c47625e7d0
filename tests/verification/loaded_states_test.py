"""Checks that the claims accept all stable loaded states before a crack, and no others, as in the table of docs/limits.md."""
import concurrent.futures
import itertools
import os
import pathlib

import pytest

from lattice_states import ACCEPTED, Lattice, rod, spring
from program import CASES, FULL, claims_where, latcon, read_json, settings

PAGE = pathlib.Path(__file__).resolve().parents[2] / "docs" / "limits.md"
STRAINS_X = (-0.3, -0.15, 0.0, 0.3, 0.8, 1.3, 2.0, 3.0)
STRAINS_Y = (0.03, 0.1, 0.3, 0.6, 1.0, 1.8, 2.4, 3.0)


def both(**entries):
    """Entries with the same values for both shells."""
    return [f"{shell}/{name}={value}" for shell in ("Nearest neighbours", "Next-nearest neighbours")
            for name, value in entries.items()]


# Law for the comparison, entries of the case that differ from quick.prm. Moduli from 10 kPa to 10 MPa.
MATERIALS = {
    "rubber": (rod(1e5, 1.5e5), []),
    "b = 0": (rod(1, 0), both(a=2.5e5, b=0)),
    "a = 0": (rod(0, 1), both(a=0, b=2.5e5)),
    "linear": (spring(1), both(law="linear", modulus=2.35e5)),
    "10 kPa": (rod(1, 1), both(a=5e3, b=5e3)),
    "10 MPa": (rod(1, 1), both(a=5e6, b=5e6)),
    "10 kPa, b = 0": (rod(1, 0), both(a=1e4, b=0)),
    "10 MPa, a = 0": (rod(0, 1), both(a=0, b=1e7)),
    "10 MPa, linear": (spring(1), both(law="linear", modulus=1e7)),
    "undamped": (rod(1e5, 1.5e5), both(viscosity=0)),
}
# The row by which a state may be refused. Neutral stability: tests/verification/bridge/slowest_wave_test.cc; waves in a sheet that
# buckles: verify_test.py.
REASON = "stability of the loaded lattice"


def check(folder, law, x, y, shells=("NN+NNN", "NN")):
    """Checks that the verdicts for these sets of shells agree with the stability of the lattice. @return whether the state is refused"""
    rows = read_json(folder / "results.json")["claims"]
    is_refused = False
    for of in shells:
        outcome = Lattice(law, of, 1 + x, 1 + y).outcome()
        failing = [row["quantity"] for row in rows if row["verdict"] == "fails" and row["quantity"].startswith((f"{of}:", f"{of},"))]
        assert bool(failing) == (outcome != ACCEPTED), (of, outcome, failing)
        for quantity in failing:
            assert REASON in quantity
        is_refused |= outcome != ACCEPTED
    return is_refused


@pytest.mark.skipif(FULL, reason="once is enough")
@pytest.mark.parametrize("name, x, shells, refused", [("verify", 1.3, ("NN+NNN", "NN"), False), ("refused", -0.3, ("NN",), True)])
def test_states_of_the_fixture_are_accepted_or_refused_for_what_they_are(name, x, shells, refused):
    """Nearest neighbours alone buckle where they are compressed."""
    assert check(pathlib.Path(os.environ["LATCON_VERDICTS"]) / "runs" / name, MATERIALS["rubber"][0], x, 1.8, shells) == refused


@pytest.mark.skipif(not FULL, reason="long")
def test_states_are_accepted_or_refused_for_what_they_are(tmp_path):
    """The map with the claims that a crack waits for, of rubber the whole one; the sheets with a hole or a notch depend on the material
    alone."""
    claims = claims_where("before_fracture") - {"steady-crack"}

    def is_judged_right(state):
        material, x, y = state
        law, entries = MATERIALS[material]
        out = tmp_path / f"{material} {x} {y}"
        changes = settings(f"Loading/strain x={x}", f"Loading/strain y={y}", "Fracture/breaking stretch=auto", *entries)
        run = latcon("verify", *claims, "--quick", "--quiet", "--threads", 1, "--case", CASES / "quick.prm", "--output-dir", out, *changes, expect=(0, 3))
        assert check(out, law, x, y) == (run.returncode == 3), state

    with concurrent.futures.ThreadPoolExecutor(os.cpu_count()) as pool:
        for material in MATERIALS:
            every = 1 if material == "rubber" else 4 if material.startswith("10 ") else 2
            list(pool.map(is_judged_right, itertools.product([material], STRAINS_X[::every], STRAINS_Y[::every])))


def test_page_has_the_map():
    page = PAGE.read_text(encoding="utf-8")
    for shells in ("NN+NNN", "NN"):
        for x in STRAINS_X:
            outcomes = [Lattice(MATERIALS["rubber"][0], shells, 1 + x, 1 + y).outcome() for y in STRAINS_Y]
            line = f"| {shells} | {x:g} | {' | '.join(outcomes)} |"
            if set(outcomes) != {ACCEPTED}:
                assert line in page
            else:
                assert f"| {shells} | {x:g} |" not in page
