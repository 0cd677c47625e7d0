#!/usr/bin/python3
"""Checks that a verdict file without rows of a claim is reported and ignored, and that the claims are checked.

Usage: planted_verdicts_test.py PATH_OF_LATCON
"""
import hashlib
import json
import os
import sys
import unittest

sys.dont_write_bytecode = True
from program import CASES, TemporaryFolder, latcon

TINY = ["--set", "Sheet/length=2.5 cm", "--set", "Sheet/height=1.5 cm", "--set", "Time/end=0.01 ms", "--set",
        "Next-nearest neighbours/present=false"]


class PlantedVerdicts(TemporaryFolder):
    def fracture(self):
        environment = dict(os.environ, XDG_CACHE_HOME=str(self.folder / "cache"))
        run = latcon("fracture", CASES / "quick.prm", "--no-report", "--output-dir", self.out, *TINY, env=environment)
        self.assertEqual(run.returncode, 0, run.stdout + run.stderr)
        return run.stdout, json.loads((self.out / "run.json").read_text())["verification"]

    def test_file_with_other_rows_is_not_used(self):
        self.assertFalse(self.fracture()[1]["reused"])
        self.assertTrue(self.fracture()[1]["reused"])
        path = self.folder / "cache" / "latcon" / "verdicts" / f"{self.fracture()[1]['hash']}.json"
        document = json.loads(path.read_text())
        del document["checksum"]
        document["results"]["claims"] = [next(row for row in document["results"]["claims"] if row["verdict"] == "holds")]
        text = json.dumps(document, separators=(",", ":"), ensure_ascii=False)
        document["checksum"] = hashlib.sha256(text.encode()).hexdigest()
        path.write_text(json.dumps(document, separators=(",", ":"), ensure_ascii=False))
        printed, told = self.fracture()
        self.assertRegex(printed, f"{path} is not used: the claim [a-z-]+ judged nothing")
        self.assertIn("judged nothing", told["note"])
        self.assertFalse(told["reused"])
        self.assertTrue(self.fracture()[1]["reused"], "not replaced")


if __name__ == "__main__":
    unittest.main(verbosity=2)
