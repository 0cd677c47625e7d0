#!/usr/bin/python3
"""Tests of latcon study: runs, exit codes, files, resuming, kills, and refusals.

Usage: study_test.py PATH_OF_LATCON
"""
import copy
import json
import os
import pathlib
import re
import shutil
import signal
import subprocess
import sys
import tempfile
import time
import unittest

sys.dont_write_bytecode = True
from program import CASES, LATCON, TemporaryFolder, children, latcon, read_csv

# Strips so small that a crack runs through in a moment, with nearest neighbours alone, which are faster to check.
TINY = {
    "title": "A tiny study",
    "base": str(CASES / "quick.prm"),
    "set": {"Sheet/length": "2.5 cm", "Sheet/height": "1.5 cm", "Time/end": "1 ms",
            "Next-nearest neighbours/present": False},
    "quick": {"set": {"Time/end": "0.5 ms"}},
    "runs": {
        "base": {"seeds": [1, 2]},
        "low": {"set": {"Sheet/height": "1 cm"}},
        "thin": {"set": {"Nearest neighbours/viscosity": 40}, "quick": False},
    },
    "claims": [
        {"claim": "The crack runs", "paper": "It does.", "rows": [
            {"run": "base", "quantity": "speed_lagrangian", "above": 1},
            {"runs": ["low", "base"], "quantity": "speed_lagrangian", "against": "Sheet/height"},
            {"run": "base", "quantity": "pattern"}]},
    ],
}
FOLDERS = ["base-1", "base-2", "low-1", "thin-1"]
# The rubber of quick.prm itself, whose verdicts the fixture of the tests has left, for studies that verify it.
BOTH_NEIGHBOURS = {**TINY["set"], "Next-nearest neighbours/present": True}


def words_of(process):
    """Its command line."""
    try:
        return pathlib.Path(f"/proc/{process}/cmdline").read_text().split("\0")
    except OSError:
        return []


def seconds_of_threads(process):
    """Processor time of each running thread of a process [s]."""
    seconds = {}
    for path in pathlib.Path(f"/proc/{process}/task").glob("*/stat"):
        try:
            fields = path.read_text().rsplit(")", 1)[1].split()
        except OSError:
            continue
        seconds[path.parent.name] = (int(fields[11]) + int(fields[12])) / os.sysconf("SC_CLK_TCK")
    return seconds


