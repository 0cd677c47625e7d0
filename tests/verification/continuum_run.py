"""Cases and results of finite element runs, for tests."""
import math

import numpy as np

from program import CASES, frames, read, read_csv

LAYER, HOLE = CASES / "shear_layer.prm", CASES / "hole.prm"
# Constants of both cases. Two shells with s = 2/3 and a + b = 0.25 MPa have the small-strain modulus of theory.md.
SPACING = 0.625e-3  # [m]
DENSITY = 944.  # [kg/m^3]
MODULUS = 2. / 3. * 9. / 8. * (1. + math.sqrt(3.)) * 0.25e6  # [Pa]


def results(folder):
    return {row["quantity"]: float(row["continuum"]) for row in read_csv(folder / "results.csv")}


def last_mesh(folder):
    return read(frames(folder / "continuum.pvd")[-1][1])


def field(mesh, name):
    """Values at the points; tensors as (point, row, column) of the plane."""
    values = mesh.PointData[name].astype(float)
    return values.transpose(0, 2, 1)[:, :2, :2] if values.ndim == 3 else values  # VTK takes columns for rows


def points_of(mesh):
    return mesh.Points[:, :2].astype(float)


def cells_of(mesh):
    """Middle and area of every cell, whose first four points are its corners."""
    points = points_of(mesh)
    corners = np.array([[points[mesh.GetCell(i).GetPointId(k)] for k in range(4)] for i in range(mesh.GetNumberOfCells())])
    one, two = corners[:, 2] - corners[:, 0], corners[:, 3] - corners[:, 1]
    return corners.mean(axis=1), 0.5 * abs(one[:, 0] * two[:, 1] - one[:, 1] * two[:, 0])
