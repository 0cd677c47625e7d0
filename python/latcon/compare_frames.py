"""``latcon compare`` of a lattice frame and a continuum frame: differences of their fields at the sites, and norms of these."""
from __future__ import annotations

import dataclasses
import math
import time
from collections.abc import Iterable, Mapping, Sequence
from typing import Any

import numpy as np
from scipy.spatial import cKDTree
from vtkmodules.vtkCommonDataModel import vtkPolyData
from vtkmodules.vtkIOXML import vtkXMLPolyDataWriter, vtkXMLUnstructuredGridWriter

from .compare import is_same_folder
from .errors import DONE
from .folder import write_file
from .frames import Floats, vtk_array
from .interpolation import interpolate
from .rows import judged_row
from .side_frames import FIELDS, Field, SideFrame, find_frame, is_same_time, list_of_times, read_side
from .study.output import shortest
from .study.program import InputError, Program
from .study.record import Printed, Record, table_of_rows

_SIDES = {"first": "lattice", "second": "continuum"}
_LOAD = "load: displacement of held sites on the edges, largest difference"


@dataclasses.dataclass
class Comparison:
    """Fields of the continuum at the sites, and the differences, lattice minus continuum: NaN where no cell is."""

    fields: tuple[Field, ...]
    continuum: dict[str, Floats]
    difference: dict[str, Floats]
    outside: Any  # True at sites outside of the continuum
    complete: Any  # at sites with all bonds, that is, as many as any
    excluded: Any  # at sites in an excluded circle
    free: Any  # at sites that are compared, for fields from bonds if they are complete

    def compared(self, field: Field) -> Any:
        """Returns which sites are compared."""
        return self.free & self.complete if field.is_from_bonds else self.free


def compare_frames(program: Program, printed: Printed, options: Mapping[str, Any]) -> int:
    """Compares two frames, as the options say. Returns the exit code; raises LatconError for invalid options or files."""
    directory, both_times = options["output_dir"], options["time"]
    if both_times and (options["lattice_time"] or options["continuum_time"]):
        raise InputError("--time is for both sides: give it, or --lattice-time and --continuum-time")
    tolerances, circles = _tolerances(program, options["tolerances"]), _circles(program, options["excluded"])
    times = {side: _time(program, *(("--time", both_times) if both_times else (f"--{side}-time", options[f"{side}_time"])))
             for side in _SIDES.values()}
    clock = [time.monotonic()]
    files = {side: find_frame(options[name], side, times[side]) for name, side in _SIDES.items()}
    # Only times given for each side by itself may differ.
    lattice, continuum = (read_side(file._replace(is_chosen=file.is_chosen and not both_times), side, times[side])
                          for side, file in files.items())
    clock.append(time.monotonic())
    require_same_time(lattice, continuum)
    if not options["overlap"]:
        require_same_bounds(lattice, continuum)
    for frame in (lattice, continuum):
        if is_same_folder(directory, frame.file.path.parent):
            raise InputError(f"--output-dir {directory} is where {frame.file.path.name} is from, whose run.json and results.json "
                             "would be lost: give another")
    comparison = compare_fields(lattice, continuum, options["overlap"], circles)
    rows = norms(lattice, continuum, comparison, tolerances)
    clock.append(time.monotonic())
    if options["dry_run"]:
        printed.say(f"# lattice: {lattice.file.path}, {len(lattice.points)} sites\n# continuum: {continuum.file.path}, "
                    f"{sum(map(len, continuum.cells))} cells")
        return DONE
    record = Record(program, printed, directory, options, False)
    record.add(lattice_frame=str(lattice.file.path), continuum_frame=str(continuum.file.path))
    _write_difference(directory, lattice, continuum, comparison)
    clock.append(time.monotonic())
    for phase, seconds in zip(("reading", "comparing", "output"), np.diff(clock)):
        record.add_time(phase, float(seconds))
    printed.say(table_of_rows(rows))
    return record.end(rows, DONE)


def _numbers(program: Program, texts: Sequence[str], unit: str) -> list[tuple[float, str]]:
    """Returns numbers in an SI unit, each with what is wrong with its text."""
    return [(number["value"], number["wrong"]) for number in program.ask(numbers=list(texts), unit=unit)]


