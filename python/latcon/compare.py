"""``latcon compare``; of two cracks: quantities, entries of their cases, distance of their paths."""
from __future__ import annotations

import dataclasses
import json
import math
import os
import pathlib
from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np

from .errors import CLAIM_FAILED, DONE, optional_package
from .files import read_columns, read_json
from .folder import write_file
from .frames import Floats
from .quantities import quantity_text
from .rows import text_table
from .study.outcome import measured_values, unfit_rows
from .study.output import csv_text
from .study.plan import zeta_of
from .study.program import InputError, Program, require_access
from .study.record import Printed, Record, draw_page

SIDES = ("first", "second")
_PARTS = ("first", "first_uncertainty", "second", "second_uncertainty", "difference", "difference_over_uncertainty")


@dataclasses.dataclass
class _Crack:
    """Measured crack of a run."""

    name: str  # of the directory, as given
    pattern: str
    side: str
    problem: str  # rows that make it unfit as a measurement; empty if there are none
    entries: dict[str, str]
    spacing: float  # [m]
    values: dict[str, float]
    X: Floats
    Y: Floats


def compare(program: Program, printed: Printed, options: Mapping[str, Any]) -> int:
    """Compares two cracks or two frames. Returns the exit code; raises LatconError for invalid options or files."""
    names = options["first"], options["second"]
    for name in names:
        require_access(name)
    cracks = [os.path.isfile(os.path.join(name, "crack.json")) for name in names]
    if all(cracks):
        if any(options[name] for name in ("time", "lattice_time", "continuum_time", "tolerances", "excluded", "overlap")):
            raise InputError("--time, --lattice-time, --continuum-time, --tolerance, --overlap and --exclude are for frames, and "
                             f"{names[0]} and {names[1]} are two cracks; to compare frames, give their files")
        if any(is_same_folder(options["output_dir"], name) for name in names):
            raise InputError(f"--output-dir {options['output_dir']} is one of the runs, whose run.json would be lost: give another")
        return _compare_cracks(program, printed, options)
    if cracks[1] or cracks[0] and os.path.isdir(names[1]) and not os.path.exists(os.path.join(names[1], "continuum.pvd")):
        raise InputError(", ".join(f"{name} holds a crack (crack.json)" if is_crack else f"{name} holds no crack.json"
                                   for name, is_crack in zip(names, cracks))
                         + "; give two output directories of cracks, or a lattice frame and a continuum frame in this order")
    optional_package("vtkmodules.vtkIOXML", "the comparison of frames needs", "vtk (Debian: python3-vtk9)")
    from .compare_frames import compare_frames
    return compare_frames(program, printed, options)


def is_same_folder(one: str, other: str | os.PathLike[str]) -> bool:
    """True if both exist and are the same."""
    return os.path.exists(one) and os.path.exists(other) and os.path.samefile(one, other)


def _compare_cracks(program: Program, printed: Printed, options: Mapping[str, Any]) -> int:
    directory = options["output_dir"]
    cracks = [_read_crack(program, options[side]) for side in SIDES]
    quantities, paths = _quantities(program, cracks), path_distance(*((crack.X, crack.Y) for crack in cracks))
    one, other = (crack.entries for crack in cracks)
    entries = [{"key": key, "unit": (program.entries[key].unit or "") if key in program.entries else "", "first": one.get(key, ""),
                "second": other.get(key, "")} for key in sorted({**one, **other}) if one.get(key) != other.get(key)]
    printed.say(_text(cracks, quantities, entries, paths))
    if options["dry_run"]:
        return DONE
    record = Record(program, printed, directory, options, False)
    record.add(first_run=cracks[0].name, second_run=cracks[1].name)
    both = {name: {side: getattr(crack, name) for side, crack in zip(SIDES, cracks)} for name in ("side", "problem", "pattern")}
    document = {**{side: crack.name for side, crack in zip(SIDES, cracks)},
                **{f"{side}_folder": os.path.relpath(os.path.realpath(crack.name), os.path.realpath(directory))
                   for side, crack in zip(SIDES, cracks)},
                "side": both["side"], "failed_checks": both["problem"], "pattern": both["pattern"], "quantities": quantities,
                "entries": entries, "paths": paths and paths | {
                    f"{name}_over_d": paths[name] / cracks[0].spacing for name in ("rms_distance", "largest_distance")}}
    # Names of folders need not be UTF-8; in ASCII the page finds their other bytes as \udcXX.
    write_file(f"{directory}/compare.json", json.dumps(document, indent=2) + "\n")
    write_file(f"{directory}/compare.csv", csv_text(
        ["quantity", "unit", *_PARTS], [[row["name"], row["unit"], *(row[part] for part in _PARTS)] for row in quantities]))
    code = record.end([], DONE)
    is_drawn = not options["no_report"] and draw_page("compare", directory, "compare.html", "repeat the command")
    printed.say(f"\n{directory}/compare.json, compare.csv{', compare.html' if is_drawn else ''}")
    return code


