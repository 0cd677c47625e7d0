"""Tests of motions of the finite element sheet that are stopped, resumed, or fail.

Kills at arbitrary times are tested in tests/faults.
"""
import os
import pathlib
import re
import signal

import h5py
import numpy as np
import pytest

from program import (
    CASES, checkpoints, children, expect_same, files, frames, latcon, latcon_on_ranks, numbers, on_ranks, read_json, wait_for)

# Waves in a layer between held faces: 12 steps, checkpoints after every third, four frames.
WAVES = {
    "Continuum/solution": "motion", "Continuum/law": "cauchy-born", "Continuum/ratio": "auto",
    "Continuum/cells x": 4, "Continuum/cells y": 8, "Continuum/degree": 2, "Continuum/static length": "0.5 mm",
    "Continuum/inertia length": "1 mm", "Bottom edge/normal gradient": "free", "Top edge/normal gradient": "free",
    "Loading/shear": 0.1, "Initial state/base": "loading",
    "Initial state/velocity x": "6*sin(pi*y/0.02)^2*sin(2*pi*x/0.01)", "Time/end": "0.06 ms",
    "Continuum/time step": "5 us", "Output/frame interval": "0.02 ms", "Output/energy interval": 2,
    "Checkpoints/steps": 3}
# Two sides thrown at each other, faster than Newton's method follows in steps of that length.
COLLISION = {**WAVES, "Initial state/velocity x": "0", "Initial state/velocity y": "-3000*sin(2*pi*y/0.02)",
             "Continuum/time step": "0.5 us", "Time/end": "20 us", "Checkpoints/steps": 0}


def command(case, folder, *more):
    entries = [word for key, value in case.items() for word in ("--set", f"{key}={value}")]
    return ["continuum", str(CASES / "shear_layer.prm"), *entries, "--output-dir", str(folder), *more]


def run_to_end(out, *more, case=WAVES, ranks=1):
    return latcon_on_ranks(ranks, *command(case, out, *more))


def stop(start, out, which):
    """Sends the signal `which` to the second of two ranks once they have written checkpoints. @return exit code of mpirun, step"""
    run = start(*command(WAVES, out), launcher=on_ranks(2))
    assert wait_for(lambda: checkpoints(out), run), "it ended too soon"
    [second] = [pid for pid in children(run.pid) if b"OMPI_COMM_WORLD_RANK=1\0" in pathlib.Path(f"/proc/{pid}/environ").read_bytes()]
    os.kill(second, which)
    run.communicate(timeout=600)
    with h5py.File(checkpoints(out)[-1], "r") as file:
        step = int(file["run/step"][0])
    assert step < 12
    return run.returncode, step


@pytest.fixture(scope="module")
def undisturbed(module_path):
    """The folder of a run on two ranks to its end, which tests leave as it is."""
    run_to_end(module_path / "whole", ranks=2)
    return module_path / "whole"


# A run on one rank that is killed: tests/faults; the multigrid, in one process: tests/continuum/motion_archive_test.cc.
def test_goes_on_to_the_same_files(start, out, undisturbed):
    status, step = stop(start, out, signal.SIGTERM)
    assert status == read_json(out / "run.json")["exit_code"] == 130
    # The instant of the signal is in a frame, in the table and in a checkpoint.
    with h5py.File(checkpoints(out)[-1], "r") as file:
        assert file["solver/time"][0] == frames(out / "continuum.pvd")[-1][0] == numbers(out / "energy.csv")["t"][-1]
    run = run_to_end(out, "--resume", ranks=2)
    assert f"step {step}," in run.stdout
    assert read_json(out / "run.json")["resumed_from"]["step"] == step
    expect_same(out, files(undisturbed))


def test_on_another_number_of_ranks_after_a_kill(start, out, undisturbed):
    status, _ = stop(start, out, signal.SIGKILL)
    assert status in range(1, 256)
    run_to_end(out, "--resume")
    assert [time for time, _ in frames(out / "continuum.pvd")] == [time for time, _ in frames(undisturbed / "continuum.pvd")]
    for _, file in frames(out / "continuum.pvd"):
        assert file.exists(), file
    found, expected = numbers(out / "energy.csv"), numbers(undisturbed / "energy.csv")
    for name in ("t", "elastic", "kinetic"):
        # Newton stops at 1e-10 of the forces.
        np.testing.assert_allclose(found[name], expected[name], rtol=1e-8, atol=1e-8 * abs(expected[name]).max())


def test_equilibrium_starts_from_the_beginning(out):
    run = run_to_end(out, "--resume", case={**WAVES, "Continuum/solution": "equilibrium"})
    assert "starting from the beginning" in run.stdout


def test_last_good_state_is_left(out):
    run = latcon(*command(COLLISION, out), expect=4)
    assert re.search(r"X = \([-\d.e]+, [-\d.e]+\) m", run.stderr)
    last = float(re.search(r"the time step from ([\d.e-]+) s failed", run.stderr)[1])
    time_, file = frames(out / "continuum.pvd")[-1]
    assert time_ == numbers(out / "energy.csv")["t"][-1] == pytest.approx(last, abs=1e-6)
    assert time_ > 0.
    assert file.exists()
    assert not list(out.rglob("*.part"))


def test_output_that_fails_on_one_rank_ends_all(out):
    blocked = out / "continuum_0001.1.vtu"
    blocked.mkdir(parents=True)
    run = latcon_on_ranks(2, *command(WAVES, out), expect=5)
    assert f"cannot write {blocked}: it is a folder" in run.stderr
    for _, file in frames(out / "continuum.pvd"):
        assert file.exists()
    assert not list(out.rglob("*.part"))
