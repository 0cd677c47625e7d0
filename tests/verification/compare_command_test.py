#!/usr/bin/python3
"""latcon compare: its files against VTK's own interpolation, ranks, choice of frames, refusals.

Usage: compare_command_test.py PATH_OF_LATCON
"""
import json
import pathlib
import sys
import tempfile
import unittest

import numpy as np
import vtk
from vtk.util.numpy_support import numpy_to_vtk, vtk_to_numpy

sys.dont_write_bytecode = True
from program import CASES, TemporaryFolder, frames, latcon, latcon_on_ranks, read, read_csv

FIELDS = ["displacement", "deformation_gradient", "first_piola_stress", "cauchy_stress", "strain_energy_density"]
SHEET = ["--set", "Sheet/length=2 cm", "--set", "Sheet/height=1.5 cm", "--set", "Loading/strain y=0.3"]
SMALL = [*SHEET, "--set", "Loading/strain x=0.1"]
LOAD = "load: displacement of held sites on the edges, largest difference"
MOTION = ["--set", "Time/end=0.02 ms", "--set", "Output/frame interval=0"]


def sites_of(folder):
    return read(vtk.vtkXMLPolyDataReader(), folder / "difference_sites.vtp")


def values(data, name):
    return vtk_to_numpy(data.GetPointData().GetArray(name)).astype(float)


def found(folder):
    return {row["quantity"]: row for row in read_csv(folder / "results.csv")}


