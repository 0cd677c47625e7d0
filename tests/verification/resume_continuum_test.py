#!/usr/bin/python3
"""Tests of motions of the finite element sheet that are stopped, resumed, or fail.

Kills at arbitrary times are tested in tests/faults.

Usage: resume_continuum_test.py PATH_OF_LATCON
"""
import json
import os
import pathlib
import signal
import subprocess
import sys
import time
import unittest

import h5py
import numpy as np

sys.dont_write_bytecode = True
from program import CASES, LATCON, TemporaryFolder, children, frames, latcon, latcon_on_ranks, read_csv


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
ENVIRONMENT = dict(os.environ, OMPI_ALLOW_RUN_AS_ROOT="1", OMPI_ALLOW_RUN_AS_ROOT_CONFIRM="1")


def command(case, folder, *more):
    entries = [word for key, value in case.items() for word in ("--set", f"{key}={value}")]
    return ["continuum", str(CASES / "shear_layer.prm"), *entries, "--output-dir", str(folder), *more]


def files(folder):
    return {path.name: path.read_bytes() for path in folder.iterdir() if path.is_file() and path.name not in ("run.json", "log.txt")}


class Resume(TemporaryFolder):
    def checkpoints(self):
        return sorted((self.out / "checkpoints").glob("*.h5"))

    def run_json(self):
        return json.loads((self.out / "run.json").read_text())

    def run_to_end(self, *more, case=WAVES, ranks=1):
        arguments = command(case, self.out, *more)
        run = latcon(*arguments) if ranks == 1 else latcon_on_ranks(ranks, *arguments)
        self.assertEqual(run.returncode, 0, run.stderr)
        return run

    def stop(self, which, case=WAVES, ranks=1, victim=None):
        """Sends the signal `which` once there are checkpoints, to mpirun, or to that rank alone. @return exit code"""
        launcher = [] if ranks == 1 else ["mpirun", "--oversubscribe", "-n", str(ranks)]
        with subprocess.Popen([*launcher, LATCON, *command(case, self.out)], stdout=subprocess.DEVNULL,
                              stderr=subprocess.PIPE, env=ENVIRONMENT) as run:
            while not self.checkpoints():
                self.assertIsNone(run.poll(), "it ended too soon")
                time.sleep(0.005)
            target = run.pid
            if victim is not None:
                [target] = [pid for pid in children(run.pid) if f"OMPI_COMM_WORLD_RANK={victim}\0".encode()
                            in pathlib.Path(f"/proc/{pid}/environ").read_bytes()]
            started = children(run.pid) if launcher else []
            os.kill(target, which)
            run.communicate(timeout=600)
            # The ranks outlive an mpirun that was killed for a moment.
            while any(pathlib.Path(f"/proc/{rank}").exists() for rank in started):
                time.sleep(0.005)
            return run.returncode

    def goes_on_to_the_same_files(self, which, case=WAVES, ranks=1, victim=None):
        self.out = self.folder / "undisturbed"
        self.run_to_end(case=case, ranks=ranks)
        expected = files(self.out)
        self.out = self.folder / "stopped"
        status = self.stop(which, case, ranks, victim)
        self.assertNotEqual(status, 0)
        with h5py.File(self.checkpoints()[-1], "r") as file:
            step = int(file["run/step"][0])
        self.assertLess(step, 20)
        if status == 130:
            # The instant of the signal is in a frame, in the table and in a checkpoint.
            with h5py.File(self.checkpoints()[-1], "r") as file:
                self.assertEqual(file["solver/time"][0], frames(self.out / "continuum.pvd")[-1][0])
                self.assertEqual(file["solver/time"][0], float(read_csv(self.out / "energy.csv")[-1]["t"]))
            self.assertEqual(self.run_json()["exit_code"], 130)
        run = self.run_to_end("--resume", case=case, ranks=ranks)
        self.assertIn(f"step {step},", run.stdout)
        self.assertEqual(self.run_json()["resumed_from"]["step"], step)
        found = files(self.out)
        self.assertEqual(sorted(found), sorted(expected))
        for name, content in expected.items():
            self.assertEqual(found[name] == content, True, name)
        return status

    def test_signal(self):
        self.assertEqual(self.goes_on_to_the_same_files(signal.SIGTERM), 130)

    def test_kill_with_multigrid(self):
        self.assertEqual(self.goes_on_to_the_same_files(signal.SIGKILL, BY_MULTIGRID), -9)

    def test_signal_to_one_rank_stops_all(self):
        # mpirun returns the exit code of a rank.
        self.assertEqual(self.goes_on_to_the_same_files(signal.SIGTERM, ranks=2, victim=1), 130)

    def test_killed_rank_ends_all(self):
        self.goes_on_to_the_same_files(signal.SIGKILL, BY_MULTIGRID, ranks=2, victim=1)

    def test_on_another_number_of_ranks(self):
        self.out = self.folder / "undisturbed"
        self.run_to_end()
        expected = {name: np.array([float(row[name]) for row in read_csv(self.out / "energy.csv")])
                    for name in ("t", "elastic", "kinetic")}
        self.out = self.folder / "stopped"
        self.stop(signal.SIGKILL, ranks=2)
        self.run_to_end("--resume")
        self.assertEqual([time for time, _ in frames(self.out / "continuum.pvd")],
                         [time for time, _ in frames(self.folder / "undisturbed" / "continuum.pvd")])
        for time_, file in frames(self.out / "continuum.pvd"):
            self.assertTrue(file.exists(), file)
        for name, column in expected.items():
            found = np.array([float(row[name]) for row in read_csv(self.out / "energy.csv")])
            # Newton stops at 1e-10 of the forces.
            np.testing.assert_allclose(found, column, rtol=1e-8, atol=1e-8 * abs(column).max())

    def test_equilibrium_starts_from_the_beginning(self):
        run = self.run_to_end("--resume", case={**WAVES, "Continuum/solution": "equilibrium"})
        self.assertIn("starting from the beginning", run.stdout)


