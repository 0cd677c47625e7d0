"""Verification before fracture: claims are checked once for the same inputs, reuse is reported, and failing cases are refused.

With LATCON_FULL each test checks the claims once more.
"""
import hashlib
import json
import os
import pathlib
import re
import shutil

import pytest

from program import CASES, FULL, LATCON, claims_where, latcon, latcon_on_ranks
from verdicts_fixture import REFUSED, TINY

NEAREST = ["--set", "Next-nearest neighbours/present=false"] if FULL else []  # faster to check
# Seconds each. What they show is shown of the store and of its keys by verdict_store_test.cc, of the claims by claims_test.cc.
in_full = pytest.mark.skipif(not FULL, reason="in full only")


class Gate:
    """A verified run, and cracks that start with a copy of the cache that it left."""

    def __init__(self, folder, out, cache, more):
        self.folder, self.out, self.cache, self.more = folder, out, cache, more
        self.environment = dict(os.environ, XDG_CACHE_HOME=str(cache))

    def fracture(self, *arguments, expect=0, ranks=1, program=LATCON, report=("--no-report",)):
        """Runs the crack. @return (what was printed, run.json)"""
        words = ["fracture", CASES / "quick.prm", *report, "--output-dir", self.out, *TINY, *self.more, *arguments]
        run = (latcon(*words, env=self.environment, program=program) if ranks == 1 else latcon_on_ranks(ranks, *words, env=self.environment))
        assert run.returncode == expect, run.stdout + run.stderr
        return run.stdout + run.stderr, json.loads((self.out / "run.json").read_text())

    def is_reused(self, *arguments, **keywords):
        return self.fracture(*arguments, **keywords)[1]["verification"]["reused"]

    def stored(self):
        """Files of the cache with verdicts on a case."""
        of_program = self.first.get("verification_of_program", {}).get("hash")
        return sorted(path for path in (self.cache / "latcon" / "verdicts").glob("*") if path.stem != of_program)

    def claims(self):
        """Rows of results.json that are not about the crack."""
        rows = json.loads((self.out / "results.json").read_text())["claims"]
        return [row for row in rows if row["claim"] != "fracture"]

    def take(self, run):
        """Remembers the verified run with these results."""
        self.first_text, self.first = (run / "log.txt").read_text(), json.loads((run / "run.json").read_text())
        self.first_rows = [row for row in json.loads((run / "results.json").read_text())["claims"] if row["claim"] != "fracture"]


@pytest.fixture(scope="module")
def verified(module_path):
    """Folder of the verified run of a name, and its cache: that of the fixture, or where each test checks the claims, of this file."""
    made = {}

    def run(name, more, expect):
        if not FULL:
            made_by_fixture = pathlib.Path(os.environ["LATCON_VERDICTS"])
            return made_by_fixture / "runs" / name, made_by_fixture
        if name not in made:
            gate = Gate(module_path, module_path / name, module_path / f"{name}-cache", more)
            gate.fracture(expect=expect)
            made[name] = gate.out, gate.cache
        return made[name]
    return run


def started(tmp_path, verified, name, more, expect):
    run, cache = verified(name, more, expect)
    gate = Gate(tmp_path, tmp_path / "out", tmp_path / "cache", more)
    gate.take(run)
    (gate.cache / "latcon" / "verdicts").mkdir(parents=True, mode=0o700)
    for key in {"verification", "verification_of_program"} & set(gate.first):  # a case that is refused does not reach the program's
        name = f"{gate.first[key]['hash']}.json"
        shutil.copy2(cache / "latcon" / "verdicts" / name, gate.cache / "latcon" / "verdicts" / name)
    return gate


@pytest.fixture
def accepted(tmp_path, verified):
    return started(tmp_path, verified, "accepted", NEAREST, 0)


@pytest.fixture
def refused(tmp_path, verified):
    return started(tmp_path, verified, "refused", REFUSED, 3)


def test_second_run_reuses_and_says_so(accepted):
    first, rows = accepted.first, accepted.first_rows
    assert "claims: checked now" in accepted.first_text
    for key in ("verification", "verification_of_program"):
        assert list(first[key]) == ["hash", "reused", "checked_at"]
    assert not first["verification"]["reused"]
    assert {row["claim"] for row in rows} == claims_where("before_fracture")
    text, second = accepted.fracture()
    when, key = first["verification"]["checked_at"], first["verification"]["hash"]
    assert f"claims: verdicts of {when}, hash {key}, reused" in text
    assert second["verification"] == {"hash": key, "reused": True, "checked_at": when}
    assert second["verification_of_program"]["reused"]
    assert accepted.claims() == rows
    assert [path.name for path in accepted.stored()] == [f"{key}.json"]


def test_file_says_what_its_verdicts_hold_for(accepted):
    document = json.loads(accepted.stored()[0].read_text())
    assert hashlib.sha256(document["inputs"].encode()).hexdigest() == accepted.first["verification"]["hash"]
    parts = [pathlib.Path(LATCON), *pathlib.Path(LATCON).parent.glob("latcon_elements.so")]
    hashes = [hashlib.sha256(part.read_bytes()).hexdigest() for part in parts]
    program = hashes[0] if len(hashes) == 1 else hashlib.sha256(" ".join(hashes).encode()).hexdigest()
    assert f"program={program}\n" in document["inputs"]
    assert "\nNearest neighbours/b=150000\n" in document["inputs"]
    assert document["checked_at"] == accepted.first["verification"]["checked_at"]
    assert {"version", "git_commit", "libraries"} <= set(document)


