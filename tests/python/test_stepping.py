"""Stepping from Python gives the bits of latcon fracture; forces, moving edges, checkpoints and frames of one's own."""
import os
import subprocess
import sys

import numpy as np
import pytest

import latcon
from conftest import rows, tiny_case
from latcon.frames import read_frame
from latcon.stepping import Simulation


@pytest.fixture
def sim():
    return Simulation(tiny_case())


def test_steps_are_those_of_the_program(crack, sim):
    written = [[float(row[name]) for name in ("t", "X", "Y", "stretch")] for row in rows(crack.directory / "broken_bonds.csv")]
    last = crack.frames[-1]
    while sim.time < last.time:
        sim.step()
    assert sim.time == last.time and len(written) > 20
    assert [[time, X, Y, stretch] for time, _, _, X, Y, stretch in sim.broken] == written
    np.testing.assert_array_equal(sim.reference, last.reference)
    np.testing.assert_array_equal(np.column_stack((sim.x, sim.y))[sim.sites] - sim.reference, last.fields["displacement"])
    np.testing.assert_array_equal(np.column_stack((sim.vx, sim.vy))[sim.sites], last.fields["velocity"])
    energies, final = sim.energies, crack.energy.iloc[-1]
    assert all(energies[name] == final[name] for name in ("elastic", "kinetic", "viscous", "broken", "boundary_work", "imbalance"))
    assert sim.tip == tuple(crack.path[["X", "Y"]].iloc[-1])
    assert {tuple(sorted(ends)) for ends in sim.bonds.tolist()} == {tuple(sorted(ends)) for ends in last.bonds.tolist()}


@pytest.mark.parametrize("stages", [None, 3, 4])
def test_views_follow_the_steps_and_cannot_be_written(stages):
    sim = Simulation(tiny_case().set({"Time/integrator": "runge-kutta-chebyshev", "Time/stages": stages} if stages else {}))
    x = sim.x
    before = x.copy()
    for _ in range(3):
        sim.step()
        assert (x != before).any() and np.shares_memory(x, sim.x)
    with pytest.raises(ValueError, match="read-only"):
        x[0] = 1


def test_a_checkpoint_continues_with_the_same_bits(sim, tmp_path):
    sim.step(300)
    sim.step(5, lambda one: np.full((len(one.sites), 2), 10.0))
    sim.checkpoint(tmp_path / "state.h5")
    other = Simulation(tiny_case(), tmp_path / "state.h5")
    assert other.time == sim.time and other.energies == sim.energies
    n_before = len(sim.broken)
    for one in (sim, other):
        one.step(300)
    assert sim.broken[n_before:] == other.broken and (sim.x == other.x).all() and (sim.vy == other.vy).all()
    with pytest.raises(ValueError, match="state.h5: .*of another size"):
        Simulation(tiny_case().set("Sheet/length", "2 cm"), tmp_path / "state.h5")
    with pytest.raises(ValueError, match="other.h5: No such file"):
        Simulation(tiny_case(), tmp_path / "other.h5")


def test_forces_add_their_impulse(sim):
    free = np.zeros((len(sim.sites), 2))
    other = Simulation(tiny_case())
    start = sim.x.copy()
    sim.step(20, lambda _: free)
    other.step(20)
    moved = np.abs(other.x - start).max()
    assert moved > 0 and np.abs(sim.x - other.x).max() < 1e-2 * moved  # forces of bonds are evaluated anew after an impulse
    force = free.copy()
    middle = np.argmin((sim.reference[:, 0] - sim.reference[:, 0].mean())**2 + (sim.reference[:, 1] - 4e-3)**2)
    force[middle, 1] = 1e3
    before = (sim.vy - other.vy)[sim.sites].sum()
    sim.step(1, lambda _: force)
    other.step(1)
    gained = (sim.vy - other.vy)[sim.sites].sum() - before  # bonds share it out, and the edges are too far away
    mass = latcon.Case("quick")["Material/density"] * np.sqrt(3) / 2 * latcon.Case("quick")["Sheet/spacing"]**2
    assert gained == pytest.approx(1e3 * sim.time_step / mass, rel=0.01)
    assert abs(sim.energies["imbalance"]) < 1e-3 * sim.energies["elastic"]


def test_edges_move_and_work_is_counted(sim):
    top = sim.sites[np.flatnonzero(sim.reference[:, 1] == sim.reference[:, 1].max())]
    before, work = sim.y[top].copy(), sim.energies["boundary_work"]
    sim.move_edges([[0, 0], [0, -100.0]])
    sim.step(100)
    expected = before - 100.0 * sim.reference[:, 1].max() * 100 * sim.time_step
    np.testing.assert_allclose(sim.y[top], expected, rtol=1e-9)
    assert sim.energies["boundary_work"] < work  # the sheet pulls the edges along
    sim.move_edges(0)
    still = sim.y[top].copy()
    sim.step(10)
    assert (sim.y[top] == still).all()


def test_frames_are_read_as_written(sim, tmp_path):
    sim.step(100)
    sim.write_frame(tmp_path / "frame.vtp")
    frame, written = sim.frame(), read_frame(tmp_path / "frame.vtp", sim.time)
    for name in ("reference", "bonds", "stretch"):
        np.testing.assert_array_equal(getattr(written, name), getattr(frame, name))
    for name in ("displacement", "velocity", "lost_bonds"):
        np.testing.assert_array_equal(written.fields[name], frame.fields[name])


@pytest.mark.parametrize("given, count", [({}, "20000"), ({"GOMP_SPINCOUNT": "77"}, "77"), ({"OMP_WAIT_POLICY": "passive"}, "0")])
def test_waiting_threads_sleep_unless_they_are_told_otherwise(given, count):
    free = {name: value for name, value in os.environ.items() if name not in ("OMP_WAIT_POLICY", "GOMP_SPINCOUNT")}
    code = "from latcon.stepping import Simulation; from conftest import tiny_case; Simulation(tiny_case())"
    run = subprocess.run([sys.executable, "-c", code], env=dict(free, OMP_DISPLAY_ENV="verbose", **given), capture_output=True, text=True,
                         cwd=os.path.dirname(__file__), check=True)
    assert f"GOMP_SPINCOUNT = '{count}'" in run.stderr


def test_cases_that_are_no_crack_are_refused():
    with pytest.raises(ValueError, match="fracture needs an end time"):
        Simulation(tiny_case().set("Time/end", 0))
