"""Readers of fields in VTK files: frames of a lattice, and mean fields near the tip of a crack."""
from __future__ import annotations

import dataclasses
import os
import pathlib
from collections.abc import Collection, Iterator, Sequence
from typing import TYPE_CHECKING, Any, overload

import numpy as np
from numpy.typing import NDArray

from .errors import LatconError, UnreadableFile
from .files import read_series

if TYPE_CHECKING:
    import xarray

Floats = NDArray[np.float64]
Field = NDArray[np.generic]


@dataclasses.dataclass(frozen=True)
class Frame:
    """Sites and bonds of a lattice at one time.

    Attributes
    ----------
    time : float
        Time t [s]; for a relaxed sheet 0 before and 1 after relaxation.
    reference : ndarray, shape (sites, 2)
        Undeformed positions X, Y [m].
    position : ndarray, shape (sites, 2)
        Current positions x, y [m].
    bonds : ndarray of int, shape (bonds, 2)
        Sites at the ends of each bond, as rows of `reference`. Reduced frames of a motion have no bonds.
    stretch : ndarray, shape (bonds,)
        Current over undeformed length λ.
    fields : dict of ndarray
        Fields at the sites, with the names of docs/reference-files.md. Vectors have shape (sites, 2), tensors (sites, 2, 2)
        with the current index first: the in-plane components.
    bond_fields : dict of ndarray
        Fields of the bonds, likewise.
    units : dict
        SI units of the fields that are quantities.
    """

    time: float
    reference: Floats
    position: Floats
    bonds: NDArray[np.int64]
    stretch: Floats
    fields: dict[str, Field]
    bond_fields: dict[str, Field]
    units: dict[str, str]


class Frames(Sequence[Frame]):
    """Frames of a series, read when they are accessed.

    Parameters
    ----------
    path
        The series, a `.pvd`.

    Attributes
    ----------
    times : ndarray
        Times t [s].

    Raises
    ------
    UnreadableFile
        If the series, or later a frame, is missing or damaged.
    """

    def __init__(self, path: pathlib.Path) -> None:
        self._series = read_series(path)
        self.times = np.array([time for time, _ in self._series])

    @overload
    def __getitem__(self, index: int) -> Frame: ...
    @overload
    def __getitem__(self, index: slice) -> list[Frame]: ...
    def __getitem__(self, index: int | slice) -> Frame | list[Frame]:
        if isinstance(index, slice):
            return [read_frame(path, time) for time, path in self._series[index]]
        time, path = self._series[index]
        return read_frame(path, time)

    def __iter__(self) -> Iterator[Frame]:
        return (read_frame(path, time) for time, path in self._series)

    def __len__(self) -> int:
        return len(self._series)


def read_frame(path: pathlib.Path, time: float, only: Collection[str] | None = None) -> Frame:
    """Reads a frame of a lattice, a `.vtp` file; `only`: the fields to read, None for all.

    Raises
    ------
    UnreadableFile
        If the file is missing or damaged, or is not a frame of a lattice.
    """
    sheet = read_vtk(path, "vtkXMLPolyDataReader", only)
    if sheet.GetNumberOfPoints() == 0:  # VTK's result for a damaged file
        raise UnreadableFile(path, "truncated, damaged, or without sites")
    numpy_of = _converter()
    fields, units = arrays_of(sheet.GetPointData())
    if "displacement" not in fields:
        raise UnreadableFile(path, "not a frame of a lattice: the field 'displacement' is missing")
    cell_fields, cell_units = arrays_of(sheet.GetCellData())
    sites = sheet.GetNumberOfVerts()  # cell data begin with the vertices
    bond_fields = {name: values[sites:] for name, values in cell_fields.items()}
    ends = np.empty((0, 2), dtype=np.int64)
    if sheet.GetNumberOfLines():
        ends = numpy_of(sheet.GetLines().GetConnectivityArray()).astype(np.int64).reshape(-1, 2)
    reference = numpy_of(sheet.GetPoints().GetData())[:, :2].astype(float)
    position, stretch = reference + fields["displacement"], bond_fields.get("stretch", np.empty(0))
    if len(ends) != len(stretch) or not np.isfinite(position).all() or not np.isfinite(stretch).all():
        raise UnreadableFile(path, "damaged: its bonds or positions are inconsistent")
    return Frame(time, reference, position, ends, stretch, fields, bond_fields, {**cell_units, **units})