def _read_crack(program: Program, name: str) -> _Crack:
    folder = pathlib.Path(name)
    info, crack = read_json(folder / "run.json"), read_json(folder / "crack.json")
    pattern, entries = crack.get("pattern"), info.get("entries", {})
    if info.get("exit_code") not in (DONE, CLAIM_FAILED) or not isinstance(pattern, str) or not pattern:
        raise InputError(f"{name}: its crack was not measured; crack.json or run.json is damaged, or the run has not ended")
    try:
        spacing, zeta = float(entries["Sheet/spacing"]), zeta_of(entries)
    except (KeyError, TypeError, ValueError):
        raise InputError(f"{folder / 'run.json'}: does not hold the entries of the case") from None
    path = read_columns(folder / "crack.csv", ("X", "Y"))
    if (back := np.flatnonzero(np.diff(path["X"]) < 0)).size:
        raise InputError(f"{folder / 'crack.csv'}: line {back[0] + 3}: damaged: X decreases")
    # Cracks of the lattice do not name their side.
    side, problem = crack.get("side", "lattice"), unfit_rows(info) if info["exit_code"] == CLAIM_FAILED else ""
    values = measured_values(program, name, spacing) | ({} if zeta is None else {"zeta": zeta})
    return _Crack(name, pattern, side, problem, entries, spacing, values, path["X"], path["Y"])


def _quantities(program: Program, cracks: Sequence[_Crack]) -> list[dict[str, Any]]:
    """Returns the quantities that at least one crack has, with uncertainties of one standard deviation."""
    rows = []
    for name, unit in program.units.items():
        (one, one_sigma), (other, other_sigma) = (
            (crack.values.get(name), crack.values.get(f"{name}_uncertainty")) for crack in cracks)
        if name.endswith("_uncertainty") or one is None and other is None:
            continue
        difference = None if one is None or other is None else other - one
        combined = 0.0 if one_sigma is None or other_sigma is None else math.hypot(one_sigma, other_sigma)
        rows.append({"name": name, "unit": unit, "first": one, "first_uncertainty": one_sigma, "second": other,
                     "second_uncertainty": other_sigma, "difference": difference,
                     "difference_over_uncertainty": difference / combined if difference is not None and combined > 0 else None})
    return rows


def path_distance(first: tuple[Floats, Floats], second: tuple[Floats, Floats]) -> dict[str, float] | None:
    """Returns the distance along Y between two paths (X, Y) [m], over the X that both cover; None if there is none.

    Points between those of a path, whose X does not decrease, are interpolated linearly.
    """
    if not all(len(X) for X, _ in (first, second)):
        return None
    begin, end = max(X[0] for X, _ in (first, second)), min(X[-1] for X, _ in (first, second))
    if not end > begin:
        return None
    at = np.sort(np.concatenate(([begin, end], *(X[(X > begin) & (X < end)] for X, _ in (first, second)))))
    apart = _heights(second, at) - _heights(first, at)
    largest = int(np.argmax(np.abs(apart)))
    a, b = apart[:-1], apart[1:]
    integral = np.cumsum(np.diff(at) * (b * b + b * a + a * a) / 3)[-1]  # the square of a linear function
    return {"X_begin": float(begin), "X_end": float(end), "rms_distance": math.sqrt(integral / (end - begin)),
            "largest_distance": float(abs(apart[largest])), "largest_distance_X": float(at[largest])}


def _heights(path: tuple[Floats, Floats], at: Floats) -> Floats:
    """Returns Y of a path at X that it covers; of several points at one X the first counts."""
    X, Y = path
    after = np.searchsorted(X, at)
    before = np.maximum(after - 1, 0)
    width = np.where(X[after] > X[before], X[after] - X[before], 1.0)
    between = Y[before] + (Y[after] - Y[before]) * (at - X[before]) / width
    return np.where((X[after] == at) | (after == 0), Y[after], between)


def _text(cracks: Sequence[_Crack], quantities: Sequence[Mapping[str, Any]], entries: Sequence[Mapping[str, str]],
          paths: Mapping[str, float] | None) -> str:
    def cell(row: Mapping[str, Any], part: str) -> str:
        return "-" if row[part] is None else quantity_text(row[part], row.get(f"{part}_uncertainty"), row["unit"])

    names = [crack.name for crack in cracks]
    rows = [["quantity", *names, "difference", "/ uncertainty"]]
    for name in ("side", "pattern"):
        values = [getattr(crack, name) for crack in cracks]
        if name == "pattern" or values[0] != values[1]:
            rows.append([name, *values, "none" if values[0] == values[1] else "differs", ""])
    for row in quantities:
        ratio = row["difference_over_uncertainty"]
        rows.append([row["name"], *(cell(row, part) for part in (*SIDES, "difference")), "" if ratio is None else f"{ratio:+.1f}"])
    text = text_table(rows[0], rows[1:], ()) + "\n\n"
    text += "".join(f"{crack.name} failed its checks, and is no measurement: {crack.problem}\n"
                    for crack in cracks if crack.problem)
    if entries:
        units = ["" if entry["unit"] == "1" else entry["unit"] for entry in entries]
        text += text_table(["entry", *names, "unit"], [[entry["key"], entry["first"], entry["second"], unit]
                                                       for entry, unit in zip(entries, units)], ()) + "\n"
    else:
        text += "The cases have the same entries.\n"
    if not paths:
        return text + "\nThe paths have no stretch of X in common."
    begin, end, at = (quantity_text(paths[name], None, "m") for name in ("X_begin", "X_end", "largest_distance_X"))
    rms, largest = (f"{quantity_text(paths[name], None, 'm')} ({paths[name] / cracks[0].spacing:.3g} d)"
                    for name in ("rms_distance", "largest_distance"))
    return text + f"\nDistance between the paths, X from {begin} to {end}: rms {rms}, largest {largest} at X = {at}"
