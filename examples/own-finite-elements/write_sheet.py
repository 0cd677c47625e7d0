"""Writes a linear elastic sheet, stretched by 1 and 2 %, as finite elements for `latcon compare`.

Usage: write_sheet.py FRAME_OF_THE_LATTICE SHEET.vtu     docs/how-to/own-finite-elements.md explains the fields.
"""
import sys
import numpy as np
import vtk
from vtk.util.numpy_support import numpy_to_vtk

reader = vtk.vtkXMLPolyDataReader()
reader.SetFileName(sys.argv[1])
reader.Update()
x0, x1, y0, y1 = reader.GetOutput().GetFieldData().GetArray("SheetBounds").GetTuple(0)

nx, ny = 8, 4  # cells
x, y = np.meshgrid(np.linspace(x0, x1, nx + 1), np.linspace(y0, y1, ny + 1))
X = np.column_stack((x.ravel(), y.ravel(), 0 * x.ravel()))

s, a, b = 2 / 3, 1e5, 1.5e5
mu = 9 / 8 * (s + 3**0.5 * s) * (a + b)
H = np.diag([0.01, 0.02, 0.0])  # gradient of displacement
stress = mu * np.trace(H) * np.diag([1.0, 1.0, 0.0]) + 2 * mu * H
everywhere = np.ones((len(X), 1))

sheet = vtk.vtkUnstructuredGrid()
points = vtk.vtkPoints()
points.SetDataTypeToDouble()
points.SetData(numpy_to_vtk(X, deep=True))
sheet.SetPoints(points)
number = np.arange(len(X)).reshape(ny + 1, nx + 1)
for j in range(ny):
    for i in range(nx):
        cell = [number[j, i], number[j, i + 1], number[j + 1, i + 1], number[j + 1, i]]
        sheet.InsertNextCell(vtk.VTK_QUAD, 4, [int(n) for n in cell])


def add(data, name, values):
    array = numpy_to_vtk(np.ascontiguousarray(values), deep=True)
    array.SetName(name)
    data.AddArray(array)


add(sheet.GetPointData(), "displacement", X @ H.T)
add(sheet.GetPointData(), "deformation_gradient", everywhere * (np.eye(3) + H).ravel())
add(sheet.GetPointData(), "first_piola_stress", everywhere * stress.ravel())
add(sheet.GetPointData(), "cauchy_stress", everywhere * stress.ravel())  # the same in a linear theory
add(sheet.GetPointData(), "strain_energy_density", everywhere * 0.5 * np.sum(stress * H))
add(sheet.GetFieldData(), "TimeValue", np.array([1.0]))  # fully loaded

writer = vtk.vtkXMLUnstructuredGridWriter()
writer.SetFileName(sys.argv[2])
writer.SetInputData(sheet)
writer.SetDataModeToAppended()
writer.EncodeAppendedDataOff()
writer.Write()
