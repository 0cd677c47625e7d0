"""Verification before fracture: claims are checked once for the same inputs, reuse is reported, and failing cases are refused.

With LATCON_FULL each test checks the claims once more.
"""
import hashlib
import json
import os
import pathlib
import re
import shutil
import tempfile
import unittest

from program import CASES, FULL, LATCON, TemporaryFolder, claims_where, latcon, latcon_on_ranks
from verdicts_fixture import REFUSED, TINY

# Runs of the fixture, or, where each test checks the claims, of this script: the same, with nearest neighbours alone.
MADE = None if FULL else pathlib.Path(os.environ["LATCON_VERDICTS"])
NEAREST = ["--set", "Next-nearest neighbours/present=false"] if FULL else []
# Seconds each. What they show is shown of the store and of its keys by verdict_store_test.cc, of the claims by claims_test.cc.
in_full = unittest.skipUnless(FULL, "in full only")


class WithStore(TemporaryFolder):
    """Every test starts with the cached verdicts of one verified run, in its own cache."""
    MADE_RUN, MORE, EXPECT = "accepted", NEAREST, 0  # its name in the fixture, its entries, its exit code

    @classmethod
    def setUpClass(cls):
        cls.shared = tempfile.TemporaryDirectory()
        cls.addClassCleanup(cls.shared.cleanup)
        before = cls("stored")
        if MADE:
            before.out, before.cache = MADE / "runs" / cls.MADE_RUN, pathlib.Path(cls.shared.name) / "cache"
            cls.first_text, cls.first = (before.out / "log.txt").read_text(), json.loads((before.out / "run.json").read_text())
            (before.cache / "latcon" / "verdicts").mkdir(parents=True, mode=0o700)
            for key in ("verification", "verification_of_program"):
                if key in cls.first:  # a case that is refused does not reach the program's
                    name = f"{cls.first[key]['hash']}.json"
                    shutil.copy2(MADE / "latcon" / "verdicts" / name, before.cache / "latcon" / "verdicts" / name)
            cls.first_rows, cls.first_cache = before.claims(), before.cache
            return
        before.folder = pathlib.Path(cls.shared.name)
        before.out, before.cache = before.folder / "out", before.folder / "cache"
        before.environment = dict(os.environ, XDG_CACHE_HOME=str(before.cache))
        cls.first_text, cls.first = before.fracture(expect=cls.EXPECT)
        cls.first_rows, cls.first_cache = before.claims(), before.cache

    def setUp(self):
        super().setUp()
        self.cache = self.folder / "cache"
        shutil.copytree(self.first_cache, self.cache)
        self.environment = dict(os.environ, XDG_CACHE_HOME=str(self.cache))

    def fracture(self, *arguments, expect=0, ranks=1):
        """Runs the crack. @return (what was printed, run.json)"""
        words = ["fracture", CASES / "quick.prm", "--no-report", "--output-dir", self.out, *TINY, *self.MORE, *arguments]
        run = (latcon(*words, env=self.environment) if ranks == 1
               else latcon_on_ranks(ranks, *words, env=self.environment))
        self.assertEqual(run.returncode, expect, run.stdout + run.stderr)
        return run.stdout + run.stderr, json.loads((self.out / "run.json").read_text())

    def stored(self):
        """Files of the cache with verdicts on a case."""
        of_program = self.first.get("verification_of_program", {}).get("hash")
        return sorted(path for path in (self.cache / "latcon" / "verdicts").glob("*") if path.stem != of_program)

    def claims(self):
        """Rows of results.json that are not about the crack."""
        rows = json.loads((self.out / "results.json").read_text())["claims"]
        return [row for row in rows if row["claim"] != "fracture"]


