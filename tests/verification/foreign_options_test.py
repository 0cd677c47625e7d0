#!/usr/bin/python3
"""Checks that libraries do not read options from the current folder, from the home folder, or from latcon's arguments.

Usage: foreign_options_test.py PATH_OF_LATCON
"""
import os
import subprocess
import sys
import unittest

sys.dont_write_bytecode = True
from program import CASES, LATCON, TemporaryFolder

TINY = [str(CASES / "quick.prm"), "--set", "Sheet/length=10 mm", "--set", "Sheet/height=6 mm", "--set", "Time/end=0.01 ms"]
COMMANDS = {"version": ["--version"], "lattice": ["lattice", *TINY, "--quiet"],
            "crack with its page": ["fracture", *TINY, "--skip-verification", "--quiet"],
            "finite elements": ["continuum", str(CASES / "shear_layer.prm"), "--quiet"]}


class Planted(TemporaryFolder):
    def setUp(self):
        super().setUp()
        self.marker = self.folder / "started"
        self.program = self.folder / "gdb"
        self.program.write_text(f"#!/bin/sh\ntouch {self.marker}\n")
        self.program.chmod(0o755)
        # PETSc options that start a debugger and write files, all within a second.
        self.options = (f"-debug_terminal {self.program}\n-start_in_debugger gdb\n-debugger_pause 1\n"
                        f"-info {self.folder}/info\n-log_view :{self.folder}/log\n")

    def run_all(self, cwd, *more, **variables):
        """@param more options of the crack"""
        for name, command in COMMANDS.items():
            with self.subTest(name):
                command = [*command, *more] if "fracture" in command else command
                out = self.folder / f"out-{name}"
                before = {path.name for path in self.folder.iterdir()} | {out.name}
                arguments = command if name == "version" else [*command, "--output-dir", str(out)]
                run = subprocess.run([LATCON, *arguments], capture_output=True, text=True, timeout=300, cwd=cwd,
                                     env=dict(os.environ, **variables))
                self.assertEqual((run.returncode, run.stderr), (0, ""))
                self.assertFalse(self.marker.exists())
                self.assertLessEqual({path.name for path in self.folder.iterdir()}, before)

    def test_in_the_current_folder(self):
        here = self.folder / "here"
        here.mkdir()
        for name in (".petscrc", "petscrc", ".slepcrc", "slepcrc"):
            (here / name).write_text(self.options)
        (here / "matplotlibrc").write_text("no.such.key: 1\nbackend: module://planted\n")
        (here / "planted.py").write_text(f"open({str(self.marker)!r}, 'w')\n")
        before = sorted(os.listdir(here))
        self.run_all(here)
        self.assertEqual(sorted(os.listdir(here)), before)

    def test_in_the_home_folder(self):
        home = self.folder / "home"
        home.mkdir()
        for name in (".petscrc", ".slepcrc"):
            (home / name).write_text(self.options)
        self.run_all(self.folder, "--no-report", HOME=str(home))

    def test_in_the_environment(self):
        self.run_all(self.folder, "--no-report", PETSC_OPTIONS=" ".join(self.options.split()))

    def test_closed_standard_output_is_no_matter_of_libraries(self):
        run = subprocess.run(["/bin/sh", "-c", 'exec "$@" >&-', "sh", LATCON, "lattice", *TINY, "--quiet", "--output-dir",
                              str(self.folder / "out")], stderr=subprocess.PIPE, text=True, timeout=600)
        self.assertEqual(run.stderr, "")


if __name__ == "__main__":
    unittest.main(verbosity=2)