def _time(program: Program, option: str, text: str) -> float | None:
    """Reads a time [s], or load factor; None for an empty text."""
    if not text:
        return None
    [(value, wrong)] = _numbers(program, [text], "s")
    if wrong:
        raise InputError(f"{option} {text}: {wrong}")
    return value


def _tolerances(program: Program, texts: Sequence[str]) -> dict[str, float]:
    tolerances, problems, names = {}, [], [field.name for field in FIELDS]
    for text in texts:
        name, is_given, number = text.partition("=")
        if not is_given or name not in names:
            problems.append(f"--tolerance {text}: FIELD=VALUE is wanted, FIELD one of {', '.join(names)}")
            continue
        [(tolerances[name], wrong)] = _numbers(program, [number], "1")
        if wrong or not tolerances[name] > 0:
            problems.append(f"--tolerance {text}: {wrong or 'must be larger than 0'}")
    if problems:
        raise InputError(*problems)
    return tolerances


def _circles(program: Program, texts: Sequence[str]) -> list[list[float]]:
    """Returns circles in the undeformed sheet: X, Y of the centre and radius [m]."""
    circles, problems = [], []
    for text in texts:
        numbers = _numbers(program, text.split(","), "m")
        circles.append([value for value, _ in numbers])
        wrong = [problem for _, problem in numbers if problem]
        if len(numbers) != 3:
            wrong.append("X,Y,R is wanted, three lengths")
        elif not numbers[2][0] > 0:
            wrong.append("the radius must be larger than 0")
        problems += [f"--exclude {text}: {problem}" for problem in wrong]
    if problems:
        raise InputError(*problems)
    return circles


def _refusal(lattice: SideFrame, continuum: SideFrame, problem: str) -> InputError:
    return InputError(f"{lattice.file.path} and {continuum.file.path}: {problem}")


def require_same_time(lattice: SideFrame, continuum: SideFrame) -> None:
    """Raises InputError if one frame moves and the other is in equilibrium, or their times differ, unless the user gave both times."""
    if lattice.file.is_chosen and continuum.file.is_chosen:
        return
    both = lattice, continuum
    advice = "".join(f"\ntimes of the {frame.side}: {list_of_times(frame.file.times)}" for frame in both if len(frame.file.times) > 1)
    advice += "\nto compare these frames anyway, give both --lattice-time and --continuum-time"
    if {frame.kind for frame in both} == {"motion", "equilibrium"}:
        moving, resting = sorted(both, key=lambda frame: frame.kind, reverse=True)
        raise _refusal(*both, f"the {moving.side} is in motion and the {resting.side} in equilibrium{advice}")
    if not is_same_time(lattice.time, continuum.time):
        raise _refusal(*both, f"the times differ: {shortest(lattice.time)} of the lattice, {shortest(continuum.time)} of the continuum"
                       + advice)


def position_tolerance(continuum: SideFrame) -> float:
    """Returns 1e-6 of the larger side of the sheet [m]. Positions in .vtu files have single precision (6e-8), and meshes of other
    programs six digits (5e-7).
    """
    return float(1e-6 * np.ptp(continuum.bounds, axis=0).max())


def require_same_bounds(lattice: SideFrame, continuum: SideFrame) -> None:
    """Raises InputError, with a likely reason, if two undeformed sheets do not have the same bounds."""
    here, there, tolerance = lattice.bounds, continuum.bounds, position_tolerance(continuum)
    if abs(here - there).max() <= tolerance:
        return
    size, other_size = here[1] - here[0], there[1] - there[0]
    with np.errstate(all="ignore"):
        ratio, ratio_y = other_size / size
    why = ""
    if _is_ratio_of_units(ratio) and abs(ratio_y / ratio - 1) < 0.05:
        why = f": {ratio:.6g} times as large in both directions, so one of them is not in metres"
    elif (abs(other_size - size[::-1]) <= tolerance).all():
        why = ": x and y are exchanged"
    spans = ["{0:.6g} to {2:.6g} m by {1:.6g} to {3:.6g} m".format(*bounds.ravel()) for bounds in (here, there)]
    raise _refusal(lattice, continuum, f"not the same sheet: the lattice spans {spans[0]}, the continuum {spans[1]}{why}")


