"""Readers of single files of a run. All raise UnreadableFile if the file is missing or damaged."""
from __future__ import annotations

import csv
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
    """Returns the UTF-8 text of a file."""
    try:
        return path.read_text(encoding="utf-8")
    except OSError as error:
        raise UnreadableFile(path, error.strerror or str(error)) from error
    except UnicodeDecodeError as error:
        raise UnreadableFile(path, f"not UTF-8 text (byte {error.start})") from error


def read_json(path: pathlib.Path) -> dict[str, Any]:
    """Returns the object in a JSON file."""
    try:
        value = json.loads(read_text(path))
    except ValueError as error:
        raise UnreadableFile(path, f"not JSON: {error}") from error
    if not isinstance(value, dict):
        raise UnreadableFile(path, "not a JSON object")
    return value


def content(path: str) -> str:
    """Returns the text of a file; empty if it cannot be read."""
    try:
        return pathlib.Path(path).read_bytes().decode("utf-8", "replace")
    except OSError:
        return ""


def object_in(path: str) -> dict[str, Any]:
    """Returns the object in a JSON file; empty if there is none."""
    try:
        document = json.loads(content(path))
    except ValueError:
        return {}
    return document if isinstance(document, dict) else {}


def read_rows(path: pathlib.Path) -> list[dict[str, Any]]:
    """Returns the rows of a `results.json`: claim, quantity, unit and verdict; numbers, None where they do not apply."""
    rows = read_json(path).get("claims")
    if not isinstance(rows, list):
        raise UnreadableFile(path, 'the list "claims" is missing')
    found = []
    for number, row in enumerate(rows, start=1):
        where = f"row {number} of \"claims\""
        try:
            texts = {key: row[key] for key in ("claim", "quantity", "unit", "verdict")}
            numbers = {key: checked_number(path, f"{where}: {key}", row[key])
                       for key in ("lattice", "continuum", "theory", "error", "tolerance")}
        except (KeyError, TypeError) as error:
            raise UnreadableFile(path, f"{where} lacks {error}") from error
        for key, value in texts.items():
            if not isinstance(value, str):
                raise UnreadableFile(path, f"{where}: {key} is {value!r}, not a string")
        found.append({**texts, **numbers})
    return found


def checked_number(path: pathlib.Path, what: str, value: Any) -> float | None:
    """Returns a number as the program writes it: null for none, the strings "nan", "inf", "-inf" for those that are not finite."""
    if value is None:
        return None
    if value in ("nan", "inf", "-inf") or isinstance(value, (int, float)) and not isinstance(value, bool):
        return float(value)
    raise UnreadableFile(path, f"{what} is {value!r}, not a number")


def read_table(path: pathlib.Path, units: Mapping[str, str], other: str = "") -> pd.DataFrame:
    """Returns the table in a CSV file of numbers; columns of whole numbers are integers. The units of the columns, of those
    without one `other`, become ``attrs["units"]``.
    """
    import pandas as pd
    columns = read_columns(path, None, finite=False)
    whole = [name for name, values in columns.items() if (values == np.floor(values)).all() and (np.abs(values) < 2**53).all()]
    table = pd.DataFrame(columns).astype(dict.fromkeys(whole, np.int64))
    table.attrs["units"] = {name: units.get(name, other) for name in table if other or name in units}
    return table


def read_columns(path: pathlib.Path, columns: Sequence[str] | None, texts: Sequence[str] = (), finite: bool = True
                 ) -> dict[str, Any]:
    """Returns columns of numbers of a CSV file as arrays by name, and columns `texts` of words; other columns are ignored.
    columns: None for all, those of `texts` that there are being of words. Damaged is also a file with numbers that are not
    finite, if `finite`.
    """
    rows = list(csv.reader(read_text(path).splitlines()))
    if not rows:
        raise UnreadableFile(path, "empty")
    header = rows[0]
    if columns is None:
        texts = [name for name in texts if name in header]
        columns = [name for name in header if name not in texts]
    if missing := [name for name in (*texts, *columns) if name not in header]:
        raise UnreadableFile(path, f"has no column {missing[0]!r}")
    for line, row in enumerate(rows[1:], start=2):
        if len(row) != len(header):
            raise UnreadableFile(path, f"line {line} has {len(row)} fields, the header has {len(header)}")
    cells = dict(zip(header, zip(*rows[1:]))) if rows[1:] else dict.fromkeys(header, ())
    found: dict[str, Any] = {name: np.array(cells[name], dtype=object) for name in texts}
    for name in columns:
        try:
            found[name] = np.array(cells[name], dtype=float)
        except ValueError as error:
            raise UnreadableFile(path, f"column {name!r}: {error}") from error
        if finite and not np.isfinite(found[name]).all():
            line = 2 + int(np.argmin(np.isfinite(found[name])))
            raise UnreadableFile(path, f"line {line} holds a number that is not finite")
    return found


def if_present(read: Callable[..., Result], path: pathlib.Path, *arguments: Any, **options: Any) -> Result | None:
    """Returns what a reader returns for a file; None if there is no such file."""
    return read(path, *arguments, **options) if path.exists() else None


def read_series(path: pathlib.Path) -> list[tuple[float, pathlib.Path]]:
    """Returns times [s] and files of the frames listed in a `.pvd`."""
    try:
        return [(float(frame.attrib["timestep"]), path.parent / frame.attrib["file"])
                for frame in ElementTree.fromstring(read_text(path)).iter("DataSet")]
    except ElementTree.ParseError as error:
        raise UnreadableFile(path, f"not XML: {error}") from error
    except (KeyError, ValueError) as error:
        raise UnreadableFile(path, f"a DataSet has no time or file: {error}") from error
