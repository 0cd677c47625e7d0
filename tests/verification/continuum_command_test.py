#!/usr/bin/python3
"""Tests of finite element cases from the command line: closed forms, files, refusals, motion, meshes from Gmsh.

Usage: continuum_command_test.py PATH_OF_LATCON
"""
import json
import math
import pathlib
import sys
import tempfile
import unittest

import numpy as np
import vtk
from vtk.util.numpy_support import vtk_to_numpy

sys.dont_write_bytecode = True
from program import CASES, TemporaryFolder, frames, latcon, latcon_on_ranks, read, read_csv

LAYER, HOLE = CASES / "shear_layer.prm", CASES / "hole.prm"
# Constants of both cases. Two shells with s = 2/3 and a + b = 0.25 MPa have the small-strain modulus of theory.md.
SPACING = 0.625e-3  # [m]
DENSITY = 944.  # [kg/m^3]
MODULUS = 2. / 3. * 9. / 8. * (1. + math.sqrt(3.)) * 0.25e6  # [Pa]
TOP_FORCE = "force on the top edge per thickness, x"


def settings(*entries):
    return [word for entry in entries for word in ("--set", entry)]


def results(folder):
    return {row["quantity"]: float(row["continuum"]) for row in read_csv(folder / "results.csv")}


def numbers(path):
    """Columns of a table; checks that all cells are finite numbers."""
    rows = read_csv(path)
    columns = {name: np.array([float(row[name]) for row in rows]) for name in rows[0]}
    assert all(np.isfinite(column).all() for column in columns.values()), path
    return columns


def last_mesh(folder):
    return read(vtk.vtkXMLUnstructuredGridReader(), frames(folder / "continuum.pvd")[-1][1])


def field(mesh, name):
    """Values at the points; tensors as (point, row, column) of the plane."""
    values = vtk_to_numpy(mesh.GetPointData().GetArray(name)).astype(float)
    return values.reshape(-1, 3, 3)[:, :2, :2] if values.ndim == 2 and values.shape[1] == 9 else values


def points_of(mesh):
    return vtk_to_numpy(mesh.GetPoints().GetData())[:, :2].astype(float)


def cells_of(mesh):
    """Middle and area of every cell, whose first four points are its corners."""
    points = points_of(mesh)
    corners = np.array([[points[mesh.GetCell(i).GetPointId(k)] for k in range(4)]
                        for i in range(mesh.GetNumberOfCells())])
    one, two = corners[:, 2] - corners[:, 0], corners[:, 3] - corners[:, 1]
    return corners.mean(axis=1), 0.5 * abs(one[:, 0] * two[:, 1] - one[:, 1] * two[:, 0])


def stiffening(ratio):
    """Shear force of a clamped layer over that of the local law, for l = ratio H (theory-continuum.md, eq. (C.35))."""
    return 1. / (1. - 2. * ratio * math.tanh(0.5 / ratio))


