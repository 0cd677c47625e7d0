"""Readers of single files of a run; errors name the file."""
from __future__ import annotations

import csv
import io
import json
import pathlib
from collections.abc import Callable, Mapping, Sequence
from typing import TYPE_CHECKING, Any, TypeVar
from xml.etree import ElementTree

import numpy as np

from .errors import UnreadableFile

if TYPE_CHECKING:
    import pandas as pd

Result = TypeVar("Result")


def read_text(path: pathlib.Path) -> str:
    """Returns the text of a file.

    Raises
    ------
    UnreadableFile
        If it is missing, cannot be read, or is not UTF-8 text.
    """
    try:
        return path.read_text(encoding="utf-8")
    except OSError as error:
        raise UnreadableFile(path, error.strerror or str(error)) from error
    except UnicodeDecodeError as error:
        raise UnreadableFile(path, f"not UTF-8 text (byte {error.start})") from error


def read_json(path: pathlib.Path) -> dict[str, Any]:
    """Returns the object in a JSON file.

    Raises
    ------
    UnreadableFile
        If it is missing or damaged, or does not contain an object.
    """
    try:
        value = json.loads(read_text(path))
    except ValueError as error:
        raise UnreadableFile(path, f"not JSON: {error}") from error
    if not isinstance(value, dict):
        raise UnreadableFile(path, "not a JSON object")
    return value


def read_table(path: pathlib.Path, units: Mapping[str, str]) -> pd.DataFrame:
    """Returns the table in a CSV file of numbers.

    Parameters
    ----------
    path
        The file.
    units
        Unit of each column; those of the columns that the file has become ``attrs["units"]``.

    Raises
    ------
    UnreadableFile
        If it is missing, a cell is not a number, or rows differ in length.
    """
    import pandas as pd
    text = read_text(path)
    lines = text.splitlines()
    if not lines:
        raise UnreadableFile(path, "empty")
    columns = lines[0].count(",")
    for number, line in enumerate(lines[1:], start=2):
        if line.count(",") != columns:
            raise UnreadableFile(path, f"line {number} has {line.count(',') + 1} fields, the header has {columns + 1}")
    try:
        # The default converter is fast and may be off by the last bit.
        table = pd.read_csv(io.StringIO(text), float_precision="round_trip")
    except ValueError as error:
        raise UnreadableFile(path, f"not a table: {error}") from error
    for name in table:
        if len(table) and not pd.api.types.is_numeric_dtype(table[name]):
            raise UnreadableFile(path, f"column {name!r} has a cell that is not a number")
    table.attrs["units"] = {name: units[name] for name in table if name in units}
    return table


def read_columns(path: pathlib.Path, columns: Sequence[str], texts: Sequence[str] = (), finite: bool = True) -> dict[str, Any]:
    """Returns columns of a CSV file as arrays by name; other columns are ignored.

    Parameters
    ----------
    columns
        Columns of numbers, all finite if `finite`.
    texts
        Columns of words.

    Raises
    ------
    UnreadableFile
        If it is missing, lacks a column, or a cell is not such a number.
    """
    rows = list(csv.reader(read_text(path).splitlines()))
    header = rows[0] if rows else []
    if missing := [name for name in (*texts, *columns) if name not in header]:
        raise UnreadableFile(path, f"has no column {missing[0]!r}")
    places = [header.index(name) for name in columns]
    values = np.empty((len(rows) - 1, len(columns)))
    for line, row in enumerate(rows[1:], start=2):
        if len(row) != len(header):
            raise UnreadableFile(path, f"line {line} has {len(row)} fields, the header has {len(header)}")
        try:
            values[line - 2] = [float(row[place]) for place in places]
        except ValueError as error:
            raise UnreadableFile(path, f"line {line}: {error}") from error
        if finite and not np.isfinite(values[line - 2]).all():
            raise UnreadableFile(path, f"line {line} holds a number that is not finite")
    words = {name: np.array([row[header.index(name)] for row in rows[1:]], dtype=object) for name in texts}
    return {**words, **dict(zip(columns, values.T))}


def if_present(read: Callable[..., Result], path: pathlib.Path, *arguments: Any, **options: Any) -> Result | None:
    """Returns what a reader returns for a file; None if there is no such file."""
    return read(path, *arguments, **options) if path.exists() else None


def read_series(path: pathlib.Path) -> list[tuple[float, pathlib.Path]]:
    """Returns times [s] and files of the frames listed in a `.pvd`.

    Raises
    ------
    UnreadableFile
        If it is missing or damaged.
    """
    try:
        return [(float(frame.attrib["timestep"]), path.parent / frame.attrib["file"])
                for frame in ElementTree.fromstring(read_text(path)).iter("DataSet")]
    except ElementTree.ParseError as error:
        raise UnreadableFile(path, f"not XML: {error}") from error
    except (KeyError, ValueError) as error:
        raise UnreadableFile(path, f"a DataSet has no time or file: {error}") from error
