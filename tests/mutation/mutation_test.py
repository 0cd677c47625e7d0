#!/usr/bin/python3
"""Tests that the mutation harness kills faults that tests detect, and reports the others: mutation_test.py [CXX] [--full].

With --full a small project of the bond laws and their test is compiled directly, and run.py introduces faults into it.
"""
import json
import pathlib
import shutil
import subprocess
import sys
import tempfile
import unittest

sys.dont_write_bytecode = True

import mutants
import testing
from equivalents import Equivalents
from run import EQUIVALENTS, PLACES, ROOT, Report, programs_for
from scratch import Scratch

CXX = "c++"
FULL = "--full" in sys.argv
BUILD = """rule compile
  command = {cxx} -std=c++17 -O0 -I{root} -MD -MF $out.d -o $out -c $in
  depfile = $out.d
  deps = gcc
rule link
  command = : && {cxx} $in -o $out -lgtest_main -lgtest -lpthread && :
build tests/CMakeFiles/lattice_tests.dir/bond_law_test.cc.o: compile {root}/tests/lattice/bond_law_test.cc
build tests/lattice_tests: link tests/CMakeFiles/lattice_tests.dir/bond_law_test.cc.o
build lattice_tests: phony tests/lattice_tests
"""
EMPTY = """#include "lattice/bonds/bond_law.h"
#include <gtest/gtest.h>
TEST(BondLaw, IsCompiled)
{
  EXPECT_NE(latcon::lattice::LinearBond{1.}.energy(2.), -1.);
}
"""


class Faults(unittest.TestCase):
    def found(self, text):
        with tempfile.TemporaryDirectory() as name:
            path = pathlib.Path(name) / "file.cc"
            path.write_text(text, encoding="utf-8")
            return [(m.line, m.kind, m.after.strip()) for m in mutants.of_file(path, "lattice/file.cc")]

    def test_are_what_they_are_called(self):
        found = self.found("double f(double x)\n{\n  if (x < 1.5 && x != 0.)\n    y += g(x, 2);\n"
                           "  return x - h[i - 1];\n}\n")
        for expected in [(3, "comparison", "if (x <= 1.5 && x != 0.)"), (3, "comparison", "if (x > 1.5 && x != 0.)"),
                         (3, "comparison", "if (x < 1.5 && x == 0.)"), (3, "logic", "if (x < 1.5 || x != 0.)"),
                         (3, "constant", "if (x < 3.0 && x != 0.)"), (3, "constant", "if (x < 1.5 && x != 1.)"),
                         (3, "negated", "if (!(x < 1.5 && x != 0.))"), (4, "arithmetic", "y -= g(x, 2);"),
                         (4, "constant", "y += g(x, 3);"), (4, "dropped", ";"), (5, "arithmetic", "return x + h[i - 1];"),
                         (5, "constant", "return x - h[i - 0];"), (5, "factor 2", "return 2. * x - h[i - 1];")]:
            self.assertIn(expected, found)

    def test_are_in_code_alone(self):
        self.assertEqual(self.found('#include "a - b.h"\n// a - b\n/* a - b\n   c < 1 */\n'
                                    '  throw Failed("a - b",\n               1 - 2);\n  assert(a < b);\n'
                                    '  static_assert(a < 1);\n  std::array<double, 6> a;\n  using A = B<1>;\n'), [])
        self.assertEqual([after for _, _, after in self.found('  const char *text = "1 - 2"; // 3\n')], [])
        # The continuation of a statement is not a statement.
        self.assertNotIn("dropped", [kind for _, kind, _ in self.found("  const double sum = a[0] +\n    f(1);\n")])

    def test_are_drawn_by_seed(self):
        many = [mutants.Mutant(f"lattice/{file}", line, "a", f"b{line}", "sign") for file, n in (("a.cc", 900), ("b.cc", 100))
                for line in range(n)]
        drawn = mutants.in_random_order(many, "1")
        self.assertEqual(drawn, mutants.in_random_order(many[::-1], "1"))
        self.assertNotEqual(drawn, mutants.in_random_order(many, "2"))
        self.assertEqual(set(drawn), set(many))
        # The position of each depends on itself alone.
        some = [m for m in many if m.line % 2]
        self.assertEqual(mutants.in_random_order(some, "1"), [m for m in drawn if m in some])
        # A file is represented in proportion to its share: 20 of 200, within three standard deviations.
        self.assertLess(abs(sum(m.file == "lattice/b.cc" for m in drawn[:200]) - 20), 3 * (200 * 0.1 * 0.9) ** 0.5)

    def test_each_source_has_its_programs(self):
        self.assertEqual(programs_for("lattice/forces.cc")[0], "lattice_tests")
        self.assertEqual(programs_for("verification/input/units.cc")[0], "verification_tests")
        self.assertEqual(programs_for("verification/bridge/bloch.cc")[0], "claims_tests")
        self.assertEqual(programs_for("verification/commands/gate.cc"), [])
        # Each beginning of a name is that of a source.
        for place in PLACES:
            self.assertTrue(any(ROOT.glob(f"{place}*")), place)


