#!/usr/bin/python3
"""Reads a series of the continuum with VTK and compares it with a homogeneous deformation computed here.

Usage: check_fields.py SERIES.pvd N_FRAMES N_CELLS
       check_fields.py SERIES.pvd motion
The sheet is [0, 0.15] x [-0.05, 0.05] m, x = F(t) X with F(t) = I + t (F(1) - I), of the rubber network
(tests/continuum/sheets.h). In motion it is x = F(1) X, with viscosity, Maxwell branches and the velocity below.
"""
import pathlib
import sys
import xml.etree.ElementTree

import numpy
from vtkmodules.numpy_interface.dataset_adapter import WrapDataObject
from vtkmodules.vtkIOXML import vtkXMLGenericDataObjectReader

A, B, S = 1e5, 1.5e5, 2.0 / 3.0
F_END = numpy.array([[2.3, 0.25], [-0.1, 1.4]])
# Values are stored in single precision.
TOLERANCE = 1e-6


def bonds(F):
    """Weight, undeformed and deformed direction, and stretch of each bond of the network."""
    for k in range(6):
        N = numpy.array([numpy.cos(numpy.pi * k / 6), numpy.sin(numpy.pi * k / 6)])
        l = numpy.linalg.norm(F @ N)
        yield S * (1.0 if k % 2 == 0 else numpy.sqrt(3.0)), N, F @ N / l, l


def network(F):
    """Energy density and first Piola stress of the network, from its bonds."""
    W = sum(c * (A * (l**2 / 2 + 1 / l - 1.5) + B * (l + 1 / (2 * l**2) - 1.5)) for c, _, _, l in bonds(F))
    return W, sum(c * (A * (l - l**-2) + B * (1 - l**-3)) * numpy.outer(n, N) for c, N, n, l in bonds(F))


VISCOSITY, MODULUS = 300.0, 2e5


def rates(X):
    """Velocities (C0 x, C1 x y) [m/s] and their gradients at the points X."""
    C0, C1 = 40.0, 900.0
    velocity = numpy.stack([C0 * X[:, 0], C1 * X[:, 0] * X[:, 1]], axis=1)
    gradient = numpy.zeros((len(X), 2, 2))
    gradient[:, 0, 0], gradient[:, 1, 0], gradient[:, 1, 1] = C0, C1 * X[:, 1], C1 * X[:, 0]
    return velocity, gradient


def rate_stress(F, rate):
    """First Piola stress of dashpots and of branches that were relaxed at F = I, per point."""
    def axial(N, n, l):
        return VISCOSITY * numpy.einsum("i,pij,j->p", n, rate, N) + MODULUS * (l - 1.0)
    return sum(c * numpy.multiply.outer(axial(N, n, l), numpy.outer(n, N)) for c, N, n, l in bonds(F))


def planar(tensor):
    """In-plane part of tensors, after a check that the rest is empty. VTK takes columns for rows."""
    assert not tensor[:, 2, :].any() and not tensor[:, :, 2].any(), "out-of-plane components are not zero"
    return tensor.transpose(0, 2, 1)[:, :2, :2]


def expect(name, found, wanted, scale):
    error = numpy.abs(found - wanted).max()
    assert error <= TOLERANCE * scale, f"{name}: off by {error}, scale {scale}"


def read(path):
    reader = vtkXMLGenericDataObjectReader()
    reader.SetFileName(str(path))
    reader.Update()
    return WrapDataObject(reader.GetOutput())


def check(path, time, n_cells):
    grid = read(path)
    assert grid.GetNumberOfCells() == n_cells, f"{path.name} has {grid.GetNumberOfCells()} cells"
    if path.suffix == ".vtu":
        assert list(grid.FieldData["TimeValue"]) == [time], f"TimeValue of {path.name} is not {time!r}"
    field, X = grid.PointData, grid.Points
    wanted = {"displacement", "deformation_gradient", "first_piola_stress", "cauchy_stress", "strain_energy_density",
              "strain_gradient_x", "strain_gradient_y", "double_stress_x", "double_stress_y"}
    assert set(field.keys()) == wanted, f"{path.name} has fields {sorted(field.keys())}"
    assert numpy.allclose(X.min(axis=0), [0, -0.05, 0], atol=1e-8) and numpy.allclose(X.max(axis=0), [0.15, 0.05, 0], atol=1e-8)
    F = numpy.eye(2) + time * (F_END - numpy.eye(2))
    W, P = network(F)
    sigma = P @ F.T / numpy.linalg.det(F)
    # The stress of the unloaded sheet is the round-off of moduli of 5e5 Pa.
    modulus = 5e5
    expect("displacement", field["displacement"][:, :2], X[:, :2] @ (F - numpy.eye(2)).T, 0.15)
    assert not field["displacement"][:, 2].any()
    expect("deformation_gradient", planar(field["deformation_gradient"]), F, 1.0)
    expect("first_piola_stress", planar(field["first_piola_stress"]), P, modulus)
    expect("cauchy_stress", planar(field["cauchy_stress"]), sigma, modulus)
    expect("strain_energy_density", field["strain_energy_density"], W, modulus)


def check_motion(path):
    grid = read(path)
    field, X = grid.PointData, grid.Points[:, :2]
    velocity, rate = rates(X)
    expect("velocity", field["velocity"][:, :2], velocity, numpy.abs(velocity).max())
    P = network(F_END)[1] + rate_stress(F_END, rate)
    scale = numpy.abs(P).max()
    assert numpy.abs(rate_stress(F_END, rate)).max() > 0.1 * scale
    expect("first_piola_stress", planar(field["first_piola_stress"]), P, scale)
    expect("cauchy_stress", planar(field["cauchy_stress"]), P @ F_END.T / numpy.linalg.det(F_END), scale)


def main():
    series = pathlib.Path(sys.argv[1])
    frames = [(float(entry.get("timestep")), entry.get("file")) for entry in xml.etree.ElementTree.parse(series).iter("DataSet")]
    times = [time for time, _ in frames]
    if sys.argv[2] == "motion":
        return check_motion(series.parent / frames[0][1])
    assert len(frames) == int(sys.argv[2]), f"{len(frames)} frames"
    assert times == [0.0, 1.0 / 3.0, 1.0], f"times {times}"
    for time, name in frames:
        check(series.parent / name, time, int(sys.argv[3]))


main()
