#!/usr/bin/python3
"""Tests of output directories that several processes use, that are removed, or that contain files of others.

Usage: folders_test.py PATH_OF_LATCON
"""
import json
import os
import shutil
import signal
import sys
import time
import unittest

sys.dont_write_bytecode = True
from program import CASES, Started, TemporaryFolder, frames, latcon, latcon_on_ranks, wait_for

QUICK = str(CASES / "quick.prm")
TINY = [QUICK, "--set", "Sheet/length=10 mm", "--set", "Sheet/height=6 mm", "--set", "Time/end=0.01 ms"]
# Starts at once and runs until it is killed.
LONG = ["fracture", QUICK, "--skip-verification", "--no-report", "--quiet", "--threads", "1",
        "--set", "Output/frame interval=0.02 ms", "--set", "Checkpoints/steps=64"]
ENDLESS = [*LONG, "--set", "Sheet/length=30 cm"]
LOCK = ".latcon.lock"
# A case in which a crack runs through within a second.
STRIP = ["--set", "Sheet/length=2.5 cm", "--set", "Sheet/height=1.5 cm", "--set", "Time/end=1.5 ms"]


def contents(folder):
    return {str(path.relative_to(folder)): path.read_bytes() for path in folder.rglob("*") if path.is_file()}


class Lock(Started):
    def setUp(self):
        super().setUp()
        self.study = self.folder / "study.json"
        self.study.write_text(json.dumps({"title": "t", "base": QUICK, "runs": {"a": {}}, "claims": [
            {"claim": "c", "paper": "s", "rows": [{"run": "a", "quantity": "pattern"}]}]}))

    def commands(self, out):
        yield ["lattice", *TINY, "--output-dir", out]
        yield ["continuum", CASES / "shear_layer.prm", "--output-dir", out]
        yield ["fracture", *TINY, "--skip-verification", "--output-dir", out]
        yield ["verify", "energy", "--quick", "--output-dir", out]
        yield ["report", out]
        yield ["study", self.study, "--skip-verification", "--output-dir", out]

    def test_second_command_is_refused_and_writes_nothing(self):
        owner = self.start(*ENDLESS, "--output-dir", self.out)
        self.assertTrue(wait_for((self.out / "lattice-0000.vtp").exists, owner))
        owner.send_signal(signal.SIGSTOP)
        before = contents(self.out)
        for command in self.commands(self.out):
            with self.subTest(command[0]):
                run = latcon(*command)
                self.assertEqual(run.returncode, 2, run.stderr)
                self.assertIn(f"{self.out} is in use by process {owner.pid} on ", run.stderr)
                self.assertIn("--output-dir", run.stderr)
        self.assertEqual(latcon("lattice", *TINY, "--dry-run", "--output-dir", self.out).returncode, 0)
        elsewhere = self.folder / "elsewhere"
        run = latcon("report", self.out, "--animation", "--output-dir", elsewhere, "--quiet")
        self.assertEqual(run.returncode, 0, run.stderr)
        self.assertIn("has not ended", (elsewhere / "report.html").read_text())
        self.assertEqual(contents(self.out), before)
        owner.kill()
        owner.communicate()
        run = latcon("lattice", *TINY, "--output-dir", self.out)
        self.assertEqual(run.returncode, 0, run.stderr)

    def test_ranks_hold_it_and_respect_it(self):
        ranks = self.start(*ENDLESS, "--output-dir", self.out, launcher=("mpirun", "--oversubscribe", "-n", "2"))
        self.assertTrue(wait_for((self.out / "lattice-0000.vtp").exists, ranks))
        run = latcon_on_ranks(2, "lattice", *TINY, "--set", "Lattice/solution=motion", "--output-dir", self.out)
        self.assertEqual(run.returncode, 2, run.stderr)
        self.assertIn("is in use by process", run.stderr)
        ranks.terminate()
        ranks.communicate()

    def test_runs_of_a_study_hold_theirs(self):
        part = self.out / "runs" / "a-1.part"
        part.mkdir(parents=True)
        owner = self.start(*ENDLESS, "--output-dir", part)
        self.assertTrue(wait_for((part / "lattice-0000.vtp").exists, owner))
        owner.send_signal(signal.SIGSTOP)
        before = contents(part)
        run = latcon("study", self.study, "--skip-verification", "--output-dir", self.out)
        self.assertEqual(run.returncode, 2, run.stderr)
        self.assertIn(f"{part} is in use by process {owner.pid} on ", run.stderr)
        self.assertEqual(contents(part), before)


class Vanishing(Started):
    VICTIMS = {
        "crack": LONG,
        "lattice": ["lattice", QUICK, "--quiet", "--set", "Lattice/solution=motion", "--set", "Time/end=10 ms",
                    "--set", "Output/frame interval=0.02 ms", "--set", "Checkpoints/steps=32"],
        "continuum": ["continuum", CASES / "shear_layer.prm", "--quiet", "--set", "Continuum/solution=motion",
                      "--set", "Continuum/time step=5 us", "--set", "Time/end=10 ms", "--set", "Checkpoints/steps=3",
                      "--set", "Output/frame interval=0.02 ms"]}

    def remove(self, process):
        self.assertTrue(wait_for((self.out / "run.json").exists, process))
        time.sleep(0.2)
        while self.out.exists():  # the run writes meanwhile
            shutil.rmtree(self.out, ignore_errors=True)

    def test_run_whose_folder_is_removed_says_so(self):
        for name, arguments in self.VICTIMS.items():
            with self.subTest(name):
                process = self.start(*arguments, "--output-dir", self.out)
                self.remove(process)
                _, said = process.communicate(timeout=600)
                self.assertEqual(process.returncode, 5, said)
                self.assertIn(str(self.out), said)
                self.assertFalse(self.out.exists())

    def test_run_whose_folder_is_replaced_leaves_the_other_alone(self):
        for name, arguments in self.VICTIMS.items():
            with self.subTest(name):
                process = self.start(*arguments, "--output-dir", self.out)
                self.assertTrue(wait_for((self.out / "run.json").exists, process))
                process.send_signal(signal.SIGSTOP)
                shutil.rmtree(self.out)
                self.out.mkdir()
                (self.out / LOCK).write_text("of another run")
                process.send_signal(signal.SIGCONT)
                _, said = process.communicate(timeout=600)
                self.assertEqual(process.returncode, 5, said)
                self.assertIn(str(self.out), said)
                self.assertEqual(os.listdir(self.out), [LOCK])
                shutil.rmtree(self.out)


