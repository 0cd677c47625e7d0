#!/usr/bin/python3
"""Explanations of the command line: typing errors, shipped cases, entries, a case to start from, runs that cost too much.

Usage: help_test.py PATH_OF_LATCON
"""
import json
import re
import subprocess
import sys
import unittest

sys.dont_write_bytecode = True
from program import CASES, LATCON, TemporaryFolder, latcon

SHORT = ["--skip-verification", "--no-report", "--set", "Time/end=0.01 ms"]
FINE = ["--set", "Sheet/spacing=0.01 mm"]  # months of computing


class Help(TemporaryFolder):
    def refused(self, *arguments, **keywords):
        run = latcon(*arguments, **keywords)
        self.assertEqual((run.returncode, run.stdout), (2, ""), run.stderr)
        return run.stderr.strip()

    def test_typing_errors_have_a_nearest_word(self):
        for arguments, message in [
                (["fractur", "quick"], "unknown command 'fractur'; nearest: fracture; see latcon --help"),
                (["fracture", "--sets=a", "quick"], "unknown option --sets; nearest: --set; see latcon fracture --help"),
                (["--outptu-dir", "x", "verify"], "unknown option --outptu-dir; nearest: --output-dir; see latcon verify --help"),
                (["verify", "--quik"], "unknown option --quik; nearest: --quick; see latcon verify --help"),
                (["report", "a", "b"], "unexpected argument 'b'; see latcon report --help"),
                (["entries", "fractur"], "no section 'fractur'; nearest: Fracture"),
                (["help", "Fracture/toughning"], "no command, section or entry 'Fracture/toughning'; nearest: Fracture/toughening"),
                (["help", "fractre"], "no command, section or entry 'fractre'; nearest: fracture")]:
            self.assertEqual(self.refused(*arguments), "latcon: " + message)
        self.assertRegex(self.refused("zzz"), r"unknown command 'zzz'; commands: verify, lattice, .*, schema; see")
        self.assertRegex(self.refused(), r"a command is required: verify, lattice, ")

    def test_the_list_of_claims_says_which_are_checked_without_names(self):
        lines = {line.split()[0]: line for line in latcon("verify", "--help").stdout.split("Claims:")[1].splitlines() if line.strip()}
        for claim in json.loads(latcon("schema").stdout)["claims"]:
            self.assertEqual("only if named" in lines[claim["name"]], not claim["default"], claim["name"])

    def test_a_missing_case_is_the_only_error(self):
        for command in ("fracture", "lattice", "continuum"):
            message = self.refused(command, "quik", "--set", "Loading/strain y=0.2")
            self.assertEqual(message, "latcon: quik: cannot read the case: No such file or directory; nearest shipped case: quick")
        self.assertIn("; shipped cases: fig1, ", self.refused("lattice", "zzz.prm"))
        self.assertIn("nearest known key: Loading/strain y", self.refused("lattice", "quick", "--set", "strain y=1"))

    def test_every_command_has_the_shared_options_and_an_example(self):
        commands = re.findall(r"^  ([a-z]+) ", latcon("--help").stdout.split("Subcommands:")[1], re.M)
        shared = re.findall(r"^  (?:-[a-z],)?(--(?!version|help)[a-z-]+)", latcon("--help").stdout, re.M)
        self.assertIn("--yes", shared)
        for command in commands:
            text = latcon(command, "--help").stdout
            self.assertIn(f"\nExample: latcon {command} ", text)
            line = text.split("(described by latcon --help): ")[1].split("Example")[0]
            self.assertEqual(re.findall(r"--[a-z-]+", line), shared)
            self.assertEqual(latcon("help", command).stdout, text)
        self.assertEqual(latcon("help").stdout, latcon("--help").stdout)

    def test_shipped_cases_have_names(self):
        run = latcon("fracture", "quick", *SHORT, cwd=self.folder)
        self.assertEqual(run.returncode, 0, run.stderr)
        self.assertTrue((self.folder / "output/quick/crack.json").exists())
        for command in ("lattice", "continuum"):
            self.assertEqual(latcon(command, "hole", "--quiet", "--set", "Sheet/spacing=1 mm", cwd=self.folder).returncode, 0)
            self.assertTrue((self.folder / f"output/hole-{command}/run.json").exists())
        # A folder of that name is no case, a file is.
        (self.folder / "quick").mkdir()
        self.assertEqual(latcon("fracture", "quick", "--dry-run", cwd=self.folder).returncode, 0)
        (self.folder / "hole").write_text("subsection Sheet\n")
        self.assertIn("hole:", self.refused("lattice", "hole", cwd=self.folder))

    def test_entries_are_those_of_the_schema(self):
        entries = json.loads(latcon("schema").stdout)["entries"]
        text = latcon("entries").stdout
        self.assertLessEqual(max(map(len, text.splitlines())), 120)
        sections = re.split(r"^(?=[A-Z])", text, flags=re.M)
        of = {section.split("\n")[0]: section for section in sections}
        for entry in entries:
            self.assertRegex(of[entry["section"]], rf"(?m)^  {re.escape(entry['name'])} ")
        self.assertEqual(latcon("entries", "near tip").stdout.split("\n\nColumns")[0], of["Near tip"].strip())
        for line in [r"  spacing +m +required +\S", r"  orientation +rows-along-crack +\S"]:
            self.assertRegex(of["Sheet"], line)

    def test_help_on_an_entry_has_all_of_it(self):
        text = latcon("help", "Fracture/toughening").stdout
        for part in ["Fracture/toughening\n", "one of none, behind-tip, retraction", "default:  none",
                     '--set "Fracture/toughening=none"']:
            self.assertIn(part, text)
        self.assertEqual(latcon("help", "toughening").stdout, text)
        self.assertIn("unit:     m;", latcon("help", "near", "tip/ahead").stdout)
        self.assertIn("Sheet/spacing\n", latcon("help", "Sheet/spacing").stdout)
        self.assertEqual(latcon("help", "viscosity").stdout.count("default:"), 4)  # of three shells and the contact
        self.assertEqual(latcon("help", "Contact").stdout, latcon("entries", "Contact").stdout)

    def test_init_makes_a_case_that_runs(self):
        run = latcon("init", "strip/", cwd=self.folder)
        self.assertEqual(run.returncode, 0, run.stderr)
        case = self.folder / "strip" / "strip.prm"
        self.assertIn("run it:       latcon fracture strip/strip.prm\n", run.stdout)
        self.assertEqual(case.read_bytes(), (CASES / "start.prm").read_bytes())
        self.assertEqual([path.name for path in case.parent.iterdir()], ["strip.prm"])
        self.assertEqual(self.refused("init", "strip", cwd=self.folder), "latcon: strip/strip.prm exists; give another folder")
        run = latcon("fracture", "strip/strip.prm", *SHORT, cwd=self.folder)
        self.assertEqual(run.returncode, 0, run.stderr)
        self.assertTrue((self.folder / "output/strip/crack.json").exists())

    def test_absurd_cost_needs_yes(self):
        for command, *entries in [("fracture", *FINE), ("lattice", *FINE, "--set", "Lattice/solution=motion", "--set",
                                                        "Time/end=1 s")]:
            for mode in ([], ["--dry-run"]):
                run = latcon(command, "quick", *entries, *mode, "--output-dir", self.out)
                self.assertEqual(run.returncode, 2, run.stdout)
                self.assertRegex(run.stderr, r"the run would take about \S+ days, more than 10; .*; use --yes")
                self.assertFalse(self.out.exists())
            self.assertEqual(latcon(command, "quick", *entries, "--dry-run", "--yes").returncode, 0)
        cells = ["--set", "Continuum/cells x=8192", "--set", "Continuum/cells y=8192"]
        self.assertRegex(self.refused("continuum", "quick", *cells, "--output-dir", self.out),
                         r"memory: .* \d{11,} bytes .*; use --yes to run it anyway")


