"""Frames of a lattice and of a continuum to compare: found by their names, read, and checked."""
from __future__ import annotations

import dataclasses
import math
import os
import pathlib
from collections.abc import Sequence
from typing import Any, NamedTuple

import numpy as np
from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkCommonDataModel import VTK_LAGRANGE_QUADRILATERAL, VTK_QUAD, vtkHigherOrderQuadrilateral

from .errors import UnreadableFile
from .files import read_series
from .frames import Floats, in_plane, read_vtk
from .interpolation import Indices
from .study.output import shortest


class Field(NamedTuple):
    """Field that frames of both sides have, with the same name."""

    name: str
    unit: str
    components: int  # in the plane
    is_from_bonds: bool  # on the lattice a sum or fit over the bonds of a site


FIELDS = (Field("displacement", "m", 2, False), Field("velocity", "m/s", 2, False), Field("deformation_gradient", "1", 4, True),
          Field("first_piola_stress", "Pa", 4, True), Field("cauchy_stress", "Pa", 4, True),
          Field("strain_energy_density", "J/m^3", 1, True))
_ENDINGS = {"lattice": (".vtp",), "continuum": (".vtu", ".pvtu")}
_OTHER = {"lattice": "continuum", "continuum": "lattice"}
_ORDER = "give the lattice first, then the continuum"
# Times are sums of time steps: the round-off of a million of them is half of 1e6 times 2^-52.
_TIME_TOLERANCE = 1e-9


def is_same_time(one: float, other: float) -> bool:
    """True if two times [s], or load factors, are equal but for round-off."""
    return abs(one - other) <= _TIME_TOLERANCE * max(abs(one), abs(other))


def list_of_times(times: Sequence[float]) -> str:
    """Lists times for a message, without the middle of many: "0, 0.5, 1"."""
    texts = [shortest(one) for one in times]
    return ", ".join(texts if len(texts) <= 9 else [*texts[:4], "...", *texts[-4:]])


class FrameFile(NamedTuple):
    """File of a frame, with the times of its series."""

    path: pathlib.Path
    time: float | None = None  # in the series [s], or load factor; None for a file given directly
    times: Sequence[float] = ()
    is_chosen: bool = False  # by a time for this side


def find_frame(name: str | os.PathLike[str], side: str, when: float | None = None) -> FrameFile:
    """Finds a frame of a side by the name of its file, its series (`.pvd`), or its output directory: at a time, or the last.

    Raises UnreadableFile, with the nearest times if there is none at this time.
    """
    path = series = pathlib.Path(name)
    if path.is_dir():
        series, other = path / f"{side}.pvd", path / f"{_OTHER[side]}.pvd"
        if not series.is_file():
            raise UnreadableFile(path, f"contains no {series.name}" + (f", but a {other.name}: {_ORDER}" if other.is_file() else ""))
    elif not path.is_file():
        raise UnreadableFile(path, "no such file")
    elif path.suffix != ".pvd":
        _require_side(path, side)
        return FrameFile(path, is_chosen=when is not None)
    entries = sorted(read_series(series), key=lambda entry: entry[0])
    if not entries:
        raise UnreadableFile(series, "contains no frames")
    times = [entry[0] for entry in entries]
    wanted = times[-1] if when is None else when
    found = [entry for entry in entries if is_same_time(entry[0], wanted)]
    if not found:
        nearest = sorted(sorted(times, key=lambda one: abs(one - wanted))[:3])
        raise UnreadableFile(series, f"no frame at {shortest(wanted)}; the nearest are at {list_of_times(nearest)}")
    if len(found) > 1:
        raise UnreadableFile(series, f"{len(found)} files at the time {shortest(wanted)}: give one of these files")
    [(own, path)] = found
    _require_side(path, side)
    if not path.is_file():
        raise UnreadableFile(path, f"does not exist, but {series} refers to it")
    return FrameFile(path, own, times, when is not None)


def _require_side(path: pathlib.Path, side: str) -> None:
    if path.suffix in _ENDINGS[_OTHER[side]]:
        raise UnreadableFile(path, f"a {_OTHER[side]} frame where a {side} frame is expected: {_ORDER}")
    if path.suffix not in _ENDINGS[side]:
        raise UnreadableFile(path, f"not a {side} frame: give a {' or '.join(_ENDINGS[side])} file, a .pvd or an output directory")


@dataclasses.dataclass
class SideFrame:
    """Frame of a side: `fields` by name, shape (points, components), at the undeformed `points` [m]."""

    file: FrameFile
    side: str
    data: Any  # of VTK
    time: float  # [s], or load factor
    points: Floats
    fields: dict[str, Floats] = dataclasses.field(default_factory=dict)
    kind: str = "motion"  # or "equilibrium"; "start" of either
    # Of a lattice: the sites at the ends of each bond; True at sites whose motion is prescribed; length of the shortest bond [m].
    bonds: Indices = dataclasses.field(default_factory=lambda: np.empty((0, 2), np.int64))
    held: Any = None
    spacing: float = 0.0
    cells: list[Indices] = dataclasses.field(default_factory=list)  # of a continuum, see interpolate()

    @property
    def bounds(self) -> Floats:
        """Low and high corner of the undeformed sheet [m]: those in the file of a lattice, which may end between its sites."""
        given = self.data.GetFieldData().GetArray("SheetBounds") if self.side == "lattice" else None
        return np.array(given.GetTuple(0)).reshape(2, 2).T if given else np.array((self.points.min(axis=0), self.points.max(axis=0)))


