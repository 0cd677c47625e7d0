"""Tests of motions of the finite element sheet that are stopped, resumed, or fail.

Kills at arbitrary times are tested in tests/faults.
"""
import functools
import json
import os
import pathlib
import re
import signal
import subprocess
import time

import h5py
import numpy as np
import pytest

from program import CASES, LATCON, children, expect_same, files, frames, latcon, latcon_on_ranks, read_csv

# Waves in a layer between held faces: 20 steps, checkpoints after every third, six frames.
WAVES = {
    "Continuum/solution": "motion", "Continuum/law": "cauchy-born", "Continuum/ratio": "auto",
    "Continuum/cells x": 4, "Continuum/cells y": 8, "Continuum/degree": 2, "Continuum/static length": "0.5 mm",
    "Continuum/inertia length": "1 mm", "Bottom edge/normal gradient": "free", "Top edge/normal gradient": "free",
    "Loading/shear": 0.1, "Initial state/base": "loading",
    "Initial state/velocity x": "6*sin(pi*y/0.02)^2*sin(2*pi*x/0.01)", "Time/end": "0.1 ms",
    "Continuum/time step": "5 us", "Output/frame interval": "0.02 ms", "Output/energy interval": 2,
    "Checkpoints/steps": 3}
# Waves with conjugate gradients, which do not support periodic edges.
BY_MULTIGRID = {**WAVES, "Left edge/condition": "held", "Right edge/condition": "held", "Continuum/direct limit": 0,
                "Initial state/velocity x": "6*sin(pi*y/0.02)^2*sin(pi*x/0.01)^2"}
# Two sides thrown at each other, faster than Newton's method follows in steps of that length.
COLLISION = {**WAVES, "Initial state/velocity x": "0", "Initial state/velocity y": "-3000*sin(2*pi*y/0.02)",
             "Continuum/time step": "0.5 us", "Time/end": "20 us", "Checkpoints/steps": 0}
CASE = {"direct": WAVES, "multigrid": BY_MULTIGRID}
ENVIRONMENT = dict(os.environ, OMPI_ALLOW_RUN_AS_ROOT="1", OMPI_ALLOW_RUN_AS_ROOT_CONFIRM="1")


def command(case, folder, *more):
    entries = [word for key, value in case.items() for word in ("--set", f"{key}={value}")]
    return ["continuum", str(CASES / "shear_layer.prm"), *entries, "--output-dir", str(folder), *more]


def checkpoints(out):
    return sorted((out / "checkpoints").glob("*.h5"))


def run_json(out):
    return json.loads((out / "run.json").read_text())


def run_to_end(out, *more, case=WAVES, ranks=1):
    arguments = command(case, out, *more)
    run = latcon(*arguments) if ranks == 1 else latcon_on_ranks(ranks, *arguments)
    assert run.returncode == 0, run.stderr
    return run


def stop(out, which, case=WAVES, victim=None):
    """Sends the signal `which` once two ranks have written checkpoints, to mpirun, or to that rank alone. @return exit code"""
    with subprocess.Popen(["mpirun", "--oversubscribe", "-n", "2", LATCON, *command(case, out)], stdout=subprocess.DEVNULL,
                          stderr=subprocess.PIPE, env=ENVIRONMENT) as run:
        while not checkpoints(out):
            assert run.poll() is None, "it ended too soon"
            time.sleep(0.005)
        target = run.pid
        if victim is not None:
            [target] = [pid for pid in children(run.pid) if f"OMPI_COMM_WORLD_RANK={victim}\0".encode()
                        in pathlib.Path(f"/proc/{pid}/environ").read_bytes()]
        started = children(run.pid)
        os.kill(target, which)
        run.communicate(timeout=600)
        # The ranks outlive an mpirun that was killed for a moment.
        while any(pathlib.Path(f"/proc/{rank}").exists() for rank in started):
            time.sleep(0.005)
        return run.returncode


@pytest.fixture(scope="module")
def undisturbed(module_path):
    """Returns the folder of a run of a case on two ranks to its end, which tests leave as it is."""
    @functools.cache
    def of(name):
        run_to_end(module_path / name, case=CASE[name], ranks=2)
        return module_path / name
    return of


# mpirun returns the exit code of a rank. A run on one rank that is killed: tests/faults.
@pytest.mark.parametrize("which, name, status", [(signal.SIGTERM, "direct", {130}), (signal.SIGKILL, "multigrid", set(range(1, 256)))])
def test_goes_on_to_the_same_files(out, undisturbed, which, name, status):
    expected, case = files(undisturbed(name)), CASE[name]
    ended = stop(out, which, case, victim=1)
    assert ended in status
    with h5py.File(checkpoints(out)[-1], "r") as file:
        step = int(file["run/step"][0])
        assert step < 20
        if ended == 130:
            # The instant of the signal is in a frame, in the table and in a checkpoint.
            assert file["solver/time"][0] == frames(out / "continuum.pvd")[-1][0] == float(read_csv(out / "energy.csv")[-1]["t"])
            assert run_json(out)["exit_code"] == 130
    run = run_to_end(out, "--resume", case=case, ranks=2)
    assert f"step {step}," in run.stdout
    assert run_json(out)["resumed_from"]["step"] == step
    expect_same(out, expected)


def test_on_another_number_of_ranks(out, undisturbed):
    whole = undisturbed("direct")
    stop(out, signal.SIGKILL)
    run_to_end(out, "--resume")
    assert [time for time, _ in frames(out / "continuum.pvd")] == [time for time, _ in frames(whole / "continuum.pvd")]
    for _, file in frames(out / "continuum.pvd"):
        assert file.exists(), file
    rows, expected = read_csv(out / "energy.csv"), read_csv(whole / "energy.csv")
    for name in ("t", "elastic", "kinetic"):
        column = np.array([float(row[name]) for row in expected])
        # Newton stops at 1e-10 of the forces.
        np.testing.assert_allclose([float(row[name]) for row in rows], column, rtol=1e-8, atol=1e-8 * abs(column).max())


def test_equilibrium_starts_from_the_beginning(out):
    run = run_to_end(out, "--resume", case={**WAVES, "Continuum/solution": "equilibrium"})
    assert "starting from the beginning" in run.stdout


def test_last_good_state_is_left(out):
    run = latcon(*command(COLLISION, out))
    assert run.returncode == 4, run.stderr
    assert re.search(r"X = \([-\d.e]+, [-\d.e]+\) m", run.stderr)
    last = float(re.search(r"the time step from ([\d.e-]+) s failed", run.stderr)[1])
    time_, file = frames(out / "continuum.pvd")[-1]
    assert time_ == float(read_csv(out / "energy.csv")[-1]["t"]) == pytest.approx(last, abs=1e-6)
    assert time_ > 0.
    assert file.exists()
    assert not list(out.rglob("*.part"))


def test_output_that_fails_on_one_rank_ends_all(out):
    out.mkdir()
    for which in ("continuum_0001.1.vtu", "energy.csv"):
        (out / which).unlink(missing_ok=True)  # of the run before, which wrote its tables with each frame
        (out / which).mkdir()
        (out / which / "mine").write_text("")
        run = latcon_on_ranks(2, *command(WAVES, out))
        assert run.returncode == 5, run.stderr
        assert f"cannot write {out / which}: it is a folder" in run.stderr
        (out / which / "mine").unlink()
        (out / which).rmdir()
        for _, file in frames(out / "continuum.pvd"):
            assert file.exists()
        assert not list(out.rglob("*.part"))
