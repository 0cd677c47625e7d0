#!/usr/bin/python3
"""The claim of examples/own-claim: a few changed files are enough for every command, the cached verdicts and the report.

Usage: own_claim_test.py LATCON_WITH_THE_CLAIM FOLDER_OF_PATCHED_FILES
"""
import json
import pathlib
import re
import sys
import unittest

sys.dont_write_bytecode = True
ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.path.append(str(ROOT / "tests" / "docs"))
import verification_page
from program import CASES, TemporaryFolder, latcon

EXAMPLE = ROOT / "examples" / "own-claim"
PATCHED = pathlib.Path(sys.argv[1])
CLAIM = "symmetry"


class OwnClaim(TemporaryFolder):
    def test_patch_changes_at_most_four_files(self):
        changed = re.findall(r"(?m)^--- (?:a/)?(\S+)", (EXAMPLE / "tree.patch").read_text())
        self.assertIn("verification/claims/claim_list.h", changed)
        self.assertLessEqual(len(changed), 4)
        self.assertTrue(all((ROOT / name).is_file() for name in changed), changed)

    def test_is_checked_by_name_and_shown_in_the_report(self):
        run = latcon("verify", CLAIM, "--quick", "--output-dir", self.out)
        self.assertEqual(run.returncode, 0, run.stdout + run.stderr)
        results = json.loads((self.out / "results.json").read_text())
        self.assertEqual({row["claim"] for row in results["claims"]}, {CLAIM})
        self.assertEqual({row["quantity"].split(":")[0] for row in results["claims"]}, {"NN", "NN+NNN"})
        own = [line for line in verification_page.differences(
            (PATCHED / "docs/verification.md").read_text(encoding="utf-8"), results) if line.startswith(CLAIM)]
        self.assertEqual(own, [])
        claims = json.loads((self.out / "claims.json").read_text())["claims"]
        self.assertEqual([claim["name"] for claim in claims], [CLAIM])
        report = latcon("report", self.out, "--quiet")
        self.assertEqual(report.returncode, 0, report.stderr)
        page = (self.out / "report.html").read_text()
        for text in (claims[0]["title"], claims[0]["statement"]):
            self.assertIn(text, page)

    def test_command_line_knows_it(self):
        self.assertIn(f"  {CLAIM} ", latcon("verify", "--help").stdout)
        wrong = latcon("verify", "symetry", "--dry-run")
        self.assertEqual(wrong.returncode, 2)
        self.assertIn(f"unknown claim 'symetry'; nearest: {CLAIM}", wrong.stderr)
        claim, = (claim for claim in json.loads(latcon("schema").stdout)["claims"] if claim["name"] == CLAIM)
        self.assertTrue(claim["default"] and claim["before_fracture"])

    def test_crack_is_verified_with_it(self):
        words = ["fracture", CASES / "quick.prm", "--no-report", "--output-dir", self.out]
        for setting in ("Sheet/length=2.5 cm", "Sheet/height=1.5 cm", "Time/end=0.01 ms", "Next-nearest neighbours/present=false"):
            words += ["--set", setting]
        for reused in (False, True):
            self.assertEqual(latcon(*words).returncode, 0)
            self.assertEqual(json.loads((self.out / "run.json").read_text())["verification"]["reused"], reused)
            rows = json.loads((self.out / "results.json").read_text())["claims"]
            self.assertIn(CLAIM, {row["claim"] for row in rows})


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