def read_side(file: FrameFile, side: str, when: float | None = None) -> SideFrame:
    """Reads a frame with the fields that are compared. It is of a motion if the lattice moves or the continuum has velocities.

    Raises UnreadableFile if it is damaged or incomplete, has a value that is not finite, or another time than `when`.
    """
    path, is_lattice = file.path, side == "lattice"
    data = read_vtk(path, is_strict=True)
    time = _time_of(file, data, when)
    points = vtk_to_numpy(data.GetPoints().GetData())[:, :2].astype(float)
    if not np.isfinite(points).all():
        raise UnreadableFile(path, "the position of a point is not finite")
    frame = SideFrame(file, side, data, time, points)
    bounds = data.GetFieldData().GetArray("SheetBounds")
    if is_lattice and bounds and (bounds.GetNumberOfComponents(), bounds.GetNumberOfTuples()) != (4, 1):
        raise UnreadableFile(path, "its field data 'SheetBounds' must be four numbers")
    has_velocity = is_lattice or data.GetPointData().GetArray("velocity") is not None
    for field in FIELDS:
        if has_velocity or field.name != "velocity":
            values = frame.fields[field.name] = _read_array(path, data, field.name, field.components)
            if n_bad := np.count_nonzero(~np.isfinite(values).all(axis=1)):
                raise UnreadableFile(path, f"'{field.name}' is not finite at {n_bad} of {len(values)} points")
    if not has_velocity or is_lattice and not frame.fields["velocity"].any():
        frame.kind = "start" if time == 0 else "equilibrium"
    if is_lattice:
        frame.held = _read_array(path, data, "held", 1)[:, 0] != 0
        _read_bonds(frame)
    else:
        _read_cells(frame)
    return frame


def _time_of(file: FrameFile, data: Any, when: float | None) -> float:
    """Returns the time in the series, otherwise that in the file."""
    if file.time is not None:
        return file.time
    array = data.GetFieldData().GetArray("TimeValue")
    if array is None or array.GetNumberOfTuples() != 1 or not math.isfinite(found := array.GetComponent(0, 0)):
        raise UnreadableFile(file.path, "has no field data 'TimeValue', so its time is unknown")
    if when is not None and not is_same_time(found, when):
        raise UnreadableFile(file.path, f"has the time {shortest(found)}, not {shortest(when)}")
    return found


def _read_array(path: pathlib.Path, data: Any, name: str, components: int) -> Floats:
    """Returns the components in the plane of point data; vectors and tensors have three and nine in the file."""
    array, expected = data.GetPointData().GetArray(name), {1: 1, 2: 3, 4: 9}[components]
    if array is None:
        raise UnreadableFile(path, f"has no point data '{name}'")
    if array.GetNumberOfComponents() != expected or array.GetNumberOfTuples() != data.GetNumberOfPoints():
        raise UnreadableFile(path, f"'{name}' has {array.GetNumberOfComponents()} components where {expected} are expected, or not a "
                             "value for every point")
    return in_plane(vtk_to_numpy(array)).reshape(-1, components).astype(float)


def _connectivity(frame: SideFrame, cells: Any) -> tuple[Indices, Indices]:
    """Returns the number of points of each cell, and the points of all cells."""
    sizes, points = np.diff(vtk_to_numpy(cells.GetOffsetsArray())), vtk_to_numpy(cells.GetConnectivityArray()).astype(np.int64)
    if sizes.sum() != len(points) or len(points) and not 0 <= points.min() <= points.max() < len(frame.points):
        raise UnreadableFile(frame.file.path, "corrupt: a cell refers to points that do not exist")
    return sizes, points


def _read_bonds(frame: SideFrame) -> None:
    sizes, points = _connectivity(frame, frame.data.GetLines())
    if (wrong := sizes[sizes != 2]).size:
        raise UnreadableFile(frame.file.path, f"a line has {wrong[0]} points, so it is not a bond")
    frame.bonds = points.reshape(-1, 2)
    if len(sizes):
        frame.spacing = float(np.hypot(*np.subtract(*frame.points[frame.bonds.T]).T).min())
    if not frame.spacing > 0:
        raise UnreadableFile(frame.file.path, "has no bonds, or a bond of zero length, so it is not a lattice")


def _read_cells(frame: SideFrame) -> None:
    sizes, points = _connectivity(frame, frame.data.GetCells())
    kinds, sides = vtk_to_numpy(frame.data.GetCellTypesArray()), np.rint(np.sqrt(sizes)).astype(np.int64)
    wrong = ~np.isin(kinds, (VTK_QUAD, VTK_LAGRANGE_QUADRILATERAL)) | (sides < 2) | (sides > 32) | (sides**2 != sizes)
    if wrong.any():
        raise UnreadableFile(frame.file.path, "has a cell that is not a quadrilateral of equal degree in both directions (VTK type "
                             f"{kinds[wrong][0]} with {sizes[wrong][0]} points)")
    if not len(sizes):
        raise UnreadableFile(frame.file.path, "has no cells")
    begin = np.cumsum(sizes) - sizes
    for n in map(int, np.unique(sides)):
        order = [vtkHigherOrderQuadrilateral.PointIndexFromIJK(i, j, (n - 1, n - 1)) for j in range(n) for i in range(n)]
        frame.cells.append(points[begin[sides == n][:, None] + order])
