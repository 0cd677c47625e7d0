#!/usr/bin/python3
"""Checks that signals end every command soon, with exit code 130, also in run.json.

Usage: signals_test.py PATH_OF_LATCON
"""
import json
import os
import re
import resource
import shutil
import signal
import subprocess
import sys
import time
import unittest

sys.dont_write_bytecode = True
from program import CASES, LATCON, Started, catches, children, latcon, wait_for

QUICK = str(CASES / "quick.prm")
TINY = [QUICK, "--set", "Sheet/length=10 mm", "--set", "Sheet/height=6 mm"]
INTERRUPTED = 130
# Longest time [s] in which a command must end after a signal.
HANGS = 20
# From the keyboard, from a scheduler, and from a limit; all are caught alike.
SOME = ("SIGINT", "SIGUSR1", "SIGXCPU")
ALL = (*SOME, "SIGTERM", "SIGHUP", "SIGUSR2", "SIGALRM")


class Interrupted(Started):
    def info(self):
        return json.loads((self.out / "run.json").read_text())

    def started(self, process):
        self.assertTrue(wait_for((self.out / "run.json").exists, process), "it has not begun")

    def ends(self, process, message="interrupted by SIG"):
        _, errors = process.communicate(timeout=HANGS)
        self.assertEqual(process.returncode, INTERRUPTED, errors)
        self.assertIn(message, errors)
        self.assertNotIn("Traceback", errors)


class WithoutSteps(Interrupted):
    """Commands and phases without state to save end at once."""

    def is_ended(self, *arguments, begun=None, number=signal.SIGINT):
        process = self.start(*arguments, "--output-dir", self.out)
        self.started(process)
        if begun:
            self.assertTrue(wait_for(begun, process))
        process.send_signal(number)
        self.ends(process)
        self.assertEqual(self.info()["exit_code"], INTERRUPTED)

    def test_verify_keeps_the_claims_that_are_done(self):
        results = self.out / "results.json"
        self.is_ended("verify", "intrinsic-length", "prestretch", "--quick", begun=results.exists, number=signal.SIGTERM)
        claims = {row["claim"] for row in json.loads(results.read_text())["claims"]}
        self.assertEqual(claims, {"intrinsic-length"})
        self.assertIsNone(self.info()["verdict"])

    def test_relaxation(self):
        self.is_ended("lattice", QUICK, "--set", "Sheet/length=45 cm", "--set", "Sheet/height=25 cm",
                      begun=(self.out / "lattice-0000.vtp").exists)

    def test_finite_element_equilibrium(self):
        self.is_ended("continuum", CASES / "hole.prm", "--set", "Continuum/refinements=3",
                      begun=(self.out / "continuum.pvd").exists)

    def test_claims_before_a_crack(self):
        self.is_ended("fracture", QUICK)
        self.assertFalse((self.out / "crack.json").exists())

    def test_dry_run(self):
        study = self.folder / "study.json"
        seeds = list(range(20000))
        study.write_text(json.dumps({"title": "t", "base": QUICK, "runs": {"a": {"seeds": seeds}}, "claims": [
            {"claim": "c", "paper": "s", "rows": [{"run": "a", "quantity": "pattern"}]}]}))
        process = self.start("study", study, "--dry-run")
        self.assertTrue(wait_for(lambda: catches(process, signal.SIGINT), process))
        process.send_signal(signal.SIGINT)
        self.ends(process)

    def test_report_ends_with_its_script(self):
        self.assertEqual(latcon("fracture", *TINY, "--set", "Time/end=0.01 ms", "--skip-verification", "--no-report",
                                "--output-dir", self.out).returncode, 0)
        process = self.start("report", self.out, start_new_session=True)
        self.assertTrue(wait_for(lambda: children(process.pid), process))
        script = children(process.pid)[0]
        time.sleep(0.5)
        os.killpg(process.pid, signal.SIGINT)  # as the keyboard does
        self.ends(process)
        self.assertTrue(wait_for(lambda: not os.path.exists(f"/proc/{script}/exe"), process, 5))


