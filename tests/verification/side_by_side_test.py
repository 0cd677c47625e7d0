"""Tests of the three views of verification/paraview/side_by_side.py, drawn by ParaView on a virtual display."""

import numpy as np
from PIL import Image
from vtkmodules.util.numpy_support import numpy_to_vtk
from vtkmodules.vtkCommonCore import vtkPoints
from vtkmodules.vtkCommonDataModel import VTK_QUAD, vtkCellArray, vtkPolyData, vtkUnstructuredGrid
from vtkmodules.vtkIOXML import vtkXMLPolyDataWriter, vtkXMLUnstructuredGridWriter

from paraview_display import ParaView

WIDTH, HEIGHT = 0.06, 0.03  # of the sheet [m]
SPACING = 0.5e-3  # [m]


def write(writer, data, path):
    writer.SetFileName(str(path))
    writer.SetInputData(data)
    assert writer.Write() == 1


def add(data, name, values):
    array = numpy_to_vtk(np.ascontiguousarray(values, dtype=float), deep=True)
    array.SetName(name)
    data.GetPointData().AddArray(array)


def vectors(x):
    return np.column_stack((x, 0 * x, 0 * x))


def set_points(data, position):
    points = vtkPoints()
    points.SetDataTypeToDouble()
    points.SetData(numpy_to_vtk(np.column_stack((position, np.zeros(len(position)))), deep=True))
    data.SetPoints(points)


def write_difference(folder):
    """Displacement along x that increases with x, equal on both sides except in the upper right quarter."""
    nx, ny = round(WIDTH / SPACING) + 1, round(HEIGHT / SPACING) + 1
    x, y = np.meshgrid(SPACING * np.arange(nx), SPACING * np.arange(ny))
    position = np.column_stack((x.ravel(), y.ravel()))
    off = np.where((position[:, 0] > 0.5 * WIDTH) & (position[:, 1] > 0.5 * HEIGHT), 1e-4, 0.0)
    sites = vtkPolyData()
    set_points(sites, position)
    number = np.arange(nx * ny).reshape(ny, nx)
    bonds = np.concatenate([np.stack((a.ravel(), b.ravel()), axis=1)
                            for a, b in ((number[:, :-1], number[:, 1:]), (number[:-1], number[1:]))])
    lines = vtkCellArray()
    for a, b in bonds:
        lines.InsertNextCell(2, (a, b))
    sites.SetLines(lines)
    u = 0.1 * position[:, 0]
    add(sites, "displacement", vectors(u + off))
    add(sites, "displacement_continuum", vectors(u))
    add(sites, "displacement_difference", vectors(off))
    # The stress of sites that lack bonds is meaningless.
    complete = (position[:, 1] > 0.25 * HEIGHT) & (position[:, 1] < 0.75 * HEIGHT)
    stress = np.zeros((nx * ny, 9))
    stress[:, 4] = np.where(complete, 1e5 + position[:, 0], -1e9)
    add(sites, "cauchy_stress", stress)
    add(sites, "cauchy_stress_continuum", np.where(complete[:, np.newaxis], stress, 0.0))
    add(sites, "cauchy_stress_difference", 0.0 * stress)
    add(sites, "complete", complete)
    write(vtkXMLPolyDataWriter(), sites, folder / "difference_sites.vtp")

    cells = vtkUnstructuredGrid()
    corners = np.array([(0, 0), (WIDTH, 0), (WIDTH, HEIGHT), (0, HEIGHT)], dtype=float)
    set_points(cells, corners)
    cells.InsertNextCell(VTK_QUAD, 4, (0, 1, 2, 3))
    add(cells, "displacement", vectors(0.1 * corners[:, 0]))
    stress = np.zeros((4, 9))
    stress[:, 4] = 1e5 + corners[:, 0]
    add(cells, "cauchy_stress", stress)
    write(vtkXMLUnstructuredGridWriter(), cells, folder / "difference_continuum.vtu")