class ShearLayer(TemporaryFolder):
    """Shear A (1 - cosh(Y/l) / cosh(H/2l)) about the middle, of mean 1, and traction mu A."""

    def sheared(self, *entries):
        """Length and height of the sheet, results, points and displacement."""
        run = latcon("continuum", LAYER, "--output-dir", self.out, "--quiet", *settings(*entries))
        self.assertEqual(run.returncode, 0, run.stderr)
        mesh = last_mesh(self.out)
        points = points_of(mesh)
        # Whole rows of the lattice; the file has seven digits.
        pitch = np.array([0.5 * SPACING, 0.5 * math.sqrt(3.) * SPACING])
        extent = np.round(np.ptp(points, axis=0) / pitch) * pitch
        np.testing.assert_allclose(np.ptp(points, axis=0), extent, rtol=1e-6)
        return *extent, results(self.out), points, field(mesh, "displacement")

    def force(self, *entries):
        """Over that of the local law."""
        length, _, found, *_ = self.sheared(*entries)
        return found[TOP_FORCE] / (MODULUS * length)

    def test_converges_to_the_closed_form(self):
        l = 4e-3
        errors = []
        for cells in (8, 16):
            length, height, found, points, u = self.sheared(f"Continuum/cells y={cells}")
            A = stiffening(l / height)
            force = MODULUS * A * length
            Y = points[:, 1] - points[:, 1].min() - 0.5 * height
            profile = A * (Y - l * np.sinh(Y / l) / math.cosh(0.5 * height / l))
            difference = u[:, 0] - profile
            errors.append([abs(found[TOP_FORCE] / force - 1.),
                           abs(found["elastic energy per thickness"] / (0.5 * force * height) - 1.),
                           np.ptp(difference) / height])
            self.assertLess(abs(u[:, 1]).max(), 1e-10 * height)
        # Energies of interior penalty elements have the order 2 (p - 1) = 4 and displacements p + 1 = 4. Measured on 16
        # cells: 2.7e-6, 2.7e-6, 7.6e-6 with the orders 3.88, 3.88, 3.77.
        for coarse, fine in zip(*errors):
            self.assertLess(fine, 1.5e-5)
            self.assertGreater(math.log2(coarse / fine), 3.5)

    def test_stiffening_by_size(self):
        _, height, *_ = self.sheared()
        for ratio in (0.05, 0.1, 0.2):
            # Measured: 7.7e-6, 1.2e-6, 1.9e-7; in the first, the boundary layer is 1.6 cells thick.
            force = self.force(f"Continuum/static length={ratio * height!r}", "Continuum/cells y=32")
            self.assertLess(abs(force / stiffening(ratio) - 1.), 1.5e-5, ratio)

    def test_local_law_is_the_limit(self):
        free = ["Bottom edge/normal gradient=free", "Top edge/normal gradient=free"]
        # Linear elements hold a uniform shear exactly; Newton stops at 1e-10.
        self.assertAlmostEqual(self.force("Continuum/gradient=none", "Continuum/degree=1", *free), 1., delta=1e-9)
        # Without clamping there is no boundary layer for any length.
        self.assertAlmostEqual(self.force(*free), 1., delta=1e-9)
        # At most the stiffening 2 l/H due to a layer that the mesh does not resolve.
        self.assertAlmostEqual(self.force("Continuum/static length=1e-6"), 1., delta=2e-6 / 0.0194)
        self.assertAlmostEqual(self.force("Continuum/static length=0", *free), 1., delta=1e-9)


def mean_rod(F, a, b):
    """Mean over directions of energy and first Piola stress [Pa] of rods a (l - l^-2) + b (1 - l^-3)."""
    angle = np.pi * np.arange(64) / 64  # exact to rounding for stretches of 2.3 and 2.8
    N = np.array([np.cos(angle), np.sin(angle)])
    f = F @ N
    l = np.hypot(*f)
    energy = a * (l**2 / 2 + 1 / l - 1.5) + b * (l + 0.5 / l**2 - 1.5)
    force = a * (l - l**-2) + b * (1 - l**-3)
    return energy.mean(), np.einsum("n,in,jn->ij", force / l, f, N) / angle.size


