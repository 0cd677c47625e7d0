"""Cases: a case file and entries that override those of the file."""
from __future__ import annotations

import os
import pathlib
from collections.abc import Mapping, Sequence

import numpy as np

from .errors import BadInput, LatconError, UnknownEntry
from .folder import write_atomically
from .schema import EntryValue, ResolvedCase, resolve, schema

Settable = str | float | int | bool | None | Sequence[float] | np.generic | np.ndarray


class Case:
    """Input of a run: a case file, and entries that override those of the file.

    A case is immutable: :meth:`set` returns a new one. The program reads and checks a case when a value is accessed, when the
    case is written and when it is run.

    Parameters
    ----------
    file
        Path of a case file, ``.prm`` or ``.json``; or the name of a case shipped with latcon, such as ``"fig1"`` or
        ``"fig1.prm"``.

    Raises
    ------
    BadInput
        If neither a file nor a shipped case of this name exists.

    Examples
    --------
    >>> case = latcon.Case("quick.prm").set("Sheet/height", "1.5 cm").set("Lattice/noise seed", 7)
    >>> case["Sheet/height"]
    0.015
    """

    def __init__(self, file: str | os.PathLike[str]) -> None:
        path = pathlib.Path(file)
        if not path.is_file():
            shipped = schema().cases
            name = path.stem if path.suffix == ".prm" else path.name
            if path.parent != pathlib.Path() or name not in shipped:
                raise BadInput(f"{path}: no such case file; cases shipped with latcon: {', '.join(shipped)}", 2)
            path = shipped[name]
        self._file = path.absolute()
        self._overrides: dict[str, str] = {}
        self._cached: tuple[object, ResolvedCase] | None = None

    @property
    def file(self) -> pathlib.Path:
        """Case file, whose entries :attr:`overrides` replaces."""
        return self._file

    @property
    def overrides(self) -> Mapping[str, str]:
        """Replaced entries by key, as strings."""
        return dict(self._overrides)

    def set(self, key: str, value: Settable) -> Case:
        """Returns the case with another value of one entry.

        Parameters
        ----------
        key
            ``Section/Name``.
        value
            A number in the SI unit of the entry, a string with a unit (``"5 cm"``), a keyword, a Boolean, a sequence of numbers,
            or None for ``auto``.

        Returns
        -------
        Case
            A new case; this one is unchanged.

        Raises
        ------
        UnknownEntry
            If there is no such entry; the message names the nearest known one. An invalid value is reported by the program when
            the case is first read.
        """
        if key not in schema():
            raise self._unknown(key)
        changed = Case(self._file)
        changed._overrides = {**self._overrides, key: _text(key, value)}
        return changed

    def __getitem__(self, key: str) -> EntryValue:
        """Value of an entry in SI units; None means ``auto``."""
        values = self._resolve().values
        if key not in values:
            raise self._unknown(key)
        return values[key]

    def resolved(self) -> dict[str, EntryValue]:
        """Values of all entries by key, in SI units, as the program reads them.

        Raises
        ------
        BadInput
            With every problem of the case.
        """
        return dict(self._resolve().values)

    def text(self) -> str:
        """The resolved case in deal.II's parameter format, every entry with its documentation."""
        return self._resolve().text

    def write(self, path: str | os.PathLike[str]) -> pathlib.Path:
        """Writes the resolved case with all entries to a ``.prm`` file, atomically.

        Raises
        ------
        BadInput
            If the case is invalid; nothing is written.
        OSError
            If the file cannot be written.
        """
        path = pathlib.Path(path)
        if path.suffix == ".json":
            raise ValueError(f"{path}: a resolved case has deal.II's parameter format; choose a name that ends in .prm")
        write_atomically(os.fspath(path), self.text())
        return path

    def arguments(self) -> list[str]:
        """Command-line options that set the replaced entries."""
        return [word for key, value in self._overrides.items() for word in ("--set", f"{key}={value}")]

    def __repr__(self) -> str:
        return f"Case({str(self._file)!r})" + "".join(f".set({key!r}, {value!r})" for key, value in self._overrides.items())

    def _resolve(self) -> ResolvedCase:
        try:
            status = self._file.stat()
        except OSError as error:
            raise BadInput(f"{self._file}: {error.strerror}", 2) from error
        state = (status.st_mtime_ns, status.st_size, status.st_ino)
        if self._cached is None or self._cached[0] != state:
            self._cached = (state, resolve(self._file, [f"{key}={value}" for key, value in self._overrides.items()]))
        return self._cached[1]

    def _unknown(self, key: str) -> UnknownEntry:
        """Exception with the program's message, which names the nearest known entry."""
        try:
            resolve(self._file, [f"{key}="])
        except BadInput as error:
            lines = [line for line in error.message.splitlines() if line.startswith("--set: ")]
            return UnknownEntry("\n".join(lines) or error.message, error.exit_code)
        except LatconError as error:
            return UnknownEntry(f"{key}: {error}", 2)
        return UnknownEntry(f"{key}: unknown entry", 2)


def _text(key: str, value: Settable) -> str:
    """Value in the syntax of a case file."""
    if isinstance(value, (np.generic, np.ndarray)):
        value = value.tolist()
    if value is None:
        return "auto"
    if isinstance(value, bool):
        return "true" if value else "false"
    if isinstance(value, float):
        return repr(value)
    if isinstance(value, (str, int)):
        return str(value)
    if isinstance(value, Sequence):
        return ", ".join(_text(key, item) for item in value)
    raise TypeError(f"{key}: a value must be a string, a number, a Boolean, a sequence of numbers or None, not "
                    f"{type(value).__name__}")
