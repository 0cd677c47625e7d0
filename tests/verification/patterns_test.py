#!/usr/bin/python3
"""Runs the study `patterns`: the parameters that determine the pattern of a crack, in strips of a few thousand sites.

Usage: patterns_test.py PATH_OF_LATCON [--full]     --full: all seeds, not one
"""
import json
import os
import pathlib
import subprocess
import sys
import tempfile
import unittest

LATCON = sys.argv[1]
VERSION = [] if "--full" in sys.argv else ["--quick"]
SHIPPED = pathlib.Path(__file__).resolve().parents[2] / "verification" / "studies" / "patterns.json"


def study(folder, *options, file="patterns"):
    """Runs the study. @return exit code, study.json"""
    run = subprocess.run([LATCON, "study", file, "--skip-verification", "--no-report", "--quiet", "--output-dir", folder,
                          *options], check=False)
    return run.returncode, json.loads((pathlib.Path(folder) / "study.json").read_text(encoding="utf-8"))


class Patterns(unittest.TestCase):
    def test_are_those_of_the_paper(self):
        with tempfile.TemporaryDirectory() as folder:
            exit_code, document = study(folder, *VERSION)
        for claim in document["claims"]:
            print(claim["claim"], [(row["quantity"], row["measured"], row["verdict"]) for row in claim["rows"]])
            self.assertEqual(claim["verdict"], "holds")
        self.assertEqual(exit_code, 0)

    def test_without_what_decides_them_the_study_fails(self):
        # Nearly without viscosity the crack that should oscillate runs straight.
        document = json.loads(SHIPPED.read_text(encoding="utf-8"))
        document.update(base=str(SHIPPED.parent / document["base"]), runs={"fig1": document["runs"]["fig1"]},
                        claims=document["claims"][:1])
        with tempfile.TemporaryDirectory() as folder:
            file = pathlib.Path(folder) / "one.json"
            file.write_text(json.dumps(document), encoding="utf-8")
            exit_code, document = study(f"{folder}/out", "--quick", "--set", "Nearest neighbours/viscosity=10", "--set",
                                        "Next-nearest neighbours/viscosity=30", file=file)
        self.assertEqual(document["claims"][0]["rows"][0]["verdict"], "does not hold")
        self.assertEqual(exit_code, 3)


if __name__ == "__main__":
    os.environ.setdefault("OMP_NUM_THREADS", "1")
    unittest.main(argv=sys.argv[:1], verbosity=2)
