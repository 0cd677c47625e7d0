#!/usr/bin/python3
"""Checks that the exit code of the program agrees with that in run.json, whatever fails last.

Usage: exit_codes_test.py PATH_OF_LATCON
"""
import json
import os
import subprocess
import sys
import unittest

sys.dont_write_bytecode = True
from program import CASES, LATCON, TemporaryFolder, latcon

TINY = ["fracture", CASES / "quick.prm", "--skip-verification", "--set", "Sheet/length=10 mm", "--set",
        "Sheet/height=6 mm", "--set", "Time/end=0.01 ms"]
BAD_INPUT, OUTPUT_FAILED = 2, 5


class ExitCodes(TemporaryFolder):
    def code_in_file(self):
        return json.loads((self.out / "run.json").read_text())["exit_code"]

    def test_page_that_cannot_be_written(self):
        (self.out / "report.html").mkdir(parents=True)
        run = latcon(*TINY, "--output-dir", self.out)
        self.assertEqual(run.returncode, OUTPUT_FAILED, run.stderr)
        self.assertEqual(self.code_in_file(), OUTPUT_FAILED)

    def test_script_that_fails(self):
        run = latcon(*TINY, "--output-dir", self.out, env=dict(os.environ, MPLCONFIGDIR="/proc"))
        self.assertEqual(run.returncode, OUTPUT_FAILED, run.stderr)
        self.assertIn("report.html: the report script failed", run.stderr)
        self.assertEqual(self.code_in_file(), OUTPUT_FAILED)

    def test_standard_output_that_is_full(self):
        for command in ([*TINY, "--no-report", "--output-dir", self.out], [*TINY, "--dry-run"], ["--version"]):
            with open("/dev/full", "w") as full:
                run = subprocess.run([LATCON, *map(str, command)], stdout=full, stderr=subprocess.PIPE, text=True)
            self.assertEqual(run.returncode, OUTPUT_FAILED, command)
            self.assertIn("cannot write standard output", run.stderr)
        self.assertEqual(self.code_in_file(), OUTPUT_FAILED)

    def test_run_that_its_solver_refuses_writes_nothing(self):
        """The case is sound; the solver sees that its initial state does not fit the edge."""
        run = latcon("continuum", CASES / "quick.prm", "--output-dir", self.out, "--set", "Continuum/solution=motion",
                     "--set", "Time/end=0.01 ms", "--set", "Top edge/displacement x=1e-4*x")
        self.assertEqual(run.returncode, BAD_INPUT, run.stderr)
        self.assertIn("the initial displacement of a boundary differs", run.stderr)
        self.assertFalse(self.out.exists())

    def test_instruction_set_that_there_is_not(self):
        for command in (TINY, ["verify", "energy", "--quick"]):
            run = latcon(*command, "--output-dir", self.out, env=dict(os.environ, LATCON_INSTRUCTION_SET="MMX"))
            self.assertEqual(run.returncode, BAD_INPUT, run.stderr)
            self.assertIn("environment variable LATCON_INSTRUCTION_SET: `MMX` is none of the instruction sets", run.stderr)
            self.assertFalse(self.out.exists())

    def test_report_does_not_depend_on_settings_of_python(self):
        self.assertEqual(latcon(*TINY, "--no-report", "--output-dir", self.out).returncode, 0)
        (self.folder / "modules").mkdir()
        (self.folder / "modules" / "numpy.py").write_text("raise ImportError('another numpy')")
        settings = {"MPLBACKEND": "nonsense", "PYTHONSAFEPATH": "1", "PYTHONWARNINGS": "error",
                    "PYTHONPATH": str(self.folder / "modules")}
        run = latcon("report", self.out, env=dict(os.environ, **settings))
        self.assertEqual(run.returncode, 0, run.stderr)
        self.assertTrue((self.out / "report.html").exists())


if __name__ == "__main__":
    unittest.main(verbosity=2)