class SideBySide(ParaView):
    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        write_difference(cls.folder)

    def picture(self, *arguments):
        """Colours of the three views, at the same size each."""
        path = self.folder / "picture.png"
        path.unlink(missing_ok=True)
        run = self.script("side_by_side.py", self.folder, "--screenshot", path, *arguments)
        self.assertEqual(run.returncode, 0, run.stderr)
        pixels = np.asarray(Image.open(path).convert("RGB")).astype(int)
        self.assertEqual(pixels.shape[1] % 3, 0)
        return np.split(pixels, 3, axis=1)

    def sheet(self, view):
        """The part of a view between its title and its bar that is not white."""
        filled = np.abs(view - 255).max(axis=2) > 40
        rows = np.flatnonzero(filled.mean(axis=1) > 0.8)  # text and colour bars are shorter
        columns = np.flatnonzero(filled[rows].mean(axis=0) > 0.7)
        return view[rows[0]:rows[-1] + 1, columns[0]:columns[-1] + 1]

    @staticmethod
    def at(sheet, x, y):
        """Mean colour about a place, as shares of the width and, from the bottom, of the height."""
        row, column = round((1 - y) * len(sheet)), round(x * sheet.shape[1])
        return sheet[row - 5:row + 6, column - 5:column + 6].reshape(-1, 3).mean(axis=0)

    def test_shows_both_sides_alike_and_their_difference(self):
        left, middle, right = map(self.sheet, self.picture())
        # 0.066 by 0.03 m as deformed.
        self.assertAlmostEqual(middle.shape[1] / middle.shape[0], 2.2, delta=0.03)
        for x, y in ((0.1, 0.5), (0.4, 0.3), (0.9, 0.2)):
            self.assertLess(abs(self.at(left, x, y) - self.at(middle, x, y)).max(), 30, (x, y))
        self.assertGreater(abs(self.at(middle, 0.1, 0.5) - self.at(middle, 0.9, 0.5)).max(), 100)
        for x, y in ((0.25, 0.25), (0.25, 0.75), (0.75, 0.25)):  # black is none
            self.assertLess(self.at(right, x, y).max(), 30, (x, y))
        self.assertGreater(self.at(right, 0.75, 0.75).min(), 100)

    def test_shows_sites_that_lack_bonds_in_grey(self):
        views = self.picture("--field", "cauchy_stress", "--component", "yy", "--undeformed")
        left, middle, right = map(self.sheet, views)
        self.assertAlmostEqual(len(left) / len(middle), 1, delta=0.03)  # none is left out
        self.assertAlmostEqual(len(right) / len(middle), 1, delta=0.03)
        for view in (left, right):
            for y in (0.1, 0.9):
                self.assertLess(np.ptp(self.at(view, 0.5, y)), 6)
                self.assertAlmostEqual(self.at(view, 0.5, y).mean(), 0.75 * 255, delta=6)
        ends = [self.at(left, x, 0.5) for x in (0.05, 0.95)]
        self.assertGreater(abs(ends[0] - ends[1]).max(), 100)  # the scale is that of the sites that are coloured
        titles = [np.count_nonzero(view[:40].min(axis=2) < 128) for view in views]
        self.assertGreater(min(titles[0], titles[2]), 2 * titles[1])  # and the title states it

    def test_refuses_what_it_cannot_show(self):
        for arguments, part in ([self.folder / "none"], "difference_sites.vtp"), ([self.folder, "--component", "z"], "x, y"), \
                               ([self.folder, "--field", "speed"], "displacement"):
            run = self.script("side_by_side.py", *arguments)
            self.assertEqual(run.returncode, 2)
            self.assertIn(part, run.stderr)
        run = self.script("side_by_side.py", self.folder, "--field", "velocity", "--screenshot", self.folder / "none.png")
        self.assertEqual(run.returncode, 1)
        self.assertIn("velocity", run.stderr)
