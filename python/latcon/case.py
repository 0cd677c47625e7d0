"""Cases: a case file and entries that override those of the file."""
from __future__ import annotations

import copy
import os
import pathlib
from collections.abc import Mapping, Sequence

import numpy as np

from .errors import BadInput, LatconError, UnknownEntry
from .folder import write_atomically
from .schema import EntryValue, ResolvedCase, resolve, schema

_WORDS: dict[str, EntryValue] = {"auto": None, "true": True, "false": False}
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
        path = pathlib.Path(file).expanduser()
        if not path.is_file():
            shipped = schema().cases
            name = path.stem if path.suffix == ".prm" else path.name
            if path.parent != pathlib.Path() or name not in shipped:
                raise BadInput(f"{path}: no such case file; cases shipped with latcon: {', '.join(shipped)}", 2)
            path = shipped[name]
        self._file = path.absolute()
        self._overrides: dict[str, str] = {}
        # With the state of the file; with None that of a run, for machines without the program.
        self._cached: tuple[object, ResolvedCase] | None = None

    @property
    def file(self) -> pathlib.Path:
        """Case file, whose entries :attr:`overrides` replaces."""
        return self._file

    @property
    def overrides(self) -> Mapping[str, str]:
        """Replaced entries by key, as strings."""
        return dict(self._overrides)

    @classmethod
    def from_dict(cls, values: Mapping[str, Settable]) -> Case:
        """Returns the case with these values, as :meth:`set` takes them, and the defaults of all other entries."""
        case = cls.__new__(cls)
        case._file, case._overrides, case._cached = pathlib.Path(os.devnull), {}, None
        return case.set(values)

    @classmethod
    def of_run(cls, file: pathlib.Path, entries: Mapping[str, str], text: str) -> Case:
        """Returns a resolved case as a run recorded it.

        Parameters
        ----------
        file
            The resolved case, `case.prm`.
        entries, text
            Texts of all entries in SI units by key, from `run.json`; content of the file.
        """
        case = cls(file)
        case._cached = None, ResolvedCase({key: _recorded(value) for key, value in entries.items()}, text)
        return case

    def set(self, key: str | Mapping[str, Settable], *value: Settable) -> Case:
        """Returns the case with other values of one entry, ``set(key, value)``, or of several, ``set({key: value, ...})``.

        Parameters
        ----------
        key
            ``Section/Name``, or a mapping of such keys to values.
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
        if len(value) != (0 if isinstance(key, Mapping) else 1):
            raise TypeError("set takes a key and a value, or one mapping of keys to values")
        changes = key if isinstance(key, Mapping) else {key: value[0]}
        for name in changes:
            if name not in schema():
                raise self._unknown(name)
        changed = copy.copy(self)
        changed._overrides = self._overrides | {name: entry_text(name, item) for name, item in changes.items()}
        changed._cached = None
        return changed

    __iter__ = None  # Python would try to iterate by []

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

    def diff(self, other: Case) -> dict[str, tuple[EntryValue, EntryValue]]:
        """Values of the entries in which two cases differ, in SI units, by key: this case's, the other's."""
        own, others = self._resolve().values, other._resolve().values
        return {key: (own.get(key), others.get(key)) for key in {**own, **others} if own.get(key) != others.get(key)}

    def __eq__(self, other: object) -> bool:
        """Returns whether all entries have the same values, however they are written."""
        return isinstance(other, Case) and not self.diff(other)

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
        return set_options(self._overrides)

    def __repr__(self) -> str:
        return f"Case({str(self._file)!r})" + "".join(f".set({key!r}, {value!r})" for key, value in self._overrides.items())

    def _resolve(self) -> ResolvedCase:
        if self._cached and self._cached[0] is None:
            return self._cached[1]
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


def set_options(settings: Mapping[str, str]) -> list[str]:
    """Returns command-line options that set entries."""
    return [word for key, value in settings.items() for word in ("--set", f"{key}={value}")]


def entry_text(key: str, value: Settable) -> str:
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
        return ", ".join(entry_text(key, item) for item in value)
    raise TypeError(f"{key}: a value must be a string, a number, a Boolean, a sequence of numbers or None, not "
                    f"{type(value).__name__}")


def _recorded(text: str) -> EntryValue:
    """Value of an entry in `run.json`, whose type its text alone shows."""
    if text in _WORDS:
        return _WORDS[text]
    for convert in (int, float):
        try:
            return convert(text)
        except ValueError:
            pass
    try:
        return [float(number) for number in text.split(",")]
    except ValueError:
        return text
