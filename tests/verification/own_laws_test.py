#!/usr/bin/python3
"""Tests of user-defined bond laws in cases: expressions, and the shared library of examples/own-laws.

Usage: own_laws_test.py PATH_OF_LATCON
"""
import json
import pathlib
import shutil
import subprocess
import sys
import unittest

sys.dont_write_bytecode = True
from program import CASES, LATCON, TemporaryFolder, latcon, latcon_on_ranks, read_csv

SOURCE = pathlib.Path(__file__).resolve().parents[2]
# A crack that takes a second.
TINY = ["--set", "Sheet/length=2.5 cm", "--set", "Sheet/height=1.5 cm", "--set", "Time/end=0.6 ms", "--no-report",
        "--skip-verification"]
RESULTS = ("crack.csv", "broken_bonds.csv", "energy.csv")
MOONEY_RIVLIN = {"law": "expression", "psi": "a*(lam^2/2 + 1/lam) + k/2*(2*lam + lam^-2)", "parameters": "k = 0.15 MPa"}


def bonds(**entries):
    """Options that set entries of both kinds of bonds."""
    return [word for section in ("Nearest neighbours", "Next-nearest neighbours") for name, value in entries.items()
            for word in ("--set", f"{section}/{name.replace('_', ' ')}={value}")]