class Failure(TemporaryFolder):
    def test_last_good_state_is_left(self):
        for ranks in (1, 2):
            self.out = self.folder / str(ranks)
            run = latcon_on_ranks(ranks, *command(COLLISION, self.out))
            self.assertEqual(run.returncode, 4, run.stderr)
            self.assertRegex(run.stderr, r"the time step from [\d.e-]+ s failed")
            self.assertRegex(run.stderr, r"X = \([-\d.e]+, [-\d.e]+\) m")
            last = float(run.stderr.split("the time step from ")[1].split(" s ")[0])
            rows = read_csv(self.out / "energy.csv")
            self.assertAlmostEqual(float(rows[-1]["t"]), last, delta=1e-6)
            self.assertGreater(float(rows[-1]["t"]), 0.)
            time_, file = frames(self.out / "continuum.pvd")[-1]
            self.assertEqual(time_, float(rows[-1]["t"]))
            self.assertTrue(file.exists())
            self.assertFalse(list(self.out.rglob("*.part")))

    def test_output_that_fails_on_one_rank_ends_all(self):
        self.out.mkdir()
        for which in ("continuum_0001.1.vtu", "continuum_0002.pvtu", "energy.csv"):
            (self.out / which).mkdir()
            (self.out / which / "mine").write_text("")
            run = latcon_on_ranks(2, *command(WAVES, self.out))
            self.assertEqual(run.returncode, 5, run.stderr)
            self.assertIn(f"cannot write {self.out / which}: it is a folder", run.stderr)
            (self.out / which / "mine").unlink()
            (self.out / which).rmdir()
            for _, file in frames(self.out / "continuum.pvd"):
                self.assertTrue(file.exists())
            self.assertFalse(list(self.out.rglob("*.part")))


if __name__ == "__main__":
    unittest.main(verbosity=2)
