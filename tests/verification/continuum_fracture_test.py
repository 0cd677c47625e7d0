#!/usr/bin/python3
"""Tests of `latcon fracture --side continuum` on a sheet that takes seconds: its files, its ledger of energies, stops and
resumes, input that it refuses, and the comparison with the lattice.

Usage: continuum_fracture_test.py PATH_OF_LATCON
"""
import csv
import json
import os
import signal
import subprocess
import sys
import time
import unittest

from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkIOXML import vtkXMLPolyDataReader

sys.dont_write_bytecode = True
from program import CASES, LATCON, TemporaryFolder, frames, latcon, latcon_on_ranks, read, read_csv

# Crosses the sheet in 40 to 80 steps. Frames and checkpoints every few.
SHEET = {"Sheet/spacing": "1 mm", "Sheet/length": "30 mm", "Sheet/height": "16 mm", "Damage/length": "0.5 mm",
         "Damage/cells per length": 1, "Damage/threshold energy": "3.2 MPa", "Nearest neighbours/viscosity": "10 Pa s",
         "Next-nearest neighbours/viscosity": "30 Pa s", "Fracture/seed sites": 8, "Time/end": "3 ms", "Fracture/stop position": 0.8,
         "Output/frame interval": "0.3 ms", "Output/energy interval": 10, "Checkpoints/steps": 5}
BAD_INPUT, SOLVER_FAILED, OUTPUT_FAILED, INTERRUPTED = 2, 4, 5, 130


def command(folder, *more, entries=None, side="continuum"):
    sets = [word for key, value in {**SHEET, **(entries or {})}.items() for word in ("--set", f"{key}={value}")]
    return ["fracture", str(CASES / "quick.prm"), "--side", side, "--skip-verification", *sets, "--output-dir", str(folder), *more]


def files(folder):
    return {path.name: path.read_bytes() for path in folder.iterdir()
            if path.is_file() and path.name not in ("run.json", "log.txt", "report.html") and path.suffix != ".png"}