class OwnLaws(TemporaryFolder):
    def crack(self, name, *options, **entries):
        ended = latcon("fracture", CASES / "quick.prm", *TINY, *bonds(**entries), *options, "--output-dir", self.folder / name)
        self.assertEqual(ended.returncode, 0, ended.stderr)
        return self.folder / name

    def refused(self, part, *options, **entries):
        ended = latcon("fracture", CASES / "quick.prm", *TINY, *bonds(**entries), *options, "--output-dir", self.folder / "bad")
        self.assertEqual(ended.returncode, 2, ended.stderr)
        self.assertIn(part, ended.stderr)
        self.assertFalse((self.folder / "bad").exists())

    def library(self, name, *flags, text=None):
        source = self.folder / f"{name}.c"
        source.write_text(text or (SOURCE / "examples/own-laws/gent_law.c").read_text())
        library = self.folder / f"{name}.so"
        subprocess.run(["cc", "-O1", "-shared", "-fPIC", "-I", SOURCE, *flags, source, "-o", library, "-lm"], check=True)
        return library

    def same_crack(self, one, other):
        """Bond after bond. The laws differ by a few roundings of each force, 1e-16. Between two breaks they grow like any
        perturbation; over the run of this test, from 1e-16 to less than 1e-9. A bond breaks in the same step unless it is as
        close to its limit as that, and time steps follow from the stiffness, whose roundings are those of the times."""
        rows = [read_csv(folder / "broken_bonds.csv") for folder in (one, other)]
        self.assertGreater(len(rows[0]), 20)
        self.assertEqual(len(rows[0]), len(rows[1]))
        for a, b in zip(*rows):
            for column in a:
                x, y = float(a[column]), float(b[column])
                self.assertAlmostEqual(x, y, delta=1e-9 * max(abs(x), 1e-3), msg=column)

    def test_expression_cracks_as_the_built_in_law(self):
        self.same_crack(self.crack("built-in"), self.crack("typed", **MOONEY_RIVLIN))

    def test_library_cracks_as_the_same_expression(self):
        parameters = "mu = 0.25 MPa, Jm = 120"
        typed = self.crack("typed", law="expression", psi="-mu*Jm/2*log(1 - (lam^2 + 2/lam - 3)/Jm)", parameters=parameters)
        compiled = self.crack("compiled", law="library", library=self.library("gent"), parameters=parameters)
        self.same_crack(typed, compiled)

    def test_threads_and_ranks_leave_the_same_bits(self):
        one = self.crack("one", "--threads", 1, **MOONEY_RIVLIN)
        two = self.crack("two", "--threads", 2, **MOONEY_RIVLIN)
        ended = latcon_on_ranks(2, "fracture", CASES / "quick.prm", *TINY, *bonds(**MOONEY_RIVLIN), "--threads", 1,
                                "--output-dir", self.folder / "ranks")
        self.assertEqual(ended.returncode, 0, ended.stderr)
        for name in RESULTS:
            for other in (two, self.folder / "ranks"):
                self.assertEqual((one / name).read_bytes(), (other / name).read_bytes(), name)

    def test_branches_beside_an_expression_leave_the_same_bits(self):
        options = ("fracture", CASES / "spectrum.prm", "--set", "Sheet/length=1.6 cm", "--set", "Sheet/height=1 cm", "--set",
                   "Time/end=0.25 ms", *bonds(**MOONEY_RIVLIN), "--threads", 1, "--no-report", "--skip-verification")
        one = latcon(*options, "--output-dir", self.folder / "one")
        two = latcon_on_ranks(2, *options, "--output-dir", self.folder / "two")
        for ended in (one, two):
            self.assertEqual(ended.returncode, 0, ended.stderr)
        self.assertGreater(len(read_csv(self.folder / "one" / "broken_bonds.csv")), 10)
        for name in RESULTS:
            self.assertEqual(*((self.folder / run / name).read_bytes() for run in ("one", "two")), name)

    def test_claims_need_the_law_up_to_their_largest_stretch(self):
        # Locks between 2.9, the largest stretch of this case's bonds, and 3.5.
        law = {"law": "expression", "psi": "-lam - (k-1)*log(k-lam)", "parameters": "k=3.2"}
        case = (CASES / "quick.prm", "--set", "Fracture/toughening=none", "--set", "Fracture/factor=1",
                "--set", "Fracture/breaking stretch=2.9", *bonds(**law), "--output-dir", self.folder / "bad")
        for command in (("fracture",), ("verify", "energy", "--quick", "--case")):
            ended = latcon(*command, *case)
            self.assertEqual(ended.returncode, 2, ended.stderr)
            self.assertIn("claims evaluate the law at stretches up to 3.5: psi is nan at stretch 3.2", ended.stderr)
            self.assertFalse((self.folder / "bad").exists())
        self.assertEqual(latcon("fracture", *case, "--skip-verification", "--dry-run").returncode, 0)

    def test_studies_need_the_law_up_to_the_largest_stretch_of_their_claims(self):
        law = {"law": "expression", "psi": "-lam - (k-1)*log(k-lam)", "parameters": "k=3.2"}
        sweep = (CASES / "quick.prm", "--sweep", "Sheet/height=1 cm,1.5 cm", "--set", "Fracture/toughening=none", "--set",
                 "Fracture/factor=1", "--set", "Fracture/breaking stretch=2.9", *bonds(**law), "--output-dir", self.folder / "bad")
        for command in (("study",), ("study", "--dry-run"), ("study", "--quick"), ("study", "--quick", "--dry-run"),
                        ("batch", "--slurm"), ("batch", "--slurm", "--quick")):
            ended = latcon(*command, *sweep)
            self.assertEqual(ended.returncode, 2, ended.stdout + ended.stderr)
            self.assertIn("claims evaluate the law at stretches up to 3.5: psi is nan at stretch 3.2", ended.stderr)
            self.assertFalse((self.folder / "bad").exists())
        self.assertEqual(latcon("study", *sweep, "--skip-verification", "--dry-run").returncode, 0)

    def test_damage_is_not_checked_for_laws_of_the_user(self):
        for options in ((), ("--dry-run",)):
            ended = latcon("verify", "energy", "damage", "--quick", "--case", CASES / "quick.prm", *bonds(**MOONEY_RIVLIN), *options,
                           "--output-dir", self.folder / "bad")
            self.assertEqual(ended.returncode, 2, ended.stdout + ended.stderr)
            self.assertIn("Nearest neighbours/law = expression: the claim damage evaluates laws far beyond the stretch of 3.5",
                          ended.stderr)
            self.assertIn("allowed: mooney-rivlin, linear", ended.stderr)
            self.assertFalse((self.folder / "bad").exists())

    def test_claims_hold(self):
        ended = latcon("verify", "energy", "wave-speeds", "--quick", "--case", CASES / "quick.prm", "--set",
                       "Next-nearest neighbours/present=false", *bonds(**MOONEY_RIVLIN), "--output-dir", self.folder / "claims")
        self.assertEqual(ended.returncode, 0, ended.stdout + ended.stderr)
        rows = json.loads((self.folder / "claims" / "results.json").read_text())["claims"]
        self.assertGreater(sum(row["verdict"] == "holds" for row in rows), 20)

    def test_force_is_compared_with_the_derivatives(self):
        text = (SOURCE / "examples/own-laws/gent_law.c").read_text()
        wrong = text.replace("  return mu * (lam", "  return (1. + 1e-3 * (lam > 2.3)) * mu * (lam")
        self.assertNotEqual(text, wrong)
        self.refused("psi' is", law="library", library=self.library("wrong", text=wrong), parameters="mu = 0.25 MPa, Jm = 120")

    def test_library_is_part_of_the_case(self):
        gent = self.library("gent")
        parameters = "mu = 0.25 MPa, Jm = 120"
        run = self.crack("first", law="library", library=gent, parameters=parameters)
        case = (run / "case.prm").read_text()
        first = json.loads((run / "run.json").read_text())["case_hash"]
        self.library("gent", "-DANOTHER=1", "-O0")  # in its place
        ended = latcon("fracture", run / "case.prm", "--no-report", "--skip-verification", "--output-dir", self.folder / "second")
        self.assertEqual(ended.returncode, 2)
        self.assertIn("Nearest neighbours/library sha256", ended.stderr)
        self.assertRegex(case, r"library sha256 *= [0-9a-f]{64}")
        second = self.crack("third", law="library", library=gent, parameters=parameters)
        self.assertNotEqual(first, json.loads((second / "run.json").read_text())["case_hash"])

    def test_all_ranks_need_the_same_library(self):
        self.library("gent")
        for name in ("one", "two", "none"):
            (self.folder / name).mkdir()
        shutil.copy(self.folder / "gent.so", self.folder / "one")
        self.library("gent", "-DANOTHER=1", "-O0")
        shutil.copy(self.folder / "gent.so", self.folder / "two")
        case = ["fracture", CASES / "quick.prm", *TINY, "--threads", 1, "--output-dir", self.folder / "ranks",
                *bonds(law="library", library="gent.so", parameters="mu = 0.25 MPa, Jm = 120")]
        for other in ("two", "none"):
            ranks = [["-n", 1, "--wdir", self.folder / folder, LATCON, *case] for folder in ("one", other)]
            command = ["mpirun", "--oversubscribe", *ranks[0], ":", *ranks[1]]
            ended = subprocess.run([str(word) for word in command], capture_output=True, text=True, timeout=600)
            self.assertEqual(ended.returncode, 2, ended.stderr)
            self.assertIn("the ranks find different libraries, or some none", ended.stderr)
            self.assertFalse((self.folder / "ranks").exists())

    def test_large_library(self):
        large = self.library("large", text=(SOURCE / "examples/own-laws/gent_law.c").read_text() +
                             "\nconst char ballast[20 << 20] = {1};\n")
        self.assertGreater(large.stat().st_size, 20 << 20)
        ended = latcon("fracture", CASES / "quick.prm", *TINY, "--dry-run",
                       *bonds(law="library", library=large, parameters="mu = 0.25 MPa, Jm = 120"))
        self.assertEqual(ended.returncode, 0, ended.stderr)

    def test_schema_refuses_an_invalid_law(self):
        for entries, part in (({"law": "expression", "psi": "a*lan"}, "unknown 'lan'"), ({"law": "library"}, "a shared library is required")):
            ended = latcon("schema", CASES / "quick.prm", *bonds(**entries))
            self.assertEqual(ended.returncode, 2, ended.stderr)
            self.assertIn(part, ended.stderr)
            self.assertEqual(ended.stdout, "")

    def test_unusable_libraries_are_refused(self):
        text = (SOURCE / "examples/own-laws/gent_law.c").read_text()
        law = {"law": "library", "parameters": "mu = 0.25 MPa, Jm = 120"}
        self.refused("cannot read the library", library=self.folder / "none.so", **law)
        self.refused("no function `latcon_bond_law_force`", **law,
                     library=self.library("nameless", text=text.replace("latcon_bond_law_force", "latcon_force")))
        self.refused("it has version 2 of the interface; required: 1", **law,
                     library=self.library("later", text=text.replace("return LATCON_BOND_LAW_VERSION", "return 2")))
        gent = self.library("gent")
        self.refused("the library needs 'Jm'", law="library", library=gent, parameters="mu = 0.25 MPa")
        # The entries a, b and modulus belong to other laws.
        borrowing = self.library("borrowing", text=text.replace('"mu Jm"', '"modulus Jm"'))
        self.refused("the library needs 'modulus'", law="library", library=borrowing, parameters="Jm = 120")
        self.refused("has no parameter 'k'", law="library", library=gent, parameters="mu = 0.25 MPa, Jm = 120, k = 1")
        # The chains lock before the toughened bonds break, at 9.15.
        self.refused("it must be finite for all stretches of bonds, 0.3 to 9.15", law="library", library=gent,
                     parameters="mu = 0.25 MPa, Jm = 30")
        # They lock at 9.16, which a bond can reach in the step in which it breaks.
        self.refused("than its breaking stretch before the time step ends in which it breaks", law="library", library=gent,
                     parameters="mu = 0.25 MPa, Jm = 81.12")


if __name__ == "__main__":
    unittest.main(verbosity=2)