def _is_ratio_of_units(ratio: float) -> bool:
    """True if a ratio is that of a unit with a prefix to the unit itself, to 5 %."""
    return any(abs(r / units - 1) < 0.05 for units in (1e2, 1e3, 1e6, 1e9) for r in (ratio, ratio and 1 / ratio))


def compare_fields(lattice: SideFrame, continuum: SideFrame, is_overlap: bool = False, circles: Iterable[Sequence[float]] = ()
                   ) -> Comparison:
    """Evaluates the continuum at the sites and computes the differences. Sheets that overlap may lack parts of each other; sites
    in circles (X, Y, radius) [m] are not compared.

    Raises InputError if a part of one sheet is missing in the other, no site can be compared, or a field seems to have other units.
    """
    values, outside = interpolate(lattice.points, continuum.points, np.hstack(list(continuum.fields.values())), continuum.cells,
                                  position_tolerance(continuum))
    n_bonds = np.bincount(lattice.bonds.ravel(), minlength=len(lattice.points))
    if not is_overlap:
        _require_no_missing_part(lattice, continuum, outside, n_bonds > 0)
    ends = np.cumsum([field.shape[1] for field in continuum.fields.values()])
    there = dict(zip(continuum.fields, np.split(values, ends[:-1], axis=1)))
    excluded = np.zeros(len(lattice.points), bool)
    for X, Y, radius in circles:
        excluded |= np.hypot(*(lattice.points - (X, Y)).T) <= radius
    comparison = Comparison(tuple(field for field in FIELDS if field.name in there), there,
                            {name: lattice.fields[name] - there[name] for name in there}, outside, n_bonds == n_bonds.max(), excluded,
                            ~outside & ~excluded & ~lattice.held)
    for name, sites in [(field.name, comparison.compared(field)) for field in comparison.fields]:
        if not sites.any():
            raise _refusal(lattice, continuum, f"'{name}' cannot be compared: no free site inside the continuum and outside the "
                           "excluded circles has all its bonds")
    for field in comparison.fields:
        one, other = (side[field.name][comparison.compared(field)].ravel() for side in (lattice.fields, there))
        size, other_size = (float(np.linalg.norm(values)) for values in (one, other))
        # Proportional fields, with a ratio that indicates another unit.
        if size > 0 and one @ other > 0.95 * size * other_size and _is_ratio_of_units(other_size / size):
            raise _refusal(lattice, continuum, f"'{field.name}' of the continuum is {other_size / size:.6g} times that of the lattice: "
                           f"different units? Both must be in {field.unit}")
    return comparison


def _require_no_missing_part(lattice: SideFrame, continuum: SideFrame, outside: Any, has_bonds: Any) -> None:
    # A site at the rim of a curved hole may be outside because of rounding, but then some of its neighbours are inside.
    is_missing = outside & has_bonds
    for one, other in (lattice.bonds.T, lattice.bonds.T[::-1]):
        is_missing[one[~outside[other]]] = False
    if is_missing.any():
        X, Y = lattice.points[np.argmax(is_missing)]
        raise _refusal(lattice, continuum, f"not the same sheet: the continuum has no cell at the site ({X:.6g}, {Y:.6g}) m, nor at its "
                       "neighbours")
    far = 2 * lattice.spacing  # in a complete lattice every point of the sheet is within one spacing of a site
    is_far = np.isinf(cKDTree(lattice.points).query(continuum.points, distance_upper_bound=far)[0])
    if is_far.any():
        X, Y = continuum.points[np.argmax(is_far)]
        raise _refusal(lattice, continuum, f"not the same sheet: the lattice has no site within {far:.6g} m of the continuum's node "
                       f"({X:.6g}, {Y:.6g}) m")