class Scores(unittest.TestCase):
    def test_interval_is_wilsons(self):
        with_faults = [mutants.Mutant("lattice/a.cc", line, "a", f"b{line}", "sign") for line in range(10)]
        report = Report(None, Equivalents({}), with_faults, 1000)
        for mutant in with_faults:
            report.add(mutant, testing.Verdict("survived" if mutant.line == 0 else "killed"), 1.)
        # 9 of 10: E. B. Wilson, J. Am. Stat. Assoc. 22, 209 (1927).
        for bound, expected in zip(report.uncertainty(), (0.5958, 0.9821)):
            self.assertAlmostEqual(bound, expected, places=3)
        self.assertIn("10 of 1000 faults were planted", report.text())


class Reviewed(unittest.TestCase):
    def test_equivalents_are_faults_of_the_sources_as_they_are(self):
        listed = Equivalents.read(EQUIVALENTS)
        self.assertEqual(listed.outdated(lambda file: mutants.of_file(ROOT / file, file)), [])

    def test_entries_are_whole(self):
        with tempfile.TemporaryDirectory() as name:
            path = pathlib.Path(name) / "list"
            path.write_text("# of\nfile: a.cc\n- x = 1;\n+ x = 0;\nreason: never\n  read\n", encoding="utf-8")
            listed = Equivalents.read(path)
            self.assertEqual(listed.reason(mutants.Mutant("a.cc", 3, "  x = 1;", "  x = 0;", "constant")), "never read")
            self.assertIsNone(listed.reason(mutants.Mutant("a.cc", 3, "  x = 1;", "  ;", "dropped")))
            self.assertEqual(listed.outdated(lambda _: []), [("a.cc", "x = 1;", "x = 0;")])
            path.write_text("file: a.cc\n- x = 1;\n+ x = 0;\n", encoding="utf-8")
            with self.assertRaises(ValueError):
                Equivalents.read(path)


class Limited(unittest.TestCase):
    def run_shell(self, command):
        with tempfile.TemporaryDirectory() as name:
            return testing.run_limited(["sh", "-c", command], pathlib.Path(name), 0., testing.Limits(1., 1., 3.))

    def test_what_fails_crashes_or_does_not_end_is_killed(self):
        self.assertEqual(self.run_shell("exit 0"), testing.Verdict("survived"))
        self.assertEqual(self.run_shell("exit 3"), testing.Verdict("killed", "exit 3"))
        self.assertEqual(self.run_shell("kill -SEGV $$"), testing.Verdict("killed", "signal 11"))
        self.assertEqual(self.run_shell("echo '[  FAILED  ] A.B (1 ms)'; exit 1"), testing.Verdict("killed", "A.B"))
        self.assertEqual(self.run_shell("while :; do :; done"), testing.Verdict("killed", "time limit"))
        self.assertEqual(self.run_shell("sleep 60"), testing.Verdict("killed", "time limit"))


