"""Fields in VTK files: frames of a lattice or a continuum, and mean fields near the tip of a crack."""
from __future__ import annotations

import dataclasses
import faulthandler
import os
import pathlib
import re
import resource
from collections.abc import Callable, Collection, Sequence
from typing import TYPE_CHECKING, Any, overload

import numpy as np
from numpy.typing import NDArray

from .errors import UnreadableFile, optional_package
from .files import read_series
from .folder import write_atomically

if TYPE_CHECKING:
    import xarray

_UNITS = re.compile(rb'<P?DataArray [^>]*Name="(\w+)"[^>]* units="([^"]+)"')
_READERS = {".vtu": "vtkXMLUnstructuredGridReader", ".pvtu": "vtkXMLPUnstructuredGridReader", ".vti": "vtkXMLImageDataReader"}

Floats = NDArray[np.float64]
Field = NDArray[np.generic]


@dataclasses.dataclass(frozen=True)
class Frame:
    """Sites and bonds of a lattice, or nodes and cells of a continuum, at one time.

    Attributes
    ----------
    time : float
        Time t [s]; for a relaxed sheet 0 before and 1 after relaxation; for an equilibrium of the continuum the load factor.
    reference : ndarray, shape (sites, 2)
        Undeformed positions X, Y of the sites or nodes [m]. Cells of finite elements have nodes of their own.
    position : ndarray, shape (sites, 2)
        Current positions x, y [m].
    bonds : ndarray of int, shape (bonds, 2)
        Sites at the ends of each bond, as rows of `reference`. Reduced frames of a motion, and a continuum, have no bonds.
    stretch : ndarray, shape (bonds,)
        Current over undeformed length λ.
    fields : dict of ndarray
        Fields at the sites or nodes, with the names of docs/reference-files.md. Vectors have shape (sites, 2), tensors (sites, 2, 2)
        with the current index first: the in-plane components.
    bond_fields : dict of ndarray
        Fields of the bonds, likewise.
    units : dict
        SI units of the fields that are quantities.
    cells : ndarray of int, shape (cells, nodes per cell)
        Nodes of each cell of a continuum, as rows of `reference` in the order of VTK: the four corners first. A lattice has none.
    """

    time: float
    reference: Floats
    position: Floats
    bonds: NDArray[np.int64]
    stretch: Floats
    fields: dict[str, Field]
    bond_fields: dict[str, Field]
    units: dict[str, str]
    cells: NDArray[np.int64] = dataclasses.field(default_factory=lambda: np.empty((0, 0), dtype=np.int64))

    def to_pyvista(self) -> Any:
        """Returns a `pyvista.PolyData` of sites and bonds or a `pyvista.UnstructuredGrid` of cells, undeformed, in SI units."""
        return optional_package("pyvista", "to_pyvista needs", "pyvista").wrap(_data_set(self))

    def to_meshio(self) -> Any:
        """Returns a `meshio.Mesh` of bonds or cells, undeformed, in SI units; fields have the shapes of `fields`, `bond_fields`."""
        meshio = optional_package("meshio", "to_meshio needs", "meshio (Debian: python3-meshio)")
        kind = {3: "triangle", 4: "quad"}.get(self.cells.shape[1], "VTK_LAGRANGE_QUADRILATERAL")
        return meshio.Mesh(self.reference, [(kind, self.cells) if len(self.cells) else ("line", self.bonds)], dict(self.fields),
                           {name: [values] for name, values in self.bond_fields.items()})

    def to_ase(self) -> Any:
        """Returns `ase.Atoms` of type X at the current positions [Å], with `arrays` of the fields in SI units and `info["time"]` [s]."""
        ase = optional_package("ase", "to_ase needs", "ase (Debian: python3-ase)")
        atoms = ase.Atoms(numbers=np.zeros(len(self.position), int), positions=_spatial(1e10 * self.position), info={"time": self.time})
        for name, values in self.fields.items():
            atoms.set_array(name, np.asarray(values).copy())
        return atoms


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

    def __len__(self) -> int:
        return len(self._series)


