"""Entries of a case as declared by the program."""
from __future__ import annotations

import dataclasses
import functools
import json
import os
import pathlib
from collections.abc import Iterator, Mapping, Sequence
from typing import Any, Union

from .errors import LatconError
from .program import ask, find_program

EntryValue = Union[float, int, bool, str, list[float], None]
"""Value of an entry in SI units; None is ``auto``."""

SEED_ENTRY = "Lattice/noise seed"
"""Entry that the seeds of a run set."""

_FORMAT_VERSION = 1


@dataclasses.dataclass(frozen=True)
class Entry:
    """Declaration of one entry of a case.

    Attributes
    ----------
    section, name : str
        Section and name within it.
    type : str
        ``number``, ``integer``, ``numbers`` (a list), ``boolean``, ``word`` (one of `words`) or ``text``.
    unit : str or None
        SI unit; ``1`` for a pure number, None for entries that are not quantities.
    required : bool
        Whether every case must set it; then it has no default.
    default : EntryValue
        Default value in SI units; None is ``auto``.
    range : dict
        Those of ``minimum``, ``exclusive_minimum``, ``maximum``, ``exclusive_maximum`` that exist; for ``numbers``, of each.
    auto : bool
        Whether ``auto`` (None) is allowed: the program derives the value.
    words : tuple of str
        Allowed words of the type ``word``.
    allowed : str
        The rule in words.
    documentation : str
        Meaning.
    """

    section: str
    name: str
    type: str
    unit: str | None
    required: bool
    default: EntryValue
    range: Mapping[str, float]
    auto: bool
    words: tuple[str, ...]
    allowed: str
    documentation: str

    @property
    def key(self) -> str:
        """``Section/Name``."""
        return f"{self.section}/{self.name}"


class Schema(Mapping[str, Entry]):
    """Entries of a case by key, ``Section/Name``, in the order of declaration.

    Attributes
    ----------
    version : str
        Version of the program.
    cases : dict
        Files of the shipped cases by name.
    """

    def __init__(self, document: Mapping[str, Any]) -> None:
        if document.get("format") != "latcon-schema" or document.get("format_version") != _FORMAT_VERSION:
            raise LatconError(f"the schema of the program {find_program()} does not match this package (format version "
                              f"{document.get('format_version')}, not {_FORMAT_VERSION}); install both from the same version")
        self.version: str = document["version"]
        self.cases = {name: pathlib.Path(path) for name, path in document["cases"].items()}
        self._entries = {f"{item['section']}/{item['name']}": Entry(
            item["section"], item["name"], item["type"], item["unit"], item["required"], item.get("default"),
            item.get("range", {}), item.get("auto", False), tuple(item.get("words", ())), item["allowed"],
            item["documentation"]) for item in document["entries"]}

    def __getitem__(self, key: str) -> Entry:
        return self._entries[key]

    def __iter__(self) -> Iterator[str]:
        return iter(self._entries)

    def __len__(self) -> int:
        return len(self._entries)


def schema() -> Schema:
    """Returns the entries of a case that the program declares (``latcon schema``)."""
    program = find_program()
    return _schema(program, program.stat().st_mtime_ns)


@functools.lru_cache(maxsize=4)
def _schema(_program: pathlib.Path, _modified: int) -> Schema:
    return Schema(json.loads(ask("schema")))


@dataclasses.dataclass(frozen=True)
class ResolvedCase:
    """Case as read by the program: all values, and the text of `case.prm`."""

    values: Mapping[str, EntryValue]
    text: str


def resolve(file: str | os.PathLike[str], overrides: Sequence[str]) -> ResolvedCase:
    """Reads a case file with the program; `overrides` are ``Section/Name=value``, replacing entries of the file. Raises
    BadInput with every problem that the program found.
    """
    words = [word for override in overrides for word in ("--set", override)]
    case = json.loads(ask("schema", os.fspath(file), *words))["case"]
    return ResolvedCase(case["values"], case["resolved"])