class NetworkLaw(TemporaryFolder):
    """The homogeneous sheet of quick.prm in the Mooney-Rivlin law of the network, with its gradient energy."""

    def test_is_the_mean_of_the_bonds_and_close_to_the_lattice(self):
        found = {}
        for law, gradient in (("mooney-rivlin-network", "network"), ("cauchy-born", "lattice")):
            out = self.folder / law
            run = latcon("continuum", CASES / "quick.prm", "--output-dir", out, "--quiet",
                         *settings("Sheet/length=2 cm", "Sheet/height=1.5 cm", f"Continuum/law={law}",
                                   f"Continuum/gradient={gradient}", "Continuum/cells x=3", "Continuum/cells y=2"))
            self.assertEqual(run.returncode, 0, run.stderr)
            found[law] = results(out)
        extent = np.ptp(points_of(last_mesh(out)), axis=0)
        energy, P = mean_rod(np.diag([2.3, 2.8]), 1e5, 1.5e5)
        weight = 3. * (0.72 + math.sqrt(3.) * 0.81)  # A0 l / V of the six bonds of a site
        network, lattice = found["mooney-rivlin-network"], found["cauchy-born"]
        # Newton stops at 1e-10; the file with the points has seven digits.
        names = ["elastic energy per thickness", "force on the right edge per thickness, x",
                 "force on the top edge per thickness, y"]
        expected = weight * np.array([energy * extent.prod(), P[0, 0] * extent[1], P[1, 1] * extent[0]])
        np.testing.assert_allclose([network[name] for name in names], expected, rtol=2e-6)
        # The sixfold anisotropy that the law neglects (theory-comparison.md, after eq. (H.13)).
        np.testing.assert_allclose(network[names[0]], lattice[names[0]], rtol=1e-6)
        np.testing.assert_allclose([network[name] for name in names[1:]], [lattice[name] for name in names[1:]], rtol=1e-4)