def read_frame(path: pathlib.Path, time: float, only: Collection[str] | None = None) -> Frame:
    """Reads a frame of a lattice, a `.vtp` file, or of a continuum, also `.vtu`; `only`: the fields to read, None for all.

    Raises UnreadableFile if the file is missing or damaged, or is not a frame.
    """
    sheet = read_vtk(path, only)
    from vtkmodules.util.numpy_support import vtk_to_numpy
    if sheet.GetNumberOfPoints() == 0:  # VTK's result for a damaged file
        raise UnreadableFile(path, "truncated, damaged, or without sites")
    fields, units = arrays_of(sheet.GetPointData())
    if "displacement" not in fields:
        raise UnreadableFile(path, "not a frame: the field 'displacement' is missing")
    cell_fields, cell_units = arrays_of(sheet.GetCellData())
    is_grid = sheet.IsA("vtkUnstructuredGrid")
    cells = _nodes(path, sheet.GetCells() if is_grid else sheet.GetPolys())
    ends = np.empty((0, 2), dtype=np.int64) if is_grid else _nodes(path, sheet.GetLines())
    sites = sheet.GetNumberOfCells() if len(cells) else sheet.GetNumberOfVerts()  # cell data begin with the vertices
    bond_fields = {name: values[sites:] for name, values in cell_fields.items()}
    reference = vtk_to_numpy(sheet.GetPoints().GetData())[:, :2].astype(float)
    position, stretch = reference + fields["displacement"], bond_fields.get("stretch", np.empty(0))
    if len(ends) != len(stretch) or not np.isfinite(position).all() or not np.isfinite(stretch).all():
        raise UnreadableFile(path, "damaged: its bonds or positions are inconsistent")
    if is_grid and not units:  # deal.II writes them where VTK does not read them
        units = {name.decode(): unit.decode() for name, unit in _UNITS.findall(path.read_bytes())}
    return Frame(time, reference, position, ends, stretch, fields, bond_fields, {**cell_units, **units}, cells)


def _nodes(path: pathlib.Path, cells: Any) -> NDArray[np.int64]:
    if not (count := cells.GetNumberOfCells()):
        return np.empty((0, 2), dtype=np.int64)
    from vtkmodules.util.numpy_support import vtk_to_numpy
    connectivity = vtk_to_numpy(cells.GetConnectivityArray()).astype(np.int64)
    if len(connectivity) % count:
        raise UnreadableFile(path, "damaged, or with cells of different kinds")
    return connectivity.reshape(count, -1)


def write_frame(path: str | os.PathLike[str], frame: Frame) -> None:
    """Writes a frame of a lattice as a `.vtp` file, of a continuum as `.vtu`, which :func:`read_frame` reads; raises OSError."""
    from vtkmodules.vtkIOXML import vtkXMLPolyDataWriter, vtkXMLUnstructuredGridWriter
    writer = vtkXMLUnstructuredGridWriter() if len(frame.cells) else vtkXMLPolyDataWriter()
    writer.SetInputData(_data_set(frame))
    writer.WriteToOutputStringOn()  # VTK reports no failure to write a file
    writer.Write()
    write_atomically(os.fspath(path), writer.GetOutputString())


