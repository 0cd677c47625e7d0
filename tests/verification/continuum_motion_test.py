"""Tests of motions of finite elements from the command line: energy, dispersion, solvers, steps."""
import math

import numpy as np
import pytest

from continuum_run import DENSITY, LAYER, MODULUS
from program import CASES, latcon, numbers, read_csv, read_json, settings

# A shear wave in a strip that is periodic both ways.
AMPLITUDE = 0.01  # of velocity [m/s]
LENGTH = 0.01  # of the strip and the wave [m]
STATIC, INERTIA = 0.5e-3, 1e-3  # l_s, l_d [m]


def arguments(folder, cells, step=5e-6, across="periodic"):
    """@param across condition of the bottom and of the top edge"""
    return ["continuum", LAYER, "--quiet", "--output-dir", folder,
            *settings("Loading/shear=0", "Continuum/law=cauchy-born", "Continuum/ratio=auto",
                      "Bottom edge/normal gradient=free", "Top edge/normal gradient=free",
                      f"Bottom edge/condition={across}", f"Top edge/condition={across}",
                      "Continuum/solution=motion", "Initial state/base=undeformed", "Output/energy interval=1",
                      f"Continuum/cells x={cells}", "Continuum/cells y=2", f"Continuum/static length={STATIC}",
                      f"Continuum/inertia length={INERTIA}", f"Continuum/time step={step}", "Time/end=5e-5",
                      f"Initial state/velocity y={AMPLITUDE}*sin(2*pi*x/{LENGTH})")]


def test_energy_balances(out):
    latcon(*arguments(out, 8))
    energy = numbers(out / "energy.csv")
    assert list(energy) == ["t", "elastic", "kinetic", "micro_inertia", "viscous", "boundary_work", "imbalance"]
    np.testing.assert_allclose(energy["t"], 5e-6 * np.arange(11), rtol=1e-12)
    total = energy["elastic"] + energy["kinetic"] + energy["viscous"] - energy["boundary_work"]
    # Average acceleration conserves the energy of a linear problem, and strains of 4e-4 are nearly linear: measured
    # 1e-9.
    assert abs(total - total[0]).max() < 1e-8 * total[0]
    np.testing.assert_allclose(energy["imbalance"], total - total[0], atol=1e-12 * total[0])
    # Micro-inertia contributes in the ratio (l_d k)^2 to 1.
    inertia = (2. * math.pi * INERTIA / LENGTH) ** 2
    np.testing.assert_allclose(energy["micro_inertia"] / energy["kinetic"], inertia / (1. + inertia), rtol=1e-4)
    assert energy["elastic"][-1] > 0.3 * total[0]
    # The frequency of the dispersion relation (C.47), in steps of average acceleration; measured 2.1e-5 (order: dynamic_solver_test.cc).
    k, step = 2. * math.pi / LENGTH, 5e-6
    omega = k * math.sqrt(MODULUS / DENSITY * (1. + (STATIC * k) ** 2) / (1. + (INERTIA * k) ** 2))
    phase = math.acos(math.sqrt(energy["kinetic"][-1] / energy["kinetic"][0]))
    assert phase / energy["t"][-1] == pytest.approx(2. / step * math.atan(0.5 * omega * step), rel=5e-5)


def test_step_too_long_for_the_motion_fails_by_its_ledger(tmp_path):
    """A sheet released at both ends; 50 us is the time in which a wave crosses a cell."""
    for step, code, verdict in ((50, 0, "holds"), (200, 3, "fails")):
        latcon("continuum", CASES / "quick.prm", "--quiet", "--output-dir", tmp_path / str(step), *settings(
            "Continuum/solution=motion", "Left edge/condition=free", "Right edge/condition=free", "Time/end=1 ms",
            f"Continuum/time step={step} us", "Output/energy interval=1", "Output/frame interval=0"), expect=code)
        rows = {row["quantity"]: row for row in read_csv(tmp_path / str(step) / "results.csv")}
        row = rows["energy imbalance over energy exchanged"]
        assert row["verdict"] == verdict
        energy = numbers(tmp_path / str(step) / "energy.csv")
        exchanged = energy["viscous"][-1] + abs(energy["boundary_work"]).max() + abs(energy["kinetic"] - energy["kinetic"][0]).max()
        assert float(row["error"]) == pytest.approx(abs(energy["imbalance"]).max() / exchanged, abs=1e-12)


def test_damped_motion_is_the_same_solved_directly_or_by_iterations(out):
    ledgers, counts = [], []
    for limit in (20000, 0):
        latcon(*arguments(out, 8, across="free"), *settings(
            "Left edge/condition=held", "Right edge/condition=held", "Nearest neighbours/viscosity=50",
            f"Continuum/direct limit={limit}"))
        ledgers.append(numbers(out / "energy.csv"))
        record = read_json(out / "run.json")
        counts.append((record["newton_iterations"], record["linear_iterations"]))
    direct, iterated = ledgers
    assert direct["viscous"][-1] > 0.01 * direct["kinetic"][0]
    # Newton stops at residuals of 1e-10; energies are of the order of the first.
    for name in ("elastic", "kinetic", "viscous"):
        np.testing.assert_allclose(iterated[name], direct[name], rtol=0., atol=1e-9 * direct["kinetic"][0])
    (newton, none), (_, linear) = counts
    assert none == 0
    assert linear >= newton >= 10  # steps


def test_ends_when_it_is_told(out):
    latcon(*arguments(out, 8, step="auto"))
    steps = np.diff(numbers(out / "energy.csv")["t"])
    assert steps.sum() / 5e-5 == pytest.approx(1., abs=1e-12)
    # Half the time in which a longitudinal wave crosses the smaller side of a cell, or slightly less.
    longest = 0.5 * (LENGTH / 8) / math.sqrt(3. * MODULUS / DENSITY)
    assert 1 / longest < 1 / steps.max() < 1 / longest + 1 / 5e-5
