"""Verification before fracture: verdicts of the same inputs are reused and reported, and failing cases are refused.

The fixture of verdicts has checked the claims. Store and keys: tests/verification/claims/verdict_store_test.cc.
"""
import hashlib
import os
import pathlib
import re
import shutil

import pytest

from program import CASES, LATCON, claims_where, latcon, read_json
from verdicts_fixture import REFUSED, TINY

MADE = pathlib.Path(os.environ["LATCON_VERDICTS"])


class Gate:
    """A verified run, and cracks that start with a copy of the verdicts that it left."""

    def __init__(self, folder, name, more):
        run, self.out, self.cache, self.more = MADE / "runs" / name, folder / "out", folder / "cache", more
        self.first_text, self.first = (run / "log.txt").read_text(), read_json(run / "run.json")
        self.first_rows = claims_in(run)
        self.store = self.cache / "latcon" / "verdicts"
        self.store.mkdir(parents=True, mode=0o700)
        for key in {"verification", "verification_of_program"} & set(self.first):  # a case that is refused does not reach the program's
            shutil.copy2(MADE / "latcon" / "verdicts" / f"{self.first[key]['hash']}.json", self.store)

    def fracture(self, *arguments, expect=0, report=("--no-report",)):
        """Runs the crack. @return (what was printed, run.json)"""
        run = latcon("fracture", CASES / "quick.prm", *report, "--output-dir", self.out, *TINY, *self.more, *arguments,
                     env=dict(os.environ, XDG_CACHE_HOME=str(self.cache)), expect=expect)
        return run.stdout + run.stderr, read_json(self.out / "run.json")


def claims_in(folder):
    """Rows of results.json that are not about the crack."""
    return [row for row in read_json(folder / "results.json")["claims"] if row["claim"] != "fracture"]


@pytest.fixture
def accepted(tmp_path):
    return Gate(tmp_path, "accepted", [])


@pytest.fixture
def refused(tmp_path):
    return Gate(tmp_path, "refused", REFUSED)


def test_second_run_reuses_and_says_so(accepted):
    first, rows = accepted.first, accepted.first_rows
    assert "claims: checked now" in accepted.first_text
    for key in ("verification", "verification_of_program"):
        assert list(first[key]) == ["hash", "reused", "checked_at"]
    assert not first["verification"]["reused"]
    assert {row["claim"] for row in rows} == claims_where("before_fracture")
    # No claim reads these entries.
    text, second = accepted.fracture("--set", "Lattice/noise seed=7", "--set", "Fracture/breaking stretch=3.1")
    when, key = first["verification"]["checked_at"], first["verification"]["hash"]
    assert f"claims: verdicts of {when}, hash {key}, reused" in text
    assert second["verification"] == {"hash": key, "reused": True, "checked_at": when}
    assert second["verification_of_program"]["reused"]
    assert claims_in(accepted.out) == rows
    before = sorted(accepted.store.iterdir())
    assert "verification" not in accepted.fracture("--skip-verification", "--set", "Material/density=951")[1]
    assert sorted(accepted.store.iterdir()) == before


def test_file_says_what_its_verdicts_hold_for(accepted):
    key = accepted.first["verification"]["hash"]
    document = read_json(accepted.store / f"{key}.json")
    assert hashlib.sha256(document["inputs"].encode()).hexdigest() == key
    parts = [pathlib.Path(LATCON), *pathlib.Path(LATCON).parent.glob("latcon_elements.so")]
    hashes = [hashlib.sha256(part.read_bytes()).hexdigest() for part in parts]
    program = hashes[0] if len(hashes) == 1 else hashlib.sha256(" ".join(hashes).encode()).hexdigest()
    assert f"program={program}\n" in document["inputs"]
    assert "\nNearest neighbours/b=150000\n" in document["inputs"]
    assert document["checked_at"] == accepted.first["verification"]["checked_at"]
    assert {"version", "git_commit", "libraries"} <= set(document)


def test_failure_is_refused_also_from_the_store(refused):
    key = refused.first["verification"]
    assert not key["reused"]
    text, run = refused.fracture(expect=3, report=())
    assert (run["verification"]["reused"], run["exit_code"]) == (True, 3)
    for said in ("no crack was run", f"delete {refused.store}/{key['hash']}.json", f"{refused.out}/report.html\n"):
        assert said in text
    assert not [path.name for path in refused.out.iterdir() if re.match(r"crack|broken|lattice", path.name)]
    # The last lines name the rows that fail; before them is the report, which says so too.
    failing = [row for row in claims_in(refused.out) if row["verdict"] == "fails"]
    lines = text.splitlines()
    first = next(number for number, line in enumerate(lines) if f"{len(failing)} of " in line)
    for row, line in zip(failing, lines[first + 1:], strict=False):
        assert f"{row['claim']}: {row['quantity']}: error {row['error']:.3g}, tolerance" in line
    assert any("it buckles in waves of kd = " in line for line in lines[first:])
    assert len(lines) < 18
    assert "it buckles" in (refused.out / "report.html").read_text()