def _data_set(frame: Frame) -> Any:
    """Returns the undeformed frame with its fields as VTK holds it: vertices and lines, or cells."""
    from vtkmodules import vtkCommonDataModel as vtk
    from vtkmodules.util.numpy_support import numpy_to_vtk, numpy_to_vtkIdTypeArray
    from vtkmodules.vtkCommonCore import vtkPoints

    def cells(nodes: Any) -> Any:
        array = vtk.vtkCellArray()
        array.SetData(nodes.shape[1], numpy_to_vtkIdTypeArray(nodes.astype(np.int64).ravel(), deep=True))
        return array

    count, points = len(frame.reference), vtkPoints()
    points.SetData(numpy_to_vtk(_spatial(frame.reference), deep=True))
    if len(frame.cells):
        sheet, n_nodes = vtk.vtkUnstructuredGrid(), frame.cells.shape[1]
        kind = {3: vtk.VTK_TRIANGLE, 4: vtk.VTK_QUAD}.get(n_nodes, vtk.VTK_LAGRANGE_QUADRILATERAL)
        sheet.SetCells(kind, cells(frame.cells))
    else:
        sheet = vtk.vtkPolyData()
        sheet.SetVerts(cells(np.arange(count)[:, None]))
        sheet.SetLines(cells(frame.bonds))
    sheet.SetPoints(points)
    # Cell data begin with the vertices.
    of_cells = {name: np.concatenate((np.full((count, *values.shape[1:]), 1.0 if name == "stretch" else 0.0), values))
                for name, values in frame.bond_fields.items()}
    for data, fields in ((sheet.GetPointData(), frame.fields), (sheet.GetCellData(), of_cells)):
        for name, values in fields.items():
            data.AddArray(vtk_array(name, values, frame.units.get(name)))
    return sheet


def vtk_array(name: str, values: Field, unit: str | None = None) -> Any:
    """Returns an array of VTK; values in the plane are padded with zeros, to three and nine components."""
    from vtkmodules.util.numpy_support import numpy_to_vtk
    from vtkmodules.vtkCommonCore import vtkDataArray
    array = numpy_to_vtk(_spatial(values), deep=True)
    array.SetName(name)
    if unit is not None:
        array.GetInformation().Set(vtkDataArray.UNITS_LABEL(), unit)
    return array


def _spatial(values: Field) -> Field:
    """Pads vectors and tensors in the plane with zeros, to three and nine components."""
    padded = np.pad(values, [(0, 0)] + [(0, 1)] * (values.ndim - 1))
    return np.ascontiguousarray(padded.reshape(len(values), -1) if values.ndim == 3 else padded)


def read_near_tip(path: pathlib.Path) -> xarray.Dataset:
    """Reads the mean fields around the tip, `near_tip.vti` or `near_tip_folded.vti`.

    The fields have the dimensions ``Y``, ``X`` (undeformed, relative to the tip [m]), vectors also ``i``, tensors ``i``, ``J``
    (current index first), and each its unit in ``attrs["units"]``. ``attrs["samples"]`` is the number of samples. Raises
    UnreadableFile if the file is missing or damaged, LatconError if xarray is not installed.
    """
    library = optional_package("xarray", "fields near the tip need", "xarray (Debian: python3-xarray)")
    X, Y, fields, units, samples = read_image(path)
    dimensions = ("Y", "X", "i", "J")
    data: xarray.Dataset = library.Dataset(
        {name: (dimensions[:values.ndim], values, {"units": units[name]} if name in units else {})
         for name, values in fields.items()}, {"X": X, "Y": Y})
    for name in "XY":
        data[name].attrs["units"] = "m"
    if samples is not None:
        data.attrs["samples"] = samples
    return data


def read_image(path: pathlib.Path) -> tuple[Floats, Floats, dict[str, Any], dict[str, str], int | None]:
    """Reads mean fields around the tip: X, Y, fields by name on (Y, X), their units, number of samples; raises UnreadableFile
    if the file is missing or damaged.
    """
    image = read_vtk(path)
    columns, rows, _ = image.GetDimensions()
    fields, units = arrays_of(image.GetPointData())
    if not fields or columns * rows == 0:
        raise UnreadableFile(path, "damaged, or without fields")
    X, Y = (origin + spacing * np.arange(count)
            for origin, spacing, count in zip(image.GetOrigin(), image.GetSpacing(), (columns, rows)))
    samples = image.GetFieldData().GetArray("Samples")
    return (X, Y, {name: values.reshape(rows, columns, *values.shape[1:]) for name, values in fields.items()}, units,
            None if samples is None else int(samples.GetValue(0)))