class EveryCommand(Interrupted):
    """As from the keyboard: the signal is sent to the command and to its child processes."""

    def is_ended(self, process):
        os.killpg(process.pid, signal.SIGINT)
        self.ends(process)

    def is_ended_as_it_reads(self, pipe, *arguments):
        """Checks that the command ends while it waits for a file that nobody writes."""
        process = self.start(*arguments, start_new_session=True)
        writers = []

        def is_read():
            try:
                writers.append(os.open(pipe, os.O_WRONLY | os.O_NONBLOCK))
            except OSError:
                return False  # nobody has opened it
            return True

        self.assertTrue(wait_for(is_read, process))
        self.addCleanup(os.close, writers[0])
        self.is_ended(process)

    def is_ended_as_it_begins(self, *arguments):
        process = self.start(*arguments, start_new_session=True)
        self.assertTrue(wait_for(lambda: catches(process, signal.SIGINT), process))
        self.is_ended(process)

    def test_ends_while_it_reads(self):
        self.assertEqual(latcon("fracture", *TINY, "--set", "Time/end=0.01 ms", "--skip-verification", "--no-report",
                                "--output-dir", self.out).returncode, 0)
        film = self.out / "motion-0001.vtp"
        film.unlink()
        case, study = self.folder / "case.prm", self.folder / "study.json"
        for pipe in (case, study, film):
            os.mkfifo(pipe)
        commands = {"verify": (case, "energy", "--quick", "--case", case), "lattice": (case, case),
                    "continuum": (case, case), "fracture": (case, case), "study": (study, study),
                    "batch": (study, study, "--slurm"), "report": (film, self.out), "schema": (case, case)}
        immediate = {"entries", "help", "init"}  # read shipped files alone
        listed = latcon("--help").stdout.partition("Subcommands:")[2].partition("Exit codes")[0]
        self.assertEqual(set(re.findall(r"^  (\w+) ", listed, re.MULTILINE)), {*commands, *immediate, "compare"})
        for name, (pipe, *arguments) in commands.items():
            with self.subTest(name):
                self.is_ended_as_it_reads(pipe, name, *arguments)

    def test_comparison(self):
        """Frames cannot be pipes: the signal is sent before they are read."""
        sheets = {"lattice": self.folder / "lattice", "continuum": self.folder / "continuum"}
        for side, folder in sheets.items():
            self.assertEqual(latcon(side, *TINY, "--output-dir", folder).returncode, 0)
        self.is_ended_as_it_begins("compare", *sheets.values(), "--output-dir", self.out)


class Motions(Interrupted):
    """Motions write a checkpoint, their last frame and tables."""

    def motion(self, *more, length="30 cm", end="1"):
        return ["fracture", QUICK, "--skip-verification", "--set", f"Time/end={end}", "--set", f"Sheet/length={length}",
                "--threads", "1", *more, "--output-dir", self.out]

    def is_saved(self, process):
        self.ends(process, f"interrupted; --resume goes on from what is in {self.out}")
        self.assertEqual(self.info()["exit_code"], INTERRUPTED)
        self.assertTrue(list((self.out / "checkpoints").glob("*.h5")))
        self.assertTrue((self.out / "crack.csv").exists())

    def test_every_signal_saves_and_draws_no_report(self):
        for name in SOME:
            with self.subTest(name):
                process = self.start(*self.motion())
                self.assertTrue(wait_for((self.out / "lattice.pvd").exists, process))
                self.assertEqual([other for other in ALL if not catches(process, getattr(signal, other))], [])
                process.send_signal(getattr(signal, name))
                self.is_saved(process)
                self.assertFalse((self.out / "report.html").exists())
                shutil.rmtree(self.out)

    def test_the_limit_of_the_processor_time(self):
        process = self.start(*self.motion(), preexec_fn=lambda: resource.setrlimit(resource.RLIMIT_CPU, (2, 60)))
        self.is_saved(process)

    def test_a_signal_to_one_of_two_ranks(self):
        process = self.start(*self.motion("--set", "Fracture/stop position=0.99", length="10 cm"), launcher=["mpirun", "--oversubscribe", "-n", "2"])
        self.assertTrue(wait_for((self.out / "lattice.pvd").exists, process))
        os.kill(max(children(process.pid)), signal.SIGTERM)
        self.is_saved(process)

    def test_a_signal_to_one_of_two_ranks_before_the_motion(self):
        process = self.start("fracture", QUICK, "--output-dir", self.out, launcher=["mpirun", "--oversubscribe", "-n", "2"])
        self.started(process)
        os.kill(max(children(process.pid)), signal.SIGTERM)
        self.ends(process)
        self.assertEqual(self.info()["exit_code"], INTERRUPTED)

    def test_ignored_hangup_stays_ignored(self):
        process = self.start(*self.motion("--no-report", length="4 cm", end="0.2 ms"),
                             launcher=["nohup"])
        self.assertTrue(wait_for((self.out / "lattice.pvd").exists, process))
        process.send_signal(signal.SIGHUP)
        process.communicate(timeout=600)
        self.assertEqual(process.returncode, 0)

    def test_a_reader_that_leaves_ends_nothing(self):
        command = [LATCON, *map(str, self.motion("--no-report", length="4 cm", end="0.02 ms"))]
        process = subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.PIPE)
        process.stdout.close()
        process.stderr.read()
        self.assertEqual(process.wait(600), 0)
        process.stderr.close()
        self.assertEqual(self.info()["exit_code"], 0)

    def test_the_limit_of_the_size_of_files_is_5(self):
        process = self.start(*self.motion(), preexec_fn=lambda: resource.setrlimit(resource.RLIMIT_FSIZE, (10000, 10000)))
        _, errors = process.communicate(timeout=HANGS)
        self.assertEqual(process.returncode, 5, errors)
        self.assertIn("File too large", errors)


if __name__ == "__main__":
    unittest.main(verbosity=2)