@unittest.skipUnless(FULL, "in full only")
class Project(unittest.TestCase):
    """Project with the bond laws alone."""

    def setUp(self):
        place = tempfile.TemporaryDirectory()
        self.addCleanup(place.cleanup)
        self.root = pathlib.Path(place.name).resolve()
        for name in (*(str(path.relative_to(ROOT)) for path in (ROOT / "lattice/bonds").glob("*.h")),
                     "tests/lattice/bond_law_test.cc"):
            (self.root / name).parent.mkdir(parents=True, exist_ok=True)
            shutil.copy(ROOT / name, self.root / name)
        self.build = self.root / "build" / "release"
        self.build.mkdir(parents=True)
        (self.build / "build.ninja").write_text(BUILD.format(cxx=CXX, root=self.root), encoding="utf-8")
        commands = subprocess.run(["ninja", "-t", "compdb", "compile"], cwd=self.build, stdout=subprocess.PIPE, text=True,
                                  check=True)
        (self.build / "compile_commands.json").write_text(commands.stdout, encoding="utf-8")

    def planted(self, *arguments):
        """@return exit status, output and JSON of run.py"""
        record = self.root / "record.json"
        before = {path: path.read_bytes() for path in self.root.glob("*/**/*.*") if "build" not in path.parts}
        done = subprocess.run([sys.executable, str(pathlib.Path(__file__).with_name("run.py")), "--root", str(self.root),
                               "--only", "lattice/bonds/mooney_rivlin_bond.h", "--programs", "lattice_tests", "--output", str(record),
                               *arguments],
                              stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True, check=False)
        self.assertIn(done.returncode, (0, 1), done.stderr)
        self.assertEqual({path: path.read_bytes() for path in before}, before)
        self.assertEqual([path.name for path in (self.root / "build").iterdir()], ["release"])
        return done.returncode, done.stdout, json.loads(record.read_text(encoding="utf-8"))

    def test_faults_of_the_bond_laws_are_killed(self):
        status, text, record = self.planted("--sample", "6", "--seed", "3")
        self.assertEqual((status, record["score"]), (0, 1.), text)
        self.assertEqual(sum(m["outcome"] == "killed" for m in record["mutants"]), 6)
        self.assertTrue(all(m["by"].startswith("lattice_tests: ") for m in record["mutants"]))
        self.assertIn("100.0 %", text)

    def test_none_begins_after_the_hours(self):
        (self.root / "record.json").write_text('{"mutants": []}', encoding="utf-8")
        status, text, record = self.planted("--hours", "0")
        self.assertEqual((status, record["mutants"]), (0, []), text)

    def test_what_no_test_sees_is_reported(self):
        (self.root / "tests/lattice/bond_law_test.cc").write_text(EMPTY, encoding="utf-8")
        status, text, record = self.planted("--sample", "2", "--seed", "3")
        self.assertEqual((status, record["score"]), (1, 0.), text)
        for mutant in record["mutants"]:
            self.assertEqual(mutant["outcome"], "survived")
            self.assertIn(f"survived: lattice/bonds/mooney_rivlin_bond.h:{mutant['line']}", text)
            self.assertIn("+ " + mutant["after"], text)

    def test_what_does_not_compile_is_no_fault(self):
        scratch = Scratch(self.root, self.build, self.root / "scratch", {"lattice_tests": testing.GoogleTests()})
        text = (self.root / "lattice/bonds/mooney_rivlin_bond.h").read_text(encoding="utf-8").split("\n")
        line = next(n for n, line in enumerate(text, 1) if "double energy(" in line)
        mutant = mutants.Mutant("lattice/bonds/mooney_rivlin_bond.h", line, text[line - 1], "  no program", "sign")
        self.assertEqual(scratch.test(mutant, ["lattice_tests"], self.root / "mutant"), testing.Verdict("no program"))


if __name__ == "__main__":
    if len(sys.argv) > 1 and not sys.argv[1].startswith("-"):
        CXX = sys.argv.pop(1)
    unittest.main(argv=sys.argv[:1])
