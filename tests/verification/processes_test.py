#!/usr/bin/python3
"""Tests of many processes on one machine: shared folders at the start, leftover files, and use of cores.

Usage: processes_test.py PATH_OF_LATCON [PATHS_OF_TEST_PROGRAMS...]
"""
import os
import shutil
import signal
import socket
import subprocess
import sys
import time
import unittest

sys.dont_write_bytecode = True
TEST_PROGRAMS = sys.argv[2:]
del sys.argv[2:]
from program import CASES, LATCON, TemporaryFolder, latcon

SMALL = ["--set", "Sheet/length=8 mm", "--set", "Sheet/height=6 mm"]
LAUNCHED = ("OMPI_", "PMIX_", "PMI_")


def environment(**variables):
    """Environment of a user without MPI settings, outside mpirun."""
    kept = {name: value for name, value in os.environ.items() if not name.startswith(LAUNCHED)}
    return dict(kept, **variables)


def names_in(folder):
    return sorted(str(path.relative_to(folder)) for path in folder.rglob("*"))


class Start(TemporaryFolder):
    def setUp(self):
        super().setUp()
        self.tmp = self.folder / "tmp"
        self.tmp.mkdir()

    def block_session_folder(self):
        """Creates files where Open MPI would create the session folder shared by a user's processes."""
        host = socket.gethostname()
        for name in {host, host.partition(".")[0]}:
            (self.tmp / f"ompi.{name}.{os.geteuid()}").write_text("in the way")

    def commands(self):
        quick = str(CASES / "quick.prm")
        yield [LATCON, "--version"]
        yield [LATCON, "lattice", quick, "--dry-run"]
        yield [LATCON, "lattice", quick, *SMALL, "--output-dir", str(self.folder / "out"), "--quiet"]
        for program in TEST_PROGRAMS:
            yield [program, "--gtest_filter=-*"]

    def test_shares_no_folder(self):
        self.block_session_folder()
        before = names_in(self.tmp)
        for command in self.commands():
            with self.subTest(command[:2]):
                run = subprocess.run(command, capture_output=True, text=True, timeout=600,
                                     env=environment(TMPDIR=str(self.tmp)))
                self.assertEqual(run.returncode, 0, run.stderr)
                self.assertNotIn("mkdir", run.stderr)
        self.assertEqual(names_in(self.tmp), before)

    def test_the_files_in_the_way_are_in_the_way(self):
        """Repeats the test with mpirun, which creates the folder. If this fails, the test above is meaningless."""
        self.block_session_folder()
        run = subprocess.run(["mpirun", "-n", "1", "true"], capture_output=True, text=True, timeout=600,
                             env=environment(TMPDIR=str(self.tmp), OMPI_ALLOW_RUN_AS_ROOT="1",
                                             OMPI_ALLOW_RUN_AS_ROOT_CONFIRM="1"))
        self.assertNotEqual(run.returncode, 0)

    def test_of_many_at_once(self):
        starts = [subprocess.Popen([LATCON, "--version"], stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True,
                                   env=environment(TMPDIR=str(self.tmp))) for _ in range(12)]
        for start in starts:
            said, _ = start.communicate(timeout=600)
            self.assertEqual(start.returncode, 0, said)
        self.assertEqual(names_in(self.tmp), [])

    def test_leaves_nothing_when_killed(self):
        run = subprocess.Popen([LATCON, "fracture", CASES / "quick.prm", "--skip-verification", "--quiet",
                                "--output-dir", self.folder / "out"], env=environment(TMPDIR=str(self.tmp)))
        while not (self.folder / "out" / "energy.csv").exists() and run.poll() is None:
            time.sleep(0.01)
        run.kill()
        self.assertEqual(run.wait(), -signal.SIGKILL)
        self.assertEqual(names_in(self.tmp), [])


class Cores(TemporaryFolder):
    def test_default_of_threads_and_of_processes_is_what_may_be_used(self):
        one = str(min(os.sched_getaffinity(0)))
        bound = ["taskset", "-c", one, LATCON]
        study = subprocess.run([*bound, "study", "patterns", "--dry-run"], capture_output=True, text=True, timeout=600)
        self.assertIn("on 1 cores", study.stdout)
        case = subprocess.run([*bound, "lattice", CASES / "quick.prm", "--dry-run", "--set", "Lattice/solution=motion"],
                              capture_output=True, text=True, timeout=600)
        self.assertIn("1 threads of each rank", case.stdout)

    def test_threads_are_those_of_the_environment(self):
        for threads in ("1", "3"):
            case = subprocess.run([LATCON, "lattice", CASES / "quick.prm", "--dry-run", "--set", "Lattice/solution=motion"],
                                  capture_output=True, text=True, timeout=600, env=environment(OMP_NUM_THREADS=threads))
            self.assertIn(f"{threads} threads of each rank", case.stdout)

    def test_threads_that_wait_sleep_unless_they_are_told_otherwise(self):
        free = {name: value for name, value in environment().items() if name not in ("OMP_WAIT_POLICY", "GOMP_SPINCOUNT")}
        for told in ({}, {"OMP_WAIT_POLICY": "active"}, {"GOMP_SPINCOUNT": "77"}):
            with self.subTest(told):
                run = subprocess.Popen([LATCON, "fracture", CASES / "quick.prm", "--skip-verification", "--quiet",
                                        "--output-dir", self.folder / "out"], env=dict(free, **told))
                while not (self.folder / "out" / "energy.csv").exists() and run.poll() is None:
                    time.sleep(0.01)
                with open(f"/proc/{run.pid}/environ", "rb") as file:
                    variables = dict(item.split(b"=", 1) for item in file.read().split(b"\0") if item)
                with open(f"/proc/{run.pid}/comm", encoding="utf-8") as file:
                    self.assertEqual(file.read(), "latcon\n")
                run.kill()
                run.wait()
                expected = told or {"GOMP_SPINCOUNT": "1000"}
                self.assertEqual({name: variables.get(name.encode(), b"").decode() for name in ("OMP_WAIT_POLICY", "GOMP_SPINCOUNT")},
                                 {"OMP_WAIT_POLICY": "", "GOMP_SPINCOUNT": "", **expected})
                shutil.rmtree(self.folder / "out")


if __name__ == "__main__":
    unittest.main(verbosity=2)