def read_vtk(path: pathlib.Path, only: Collection[str] | None = None, is_strict: bool = False) -> Any:
    """Returns the data set in a VTK file, with the arrays of some names, or all. If `is_strict`, raises UnreadableFile for a file
    about which VTK has any complaint; others may have lost data then.
    """
    vtkIOXML = optional_package("vtkmodules.vtkIOXML", "frames need", "vtk (Debian: python3-vtk9)")
    from vtkmodules.vtkCommonCore import vtkLogger, vtkOutputWindow, vtkStringOutputWindow
    if not path.exists():
        raise UnreadableFile(path, "no such file")
    complaints = vtkStringOutputWindow()
    vtkOutputWindow.SetInstance(complaints)
    vtkLogger.SetStderrVerbosity(vtkLogger.VERBOSITY_OFF)
    reader = getattr(vtkIOXML, _READERS.get(path.suffix, "vtkXMLPolyDataReader"))()
    reader.SetFileName(os.fsencode(path))  # a name need not be UTF-8 text
    if is_strict and not reader.CanReadFile(os.fsencode(path)):
        raise UnreadableFile(path, "not a VTK file of the type that its name says")
    if is_strict and not _is_survived(reader.Update):
        raise UnreadableFile(path, "corrupt: invalid size of an array")
    if only is not None:
        reader.UpdateInformation()
        for selection in (reader.GetPointDataArraySelection(), reader.GetCellDataArraySelection()):
            for index in range(selection.GetNumberOfArrays()):
                selection.SetArraySetting(selection.GetArrayName(index), selection.GetArrayName(index) in only)
    reader.Update()
    # "ERROR: In FILE, line N\nvtkClass (ADDRESS): what is wrong\n\n"
    if is_strict and (error := re.search(r"^ERROR: In .*\n.*?\): ((?:.|\n)*?)\n\n", complaints.GetOutput(), re.MULTILINE)):
        raise UnreadableFile(path, "corrupt: " + error[1].replace("\n", " ").rstrip())
    if is_strict and (reader.GetErrorCode() or not reader.GetOutput().GetNumberOfPoints()):
        raise UnreadableFile(path, "truncated, or without points")
    return reader.GetOutput()


def _is_survived(act: Callable[[], Any]) -> bool:
    """Returns whether a child survives an act; exceptions of C++, as of an array of impossible size, would end this process."""
    if (child := os.fork()) == 0:
        try:
            faulthandler.disable()
            os.dup2(os.open(os.devnull, os.O_WRONLY), 2)
            resource.setrlimit(resource.RLIMIT_CORE, (0, 0))
            # More than any frame and what is mapped already, since threads reserve gigabytes that they never use.
            most = 2 * os.sysconf("SC_PAGE_SIZE") * os.sysconf("SC_PHYS_PAGES") + 2**34
            resource.setrlimit(resource.RLIMIT_AS, (most, most))
            act()
        finally:
            os._exit(0)
    return os.waitpid(child, 0)[1] == 0


def in_plane(values: Any) -> Any:
    """Returns the components in the plane of vectors and tensors."""
    if values.ndim == 2 and values.shape[1] == 3:
        return values[:, :2]
    return values.reshape(-1, 3, 3)[:, :2, :2] if values.ndim == 2 and values.shape[1] == 9 else values


def arrays_of(data: Any) -> tuple[dict[str, Any], dict[str, str]]:
    """Returns arrays by name, with the in-plane components of vectors and tensors, and the units of those that have one."""
    from vtkmodules.util.numpy_support import vtk_to_numpy
    from vtkmodules.vtkCommonCore import vtkDataArray
    arrays, units = {}, {}
    for index in range(data.GetNumberOfArrays()):
        array = data.GetArray(index)
        name, values = array.GetName(), vtk_to_numpy(array)
        arrays[name] = in_plane(values)
        if array.HasInformation() and (unit := array.GetInformation().Get(vtkDataArray.UNITS_LABEL())):
            units[name] = unit
    return arrays, units
