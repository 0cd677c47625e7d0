#!/usr/bin/python3
"""Tests of checkpoints and --resume: choice of the checkpoint, messages about unusable ones, files of a stopped run.

Results of runs that are stopped at arbitrary times and resumed are tested in tests/faults.

Usage: resume_test.py PATH_OF_LATCON
"""
import hashlib
import json
import math
import pathlib
import re
import shutil
import signal
import subprocess
import sys
import tempfile
import time
import unittest

import h5py
import vtk

sys.dont_write_bytecode = True
from program import CASES, LATCON, TemporaryFolder, frames, latcon, latcon_on_ranks, read, read_csv

STRIP = ["fracture", CASES / "quick.prm", "--skip-verification", "--no-report", "--set", "Sheet/length=2.5 cm", "--set",
         "Sheet/height=1.25 cm", "--set", "Output/frame interval=0.1 ms", "--set", "Checkpoints/steps=160", "--set",
         "Time/end=0.8 ms", "--set", "Near tip/interval=0"]


def files(folder):
    return {path.name: path.read_bytes() for path in folder.iterdir() if path.is_file() and path.name not in ("run.json", "log.txt")}


class Resume(TemporaryFolder):
    @classmethod
    def setUpClass(cls):
        """Runs the strip to its end, once for all tests that begin with it."""
        folder = tempfile.TemporaryDirectory()
        cls.addClassCleanup(folder.cleanup)
        cls.ended = pathlib.Path(folder.name) / "out"
        run = latcon(*STRIP, "--output-dir", cls.ended)
        assert run.returncode in (0, 3), run.stderr

    def begin_with_the_end(self):
        shutil.copytree(self.ended, self.out)

    def run_to_end(self, *more):
        run = latcon(*STRIP, "--output-dir", self.out, *more)
        self.assertIn(run.returncode, (0, 3), run.stderr)
        return run

    def checkpoints(self):
        return sorted((self.out / "checkpoints").glob("*.h5"))

    def step_told(self):
        return json.loads((self.out / "run.json").read_text())["resumed_from"]["step"]

    def test_last_two_are_kept_and_tell_what_they_are(self):
        self.begin_with_the_end()
        found = self.checkpoints()
        self.assertEqual(len(found), 2)
        steps = []
        for path in found:
            with h5py.File(path, "r") as file:
                steps.append(int(file["run/step"][0]))
                self.assertEqual(path.name, f"checkpoint-{steps[-1]:012}.h5")
                self.assertEqual(file["run/command"][0], b"fracture")
                self.assertEqual(file["run/schema"][0], 4)
                self.assertIn(b"Sheet/length = 0.025\n", file["run/case"][0])
                self.assertEqual(file["run/time"][0], file["simulation/time"][0])
                sites = file["simulation/x"].shape
                self.assertEqual(file["simulation/bonds"].shape, sites)
                self.assertGreater(file["record/tip/X"].size, 0)
        self.assertEqual(steps[1] - steps[0], 160)

    def test_case_hash_is_that_of_the_run(self):
        self.begin_with_the_end()
        with h5py.File(self.checkpoints()[-1], "r") as file:
            case, case_hash = file["run/case"][0], file["run/case_hash"][0].decode()
        self.assertEqual(case_hash, hashlib.sha256(case).hexdigest())
        self.assertEqual(json.loads((self.out / "run.json").read_text())["case_hash"], case_hash)

    def test_stopped_run_goes_on_with_the_same_bits_on_other_ranks_and_threads(self):
        expected = files(self.ended)
        with subprocess.Popen([LATCON, *map(str, STRIP), "--output-dir", str(self.out), "--threads", "2"],
                              stdout=subprocess.DEVNULL) as run:
            while len(self.checkpoints()) < 2:
                self.assertIsNone(run.poll(), "it ended too soon")
                time.sleep(0.01)
            run.send_signal(signal.SIGTERM)
            self.assertEqual(run.wait(timeout=600), 130)
        stopped = json.loads((self.out / "run.json").read_text())
        self.assertEqual(stopped["exit_code"], 130)
        # The instant of the signal is in a frame and in a checkpoint.
        with h5py.File(self.checkpoints()[-1], "r") as file:
            self.assertEqual(file["run/time"][0], frames(self.out / "lattice.pvd")[-1][0])
            step = int(file["run/step"][0])
        run = latcon_on_ranks(2, *STRIP, "--resume", "--output-dir", self.out, "--threads", "1")
        self.assertIn(run.returncode, (0, 3), run.stderr)
        self.assertIn(f"step {step},", run.stdout)
        self.assertEqual(self.step_told(), step)
        found = files(self.out)
        self.assertEqual(sorted(found), sorted(expected))
        for name, content in expected.items():
            self.assertEqual(found[name] == content, True, name)

    def test_checkpoint_of_another_program_is_named(self):
        self.begin_with_the_end()
        own = json.loads((self.out / "run.json").read_text())["program_hash"]
        program = pathlib.Path(LATCON).resolve()
        self.assertEqual(own, hashlib.sha256(program.read_bytes()).hexdigest())
        (self.folder / "bin").mkdir()
        (self.folder / "share").symlink_to(program.parents[1] / "share")
        other = self.folder / "bin" / "latcon"
        other.write_bytes(program.read_bytes() + b"\0")
        other.chmod(0o755)
        run = latcon(*STRIP, "--resume", "--output-dir", self.out, program=other)
        self.assertIn(run.returncode, (0, 3), run.stderr)
        self.assertIn("It was written by another build of latcon, commit ", run.stdout)
        info = json.loads((self.out / "run.json").read_text())
        self.assertEqual(info["resumed_from"]["program_hash"], own)
        self.assertEqual(info["program_hash"], hashlib.sha256(other.read_bytes()).hexdigest())

    def test_resumed_run_takes_the_same_samples_near_the_tip(self):
        change = {"Near tip/interval=0": "Near tip/interval=7e-6", "Time/end=0.8 ms": "Time/end=1.2 ms"}
        sampled = [*(change.get(word, word) for word in STRIP), "--set", "Near tip/ahead=4 mm", "--set",
                   "Near tip/behind=6 mm", "--set", "Near tip/half height=4 mm"]
        run = latcon(*sampled, "--output-dir", self.out)
        self.assertIn(run.returncode, (0, 3), run.stderr)
        expected = files(self.out)
        self.assertGreater(json.loads(expected["near_tip.json"])["samples"], 20)
        self.checkpoints()[-1].unlink()
        last = self.checkpoints()[-1].read_bytes()
        for ranks in (1, 2):
            for path in self.checkpoints():
                path.unlink()
            (self.out / "checkpoints" / "checkpoint-0.h5").write_bytes(last)
            run = latcon_on_ranks(ranks, *sampled, "--resume", "--output-dir", self.out)
            self.assertIn(run.returncode, (0, 3), run.stderr)
            self.assertIn("resumed_from", json.loads((self.out / "run.json").read_text()))
            found = files(self.out)
            for name in ("near_tip.json", "near_tip.vti", "near_tip_folded.vti"):
                self.assertEqual(found[name] == expected[name], True, f"{name} on {ranks} ranks")

    def test_without_any_it_starts_from_the_beginning(self):
        run = self.run_to_end("--resume")
        self.assertIn("No checkpoint in", run.stdout)
        self.assertNotIn("resumed_from", json.loads((self.out / "run.json").read_text()))

    def test_files_may_be_renamed(self):
        self.begin_with_the_end()
        first, last = self.checkpoints()
        with h5py.File(last, "r") as file:
            step = int(file["run/step"][0])
        last.rename(last.with_name("a.h5"))
        first.rename(first.with_name("b.h5"))
        run = self.run_to_end("--resume")
        self.assertIn("a.h5", run.stdout)
        self.assertEqual(self.step_told(), step)

    def test_older_one_is_taken_if_the_last_is_damaged(self):
        self.begin_with_the_end()
        expected = files(self.out)
        first, last = self.checkpoints()
        content = bytearray(last.read_bytes())
        content[len(content) // 2] ^= 16
        last.write_bytes(content)
        run = self.run_to_end("--resume")
        self.assertIn(f"{last}: it was changed or damaged", run.stderr)
        self.assertIn(str(first), run.stdout)
        self.assertEqual(files(self.out) == expected, True)

    def test_nothing_is_touched_if_none_can_be_used(self):
        self.begin_with_the_end()
        first, last = self.checkpoints()
        first.write_bytes(first.read_bytes()[:1000])
        last.write_text("not a checkpoint at all\n")
        (self.out / "checkpoints" / "notes.txt").write_text("mine")
        before = {path: path.stat().st_mtime_ns for path in self.out.rglob("*")}
        run = latcon(*STRIP, "--output-dir", self.out, "--resume")
        self.assertEqual(run.returncode, 2)
        self.assertIn(f"{first}: it was changed or damaged", run.stderr)
        self.assertIn(f"{last}: it is not a checkpoint", run.stderr)
        self.assertIn("omit --resume", run.stderr)
        self.assertEqual({path: path.stat().st_mtime_ns for path in self.out.rglob("*")}, before)

    def test_those_of_another_case_are_refused_with_the_difference(self):
        self.begin_with_the_end()
        run = latcon(*STRIP, "--output-dir", self.out, "--resume", "--set", "Fracture/breaking stretch=3.1")
        self.assertEqual(run.returncode, 2)
        self.assertIn("another case: Fracture/breaking stretch = 3.05 in the checkpoint, 3.1 in this case", run.stderr)
        run = latcon("lattice", *STRIP[1:2], "--output-dir", self.out, "--resume", "--set", "Lattice/solution=motion")
        self.assertEqual(run.returncode, 2)
        self.assertIn("written by `latcon fracture`", run.stderr)

    def test_how_often_they_are_written_may_change(self):
        self.begin_with_the_end()
        run = self.run_to_end("--resume", "--set", "Checkpoints/interval=1")
        self.assertIn("Resuming from", run.stdout)

    def test_new_start_keeps_those_of_the_run_before(self):
        self.begin_with_the_end()
        before = [path.name for path in self.checkpoints()]
        self.run_to_end()
        self.assertEqual(sorted(path.name for path in (self.out / "checkpoints.old").glob("*.h5")), before)
        self.assertEqual([path.name for path in self.checkpoints()], before)

    def test_by_wall_time(self):
        place = STRIP.index("Checkpoints/steps=160")
        arguments = STRIP[:place - 1] + STRIP[place + 1:]
        run = latcon(*arguments, "--output-dir", self.out, "--set", "Checkpoints/interval=0.05 s")
        self.assertIn(run.returncode, (0, 3), run.stderr)
        self.assertEqual(len(self.checkpoints()), 2)


class BlowUp(TemporaryFolder):
    def push(self, checkpoint, speed):
        """Gives a site in the middle of the sheet in a checkpoint another velocity."""
        with h5py.File(checkpoint, "r+") as file:
            velocities = file["simulation/vx"]
            velocities[velocities.size // 2] = speed
        content = checkpoint.read_bytes()
        head, rest = content[:512], content[512:]
        checkpoint.write_bytes(re.sub(rb"[0-9a-f]{64}", hashlib.sha256(rest).hexdigest().encode(), head, count=1) + rest)

    def test_last_sound_state_is_left_with_when_and_where(self):
        """Steps are stable, and divided where bonds are short, so that no case makes a sheet blow up."""
        motion = ["lattice", CASES / "quick.prm", "--output-dir", self.out, "--set", "Lattice/solution=motion", "--set",
                  "Time/end=0.1 ms", "--set", "Fracture/breaking stretch=auto", "--set", "Output/energy interval=1",
                  "--set", "Checkpoints/steps=20"]
        self.assertEqual(latcon(*motion).returncode, 0)
        self.push(sorted((self.out / "checkpoints").glob("*.h5"))[-1], 1e4)
        run = latcon(*motion, "--resume")
        self.assertEqual(run.returncode, 4, run.stderr)
        told = re.search(r"became unstable: at (\S+) s .* number (\d+) at X = (\S+) m, Y = (\S+) m, .* state, at (\S+) s; try",
                         run.stderr)
        self.assertIsNotNone(told, run.stderr)
        self.assertIn("try a smaller Time/safety factor\n", run.stderr)
        blown, site, X, Y, sound = map(float, told.groups())
        self.assertLess(sound, blown)
        energies = read_csv(self.out / "energy.csv")
        # Checked in every step.
        step = float(energies[1]["t"]) - float(energies[0]["t"])
        self.assertAlmostEqual((blown - sound) / step, 1., delta=1e-5 * blown / step)  # six digits of each
        last_time, last = frames(self.out / "lattice.pvd")[-1]
        self.assertAlmostEqual(last_time, sound, delta=1e-5 * sound)
        self.assertEqual(last_time, float(energies[-1]["t"]))
        self.assertLess(float(energies[-1]["elastic"]) + float(energies[-1]["kinetic"]),
                        2. * float(energies[0]["elastic"]))
        sheet = read(vtk.vtkXMLPolyDataReader(), last)
        kinetic = sum(sum(v * v for v in sheet.GetPointData().GetArray("velocity").GetTuple(i))
                      for i in range(sheet.GetNumberOfPoints()))
        self.assertTrue(0. < kinetic < math.inf)
        place = sheet.GetPoint(int(site))
        self.assertAlmostEqual(place[0], X, places=6)
        self.assertAlmostEqual(place[1], Y, places=6)

    def test_last_sound_frame_has_the_stresses_of_its_time(self):
        """Bonds have a memory, and steps are too long for the springs of their branches."""
        case = ["fracture", CASES / "quick.prm", "--skip-verification", "--no-report"]
        for entry in ("Contact/present=false", "Nearest neighbours/viscosity=1 Pa s", "Next-nearest neighbours/viscosity=1 Pa s",
                      "Nearest neighbours/branch moduli=5 MPa", "Nearest neighbours/relaxation times=0.2 ms",
                      "Output/energy interval=40", "Output/frame interval=0", "Fracture/breaking stretch=1000"):
            case += ["--set", entry]
        sound = latcon(*case, "--output-dir", self.folder / "sound", "--set", "Time/end=10 us")
        self.assertIn(sound.returncode, (0, 3), sound.stderr)
        run = latcon(*case, "--output-dir", self.out, "--set", "Time/step=9.4e-6 s")
        self.assertEqual(run.returncode, 4, run.stderr)
        self.assertIn("valid state, at 0 s; try a smaller Time/step\n", run.stderr)
        self.assertEqual([time for time, _ in frames(self.out / "lattice.pvd")], [0.])
        self.assertEqual((self.out / "lattice-0000.vtp").read_bytes(), (self.folder / "sound" / "lattice-0000.vtp").read_bytes())


if __name__ == "__main__":
    unittest.main(verbosity=2)