def norms(lattice: SideFrame, continuum: SideFrame, comparison: Comparison, tolerances: Mapping[str, float]) -> list[dict[str, Any]]:
    """Returns rows on the compared sites, on whether the sheets have the same load, and of each field the largest and the
    root-mean-square difference, relative to the larger of these norms of the two sides.

    The norm of tensors and vectors is the root of the sum of squares of their components in the plane, for deformation_gradient of
    F - 1. The loads are the same if the lattice's sites on edges that are held all along have the same displacement to 1e-4 of the
    largest; sheets without such edges have no such row. `tolerances` are of root-mean-square differences, by field.
    """
    for name in tolerances:
        if name not in continuum.fields:
            raise InputError(f"--tolerance: '{name}' is not in {continuum.file.path}")
    rows: list[dict[str, Any]] = []

    def add(quantity: str, unit: str, numbers: Iterable[float], tolerance: float | None = None, reason: str = "") -> None:
        values: list[Any] = [*numbers, None, None]
        here, there, difference = values[:3]
        error = difference and difference / float(np.max((here, there)))
        rows.append(judged_row("compare", quantity, unit, float(here), there, error=error, tolerance=tolerance, reason=reason))

    free = comparison.free
    for what, sites in (("sites", np.ones_like(free)), ("sites outside the finite element sheet", comparison.outside),
                        ("sites in excluded circles", comparison.excluded), ("free sites inside", free),
                        ("free sites inside with all their bonds", free & comparison.complete)):
        add(what, "1", [np.count_nonzero(sites)])
    moves = "motion" in (lattice.kind, continuum.kind)
    add("time" if moves else "load factor", "s" if moves else "1", (lattice.time, continuum.time))
    sides = lattice.fields, comparison.continuum, comparison.difference
    is_on = abs(lattice.points - continuum.bounds[:, None]) <= position_tolerance(continuum)
    # Without edges that are free but for their ends, which other edges hold.
    is_on &= (lattice.held[:, None] | ~is_on).all(axis=1, keepdims=True)
    held = is_on.any(axis=(0, 2)) & ~comparison.outside & ~comparison.excluded
    if held.any():
        add(_LOAD, "m", [_norms(side["displacement"][held])[0] for side in sides], 1e-4,
            "positions in files: 1e-6 of the longer side, at most a hundred times the shorter")
    for field in comparison.fields:
        values = [side[field.name][comparison.compared(field)] for side in sides]
        name = field.name
        if name == "deformation_gradient":
            name += " less identity"
            values[:2] = [value - (1, 0, 0, 1) for value in values[:2]]
        largest, rms = zip(*map(_norms, values))
        add(f"{name}, largest difference", field.unit, largest)
        add(f"{name}, rms difference", field.unit, rms, tolerances.get(field.name))
    return rows


def _norms(values: Floats) -> tuple[float, float]:
    """Returns the largest norm and the root mean square of the norms; NaN if a value is."""
    squares = np.cumsum(values**2, axis=1)[:, -1]
    return math.sqrt(squares.max()), math.sqrt(np.cumsum(squares)[-1] / len(squares))


def _write_difference(directory: str, lattice: SideFrame, continuum: SideFrame, comparison: Comparison) -> None:
    """Writes the comparison for ParaView; the series last, so that the files it refers to exist."""
    sites = vtkPolyData()
    sites.ShallowCopy(lattice.data)
    arrays = {f"{field.name}_{side}": getattr(comparison, side)[field.name].reshape(-1, *{1: (), 2: (2,), 4: (2, 2)}[field.components])
              for side in ("continuum", "difference") for field in comparison.fields}
    arrays |= {name: getattr(comparison, name).astype(np.uint8) for name in ("outside", "complete", "excluded")}
    for name, values in arrays.items():
        sites.GetPointData().AddArray(vtk_array(name, values))
    parts = ""
    for part, (name, data, writer) in enumerate((("difference_sites.vtp", sites, vtkXMLPolyDataWriter()),
                                                 ("difference_continuum.vtu", continuum.data, vtkXMLUnstructuredGridWriter()))):
        writer.SetInputData(data)
        writer.SetDataModeToAppended()
        writer.EncodeAppendedDataOff()
        writer.SetCompressorTypeToZLib()
        writer.WriteToOutputStringOn()
        if not writer.Write():
            raise OSError(0, "VTK cannot write it", f"{directory}/{name}")
        write_file(f"{directory}/{name}", writer.GetOutputString())
        parts += f'    <DataSet timestep="{shortest(lattice.time)}" part="{part}" file="{name}"/>\n'
    write_file(f"{directory}/difference.pvd", '<?xml version="1.0"?>\n<VTKFile type="Collection" version="0.1" '
               f'byte_order="LittleEndian">\n  <Collection>\n{parts}  </Collection>\n</VTKFile>\n')