class Gate(WithStore):
    def test_second_run_reuses_and_says_so(self):
        first, rows = self.first, self.first_rows
        self.assertIn("claims: checked now", self.first_text)
        self.assertEqual(list(first["verification"]), ["hash", "reused", "checked_at"])
        self.assertFalse(first["verification"]["reused"])
        self.assertEqual(list(first["verification_of_program"]), ["hash", "reused", "checked_at"])
        self.assertEqual({row["claim"] for row in rows}, claims_where("before_fracture"))

        text, second = self.fracture()
        when, key = first["verification"]["checked_at"], first["verification"]["hash"]
        self.assertIn(f"claims: verdicts of {when}, hash {key}, reused", text)
        self.assertEqual(second["verification"], {"hash": key, "reused": True, "checked_at": when})
        self.assertTrue(second["verification_of_program"]["reused"])
        self.assertEqual(self.claims(), rows)
        self.assertEqual([path.name for path in self.stored()], [f"{key}.json"])

    def test_file_says_what_its_verdicts_hold_for(self):
        run = self.first
        document = json.loads(self.stored()[0].read_text())
        self.assertEqual(hashlib.sha256(document["inputs"].encode()).hexdigest(), run["verification"]["hash"])
        with open(LATCON, "rb") as file:
            self.assertIn(f"program={hashlib.sha256(file.read()).hexdigest()}\n", document["inputs"])
        self.assertIn("\nNearest neighbours/b=150000\n", document["inputs"])
        self.assertEqual(document["checked_at"], run["verification"]["checked_at"])
        for key in ("version", "git_commit", "hardware_threads"):
            self.assertIn(key, document)

    @in_full
    def test_constant_changed_in_its_last_digits_is_checked(self):
        text, run = self.fracture("--set", f"Material/density={944 * (1 + 1e-12)!r}")
        self.assertIn("claims: checked now", text)
        self.assertNotEqual(run["verification"]["hash"], self.first["verification"]["hash"])
        self.assertEqual(len(self.stored()), 2)

    @in_full
    def test_verdict_on_the_program_serves_all_cases(self):
        _, run = self.fracture("--set", "Material/density=947")
        self.assertFalse(run["verification"]["reused"])
        self.assertEqual(run["verification_of_program"]["hash"], self.first["verification_of_program"]["hash"])
        self.assertTrue(run["verification_of_program"]["reused"])

    def test_what_no_claim_reads_may_change(self):
        text, _ = self.fracture("--set", "Lattice/noise seed=7", "--set", "Fracture/breaking stretch=3.1")
        self.assertIn("reused", text)

    @in_full
    def test_another_program_checks_again(self):
        other = self.folder / "latcon"
        with open(LATCON, "rb") as file:
            other.write_bytes(file.read() + b"\0")  # behind its end, which is not read
        other.chmod(0o755)
        words = ["fracture", CASES / "quick.prm", "--no-report", "--output-dir", self.out, *TINY, *self.MORE]
        self.assertEqual(latcon(*words, program=other, env=self.environment).returncode, 0)
        second = json.loads((self.out / "run.json").read_text())
        self.assertFalse(second["verification"]["reused"])
        self.assertNotEqual(second["verification"]["hash"], self.first["verification"]["hash"])

    @in_full
    def test_damaged_file_is_said_and_replaced(self):
        path = self.stored()[0]
        whole = path.read_text()
        path.write_text(whole[:len(whole) // 2])
        text, run = self.fracture()
        self.assertIn(f"{path} is not used: ", text)
        self.assertIn("is not used", run["verification"]["note"])
        self.assertFalse(run["verification"]["reused"])
        self.assertTrue(self.fracture()[1]["verification"]["reused"])
        self.assertEqual(self.stored(), [path])

    @in_full
    def test_file_of_other_inputs_under_this_name_is_not_used(self):
        right = self.stored()[0]
        self.fracture("--set", "Material/density=950")
        wrong = next(path for path in self.stored() if path != right)
        right.write_bytes(wrong.read_bytes())
        text, run = self.fracture()
        self.assertIn("it belongs to other inputs", text)
        self.assertFalse(run["verification"]["reused"])

    @in_full
    def test_file_that_others_may_have_written_is_not_used(self):
        path = self.stored()[0]
        mode = path.stat().st_mode & 0o777
        self.assertEqual(mode & 0o022, 0)
        path.chmod(mode | 0o020)
        printed, info = self.fracture()
        self.assertIn("is not used: it belongs to another user, or others may write it", printed)
        self.assertFalse(info["verification"]["reused"])
        path = self.stored()[0]  # rewritten
        self.assertEqual(path.stat().st_mode & 0o022, 0)
        self.assertTrue(self.fracture()[1]["verification"]["reused"])
        if FULL and os.geteuid() == 0:
            os.chown(path, 65534, 65534)
            printed, info = self.fracture()
            self.assertIn("is not used: it belongs to another user", printed)
            self.assertFalse(info["verification"]["reused"])

    @in_full
    def test_link_in_place_of_a_file_is_not_used(self):
        path = self.stored()[0]
        path.rename(self.folder / "elsewhere.json")
        path.symlink_to(self.folder / "elsewhere.json")
        self.assertFalse(self.fracture()[1]["verification"]["reused"])

    @in_full
    def test_laws_that_no_crack_uses_do_not_refuse_it(self):
        # The fitted law has its best ratio at the end of the interval, or a given one loses ellipticity on the way.
        for settings, word in ((["Loading/strain x=0", "Fracture/breaking stretch=3.2"], "at the end of the search interval"),
                               (["Continuum/ratio=-0.2"], "the law loses ellipticity")):
            self.fracture(*(word for setting in settings for word in ("--set", setting)))
            rows = [row for row in self.claims() if word in row["quantity"]]
            self.assertEqual([row["verdict"] for row in rows], ["reported"], word)
            self.assertGreater(sum(row["verdict"] == "holds" for row in self.claims()), 30)

    @in_full
    def test_store_that_cannot_be_written_stops_nothing(self):
        shutil.rmtree(self.cache)
        self.cache.write_text("in the way")
        text, run = self.fracture()
        self.assertIn("the verdicts are not kept: cannot write ", text)
        self.assertIn("not kept", run["verification"]["note"])
        self.assertTrue((self.out / "crack.json").exists())

    @in_full
    def test_without_a_home_nothing_is_kept(self):
        for name in ("XDG_CACHE_HOME", "HOME"):
            self.environment.pop(name, None)
        text, run = self.fracture()
        self.assertIn("no verdicts are kept", text)
        self.assertFalse(run["verification"]["reused"])

    @in_full
    def test_all_ranks_decide_alike(self):
        self.assertFalse(self.fracture(ranks=2)[1]["verification"]["reused"])  # one rank has another hash
        self.assertEqual(len(self.stored()), 2)
        self.assertTrue(self.fracture(ranks=2)[1]["verification"]["reused"])

    def test_skipped_verification_neither_checks_nor_stores(self):
        before = self.stored()
        _, run = self.fracture("--skip-verification", "--set", "Material/density=951")
        self.assertNotIn("verification", run)
        self.assertEqual(self.stored(), before)


class Refused(WithStore):
    """A crack whose claims fail."""
    MADE_RUN, MORE, EXPECT = "refused", REFUSED, 3

    def test_failure_is_refused_also_from_the_store(self):
        self.assertFalse(self.first["verification"]["reused"])
        text, run = self.fracture(expect=3)
        self.assertTrue(run["verification"]["reused"])
        self.assertIn("no crack was run", text)
        self.assertIn(f"delete {self.stored()[0]}", text)
        self.assertTrue(any(row["verdict"] == "fails" for row in self.claims()))
        self.assertFalse([path.name for path in self.out.iterdir() if re.match(r"crack|broken|lattice", path.name)])

    def test_last_lines_name_the_rows_that_fail(self):
        text, run = self.fracture(expect=3)
        failing = [row for row in self.claims() if row["verdict"] == "fails"]
        self.assertEqual(run["exit_code"], 3)
        lines = text.splitlines()
        self.assertIn(f"{len(failing)} of ", lines[-len(failing) - 1])
        for row, line in zip(failing, lines[-len(failing):]):
            self.assertIn(f"{row['claim']}: {row['quantity']}: error {row['error']:.3g}, tolerance", line)
        self.assertTrue(any("it buckles in waves of kd = " in line for line in lines[-len(failing):]), text)
        self.assertLess(len(lines), 16)

    def test_refused_crack_leaves_its_report(self):
        words = ["fracture", CASES / "quick.prm", "--output-dir", self.out, *TINY, *self.MORE]
        run = latcon(*words, env=self.environment)
        self.assertEqual(run.returncode, 3)
        self.assertIn(f"{self.out}/report.html\n", run.stdout)
        page = (self.out / "report.html").read_text()
        self.assertIn("it buckles", page)
