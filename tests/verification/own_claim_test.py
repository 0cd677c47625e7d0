"""The claim of examples/own-claim: a few changed files are enough for every command, the cached verdicts and the report."""
import json
import os
import pathlib
import re

import pytest

from program import CASES, FULL, latcon, read_json, settings

ROOT = pathlib.Path(__file__).resolve().parents[2]
EXAMPLE = ROOT / "examples" / "own-claim"
PATCHED = pathlib.Path(os.environ["LATCON_PATCHED"])
CLAIM = "symmetry"


def test_patch_changes_at_most_four_files():
    changed = re.findall(r"(?m)^--- (?:a/)?(\S+)", (EXAMPLE / "tree.patch").read_text())
    assert "verification/claims/claim_table.inc" in changed
    assert len(changed) <= 4
    assert all((ROOT / name).is_file() for name in changed), changed


def test_is_checked_by_name_and_shown_in_the_report(out):
    latcon("verify", CLAIM, "--quick", "--output-dir", out)
    results = read_json(out / "results.json")
    assert {row["claim"] for row in results["claims"]} == {CLAIM}
    assert {row["quantity"].split(":")[0] for row in results["claims"]} == {"NN", "NN+NNN"}
    assert {row["verdict"] for row in results["claims"]} == {"holds"}
    assert f"## {CLAIM}\n" in (PATCHED / "docs/verification.md").read_text(encoding="utf-8")
    claims = read_json(out / "claims.json")["claims"]
    assert [claim["name"] for claim in claims] == [CLAIM]
    latcon("report", out, "--quiet")
    page = (out / "report.html").read_text()
    for text in (claims[0]["title"], claims[0]["statement"]):
        assert text in page


def test_command_line_knows_it():
    assert f"  {CLAIM} " in latcon("verify", "--help").stdout
    wrong = latcon("verify", "symetry", "--dry-run", expect=2)
    assert f"unknown claim 'symetry'; nearest: {CLAIM}" in wrong.stderr
    claim, = (claim for claim in json.loads(latcon("schema").stdout)["claims"] if claim["name"] == CLAIM)
    assert claim["default"] and claim["before_fracture"]


@pytest.mark.skipif(not FULL, reason="in full only")  # gate_test.py: a crack waits for all claims with the property above
def test_crack_is_verified_with_it(out):
    short = settings("Sheet/length=2.5 cm", "Sheet/height=1.5 cm", "Time/end=0.01 ms", "Next-nearest neighbours/present=false")
    for reused in (False, True):
        latcon("fracture", CASES / "quick.prm", "--no-report", "--output-dir", out, *short)
        assert read_json(out / "run.json")["verification"]["reused"] == reused
        rows = read_json(out / "results.json")["claims"]
        assert CLAIM in {row["claim"] for row in rows}