class Study(TemporaryFolder):
    @classmethod
    def setUpClass(cls):
        """Runs the study, once for all tests that begin with it."""
        folder = tempfile.TemporaryDirectory()
        cls.addClassCleanup(folder.cleanup)
        before = cls("study")
        before.folder = pathlib.Path(folder.name)
        cls.ended = before.out = before.folder / "out"
        before.study()

    def begin_with_the_end(self):
        shutil.copytree(self.ended, self.out)  # with the times of the files

    def study(self, *arguments, change=None, expect=0, skip=True, page=False, **keywords):
        """Runs the tiny study after `change` has changed it, without its page unless `page`. @return its output"""
        document = copy.deepcopy(TINY)
        if change:
            change(document)
        path = self.folder / "tiny.json"
        path.write_text(json.dumps(document))
        words = ["study", path, "--output-dir", self.out, *["--skip-verification"] * skip,
                 *["--no-report"] * (not page), *arguments]
        run = latcon(*words, **keywords)
        self.assertEqual(run.returncode, expect, run.stdout + run.stderr)
        return run.stdout + run.stderr

    def test_a_run_whose_energies_do_not_balance_is_no_measurement(self):
        def change(document):
            document["set"].update({"Time/integrator": "runge-kutta-chebyshev", "Output/energy interval": 1})
            document["runs"] = {"fine": {}, "coarse": {"set": {"Time/step": "16 us"}}}  # four times the automatic step
            document["claims"] = [{"claim": "It runs", "rows": [{"run": "fine", "quantity": "bonds_broken", "above": 1},
                                                                {"run": "coarse", "quantity": "bonds_broken"}]}]
        printed = self.study(change=change, expect=3, page=True)
        self.assertRegex(printed, r"coarse, seed 1: failed its checks: fracture: energy imbalance [^()]* \(ledger\)")
        self.assertEqual([line["state"] for line in read_csv(self.out / "study.csv")], ["measured", "failed its checks"])
        claim, = json.loads(self.text("study.json"))["claims"]
        self.assertEqual(claim["verdict"], "holds")  # no row needs the run that failed, but the study does
        self.assertEqual([row["values"][0]["n"] for row in claim["rows"]], [1, 0])
        self.assertIn("coarse, seed 1: failed its checks</b> fracture: energy imbalance", self.text("study.html"))
        self.assertEqual(list(json.loads(self.text("runs/coarse-1/run.json"))["failed_rows"].values()), ["ledger"])
        times = [path.stat().st_mtime_ns for path in sorted(self.out.glob("runs/*/crack.json"))]
        self.study("--resume", change=change, expect=3)  # such a run would end alike
        self.assertEqual(times, [path.stat().st_mtime_ns for path in sorted(self.out.glob("runs/*/crack.json"))])

    def text(self, name):
        return (self.out / name).read_text()

    def times(self):
        """Modification times of the runs."""
        return {name: (self.out / "runs" / name / "crack.json").stat().st_mtime_ns for name in FOLDERS}

    def test_runs_everything_and_leaves_every_file(self):
        environment = {name: value for name, value in os.environ.items() if not name.startswith("OMPI_")}
        printed = self.study(env=environment, page=True, change=lambda document: document.update(pictures=["base"]))
        self.assertIn("[4/4]", printed)
        self.assertLessEqual(max(map(len, printed.splitlines())), 120)
        self.assertEqual(sorted(path.name for path in (self.out / "runs").iterdir()), FOLDERS)
        self.assertNotIn("report.html", os.listdir(self.out / "runs" / "base-1"))
        document = json.loads(self.text("study.json"))
        rows = document["claims"][0]["rows"]
        self.assertEqual([row["verdict"] for row in rows], ["holds", "reported", "reported"])
        self.assertEqual(rows[0]["values"][0]["n"], 2)
        self.assertEqual((document["verification"], document["verified"]), ("none (--skip-verification)", False))
        lines = read_csv(self.out / "study.csv")
        self.assertEqual([(line["run"], line["seed"]) for line in lines],
                         [("base", "1"), ("base", "2"), ("low", "1"), ("thin", "1")])
        crack = json.loads(self.text("runs/base-2/crack.json"))
        self.assertEqual(float(lines[1]["speed_lagrangian [m/s]"]), crack["speed_lagrangian"])
        self.assertEqual(json.loads(self.text("results.json"))["verdict"], "holds")
        page = self.text("study.html")
        self.assertTrue((self.out / "pictures" / "base-sheet.png").exists())
        for part in ("The crack runs", "Not verified: the only row holds", "data:image/png", "It does."):
            self.assertIn(part, page)
        self.assertNotIn('class="banner holds"', page)
        self.assertNotIn("http", page.replace("http://www.w3.org", ""))

    def test_without_report_every_other_file_is_left(self):
        self.begin_with_the_end()
        self.assertEqual({"study.json", "study.csv", "results.json", "study.html", "pictures"} & set(os.listdir(self.out)),
                         {"study.json", "study.csv", "results.json"})

    def test_claim_that_could_not_be_measured_is_3(self):
        def change(document):  # a straight crack has no wavelength
            document["runs"] = {"base": {}}
            document["claims"][0]["rows"] = [{"run": "base", "quantity": "speed_lagrangian", "above": 1},
                                             {"run": "base", "quantity": "wavelength", "above": 0}]
        printed = self.study(change=change, expect=3, page=True)
        self.assertIn("The crack runs: incomplete", printed)
        self.assertIn("not measured in 1 of 1", printed)
        self.assertEqual(json.loads(self.text("study.json"))["claims"][0]["verdict"], "incomplete")
        results = json.loads(self.text("results.json"))
        self.assertEqual([row["verdict"] for row in results["claims"]], ["holds", "fails"])
        self.assertEqual((results["claims"][1]["error"], results["verdict"]), ("nan", "fails"))
        self.assertEqual(json.loads(self.text("run.json"))["exit_code"], 3)
        self.assertIn("Incomplete: 1 row holds", self.text("study.html"))

    def test_child_that_fails_is_4_and_stops_no_other(self):
        """A run that is killed by the system, as when memory is exhausted."""
        path = self.folder / "tiny.json"
        path.write_text(json.dumps(TINY))
        process = subprocess.Popen([LATCON, "study", path, "--output-dir", self.out, "--skip-verification", "--threads", "1"],
                                   stdout=subprocess.PIPE, text=True)
        killed = None
        while killed is None and process.poll() is None:
            for child in children(process.pid):
                if any("low-1" in word for word in words_of(child)):
                    os.kill(child, signal.SIGKILL)
                    killed = child
            time.sleep(0.01)
        printed = process.communicate(timeout=300)[0]
        self.assertIsNotNone(killed)
        self.assertEqual(process.returncode, 4, printed)
        self.assertIn("failed", printed)
        states = {line["run"]: line["state"] for line in read_csv(self.out / "study.csv")}
        self.assertEqual(states, {"base": "measured", "low": "failed", "thin": "measured"})
        self.assertIn("low, seed 1", self.text("study.html"))

    def test_state_that_is_refused_is_reported(self):
        def change(document):
            document["runs"] = {"base": {"set": {"Loading/strain x": -0.3}}}
            document["claims"][0]["rows"] = [{"run": "base", "quantity": "pattern"}]
        self.assertIn("refused: verification", self.study(change=change, skip=False, expect=3))
        self.assertIn("refused: verification", self.text("study.csv"))
        (seed,) = json.loads(self.text("study.json"))["seeds"]
        self.assertIn("no crack was run", seed["problem"])

    def test_resume_repeats_nothing_and_gives_the_same_files(self):
        self.begin_with_the_end()
        before, first = self.times(), {name: self.text(name) for name in ("study.json", "study.csv", "results.json")}
        self.assertIn("0 runs, 4 are finished already", self.study("--resume"))
        self.assertEqual(self.times(), before)
        self.assertEqual({name: self.text(name) for name in first}, first)

        def change(document):  # claims are not a part of the runs
            document["claims"][0]["rows"][0]["above"] = 1000
        printed = self.study("--resume", change=change, expect=3)
        self.assertIn("0 runs, 4 are finished already", printed)
        self.assertIn("does not hold", printed)

        self.study()
        self.assertFalse([name for name, when in self.times().items() if when == before[name]])

    def test_resume_repeats_what_would_come_out_differently(self):
        self.begin_with_the_end()
        before = self.times()

        def change(document):
            document["runs"]["low"]["set"]["Sheet/height"] = "1.1 cm"
        info = self.out / "runs" / "thin-1" / "run.json"
        document = json.loads(info.read_text())
        info.write_text(json.dumps(dict(document, program_hash="0" * 64)))
        self.assertIn("2 runs, 2 are finished already", self.study("--resume", change=change))
        after = self.times()
        self.assertEqual([name for name in FOLDERS if after[name] != before[name]], ["low-1", "thin-1"])

    def test_edited_base_changes_no_run(self):
        base = self.folder / "base.prm"
        base.write_text((CASES / "quick.prm").read_text())

        document = copy.deepcopy(TINY)
        document["base"] = str(base)
        document["runs"] = {"base": {"seeds": [1, 2, 3]}}
        document["claims"][0]["rows"] = document["claims"][0]["rows"][:1]
        (self.folder / "tiny.json").write_text(json.dumps(document))
        process = subprocess.Popen([LATCON, "study", self.folder / "tiny.json", "--output-dir", self.out, "--quiet",
                                    "--skip-verification", "--threads", "1"])
        runs = self.out / "runs"
        deadline = time.time() + 600
        while not (runs.exists() and list(runs.iterdir())) and time.time() < deadline:
            time.sleep(0.01)
        base.write_text(base.read_text().replace("strain y = 1.8", "strain y = 1.4"))
        process.wait(120)
        cases = [(runs / f"base-{seed}" / "case.prm").read_text() for seed in (1, 2, 3)]
        self.assertEqual([re.search("set strain y *= (.*)", case).group(1) for case in cases], ["1.8"] * 3)
        for seed, case in zip((1, 2, 3), cases):
            self.assertEqual((self.out / "cases" / f"base-{seed}.prm").read_text(), case)

    def test_endless_file_is_refused(self):
        run = latcon("study", "/dev/zero", "--dry-run", timeout=30)
        self.assertEqual(run.returncode, 2)
        self.assertIn("larger than 16 MiB", run.stderr)

    def test_killed_and_resumed_is_as_if_never_stopped(self):
        def longer(document):
            document["set"]["Sheet/length"] = "3 cm"
            document["set"]["Time/end"] = "2 ms"
            document["runs"] = {"base": {"seeds": [1, 2]}}
            del document["claims"][0]["rows"][1]
        self.study(change=longer)
        whole = self.text("study.csv")
        for number, expected in ((signal.SIGTERM, 130), (signal.SIGKILL, -signal.SIGKILL)):
            subprocess.run(["rm", "-r", self.out], check=True)
            process = subprocess.Popen([LATCON, "study", self.folder / "tiny.json", "--output-dir", self.out, "--quiet",
                                        "--skip-verification", "--threads", "1"])
            runs = self.out / "runs"
            deadline = time.time() + 600
            while not (runs.exists() and any(p.suffix != ".part" for p in runs.iterdir())) and time.time() < deadline:
                time.sleep(0.01)
            # In the middle of the next crack.
            while not list(runs.glob("*.part/lattice-0000.vtp")) and time.time() < deadline:
                time.sleep(0.01)
            process.send_signal(number)
            self.assertEqual(process.wait(600), expected)
            time.sleep(0.5 if number == signal.SIGKILL else 0)
            begun = [path for path in runs.iterdir() if path.suffix == ".part"]
            self.assertTrue(begun)
            if number == signal.SIGTERM:
                self.assertIn("not run", self.text("study.csv"))
            printed = self.study("--resume", change=longer)
            self.assertNotIn("2 runs, 0 are", printed)
            self.assertEqual(self.text("study.csv"), whole)
            self.assertFalse([path for path in runs.iterdir() if path.suffix == ".part"])
            for path in begun:
                if (path.with_suffix("") / "checkpoints").exists():
                    self.assertIn("resumed_from", json.loads((path.with_suffix("") / "run.json").read_text()))
            if number == signal.SIGTERM:
                self.assertTrue([path for path in begun if (path.with_suffix("") / "checkpoints").exists()])

    def test_runs_fill_the_cores_and_keep_to_one_each(self):
        document = dict(TINY, runs={"base": {"seeds": [1, 2]}})
        document["claims"] = [dict(TINY["claims"][0], rows=TINY["claims"][0]["rows"][:1])]
        # Enough sites for a lattice to be worth several threads; claims are checked too.
        document["set"] = {**BOTH_NEIGHBOURS, "Sheet/length": "6 cm", "Sheet/height": "4 cm", "Time/end": "0.5 ms"}
        path = self.folder / "tiny.json"
        path.write_text(json.dumps(document))
        process = subprocess.Popen([LATCON, "study", path, "--output-dir", self.out, "--quiet", "--threads", "2"])
        most_at_once, times = 0, {}
        while process.poll() is None:
            runs = [child for child in children(process.pid) if "fracture" in words_of(child)]
            most_at_once = max(most_at_once, len(runs))
            for child in runs:
                times.setdefault(child, {}).update(seconds_of_threads(child))
            time.sleep(0.02)
        self.assertEqual(process.returncode, 3)  # not measured: a millisecond is too short for a speed
        self.assertEqual(most_at_once, 2)
        self.assertEqual(len(times), 2)
        for of_run in times.values():
            *others, busiest = sorted(of_run.values())
            # Idle threads of libraries wait for work briefly, 2^26 cycles in OpenBLAS, and then sleep.
            idle = 0.1
            self.assertLess(max(others, default=0.), idle)
            self.assertGreater(busiest, 3 * idle)

    def test_quick_study_verifies_the_base_case_once(self):
        # The row is not measured: no crack of the quick version runs far enough to have a speed.
        printed = self.study("--quick", skip=False, expect=3, page=True, change=lambda document: document.update({"set": BOTH_NEIGHBOURS}))
        self.assertRegex(printed, "claims: (checked now|verdicts of .*, reused)")
        document = json.loads(self.text("study.json"))
        self.assertTrue(document["quick"])
        self.assertEqual(document["left_out"], ["thin"])
        self.assertIn("base case alone", document["verification"])
        info = json.loads(self.text("runs/low-1/run.json"))
        self.assertTrue(info["skip_verification"])
        self.assertFalse(json.loads(self.text("run.json"))["skip_verification"])
        self.assertIn("base case alone", self.text("study.html"))

    def test_quick_study_of_a_refused_base_runs_nothing(self):
        def change(document):
            document["set"]["Loading/strain x"] = -0.3
        self.study("--quick", change=change, skip=False, expect=3)
        self.assertFalse((self.out / "runs").exists())

    def test_bad_input_is_2_and_writes_nothing(self):
        def unknown(document):
            document["runs"]["low"]["set"]["Sheet/hight"] = 1
        printed = self.study(change=unknown, expect=2)
        self.assertIn("tiny.json: runs/low/set/Sheet/hight: not an entry of a case; nearest: Sheet/height", printed)

        def out_of_range(document):
            document["runs"]["low"]["set"]["Sheet/height"] = "1 mm"
        self.assertIn("runs/low", self.study(change=out_of_range, expect=2))
        self.study("--set", "Sheet/hight=1", expect=2)
        self.study("--set", "Lattice/noise seed=1", expect=2)
        self.assertEqual(latcon("study", self.folder / "none.json", "--output-dir", self.out).returncode, 2)
        self.assertFalse(self.out.exists())

    def test_dry_run_lists_the_runs(self):
        printed = self.study("--dry-run")
        for name in FOLDERS:
            self.assertIn(name, printed)
        self.assertIn("4 runs", printed)
        self.assertFalse(self.out.exists())
        self.assertIn("fig1-15", latcon("study", "paper", "--dry-run").stdout)


if __name__ == "__main__":
    unittest.main(argv=[word for word in sys.argv if word != "--full"], verbosity=2)
