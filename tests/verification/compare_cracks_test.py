#!/usr/bin/python3
"""latcon compare of two cracks: differences in units of their uncertainty, entries that differ, distance of the paths.

Usage: compare_cracks_test.py PATH_OF_LATCON
"""
import json
import math
import pathlib
import shutil
import sys
import tempfile
import unittest

import numpy as np

sys.dont_write_bytecode = True
from program import TemporaryFolder, latcon, read_csv

RUN = ["fracture", "quick", "--skip-verification", "--no-report", "--quiet"]


class CompareCracks(TemporaryFolder):
    @classmethod
    def setUpClass(cls):
        cls.runs = tempfile.TemporaryDirectory()
        cls.one, cls.other = (pathlib.Path(cls.runs.name) / name for name in ("one", "other"))
        for folder, *entries in [(cls.one,), (cls.other, "--set", "Loading/strain y=1.9", "--set", "Lattice/noise seed=3")]:
            run = latcon(*RUN, "--output-dir", folder, *entries)
            assert run.returncode == 0, run.stderr

    @classmethod
    def tearDownClass(cls):
        cls.runs.cleanup()

    def compare(self, *arguments):
        run = latcon("compare", *arguments, "--no-report", "--output-dir", self.out)
        self.assertEqual(run.returncode, 0, run.stderr)
        return run.stdout, json.loads((self.out / "compare.json").read_text())

    def refused(self, *arguments):
        run = latcon("compare", *arguments)
        self.assertEqual((run.returncode, run.stdout), (2, ""), run.stderr)
        return run.stderr

    def test_quantities_are_those_of_the_runs(self):
        text, found = self.compare(self.one, self.other)
        rows = {row["name"]: row for row in found["quantities"]}
        table = {row["quantity"]: row for row in read_csv(self.out / "compare.csv")}
        self.assertEqual(list(rows), list(table))
        for file, names in [("crack.json", ["speed_lagrangian", "speed_laboratory", "bonds_broken"]),
                            ("near_tip.json", ["wedge_angle"])]:
            first, second = (json.loads((run / file).read_text()) for run in (self.one, self.other))
            for name in names:
                row = rows[name]
                self.assertEqual((row["first"], row["second"]), (first[name], second[name]))
                self.assertEqual(row["difference"], second[name] - first[name])
                self.assertEqual(float(table[name]["difference"]), row["difference"])
                if name == "bonds_broken":
                    self.assertIsNone(row["difference_over_uncertainty"])
                    self.assertEqual(table[name]["difference_over_uncertainty"], "")
                    continue
                combined = math.hypot(first[name + "_uncertainty"], second[name + "_uncertainty"])
                self.assertAlmostEqual(row["difference_over_uncertainty"], row["difference"] / combined, delta=1e-12)
        self.assertRegex(text, r"(?m)^speed_lagrangian  +\S+ ± \S+ m/s  +\S+ ± \S+ m/s  +\S+ m/s  +[+-]\d+\.\d$")
        self.assertRegex(text, r"(?m)^pattern ")

    def test_entries_that_differ_are_listed(self):
        text, found = self.compare(self.one, self.other)
        self.assertEqual(found["entries"],
                         [{"key": "Lattice/noise seed", "unit": "", "first": "1", "second": "3"},
                          {"key": "Loading/strain y", "unit": "1", "first": "1.8", "second": "1.9"}])
        self.assertRegex(text, r"(?m)^Loading/strain y +1\.8 +1\.9$")

    def test_distance_of_the_paths_is_numpys(self):
        _, found = self.compare(self.one, self.other)
        paths = [np.genfromtxt(run / "crack.csv", delimiter=",", names=True) for run in (self.one, self.other)]
        begin, end = max(path["X"][0] for path in paths), min(path["X"][-1] for path in paths)
        self.assertEqual((found["paths"]["X_begin"], found["paths"]["X_end"]), (begin, end))
        X = np.linspace(begin, end, 200001)
        apart = np.interp(X, paths[1]["X"], paths[1]["Y"]) - np.interp(X, paths[0]["X"], paths[0]["Y"])
        self.assertGreater(abs(apart).max(), 1e-4)
        self.assertAlmostEqual(found["paths"]["rms_distance"], np.sqrt((apart**2).mean()), delta=1e-4 * abs(apart).max())
        self.assertAlmostEqual(found["paths"]["largest_distance"], abs(apart).max(), delta=1e-3 * abs(apart).max())
        self.assertAlmostEqual(found["paths"]["largest_distance_over_d"], found["paths"]["largest_distance"] / 0.625e-3)

    def test_a_run_does_not_differ_from_itself(self):
        text, found = self.compare(self.one, self.one)
        self.assertEqual({row["difference"] for row in found["quantities"]}, {0.})
        self.assertEqual((found["entries"], found["paths"]["rms_distance"], found["paths"]["largest_distance"]), ([], 0., 0.))
        self.assertIn("The cases have the same entries.", text)
        self.assertEqual(json.loads((self.out / "run.json").read_text())["exit_code"], 0)

    def test_the_page_shows_both_runs(self):
        run = latcon("compare", self.one, self.other, "--output-dir", self.out)
        self.assertEqual((run.returncode, run.stderr), (0, ""))
        self.assertIn(f"{self.out}/compare.json, compare.csv, compare.html", run.stdout)
        found = json.loads((self.out / "compare.json").read_text())
        for side, folder in (("first", self.one), ("second", self.other)):
            self.assertEqual((self.out / found[f"{side}_folder"]).resolve(), folder.resolve())
        html = (self.out / "compare.html").read_text(encoding="utf-8")
        self.assertEqual(html.count('class="viewer"'), 2)
        self.assertIn("Loading/strain y", html)
        self.assertNotIn("failed its checks", html)
        shutil.rmtree(self.out)
        self.compare(self.one, self.other)
        self.assertFalse((self.out / "compare.html").exists())

    def test_the_page_says_which_run_failed_its_checks(self):
        failed = self.folder / "failed"
        shutil.copytree(self.one, failed)
        info = json.loads((failed / "run.json").read_text())
        info |= {"exit_code": 3, "failed_rows": {"fracture: energy imbalance over energy exchanged": "ledger"}}
        (failed / "run.json").write_text(json.dumps(info))
        latcon("compare", failed, self.other, "--output-dir", self.out)
        html = (self.out / "compare.html").read_text(encoding="utf-8")
        self.assertRegex(html, r'failed its checks</b>: [^<]*energy imbalance over energy exchanged \(ledger\)')
        self.assertEqual(html.count("failed its checks"), 1)

    def test_what_is_no_pair_of_cracks_is_refused(self):
        empty = self.folder / "empty"
        empty.mkdir()
        for pair in [(self.one, empty), (empty, self.one)]:
            self.assertRegex(self.refused(*pair), f"{empty} holds no crack.json.*give two output directories of cracks, or a lattice")
        self.assertIn("are for frames", self.refused(self.one, self.other, "--overlap"))
        self.assertIn("is one of the runs", self.refused(self.one, self.other, "--output-dir", self.other))
        damaged = self.folder / "damaged"
        shutil.copytree(self.one, damaged)
        (damaged / "crack.csv").write_text("t,X,Y\n0,1,2\n0,1\n")
        self.assertIn("damaged/crack.csv:3: damaged", self.refused(self.one, damaged))
        (damaged / "crack.json").write_text("{")
        self.assertIn("damaged: its crack was not measured", self.refused(self.one, damaged))
        (damaged / "case.prm").unlink()
        self.assertIn("damaged/case.prm: cannot read", self.refused(self.one, damaged))


if __name__ == "__main__":
    unittest.main()