class Log(TemporaryFolder):
    def log(self):
        return (self.out / "log.txt").read_text().splitlines()

    def run_(self, *arguments):
        return latcon("fracture", "quick", *SHORT, "--output-dir", self.out, *arguments)

    def test_is_that_of_each_run(self):
        first = self.run_()
        self.assertEqual(self.log()[1:], first.stdout.splitlines())
        second = self.run_("--set", "Loading/strain y=1.7")
        self.assertEqual(self.log()[1:], second.stdout.splitlines())
        self.assertEqual((self.out / "earlier-run/log.txt").read_text().splitlines()[1:], first.stdout.splitlines())
        third = self.run_("--set", "Loading/strain y=1.7", "--resume")
        self.assertEqual(len([line for line in self.log() if line.startswith("$ ")]), 2)
        self.assertEqual(self.log()[-len(third.stdout.splitlines()):], third.stdout.splitlines())

    def test_ends_with_the_error(self):
        (self.out / "crack.csv").mkdir(parents=True)
        run = self.run_()
        self.assertEqual(run.returncode, 5)
        self.assertIn("crack.csv", run.stderr)
        self.assertEqual(self.log()[-1:], run.stderr.splitlines())

    def test_is_left_alone_where_output_goes_to_it(self):
        self.out.mkdir()
        with (self.out / "log.txt").open("w") as file:
            subprocess.run([LATCON, "fracture", "quick", *SHORT, "--output-dir", self.out], stdout=file, check=True)
        self.assertNotIn("$ ", self.log()[0])
        self.assertIn("crack", self.log()[0])


if __name__ == "__main__":
    unittest.main()