def write_frame(path: str | os.PathLike[str], frame: Frame) -> None:
    """Writes a frame of a lattice as a `.vtp` file, which :func:`read_frame` reads."""
    from vtkmodules.util.numpy_support import numpy_to_vtk, numpy_to_vtkIdTypeArray
    from vtkmodules.vtkCommonCore import vtkPoints
    from vtkmodules.vtkCommonDataModel import vtkCellArray, vtkPolyData
    from vtkmodules.vtkIOXML import vtkXMLPolyDataWriter
    sheet, points, sites, bonds = vtkPolyData(), vtkPoints(), vtkCellArray(), vtkCellArray()
    points.SetData(numpy_to_vtk(np.column_stack((frame.reference, np.zeros(len(frame.reference)))), deep=True))
    sites.SetData(1, numpy_to_vtkIdTypeArray(np.arange(len(frame.reference)), deep=True))
    bonds.SetData(2, numpy_to_vtkIdTypeArray(frame.bonds.astype(np.int64).ravel(), deep=True))
    sheet.SetPoints(points)
    sheet.SetVerts(sites)
    sheet.SetLines(bonds)
    of_cells: dict[str, Any] = {"stretch": np.concatenate((np.ones(len(frame.reference)), frame.stretch))}  # vertices first
    of_sites: dict[str, Any] = frame.fields
    for data, fields in ((sheet.GetPointData(), of_sites), (sheet.GetCellData(), of_cells)):
        for name, values in fields.items():
            three = np.column_stack((values, np.zeros(len(values)))) if values.ndim == 2 else values
            array = numpy_to_vtk(np.ascontiguousarray(three), deep=True)
            array.SetName(name)
            data.AddArray(array)
    writer = vtkXMLPolyDataWriter()
    writer.SetFileName(os.fsencode(path))
    writer.SetInputData(sheet)
    if not writer.Write():
        raise OSError(5, "the frame cannot be written", os.fspath(path))


def read_near_tip(path: pathlib.Path) -> xarray.Dataset:
    """Reads the mean fields around the tip, `near_tip.vti` or `near_tip_folded.vti`.

    Returns
    -------
    xarray.Dataset
        Fields on the dimensions ``Y``, ``X`` (undeformed, relative to the tip [m]), vectors also on ``i``, tensors on ``i``,
        ``J`` (current index first), each with its unit in ``attrs["units"]``. ``attrs["samples"]`` is the number of samples.

    Raises
    ------
    UnreadableFile
        If the file is missing or damaged.
    LatconError
        If xarray is not installed.
    """
    try:
        import xarray
    except ImportError as error:
        raise LatconError("fields near the tip need the Python package xarray (Debian: python3-xarray)") from error
    X, Y, fields, units, samples = read_image(path)
    dimensions = ("Y", "X", "i", "J")
    data = xarray.Dataset({name: (dimensions[:values.ndim], values, {"units": units[name]} if name in units else {})
                           for name, values in fields.items()}, {"X": X, "Y": Y})
    for name in "XY":
        data[name].attrs["units"] = "m"
    if samples is not None:
        data.attrs["samples"] = samples
    return data


def read_image(path: pathlib.Path) -> tuple[Floats, Floats, dict[str, Any], dict[str, str], int | None]:
    """Reads mean fields around the tip: X, Y, fields by name on (Y, X), their units, number of samples.

    Raises
    ------
    UnreadableFile
        If the file is missing or damaged.
    """
    image = read_vtk(path, "vtkXMLImageDataReader")
    columns, rows, _ = image.GetDimensions()
    fields, units = arrays_of(image.GetPointData())
    if not fields or columns * rows == 0:
        raise UnreadableFile(path, "damaged, or without fields")
    X, Y = (origin + spacing * np.arange(count)
            for origin, spacing, count in zip(image.GetOrigin(), image.GetSpacing(), (columns, rows)))
    samples = image.GetFieldData().GetArray("Samples")
    return (X, Y, {name: values.reshape(rows, columns, *values.shape[1:]) for name, values in fields.items()}, units,
            None if samples is None else int(samples.GetValue(0)))


def read_vtk(path: pathlib.Path, reader_name: str, only: Collection[str] | None = None) -> Any:
    """Returns the data set in a VTK file, with the arrays of some names, or all."""
    try:
        from vtkmodules import vtkIOXML
        from vtkmodules.vtkCommonCore import vtkObject
    except ImportError as error:
        raise LatconError("frames need the Python package vtk (Debian: python3-vtk9)") from error
    if not path.exists():
        raise UnreadableFile(path, "no such file")
    vtkObject.GlobalWarningDisplayOff()  # the callers report damaged files
    reader = getattr(vtkIOXML, reader_name)()
    reader.SetFileName(os.fsencode(path))  # a name need not be UTF-8 text
    if only is not None:
        reader.UpdateInformation()
        for selection in (reader.GetPointDataArraySelection(), reader.GetCellDataArraySelection()):
            for index in range(selection.GetNumberOfArrays()):
                selection.SetArraySetting(selection.GetArrayName(index), selection.GetArrayName(index) in only)
    reader.Update()
    return reader.GetOutput()


def _converter() -> Any:
    from vtkmodules.util.numpy_support import vtk_to_numpy
    return vtk_to_numpy


def arrays_of(data: Any) -> tuple[dict[str, Any], dict[str, str]]:
    """Returns arrays by name, with the in-plane components of vectors and tensors, and the units of those that have one."""
    from vtkmodules.vtkCommonCore import vtkDataArray
    numpy_of = _converter()
    arrays, units = {}, {}
    for index in range(data.GetNumberOfArrays()):
        array = data.GetArray(index)
        name, values = array.GetName(), numpy_of(array)
        if values.ndim == 2 and values.shape[1] == 3:
            values = values[:, :2]
        elif values.ndim == 2 and values.shape[1] == 9:
            values = values.reshape(-1, 3, 3)[:, :2, :2]
        arrays[name] = values
        if array.HasInformation() and (unit := array.GetInformation().Get(vtkDataArray.UNITS_LABEL())):
            units[name] = unit
    return arrays, units