class Hole(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = tempfile.TemporaryDirectory()
        cls.out = pathlib.Path(cls.folder.name) / "out"
        cls.run_ = latcon("continuum", HOLE, "--output-dir", cls.out)

    @classmethod
    def tearDownClass(cls):
        cls.folder.cleanup()

    def test_ends_well_with_every_file(self):
        self.assertEqual(self.run_.returncode, 0, self.run_.stderr)
        names = {path.name for path in self.out.iterdir()}
        self.assertLessEqual({"case.prm", "run.json", "results.json", "results.csv", "energy.csv", "reactions.csv",
                              "newton.csv", "meshes.csv", "continuum.pvd"}, names)
        self.assertFalse([name for name in names if name.endswith(".part")])
        self.assertIn("cycle 8", self.run_.stdout)

    def test_reactions_settle_as_the_mesh_grows(self):
        meshes = numbers(self.out / "meshes.csv")
        self.assertEqual(len(meshes["cells"]), 9)
        self.assertTrue((np.diff(meshes["cells"]) > 0).all())
        self.assertTrue((np.diff(meshes["unknowns"]) > 0).all())
        largest = meshes["top_y"]  # equal to the bottom except for sign and round-off
        change = abs(np.diff(largest)) / largest[1:]
        self.assertLess(change[-1], 1e-5)
        # Once a mesh resolves the rim, the changes decrease by an order of magnitude or more.
        self.assertLess(change[-1], 0.1 * change.max())
        row = read_csv(self.out / "results.csv")[-1]
        # Newton stops at 1e-10 of the reactions.
        self.assertAlmostEqual(float(row["error"]), change[-1], delta=1e-9)
        self.assertEqual(row["verdict"], "holds")
        self.assertAlmostEqual(float(row["continuum"]) / largest[-1], 1., delta=1e-9)

    def test_tables_tell_one_story(self):
        meshes, newton = numbers(self.out / "meshes.csv"), numbers(self.out / "newton.csv")
        reactions, energy = numbers(self.out / "reactions.csv"), numbers(self.out / "energy.csv")
        self.assertEqual(list(energy), ["load_factor", "elastic"])
        self.assertEqual((reactions["load_factor"][-1], energy["load_factor"][-1]), (1., 1.))
        # The row at full load is that of the last mesh.
        self.assertEqual(energy["elastic"][-1], meshes["elastic"][-1])
        self.assertEqual(reactions["top_y"][-1], meshes["top_y"][-1])
        self.assertEqual(results(self.out)["elastic energy per thickness"], meshes["elastic"][-1])
        for axis in "xy":
            sides = [meshes[f"{edge}_{axis}"] for edge in ("bottom", "top")]
            # Newton stops at 1e-10 of the reactions.
            self.assertLess(abs(sum(sides)).max(), 1e-9 * meshes["top_y"][0])
        ends = np.append(newton["iteration"][1:] == 0, True)
        self.assertEqual(ends.sum(), 9)
        self.assertEqual(newton["mesh"][ends].tolist(), list(range(9)))
        self.assertTrue((newton["residual"][ends] <= newton["tolerance"][ends]).all())

    def test_fields_open_outside_latcon(self):
        mesh = last_mesh(self.out)
        self.assertEqual(mesh.GetFieldData().GetArray("TimeValue").GetValue(0), 1.)
        points = mesh.GetPointData()
        components = {points.GetArrayName(i): points.GetArray(i).GetNumberOfComponents()
                      for i in range(points.GetNumberOfArrays())}
        tensors = ["deformation_gradient", "first_piola_stress", "cauchy_stress", "strain_gradient_x",
                   "strain_gradient_y", "double_stress_x", "double_stress_y"]
        self.assertEqual(components, {"displacement": 3, "strain_energy_density": 1, **dict.fromkeys(tensors, 9)})
        F, P, sigma, Gx, Gy, Qx, Qy = (field(mesh, name) for name in (
            "deformation_gradient", "first_piola_stress", "cauchy_stress", "strain_gradient_x", "strain_gradient_y",
            "double_stress_x", "double_stress_y"))
        # Fields are stored in single precision.
        pushed = np.einsum("piJ,pjJ->pij", P, F) / np.linalg.det(F)[:, None, None]
        self.assertLess(abs(pushed - sigma).max(), 1e-5 * abs(sigma).max())
        for G in (Gx, Gy, Qx, Qy):
            self.assertGreater(abs(G).max(), 0.)
            self.assertLess(abs(G - G.transpose(0, 2, 1)).max(), 1e-5 * abs(G).max())
        self.assertGreater(field(mesh, "strain_energy_density").min(), 0.)

    def test_cells_are_small_at_the_rim(self):
        mesh = last_mesh(self.out)
        middle, area = cells_of(mesh)
        points = points_of(mesh)
        distance = np.linalg.norm(middle - 0.5 * (points.min(axis=0) + points.max(axis=0)), axis=1) - 5e-3
        self.assertGreater(distance.min(), 0.)
        # Within a radius of the rim, where stress concentrates, cells are at most twice as wide as the smallest of all,
        # which lie there or at the corners, and far from both they are large.
        at_rim = distance < 5e-3
        self.assertLess(area[at_rim].min(), 4.1 * area.min())
        self.assertGreater(area.max(), 16. * area[at_rim].min())
        self.assertGreater(distance[area > 0.5 * area.max()].min(), 5e-3)

    def test_reaction_that_does_not_settle_is_3(self):
        out = self.out.parent / "absurd"
        run = latcon("continuum", HOLE, "--output-dir", out,
                     *settings("Continuum/adaptive cycles=1", "Continuum/reaction tolerance=1e-12"))
        self.assertEqual(run.returncode, 3, run.stderr)
        self.assertIn("fails", run.stdout)
        self.assertEqual(json.loads((out / "run.json").read_text())["exit_code"], 3)

    # Strains of Fig. 1: the sheet around the hole is stretched by 2.3 and 2.8, its rim compressed across.
    FIG1 = ("Loading/strain x=1.3", "Loading/strain y=1.8")

    def test_large_strain_is_carried_with_gradient_energy(self):
        for law, gradient in (("cauchy-born", "lattice"), ("mooney-rivlin-network", "network")):
            with self.subTest(law=law):
                out = self.out.parent / law
                run = latcon("continuum", HOLE, "--output-dir", out,
                             *settings(*self.FIG1, f"Continuum/law={law}", f"Continuum/gradient={gradient}",
                                       "Continuum/adaptive cycles=5"))
                self.assertEqual(run.returncode, 0, run.stderr)
                self.assertGreater(results(out)["largest area ratio"], 6.)

    def test_loading_that_cannot_be_carried_is_4(self):
        run = latcon("continuum", HOLE, "--output-dir", self.out.parent / "torn",
                     *settings(*self.FIG1, "Continuum/law=mooney-rivlin", "Continuum/gradient=none",
                               "Continuum/refinements=2", "Continuum/adaptive cycles=0"))
        self.assertEqual(run.returncode, 4, run.stderr)
        for part in ["equilibrium was found beyond load factor 0.", "rejected", "converged", "iteration  0  residual"]:
            self.assertIn(part, run.stdout + run.stderr)
        self.assertIn("no static equilibrium was found", run.stderr)


class BadInput(TemporaryFolder):
    def refused(self, command, case, parts, *entries):
        """Checks exit code 2, a message with the given parts, and that no file is changed."""
        self.out.mkdir(exist_ok=True)
        (self.out / "case.prm").write_text("of an earlier run")
        run = latcon(command, case, "--output-dir", self.out, *settings(*entries))
        self.assertEqual(run.returncode, 2, (entries, run.stdout, run.stderr))
        for part in parts:
            self.assertIn(part, run.stderr)
        self.assertEqual([path.name for path in self.out.iterdir()], ["case.prm"])
        self.assertEqual((self.out / "case.prm").read_text(), "of an earlier run")
        return run

    def test_conditions_that_contradict_each_other(self):
        for case, parts, *entries in [
                (LAYER, ["Left edge/condition", "Right edge/condition", "shear_layer.prm:"], "Left edge/condition=held"),
                (LAYER, ["Bottom edge/normal gradient", "Continuum/gradient"], "Continuum/gradient=none"),
                (LAYER, ["Top edge/double traction x", "Top edge/normal gradient"], "Top edge/double traction x=1"),
                (LAYER, ["Continuum/degree"], "Continuum/degree=1"),
                (HOLE, ["Sheet/notch length", "Sheet/hole radius"], "Sheet/notch length=1 cm"),
                (HOLE, ["Continuum/mesh file", "Sheet/hole radius"], "Continuum/mesh file=a.msh")]:
            self.refused("continuum", case, parts, *entries)

    def test_expression_that_cannot_be_read(self):
        run = self.refused("continuum", LAYER, ["Top edge/displacement x", "sin(z)", "position 4"],
                           "Top edge/displacement x=sin(z)")
        self.assertEqual(len(run.stderr.splitlines()), 1)

    def test_mesh_file_that_is_not_there_or_none(self):
        nowhere = self.folder / "none.msh"
        whole = "Sheet/hole radius=0"
        self.refused("continuum", HOLE, [str(nowhere)], whole, f"Continuum/mesh file={nowhere}")
        text = self.folder / "text.msh"
        text.write_text("no mesh\n")
        self.refused("continuum", HOLE, [str(text)], whole, f"Continuum/mesh file={text}")

    def test_cracks_run_in_whole_held_sheets(self):
        self.refused("fracture", HOLE, ["Sheet/hole radius", "Left edge/condition", "latcon fracture"])

    def test_lattice_is_told_no_more_than_it_can_do(self):
        self.refused("lattice", LAYER, ["Top edge/normal gradient", "Bottom edge/normal gradient", "latcon lattice"])
        self.refused("lattice", HOLE, ["Top edge/displacement x"], "Top edge/displacement x=0.01*y")


class Motion(TemporaryFolder):
    """A shear wave in a strip that is periodic both ways."""
    AMPLITUDE = 0.01  # of velocity [m/s]
    LENGTH = 0.01  # of the strip and the wave [m]
    STATIC, INERTIA = 0.5e-3, 1e-3  # l_s, l_d [m]

    def arguments(self, folder, cells, step=5e-6, across="periodic"):
        """@param across condition of the bottom and of the top edge"""
        return ["continuum", LAYER, "--quiet", "--output-dir", folder,
                *settings("Loading/shear=0", "Continuum/law=cauchy-born", "Continuum/ratio=auto",
                          "Bottom edge/normal gradient=free", "Top edge/normal gradient=free",
                          f"Bottom edge/condition={across}", f"Top edge/condition={across}",
                          "Continuum/solution=motion", "Initial state/base=undeformed", "Output/energy interval=1",
                          f"Continuum/cells x={cells}", "Continuum/cells y=2", f"Continuum/static length={self.STATIC}",
                          f"Continuum/inertia length={self.INERTIA}", f"Continuum/time step={step}", "Time/end=5e-5",
                          f"Initial state/velocity y={self.AMPLITUDE}*sin(2*pi*x/{self.LENGTH})")]

    def moved(self, cells):
        run = latcon(*self.arguments(self.out, cells))
        self.assertEqual(run.returncode, 0, run.stderr)
        return numbers(self.out / "energy.csv")

    def test_energy_balances(self):
        energy = self.moved(8)
        self.assertEqual(list(energy), ["t", "elastic", "kinetic", "micro_inertia", "viscous", "boundary_work",
                                        "imbalance"])
        np.testing.assert_allclose(energy["t"], 5e-6 * np.arange(11), rtol=1e-12)
        total = energy["elastic"] + energy["kinetic"] + energy["viscous"] - energy["boundary_work"]
        # Average acceleration conserves the energy of a linear problem, and strains of 4e-4 are nearly linear: measured
        # 1e-9.
        self.assertLess(abs(total - total[0]).max(), 1e-8 * total[0])
        np.testing.assert_allclose(energy["imbalance"], total - total[0], atol=1e-12 * total[0])
        # Micro-inertia contributes in the ratio (l_d k)^2 to 1.
        inertia = (2. * math.pi * self.INERTIA / self.LENGTH) ** 2
        np.testing.assert_allclose(energy["micro_inertia"] / energy["kinetic"], inertia / (1. + inertia), rtol=1e-4)
        self.assertGreater(energy["elastic"][-1], 0.3 * total[0])

    def test_step_too_long_for_the_motion_fails_by_its_ledger(self):
        """A sheet released at both ends; 50 us is the time in which a wave crosses a cell."""
        for step, code, verdict in ((50, 0, "holds"), (200, 3, "fails")):
            run = latcon("continuum", CASES / "quick.prm", "--quiet", "--output-dir", self.folder / str(step), *settings(
                "Continuum/solution=motion", "Left edge/condition=free", "Right edge/condition=free", "Time/end=1 ms",
                f"Continuum/time step={step} us", "Output/energy interval=1", "Output/frame interval=0"))
            self.assertEqual(run.returncode, code, run.stderr)
            row = [row for row in read_csv(self.folder / str(step) / "results.csv")
                   if row["quantity"] == "energy imbalance over energy exchanged"][0]
            self.assertEqual(row["verdict"], verdict)
            energy = numbers(self.folder / str(step) / "energy.csv")
            exchanged = (energy["viscous"][-1] + abs(energy["boundary_work"]).max()
                         + abs(energy["kinetic"] - energy["kinetic"][0]).max())
            self.assertAlmostEqual(float(row["error"]), abs(energy["imbalance"]).max() / exchanged, delta=1e-12)

    def test_frequency_is_that_of_the_dispersion_relation(self):
        k = 2. * math.pi / self.LENGTH
        omega = k * math.sqrt(MODULUS / DENSITY * (1. + (self.STATIC * k) ** 2) / (1. + (self.INERTIA * k) ** 2))
        step = 5e-6
        discrete = 2. / step * math.atan(0.5 * omega * step)  # of average acceleration
        errors = []
        for cells in (8, 16):
            energy = self.moved(cells)
            phase = np.arccos(np.sqrt(energy["kinetic"][1:] / energy["kinetic"][0]))
            errors.append(abs(phase[-1] / energy["t"][-1] / discrete - 1.))
        # The order is 2 (p - 1) = 4 (motion.md). Measured: 2.1e-5 and 1.2e-6.
        self.assertLess(errors[0], 5e-5)
        self.assertGreater(errors[0] / errors[1], 8.)

    def test_ranks_leave_no_trace(self):
        one = self.moved(8)
        run = latcon_on_ranks(2, *self.arguments(self.folder / "ranks", 8))
        self.assertEqual(run.returncode, 0, run.stderr)
        two = numbers(self.folder / "ranks" / "energy.csv")
        self.assertEqual(list(one), list(two))
        for name, column in one.items():
            # The order of summation differs; displacements are 1e-7 of the size of a cell, so strains keep nine digits.
            np.testing.assert_allclose(two[name], column, rtol=0., atol=1e-9 * max(abs(column).max(), one["kinetic"][0]))
        time, path = frames(self.folder / "ranks" / "continuum.pvd")[-1]
        whole = read(vtk.vtkXMLPUnstructuredGridReader(), path)
        self.assertEqual((time, whole.GetNumberOfCells()), (one["t"][-1], 16))
        here = last_mesh(self.out)
        for name in ["displacement", "velocity"]:
            self.assertAlmostEqual(abs(field(whole, name)).max() / abs(field(here, name)).max(), 1., delta=1e-6)

    def test_damped_motion_is_the_same_solved_directly_or_by_iterations(self):
        ledgers, counts = [], []
        for limit in (20000, 0):
            run = latcon(*self.arguments(self.out, 8, across="free"), *settings(
                "Left edge/condition=held", "Right edge/condition=held", "Nearest neighbours/viscosity=50",
                f"Continuum/direct limit={limit}"))
            self.assertEqual(run.returncode, 0, run.stderr)
            ledgers.append(numbers(self.out / "energy.csv"))
            record = json.loads((self.out / "run.json").read_text())
            counts.append((record["newton_iterations"], record["linear_iterations"]))
        direct, iterated = ledgers
        self.assertGreater(direct["viscous"][-1], 0.01 * direct["kinetic"][0])
        # Newton stops at residuals of 1e-10; energies are of the order of the first.
        for name in ("elastic", "kinetic", "viscous"):
            np.testing.assert_allclose(iterated[name], direct[name], rtol=0., atol=1e-9 * direct["kinetic"][0])
        (newton, none), (_, linear) = counts
        self.assertGreaterEqual(newton, 10)  # steps
        self.assertEqual(none, 0)
        self.assertGreaterEqual(linear, newton)

    def test_ends_when_it_is_told(self):
        run = latcon(*self.arguments(self.out, 8, step="auto"))
        self.assertEqual(run.returncode, 0, run.stderr)
        steps = np.diff(numbers(self.out / "energy.csv")["t"])
        self.assertAlmostEqual(steps.sum() / 5e-5, 1., delta=1e-12)
        # Half the time in which a longitudinal wave crosses the smaller side of a cell, or slightly less.
        longest = 0.5 * (self.LENGTH / 8) / math.sqrt(3. * MODULUS / DENSITY)
        self.assertLess(steps.max(), longest)
        self.assertLess(1 / steps.max(), 1 / longest + 1 / 5e-5)


class Gmsh(TemporaryFolder):
    # Four quadrilaterals around an off-centre node, one of them bisected, in a rectangle of 3 by 2 cm.
    NODES = [(0, 0), (1.7, 0), (3, 0), (0, 1.2), (1.3, 0.8), (3, 0.9), (0, 2), (1.2, 2), (3, 2)]
    QUADS = [(1, 2, 5, 4), (2, 3, 6, 5), (4, 5, 8, 7), (5, 6, 9, 8)]
    # Physical curve and its nodes: left, right, bottom, top.
    LINES = [(0, 1, 4), (0, 4, 7), (1, 3, 6), (1, 6, 9), (2, 1, 2), (2, 2, 3), (3, 7, 8), (3, 8, 9)]

    def write_mesh(self, shift=0, unit=0.01):
        """@param shift offset of the numbers of the curves"""
        nodes = [f"{i} {unit * x!r} {unit * y!r} 0" for i, (x, y) in enumerate(self.NODES, 1)]
        lines = [f"1 2 {tag + shift} 1 {a} {b}" for tag, a, b in self.LINES]
        quads = ["3 2 9 1 " + " ".join(map(str, quad)) for quad in self.QUADS]
        elements = [f"{i} {element}" for i, element in enumerate(lines + quads, 1)]
        path = self.folder / "four.msh"
        path.write_text("\n".join(["$MeshFormat", "2.2 0 8", "$EndMeshFormat", "$Nodes", str(len(nodes)), *nodes,
                                   "$EndNodes", "$Elements", str(len(elements)), *elements, "$EndElements", ""]))
        return settings("Sheet/hole radius=0", f"Continuum/mesh file={path}", "Continuum/adaptive cycles=0",
                        "Continuum/refinements=1", "Loading/strain x=0.2", "Loading/strain y=0.4",
                        "Left edge/condition=held", "Right edge/condition=held")

    def test_skewed_quadrilaterals_hold_a_homogeneous_state(self):
        run = latcon("continuum", HOLE, "--output-dir", self.out, *self.write_mesh())
        self.assertEqual(run.returncode, 0, run.stderr)
        mesh = last_mesh(self.out)
        self.assertEqual(mesh.GetNumberOfCells(), 16)
        self.assertAlmostEqual(cells_of(mesh)[1].sum(), 6e-4, delta=1e-9)
        F, P = field(mesh, "deformation_gradient"), field(mesh, "first_piola_stress")
        self.assertLess(abs(F - np.diag([1.2, 1.4])).max(), 1e-6)
        # Forces on the edges by name, that is by the numbers of the curves; fields in single precision.
        found = results(self.out)
        for edge, i, force in [("left", 0, -0.02 * P[0, 0, 0]), ("right", 0, 0.02 * P[0, 0, 0]),
                               ("bottom", 1, -0.03 * P[0, 1, 1]), ("top", 1, 0.03 * P[0, 1, 1])]:
            self.assertAlmostEqual(found[f"force on the {edge} edge per thickness, {'xy'[i]}"] / force, 1., delta=1e-5)
        density = field(mesh, "strain_energy_density")[0]
        self.assertAlmostEqual(found["elastic energy per thickness"] / (6e-4 * density), 1., delta=1e-5)

    def test_curves_of_other_numbers_are_refused(self):
        for shift in (5, 300, -1):
            run = latcon("continuum", HOLE, "--output-dir", self.out, *self.write_mesh(shift=shift))
            self.assertEqual(run.returncode, 2)
            self.assertIn("four.msh", run.stderr)
            self.assertFalse(self.out.exists())

    def test_extent_is_shown_and_must_be_that_of_a_sheet_in_metres(self):
        run = latcon("continuum", HOLE, "--output-dir", self.out, "--dry-run", *self.write_mesh())
        self.assertEqual(run.returncode, 0, run.stderr)
        self.assertIn("# mesh: 0.03 m x 0.02 m\n", run.stdout)
        run = latcon("continuum", HOLE, "--output-dir", self.out, *self.write_mesh(unit=10.))
        self.assertEqual(run.returncode, 2)
        self.assertIn("four.msh spans 30 m x 20 m", run.stderr)
        self.assertFalse(self.out.exists())

    def test_mesh_is_part_of_the_case(self):
        def move(*more):
            return latcon("continuum", HOLE, "--output-dir", self.out, *more, *entries,
                          *settings("Continuum/solution=motion", "Continuum/gradient=none", "Time/end=50 us",
                                    "Continuum/time step=10 us", "Checkpoints/steps=2"))
        entries = self.write_mesh()
        run = move()
        self.assertEqual(run.returncode, 0, run.stderr)
        case_hash = json.loads((self.out / "run.json").read_text())["case_hash"]
        mesh = self.folder / "four.msh"
        text = mesh.read_text()
        mesh.write_text(text.replace(f"5 {0.01 * 1.3!r} 0.008 0", "5 0.014 0.008 0"))
        self.assertNotEqual(mesh.read_text(), text)
        run = move("--resume")
        self.assertEqual(run.returncode, 2, run.stdout)
        self.assertIn("Continuum/mesh sha256", run.stderr)
        self.assertEqual(json.loads((self.out / "run.json").read_text())["case_hash"], case_hash)
        self.write_mesh()
        self.assertEqual(move("--resume").returncode, 0)


if __name__ == "__main__":
    unittest.main(verbosity=2)