class Planted(Started):
    def test_links_are_not_followed(self):
        crack = ["fracture", *TINY, "--skip-verification", "--quiet", "--set", "Checkpoints/steps=16"]
        self.assertEqual(latcon(*crack, "--output-dir", self.out).returncode, 0)
        names = contents(self.out)
        self.assertIn("report.html", names)
        self.assertTrue(any(name.endswith(".h5") for name in names))
        shutil.rmtree(self.out)
        victim = self.folder / "victim"
        victim.write_text("mine")
        for name in names:
            if name != LOCK:
                for place in (self.out / name, self.out / f"{name}.part"):
                    place.parent.mkdir(parents=True, exist_ok=True)
                    place.symlink_to(victim)
        run = latcon(*crack, "--output-dir", self.out)
        self.assertEqual(run.returncode, 0, run.stderr)
        self.assertEqual(victim.read_text(), "mine")
        self.assertFalse([name for name in names if (self.out / name).is_symlink()])

    def test_link_in_place_of_the_lock_is_refused(self):
        self.out.mkdir()
        victim = self.folder / "victim"
        victim.write_text("mine")
        (self.out / LOCK).symlink_to(victim)
        run = latcon("lattice", *TINY, "--output-dir", self.out)
        self.assertEqual(run.returncode, 5, run.stderr)
        self.assertIn(str(self.out / LOCK), run.stderr)
        self.assertEqual((victim.read_text(), os.listdir(self.out)), ("mine", [LOCK]))

    def test_what_killed_runs_left_is_removed(self):
        (self.out / "checkpoints").mkdir(parents=True)
        stale = [self.out / "case.prm.0123456789abcdef.part",
                 self.out / "checkpoints" / "checkpoint-000000000016.h5.00000000deadbeef.part"]
        own = self.out / "notes.part"
        for path in (*stale, own):
            path.write_text("half")
        self.assertEqual(latcon("lattice", *TINY, "--output-dir", self.out).returncode, 0)
        self.assertFalse([path for path in stale if path.exists()])
        self.assertEqual(own.read_text(), "half")


class EarlierRuns(TemporaryFolder):
    def test_files_of_the_run_before_are_moved_aside(self):
        def run(*words):
            done = latcon("fracture", CASES / "quick.prm", "--output-dir", self.out, *STRIP, "--no-report", "--skip-verification", *words)
            self.assertEqual(done.returncode, 0, done.stderr)
            return done.stdout

        def lattice_frames(folder):
            return sorted(path.name for path in folder.glob("lattice-*.vtp"))

        self.assertNotIn("earlier-run", run("--set", "Output/frame interval=0.1 ms"))
        (self.out / "notes.txt").write_text("mine")
        before = lattice_frames(self.out)
        first = (self.out / "crack.csv").read_bytes()
        self.assertIn(f"now in {self.out}/earlier-run\n", run("--set", "Output/frame interval=1 ms"))
        named = sorted(path.name for _, path in frames(self.out / "lattice.pvd"))
        self.assertEqual(lattice_frames(self.out), named)
        self.assertLess(len(named), len(before))
        self.assertEqual(lattice_frames(self.out / "earlier-run"), before)
        self.assertEqual((self.out / "earlier-run" / "crack.csv").read_bytes(), first)
        self.assertTrue((self.out / "notes.txt").exists())
        # A refused crack leaves no files of the previous run among its own, and the report shows one run.
        refused = latcon("fracture", CASES / "quick.prm", "--output-dir", self.out, *STRIP, "--set", "Loading/strain x=-0.3",
                         "--set", "Next-nearest neighbours/present=false")  # faster to check
        self.assertEqual(refused.returncode, 3)
        self.assertFalse(any((self.out / name).exists() for name in ("crack.json", "crack.csv", "crack_path.png")))
        self.assertNotIn("earlier-run", latcon("report", self.out).stdout)
        # An existing case file remains; the user's own file is not overwritten.
        again = latcon("lattice", self.out / "case.prm", "--output-dir", self.out, "--set", "Loading/strain x=0.1",
                       "--set", "Fracture/breaking stretch=auto")
        self.assertEqual(again.returncode, 0, again.stderr)
        (self.folder / "own").mkdir()
        (self.folder / "own" / "case.prm").write_text((CASES / "quick.prm").read_text())
        refused = latcon("lattice", self.folder / "own" / "case.prm", "--output-dir", self.folder / "own")
        self.assertEqual(refused.returncode, 2)
        self.assertIn("overwrite its own case", refused.stderr)
        self.assertEqual((self.folder / "own" / "case.prm").read_text(), (CASES / "quick.prm").read_text())


if __name__ == "__main__":
    unittest.main(verbosity=2)
