"""Readers of fields in VTK files: frames of a lattice, and mean fields near the tip of a crack."""
from __future__ import annotations

import dataclasses
import os
import pathlib
from collections.abc import Iterator, Sequence
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


def read_frame(path: pathlib.Path, time: float) -> Frame:
    """Reads a frame of a lattice, a `.vtp` file.

    Raises
    ------
    UnreadableFile
        If the file is missing or damaged, or is not a frame of a lattice.
    """
    sheet = _read(path, "vtkXMLPolyDataReader")
    if sheet.GetNumberOfPoints() == 0:  # VTK's result for a damaged file
        raise UnreadableFile(path, "damaged, or without sites")
    numpy_of = _converter()
    fields, units = _arrays(sheet.GetPointData())
    if "displacement" not in fields:
        raise UnreadableFile(path, "not a frame of a lattice: the field 'displacement' is missing")
    cell_fields, cell_units = _arrays(sheet.GetCellData())
    sites = sheet.GetNumberOfVerts()  # cell data begin with the vertices
    bond_fields = {name: values[sites:] for name, values in cell_fields.items()}
    ends = np.empty((0, 2), dtype=np.int64)
    if sheet.GetNumberOfLines():
        ends = numpy_of(sheet.GetLines().GetConnectivityArray()).astype(np.int64).reshape(-1, 2)
    reference = numpy_of(sheet.GetPoints().GetData())[:, :2].astype(float)
    return Frame(time, reference, reference + fields["displacement"], ends,
                 bond_fields.get("stretch", np.empty(0)), fields, bond_fields, {**cell_units, **units})


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
    image = _read(path, "vtkXMLImageDataReader")
    columns, rows, _ = image.GetDimensions()
    fields, units = _arrays(image.GetPointData())
    if not fields or columns * rows == 0:
        raise UnreadableFile(path, "damaged, or without fields")
    origin, spacing = image.GetOrigin(), image.GetSpacing()
    dimensions = ("Y", "X", "i", "J")
    coordinates = {"X": origin[0] + spacing[0] * np.arange(columns), "Y": origin[1] + spacing[1] * np.arange(rows)}
    data = xarray.Dataset(
        {name: (dimensions[:values.ndim + 1], values.reshape(rows, columns, *values.shape[1:]),
                {"units": units[name]} if name in units else {}) for name, values in fields.items()}, coordinates)
    for name in "XY":
        data[name].attrs["units"] = "m"
    samples = image.GetFieldData().GetArray("Samples")
    if samples is not None:
        data.attrs["samples"] = int(samples.GetValue(0))
    return data


def _read(path: pathlib.Path, reader_name: str) -> Any:
    try:
        from vtkmodules import vtkIOXML
        from vtkmodules.vtkCommonCore import vtkObject
    except ImportError as error:
        raise LatconError("frames need the Python package vtk (Debian: python3-vtk9)") from error
    if not path.is_file():
        raise UnreadableFile(path, "no such file")
    vtkObject.GlobalWarningDisplayOff()  # the callers report damaged files
    reader = getattr(vtkIOXML, reader_name)()
    reader.SetFileName(os.fsencode(path))  # a name need not be UTF-8 text
    reader.Update()
    return reader.GetOutput()


def _converter() -> Any:
    from vtkmodules.util.numpy_support import vtk_to_numpy
    return vtk_to_numpy


def _arrays(data: Any) -> tuple[dict[str, Any], dict[str, str]]:
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