def test_what_no_claim_reads_may_change(accepted):
    assert accepted.is_reused("--set", "Lattice/noise seed=7", "--set", "Fracture/breaking stretch=3.1")


def test_skipped_verification_neither_checks_nor_stores(accepted):
    before = accepted.stored()
    assert "verification" not in accepted.fracture("--skip-verification", "--set", "Material/density=951")[1]
    assert accepted.stored() == before


@in_full
def test_constant_changed_in_its_last_digits_is_checked_and_the_program_is_not(accepted):
    _, run = accepted.fracture("--set", f"Material/density={944 * (1 + 1e-12)!r}")
    assert not run["verification"]["reused"]
    assert run["verification"]["hash"] != accepted.first["verification"]["hash"]
    assert len(accepted.stored()) == 2
    assert run["verification_of_program"] == {**accepted.first["verification_of_program"], "reused": True}


@in_full
def test_another_program_checks_again(accepted):
    other = accepted.folder / "latcon"
    for module in pathlib.Path(LATCON).parent.glob("latcon_elements.so"):
        shutil.copy2(module, accepted.folder)
    other.write_bytes(pathlib.Path(LATCON).read_bytes() + b"\0")  # behind its end, which is not read
    other.chmod(0o755)
    assert not accepted.is_reused(program=other)


def halve(accepted, path):
    path.write_text(path.read_text()[:path.stat().st_size // 2])


def exchange(accepted, path):
    accepted.fracture("--set", "Material/density=950")
    wrong, = (other for other in accepted.stored() if other != path)
    shutil.move(wrong, path)


def empty(accepted, path):
    """Leaves one row."""
    document = json.loads(path.read_text())
    document["results"]["claims"] = [next(row for row in document["results"]["claims"] if row["verdict"] == "holds")]
    path.write_text(json.dumps(document))


@in_full
@pytest.mark.parametrize("damage, reason", [
    (halve, "it is damaged"), (exchange, "it belongs to other inputs"), (empty, "the claim [a-z-]+ judged nothing")])
def test_file_that_cannot_be_trusted_is_said_and_replaced(accepted, damage, reason):
    path, = accepted.stored()
    damage(accepted, path)
    text, run = accepted.fracture()
    assert re.search(f"{path} is not used: .*{reason}", text)
    assert "is not used" in run["verification"]["note"]
    assert not run["verification"]["reused"]
    assert accepted.is_reused()


# The fitted law has its best ratio at the end of the interval, or a given one loses ellipticity on the way.
@in_full
@pytest.mark.parametrize("settings, words", [
    (["Loading/strain x=0", "Fracture/breaking stretch=3.2"], "at the end of the search interval"),
    (["Continuum/ratio=-0.2"], "the law loses ellipticity")])
def test_laws_that_no_crack_uses_do_not_refuse_it(accepted, settings, words):
    accepted.fracture(*(word for setting in settings for word in ("--set", setting)))
    assert [row["verdict"] for row in accepted.claims() if words in row["quantity"]] == ["reported"]
    assert sum(row["verdict"] == "holds" for row in accepted.claims()) > 30


@in_full
def test_store_that_cannot_be_written_stops_nothing(accepted):
    shutil.rmtree(accepted.cache)
    accepted.cache.write_text("in the way")
    text, run = accepted.fracture()
    assert "the verdicts are not kept: cannot write " in text
    assert "not kept" in run["verification"]["note"]
    for name in ("XDG_CACHE_HOME", "HOME"):
        accepted.environment.pop(name, None)
    assert "no verdicts are kept" in accepted.fracture()[0]


@in_full
def test_all_ranks_decide_alike(accepted):
    assert not accepted.is_reused(ranks=2)  # one rank has another hash
    assert len(accepted.stored()) == 2
    assert accepted.is_reused(ranks=2)


def test_failure_is_refused_also_from_the_store(refused):
    assert not refused.first["verification"]["reused"]
    text, run = refused.fracture(expect=3, report=())
    assert run["verification"]["reused"]
    assert run["exit_code"] == 3
    assert "no crack was run" in text
    assert f"delete {refused.stored()[0]}" in text
    assert not [path.name for path in refused.out.iterdir() if re.match(r"crack|broken|lattice", path.name)]
    # The last lines name the rows that fail; before them is the report, which says so too.
    failing = [row for row in refused.claims() if row["verdict"] == "fails"]
    lines = text.splitlines()
    first = next(number for number, line in enumerate(lines) if f"{len(failing)} of " in line)
    for row, line in zip(failing, lines[first + 1:], strict=False):
        assert f"{row['claim']}: {row['quantity']}: error {row['error']:.3g}, tolerance" in line
    assert any("it buckles in waves of kd = " in line for line in lines[first:])
    assert len(lines) < 18
    assert f"{refused.out}/report.html\n" in text
    assert "it buckles" in (refused.out / "report.html").read_text()