class Compare(TemporaryFolder):
    def test_impossible_size_of_an_array_is_2(self):
        frame = frames(self.lattice / "lattice.pvd")[-1][1]
        damaged = self.folder / "damaged.vtp"
        damaged.write_bytes(frame.read_bytes().replace(b'NumberOfComponents="4"', b'NumberOfComponents="-1"', 1))
        run = latcon("compare", damaged, self.continuum, "--output-dir", self.out)
        self.assertEqual(run.returncode, 2, run.stderr)
        self.assertIn("damaged.vtp: corrupt", run.stderr)
        self.assertFalse(self.out.exists())

    @classmethod
    def setUpClass(cls):
        cls.runs = tempfile.TemporaryDirectory()
        runs = pathlib.Path(cls.runs.name)
        cls.lattice, cls.continuum = runs / "lattice", runs / "continuum"
        # The continuum has free sides and the lattice has not, which produces a difference.
        for command, out, ranks, entries in [
                ("lattice", cls.lattice, 1, []), ("continuum", cls.continuum, 1, []),
                ("continuum", runs / "free", 1, ["--set", "Left edge/condition=free", "--set", "Right edge/condition=free"]),
                ("continuum", runs / "pieces", 2, []),
                ("lattice", runs / "lattice-moves", 1, ["--set", "Lattice/solution=motion", *MOTION]),
                ("continuum", runs / "continuum-moves", 1, ["--set", "Continuum/solution=motion", *MOTION])]:
            arguments = [command, CASES / "quick.prm", "--quiet", "--output-dir", out, *SMALL, *entries]
            run = latcon(*arguments) if ranks == 1 else latcon_on_ranks(ranks, *arguments)
            assert run.returncode == 0, run.stderr

    @classmethod
    def tearDownClass(cls):
        cls.runs.cleanup()

    def setUp(self):
        super().setUp()
        self.runs = pathlib.Path(self.runs.name)

    def compare(self, *arguments):
        return latcon("compare", *arguments, "--output-dir", self.out)

    def refused(self, parts, *arguments):
        run = self.compare(*arguments)
        self.assertEqual(run.returncode, 2, run.stderr)
        for part in parts:
            self.assertIn(part, run.stderr)

    # The sites of a periodic lattice stop half a spacing or a whole one short of its ends.
    def test_periodic_sheets_are_the_same_sheet(self):
        periodic = [word for side in ("Left", "Right") for word in ("--set", f"{side} edge/condition=periodic")]
        for command in ("lattice", "continuum"):
            run = latcon(command, CASES / "quick.prm", "--quiet", "--output-dir", self.folder / command, *SHEET, *periodic,
                         "--set", "Loading/strain x=0")
            self.assertEqual(run.returncode, 0, run.stderr)
        run = self.compare(self.folder / "lattice", self.folder / "continuum", "--tolerance", "displacement=1e-6")
        self.assertEqual(run.returncode, 0, run.stderr + run.stdout)
        self.assertEqual(found(self.out)["sites outside the finite element sheet"]["lattice"], "0")

    def test_equal_sheets_agree(self):
        tolerances = [word for name in FIELDS for word in ("--tolerance", f"{name}=1e-6")]
        for continuum in [self.continuum, self.runs / "pieces" / "continuum.pvd", self.continuum / "continuum_0001.vtu",
                          self.runs / "pieces" / "continuum_0001.pvtu"]:
            run = self.compare(self.lattice, continuum, *tolerances)
            self.assertEqual(run.returncode, 0, run.stderr + run.stdout)
            self.assertEqual(json.loads((self.out / "results.json").read_text())["verdict"], "holds")
        self.assertEqual(found(self.out)["sites outside the finite element sheet"]["lattice"], "0")
        record = json.loads((self.out / "run.json").read_text())
        self.assertEqual(record["lattice_frame"], str(self.lattice / "lattice-0001.vtp"))
        self.assertEqual(record["continuum_frame"], str(self.runs / "pieces" / "continuum_0001.pvtu"))
        self.assertFalse([path for path in self.out.iterdir() if path.suffix == ".part"])

    def test_sheets_under_other_loads_are_3(self):
        loaded = self.folder / "loaded"
        run = latcon("continuum", CASES / "quick.prm", "--quiet", "--output-dir", loaded,
                     *(word.replace("y=0.3", "y=0.301") for word in SMALL))
        self.assertEqual(run.returncode, 0, run.stderr)
        for folder, expect, verdict in [(self.continuum, 0, "holds"), (loaded, 3, "fails")]:
            self.assertEqual(self.compare(self.lattice, folder).returncode, expect)
            self.assertEqual(found(self.out)[LOAD]["verdict"], verdict)
        self.assertAlmostEqual(float(found(self.out)[LOAD]["error"]), 0.001 * 0.0075 / np.hypot(0.1 * 0.02, 0.301 * 0.0075), delta=3e-5)

    def test_difference_is_that_of_another_interpolation(self):
        run = self.compare(self.lattice, self.runs / "free")
        self.assertEqual(run.returncode, 3, run.stderr)  # free sides are another load
        self.assertEqual([(time, path.name) for time, path in frames(self.out / "difference.pvd")],
                         [(1., "difference_sites.vtp"), (1., "difference_continuum.vtu")])
        cells = read(vtk.vtkXMLUnstructuredGridReader(), frames(self.runs / "free" / "continuum.pvd")[-1][1])
        sites = read(vtk.vtkXMLPolyDataReader(), self.lattice / "lattice-0001.vtp")
        probe = vtk.vtkProbeFilter()
        probe.SetSourceData(cells)
        probe.SetInputData(sites)
        probe.Update()
        inside = values(probe.GetOutput(), "vtkValidPointMask") == 1
        self.assertGreater(inside.sum(), 0.9 * len(inside))
        out = sites_of(self.out)
        self.assertEqual(values(out, "outside").sum(), 0.)
        u = values(sites, "displacement")
        # The file's positions and fields have 24 bits.
        np.testing.assert_allclose(values(out, "displacement_continuum")[inside],
                                   values(probe.GetOutput(), "displacement")[inside], rtol=0., atol=5e-7 * abs(u).max())
        for name in FIELDS:
            np.testing.assert_array_equal(values(out, name), values(sites, name))
            np.testing.assert_array_equal(values(out, name + "_difference"),
                                          values(out, name) - values(out, name + "_continuum"))
        # Norms, computed independently.
        difference = values(out, "displacement_difference")[values(out, "held") == 0]
        row = found(self.out)["displacement, rms difference"]
        scale = max(float(row["lattice"]), float(row["continuum"]))
        self.assertGreater(float(row["error"]), 1e-2)
        self.assertAlmostEqual(float(row["error"]), np.sqrt((difference**2).sum(axis=1).mean()) / scale, delta=1e-12)
        chosen = (values(out, "held") == 0) & (values(out, "complete") == 1)
        difference = values(out, "cauchy_stress_difference")[chosen]
        row = found(self.out)["cauchy_stress, largest difference"]
        scale = max(float(row["lattice"]), float(row["continuum"]))
        self.assertAlmostEqual(float(row["error"]), np.sqrt((difference**2).sum(axis=1)).max() / scale, delta=1e-12)
        # The continuum is unchanged.
        copy = read(vtk.vtkXMLUnstructuredGridReader(), self.out / "difference_continuum.vtu")
        np.testing.assert_array_equal(values(copy, "displacement"), values(cells, "displacement"))

    def test_sites_in_excluded_circles_are_not_compared(self):
        run = self.compare(self.lattice, self.runs / "free", "--exclude", "1 cm,2 mm,3 mm", "--exclude", "0.002,-0.004,0.0015")
        self.assertEqual(run.returncode, 3, run.stderr)
        out = sites_of(self.out)
        X = vtk_to_numpy(out.GetPoints().GetData()).astype(float)
        circles = (np.hypot(X[:, 0] - 0.01, X[:, 1] - 0.002) < 0.003) | (np.hypot(X[:, 0] - 0.002, X[:, 1] + 0.004) < 0.0015)
        np.testing.assert_array_equal(values(out, "excluded") == 1, circles)
        rows = found(self.out)
        self.assertEqual(int(rows["sites in excluded circles"]["lattice"]), circles.sum())
        chosen = (values(out, "held") == 0) & ~circles
        self.assertEqual(int(rows["free sites inside"]["lattice"]), chosen.sum())
        difference = values(out, "displacement_difference")[chosen]
        row = rows["displacement, rms difference"]
        scale = max(float(row["lattice"]), float(row["continuum"]))
        self.assertAlmostEqual(float(row["error"]), np.sqrt((difference**2).sum(axis=1).mean()) / scale, delta=1e-12)
        self.refused(["cannot be compared"], self.lattice, self.continuum, "--exclude", "0,0,1 m")

    # One homogeneous deformation, also in the left half of the sheet.
    def test_a_part_of_the_sheet_is_compared_where_both_are(self):
        half = self.folder / "half"
        run = latcon("continuum", CASES / "quick.prm", "--quiet", "--output-dir", half, *(word.replace("=2 cm", "=1 cm") for word in SMALL))
        self.assertEqual(run.returncode, 0, run.stderr)
        self.refused(["not the same sheet"], self.lattice, half)
        run = self.compare(self.lattice, half, "--overlap", "--tolerance", "displacement=1e-6", "--tolerance",
                           "first_piola_stress=1e-6")
        self.assertEqual(run.returncode, 0, run.stderr + run.stdout)
        out = sites_of(self.out)
        X = vtk_to_numpy(out.GetPoints().GetData()).astype(float)
        np.testing.assert_array_equal(values(out, "outside") == 1, X[:, 0] > 0.01 + 1e-8)
        self.assertTrue(np.isnan(values(out, "displacement_difference")[X[:, 0] > 0.011, :2]).all())

    def test_ranks_leave_no_trace(self):
        self.assertEqual(self.compare(self.lattice, self.continuum).returncode, 0)
        names = ["difference.pvd", "difference_sites.vtp", "difference_continuum.vtu", "results.json", "results.csv"]
        one = {name: (self.out / name).read_bytes() for name in names}
        run = latcon_on_ranks(3, "compare", self.lattice, self.continuum, "--output-dir", self.folder / "ranks")
        self.assertEqual(run.returncode, 0, run.stderr)
        for name in names:
            self.assertEqual(one[name], (self.folder / "ranks" / name).read_bytes(), name)
        run = latcon_on_ranks(3, "compare", self.continuum, self.lattice, "--output-dir", self.folder / "none")
        self.assertEqual(run.returncode, 2)
        self.assertFalse((self.folder / "none").exists())

    def test_motions_end_at_the_same_time(self):
        lattice, continuum = self.runs / "lattice-moves", self.runs / "continuum-moves"
        run = self.compare(lattice, continuum)
        self.assertEqual(run.returncode, 0, run.stderr)
        self.assertAlmostEqual(frames(self.out / "difference.pvd")[0][0] / 2e-5, 1., delta=1e-9)
        self.assertIn("velocity, rms difference", found(self.out))
        self.assertEqual(self.compare(lattice, continuum, "--time", "0.02 ms").returncode, 0)
        self.assertEqual(self.compare(lattice, continuum, "--lattice-time", "0", "--continuum-time", "2e-5").returncode, 0)
        row = found(self.out)["time"]
        self.assertEqual((row["lattice"], float(row["continuum"])), ("0", 2e-5))
        self.refused(["no frame at 0.01", "the nearest are at 0, 2"], lattice, continuum, "--time", "10 ms")
        self.refused(["the times differ", "times of the lattice: 0, 2", "times of the continuum: 0, 2"], lattice,
                     continuum, "--continuum-time", "0")
        self.refused(["the lattice is in motion and the continuum in equilibrium"], lattice, self.continuum)

    def test_exchanged_components_fail_a_tolerance(self):
        cells = read(vtk.vtkXMLUnstructuredGridReader(), self.continuum / "continuum_0001.vtu")
        u = vtk_to_numpy(cells.GetPointData().GetArray("displacement"))
        u[:, :2] = u[:, 1::-1].copy()
        writer = vtk.vtkXMLUnstructuredGridWriter()
        writer.SetFileName(str(self.folder / "exchanged.vtu"))
        writer.SetInputData(cells)
        writer.Write()
        run = self.compare(self.lattice, self.folder / "exchanged.vtu", "--tolerance", "displacement=0.1")
        self.assertEqual(run.returncode, 3, run.stderr)
        row = found(self.out)["displacement, rms difference"]
        self.assertEqual((row["verdict"], row["tolerance"]), ("fails", "0.1"))

    def test_bad_input_touches_nothing(self):
        self.assertEqual(self.compare(self.lattice, self.continuum).returncode, 0)
        before = {path.name: path.read_bytes() for path in self.out.iterdir()}
        self.refused(["give the lattice first"], self.continuum, self.lattice)
        self.refused(["--tolerance speed=1", "displacement"], self.lattice, self.continuum, "--tolerance", "speed=1")
        self.refused(["larger than 0"], self.lattice, self.continuum, "--tolerance", "displacement=0")
        self.refused(["velocity"], self.lattice, self.continuum, "--tolerance", "velocity=1")
        self.refused(["--exclude 1,2: X,Y,R is wanted"], self.lattice, self.continuum, "--exclude", "1,2")
        self.refused(["--exclude 0,0,0: the radius"], self.lattice, self.continuum, "--exclude", "0,0,0")
        self.refused(["furlong"], self.lattice, self.continuum, "--exclude", "0,1 furlong,1")
        self.refused(["furlong"], self.lattice, self.continuum, "--time", "1 furlong")
        self.refused(["--time is for both"], self.lattice, self.continuum, "--time", "1", "--lattice-time", "1")
        self.refused(["--set"], self.lattice, self.continuum, "--set", "Sheet/length=1")
        (self.folder / "text.vtu").write_text("text")
        self.refused(["text.vtu"], self.lattice, self.folder / "text.vtu")
        (self.runs / "pieces" / "continuum_0000.1.vtu").unlink()
        self.refused(["continuum_0000"], self.lattice, self.runs / "pieces", "--time", "0")
        self.assertEqual(before, {path.name: path.read_bytes() for path in self.out.iterdir()})

    def test_a_run_is_not_overwritten(self):
        before = (self.lattice / "run.json").read_bytes()
        run = latcon("compare", self.lattice, self.continuum, "--output-dir", self.lattice)
        self.assertEqual(run.returncode, 2)
        self.assertEqual(before, (self.lattice / "run.json").read_bytes())

    def test_dry_run_writes_nothing(self):
        run = self.compare(self.lattice, self.continuum, "--dry-run")
        self.assertEqual(run.returncode, 0, run.stderr)
        self.assertIn("lattice-0001.vtp", run.stdout)
        self.assertFalse(self.out.exists())

    def test_unwritable_place_is_5(self):
        (self.folder / "file").write_text("in the way")
        run = latcon("compare", self.lattice, self.continuum, "--output-dir", self.folder / "file" / "out")
        self.assertEqual(run.returncode, 5, run.stderr)


if __name__ == "__main__":
    unittest.main(verbosity=2)