class ContinuumFracture(TemporaryFolder):
    def run_to_end(self, *more, **keywords):
        run = latcon(*command(self.out, *more, **keywords))
        self.assertEqual(run.returncode, 0, run.stderr)
        return run

    def test_files(self):
        self.run_to_end()
        crack = json.loads((self.out / "crack.json").read_text())
        self.assertEqual(crack["side"], "continuum")
        self.assertTrue(crack["skip_verification"])
        self.assertGreater(crack["speed_lagrangian"], 1.0)
        tip = read_csv(self.out / "crack.csv")
        self.assertGreaterEqual(float(tip[-1]["X"]), 0.8 * 30e-3)
        edges = read_csv(self.out / "crack_edges.csv")
        self.assertTrue(all(float(row["lower"]) < float(row["upper"]) for row in edges))
        # Every energy is in the table: their sum is that of the start.
        sums = [sum(float(row[name]) for name in ("elastic", "kinetic", "viscous", "broken", "shed", "imbalance"))
                for row in read_csv(self.out / "energy.csv")]
        for total in sums:
            self.assertAlmostEqual(total / sums[0], 1.0, delta=1e-12)
        # Long steps for so fast a crack; the tolerance is that of its speed (theory-damage.md, eq. (C.83)).
        row = [row for row in read_csv(self.out / "results.csv") if row["quantity"] == "energy imbalance over energy exchanged"][0]
        self.assertEqual(float(row["error"]), crack["energy_imbalance"])
        self.assertEqual(row["verdict"], "holds")
        energy = [{name: float(value) for name, value in row.items()} for row in read_csv(self.out / "energy.csv")]
        spent = energy[-1]["broken"] + energy[-1]["viscous"] + energy[-1]["shed"]
        self.assertAlmostEqual(crack["energy_imbalance"], max(abs(row["imbalance"]) for row in energy) / spent, delta=1e-12)
        shown = frames(self.out / "continuum.pvd")
        self.assertGreater(len(shown), 3)
        for when, path in (shown[0], shown[-1]):
            sheet = read(vtkXMLPolyDataReader(), path)
            self.assertEqual(sheet.GetFieldData().GetArray("TimeValue").GetValue(0), when)
            damage = vtk_to_numpy(sheet.GetPointData().GetArray("damage"))
            self.assertEqual((damage.min(), damage.max()), (0.0, 1.0))
            for name in ("displacement", "velocity", "strain_energy_density"):
                self.assertIsNotNone(sheet.GetPointData().GetArray(name), name)
            # Held corners are where the loading of quick.prm puts them.
            corner = vtk_to_numpy(sheet.GetPointData().GetArray("displacement"))[-1]
            self.assertAlmostEqual(corner[0] / (1.3 * sheet.GetBounds()[1]), 1.0, delta=1e-6)
            self.assertAlmostEqual(corner[1] / (1.8 * sheet.GetBounds()[3]), 1.0, delta=1e-6)
        page = (self.out / "report.html").read_text()
        self.assertIn("Crack of the continuum", page)
        for picture in ("damage.png", "crack_edges.png", "crack_path.png", "energy.png"):
            self.assertTrue((self.out / picture).exists(), picture)

    def test_stop_and_resume(self):
        self.run_to_end("--no-report", "--threads", "2")
        expected = files(self.out)
        self.out = self.folder / "stopped"
        with subprocess.Popen([LATCON, *command(self.out, "--no-report")], stdout=subprocess.DEVNULL,
                              stderr=subprocess.DEVNULL) as run:
            while not list(self.out.glob("checkpoints/*.h5")):
                self.assertIsNone(run.poll(), "it ended too soon")
                time.sleep(0.002)
            os.kill(run.pid, signal.SIGTERM)
            self.assertEqual(run.wait(timeout=600), INTERRUPTED)
        self.assertNotEqual(files(self.out)["crack.csv"], expected["crack.csv"])
        self.assertIn("step", self.run_to_end("--no-report", "--resume", "--threads", "1").stdout)
        found = files(self.out)
        self.assertEqual(sorted(found), sorted(expected))
        for name, content in expected.items():
            self.assertEqual(found[name] == content, True, name)

    def test_checkpoint_of_the_other_side_is_refused(self):
        self.run_to_end("--no-report", side="lattice")
        run = latcon(*command(self.out, "--resume"))
        self.assertEqual(run.returncode, BAD_INPUT)
        self.assertIn("fracture --side continuum", run.stderr)

    def test_resume_without_a_checkpoint_keeps_no_files_of_the_other_side(self):
        self.run_to_end("--no-report", side="lattice", entries={"Checkpoints/steps": 0, "Checkpoints/interval": 0})
        self.assertTrue((self.out / "lattice.pvd").exists())
        self.run_to_end("--no-report", "--resume")
        self.assertFalse((self.out / "lattice.pvd").exists())
        self.assertTrue((self.out / "earlier-run" / "lattice.pvd").exists())

    def test_bad_input(self):
        for entries, message in (({"Continuum/law": "mooney-rivlin"}, "Continuum/law"),
                                 ({"Continuum/gradient": "network"}, "Continuum/gradient"),
                                 ({"Fracture/left end": "free"}, "Fracture/left end"),
                                 ({"Disorder/strength": "uniform"}, "Disorder/strength"),
                                 ({"Nearest neighbours/branch moduli": "0.1 MPa",
                                   "Nearest neighbours/relaxation times": "1 s"}, "Nearest neighbours/branch moduli"),
                                 ({"Third-nearest neighbours/present": "true",
                                   "Third-nearest neighbours/branch moduli": "0.1 MPa",
                                   "Third-nearest neighbours/relaxation times": "1 s"}, "Third-nearest neighbours/branch moduli"),
                                 ({"Third-nearest neighbours/present": "true", "Third-nearest neighbours/law": "expression",
                                   "Third-nearest neighbours/psi": "a*(lam-1)^2"}, "Third-nearest neighbours/law"),
                                 ({"Body force/force y": "1"}, "Body force/force y"),
                                 ({"Initial state/velocity x": "1"}, "Initial state/velocity x"),
                                 ({"Initial state/base": "undeformed"}, "Initial state/base"),
                                 ({"Continuum/time step": "1 s"}, "Continuum/time step"),
                                 ({"Continuum/gradient": "lattice", "Continuum/inertia length": "100 m"}, "Continuum/inertia length"),
                                 ({"Damage/threshold energy": "1 MPa"}, "would be damaged everywhere"),
                                 ({"Damage/length": "3 mm"}, "Damage/length"),
                                 ({"Damage/cells per length": 0}, "Damage/cells per length"),
                                 ({"Sheet/hole radius": "2 mm"}, "Sheet/hole radius"),
                                 ({"Fracture/breaking stretch": "auto"}, "Fracture/breaking stretch")):
            with self.subTest(entries):
                run = latcon(*command(self.out, entries=entries))
                self.assertEqual(run.returncode, BAD_INPUT, run.stderr)
                self.assertIn(message, run.stderr)
                self.assertFalse(self.out.exists())
        self.assertEqual(latcon(*command(self.out), "--side", "both").returncode, BAD_INPUT)

    def test_threshold_is_compared_with_the_energy_of_the_law(self):
        # A lattice of nearest neighbours alone stores more at these strains than its network, 0.717 MPa.
        nearest = {"Next-nearest neighbours/present": "false", "Loading/strain x": 0.2, "Loading/strain y": 2.2,
                   "Damage/threshold energy": "0.7205 MPa"}
        for law, code in (("cauchy-born", BAD_INPUT), ("mooney-rivlin-network", 0)):
            run = latcon(*command(self.out, "--dry-run", entries={**nearest, "Continuum/law": law}))
            self.assertEqual(run.returncode, code, run.stderr)

    def test_three_ranks_leave_the_files_of_one(self):
        entries = {"Continuum/gradient": "lattice", "Fracture/stop position": 0.5}
        self.run_to_end("--no-report", entries=entries)
        expected = files(self.out)
        self.out = self.folder / "ranks"
        run = latcon_on_ranks(3, *command(self.out, "--no-report", "--threads", "1", entries=entries))
        self.assertEqual(run.returncode, 0, run.stderr)
        self.assertEqual(files(self.out), expected)
        # From the older of the two checkpoints, on another number of ranks.
        max((self.out / "checkpoints").iterdir()).unlink()
        run = latcon_on_ranks(2, *command(self.out, "--no-report", "--threads", "1", "--resume", entries=entries))
        self.assertEqual(run.returncode, 0, run.stderr)
        self.assertIn("checkpoint", run.stdout)
        self.assertEqual(files(self.out), expected)

    def test_crack_that_fails_leaves_its_last_valid_state(self):
        entries = {"Nearest neighbours/viscosity": "1 Pa s", "Next-nearest neighbours/viscosity": "1 Pa s"}
        run = latcon(*command(self.out, "--no-report", entries=entries))
        self.assertEqual(run.returncode, SOLVER_FAILED, run.stderr)
        self.assertIn("a cell that is not broken is inverted", run.stderr)
        shown = frames(self.out / "continuum.pvd")
        self.assertGreater(shown[-1][0], 0.0)
        self.assertEqual(shown[-1][0], json.loads((self.out / "crack.json").read_text())["end_time"])
        self.assertEqual(json.loads((self.out / "run.json").read_text())["exit_code"], SOLVER_FAILED)
        expected, message = files(self.out), run.stderr.split("latcon: ")[-1]
        self.out = self.folder / "ranks"
        run = latcon_on_ranks(2, *command(self.out, "--no-report", "--threads", "1", entries=entries))
        self.assertEqual(run.returncode, SOLVER_FAILED, run.stderr)
        self.assertIn(message.strip(), run.stderr)
        self.assertEqual(files(self.out), expected)

    def test_table_that_cannot_be_written(self):
        (self.out / "crack_edges.csv").mkdir(parents=True)
        self.assertEqual(latcon(*command(self.out, "--no-report")).returncode, OUTPUT_FAILED)

    def test_dry_run(self):
        run = latcon(*command(self.out, "--dry-run"))
        self.assertEqual(run.returncode, 0, run.stderr)
        self.assertIn("# damage: length 0.0005 m, threshold 3.2e+06 J/m^3", run.stdout)
        self.assertFalse(self.out.exists())

    def test_comparison_with_the_lattice(self):
        self.run_to_end("--no-report")
        lattice = self.folder / "lattice"
        self.assertEqual(latcon(*command(lattice, "--no-report", side="lattice")).returncode, 0)
        run = latcon("compare", lattice, self.out, "--output-dir", self.folder / "both", "--no-report")
        self.assertEqual(run.returncode, 0, run.stderr)
        with open(self.folder / "both" / "compare.csv", newline="") as table:
            speeds = [row for row in csv.reader(table) if row and row[0] == "speed_lagrangian"]
        self.assertEqual(len(speeds), 1)
        compared = json.loads((self.folder / "both" / "compare.json").read_text())
        self.assertEqual(compared["side"], {"first": "lattice", "second": "continuum"})
        for sheets in ((self.out / "continuum.pvd", lattice / "lattice.pvd"), (lattice / "lattice.pvd", self.out / "continuum.pvd")):
            frame = latcon("compare", *sheets, "--output-dir", self.folder / "frames")
            self.assertEqual(frame.returncode, BAD_INPUT)
            self.assertIn("cannot be compared site by site", frame.stderr)

    def test_step_four_times_too_long_fails_by_its_ledger(self):
        steps = {}
        for times in (4, 1):
            folder = self.folder / str(times)
            entries = {"Sheet/length": "3 cm", "Sheet/height": "1.5 cm", "Time/end": "1 ms", "Continuum/time step": 1.26936e-6 * times,
                       "Output/energy interval": 5}
            run = latcon("fracture", CASES / "quick.prm", "--side", "continuum", "--skip-verification", "--no-report", "--output-dir", folder,
                         *[word for key, value in entries.items() for word in ("--set", f"{key}={value}")])
            self.assertEqual(run.returncode, 3 if times == 4 else 0, run.stderr)
            steps[times] = [float(row["tolerance"]) for row in read_csv(folder / "results.csv") if "imbalance" in row["quantity"]]
        self.assertAlmostEqual(steps[4][0] / steps[1][0], 1.0, delta=0.05)  # is that of the automatic step

    def test_study_of_both_sides(self):
        entries = {key: value for key, value in SHEET.items() if not key.startswith(("Output/frame", "Checkpoints"))}
        document = {"title": "Both sides", "base": str(CASES / "quick.prm"), "set": entries, "side": "continuum",
                    "runs": {"damage": {}, "bonds": {"side": "lattice"}},
                    "claims": [{"claim": "It runs", "rows": [{"runs": ["damage", "bonds"], "quantity": "speed_lagrangian", "above": 1}]}]}
        path = self.folder / "both.json"

        def study(*more):
            path.write_text(json.dumps(document))
            run = latcon("study", path, "--skip-verification", "--output-dir", self.out, *more)
            self.assertEqual(run.returncode, 0, run.stdout + run.stderr)
            return run.stdout

        def sides():
            cracks = [json.loads((self.out / "runs" / f"{name}-1" / "crack.json").read_text()) for name in ("damage", "bonds")]
            return [crack.get("side", "lattice") for crack in cracks]
        study()
        self.assertEqual(sides(), ["continuum", "lattice"])
        self.assertIn("0 runs, 2 are finished already", study("--resume"))
        # A crack of the other side is not the run that is asked for.
        document["runs"]["damage"]["side"] = "lattice"
        self.assertIn("1 runs, 1 are finished already", study("--resume"))
        self.assertEqual(sides(), ["lattice", "lattice"])
        document["runs"] = {"damage": {}, "bonds": {}}
        self.assertIn("2 runs, 0 are finished already", study("--resume"))
        self.assertEqual(sides(), ["continuum", "continuum"])


if __name__ == "__main__":
    unittest.main(verbosity=2)
