"""Strict reader of JSON: unknown keys and values of another type are problems."""
from __future__ import annotations

import json
import math
from collections.abc import Sequence
from typing import Any

from .program import InputError, Program, printable


def parse_json(file: str, text: bytes) -> dict[str, Any]:
    """Parses a JSON object without repeated keys; raises InputError if it is not JSON, not an object, nested deeper than 64
    levels, or if a key is repeated.
    """
    if b"\0" in text:
        raise InputError(f"{file}:{1 + text[:text.index(0)].count(10)}: not a text file: it holds zero bytes")
    problems = []

    def unique(pairs: list[tuple[str, Any]]) -> dict[str, Any]:
        members: dict[str, Any] = {}
        for key, value in pairs:
            if key in members:
                problems.append(f"{file}: the key '{printable(key)}' occurs twice in an object")
            members[key] = value
        return members

    try:
        document = json.loads(text.decode("utf-8-sig"), object_pairs_hook=unique, parse_int=_whole, parse_constant=_refuse)
        json.dumps(document, ensure_ascii=False).encode()  # without half a pair of surrogates
    except RecursionError:
        document, deepest = None, math.inf
    except ValueError as error:
        raise InputError(f"{file}: not JSON: {printable(str(error), 200)}") from None
    else:
        deepest = _depth(document)
    if deepest > _MAX_DEPTH:
        raise InputError(f"{file}: not a study: objects and lists are nested deeper than {_MAX_DEPTH}")
    if not isinstance(document, dict):
        problems.append(f"{file}: a study must be a JSON object")
    if problems:
        raise InputError(*problems)
    return document


_MAX_DEPTH = 64  # deeper than any study, and safe for recursion


def _whole(text: str) -> int | float:
    number = int(text)
    return number if -2**63 <= number < 2**64 else float(text)


def _refuse(word: str) -> float:
    raise ValueError(f"{word} is not a number of JSON")


def _depth(value: Any) -> int:
    items = value.values() if isinstance(value, dict) else value if isinstance(value, list) else None
    return 0 if items is None else 1 + max(map(_depth, items), default=0)


class JsonPlace:
    """Position in a JSON document, and the list of problems that all positions of the document share."""

    def __init__(self, value: Any, file: str, path: str, problems: list[str], program: Program) -> None:
        self.value = value
        self._file, self._path, self._problems, self._program = file, path, problems, program

    @property
    def place(self) -> str:
        """``FILE: PATH``."""
        return f"{self._file}: {self._path}" if self._path else self._file

    def problem(self, text: str) -> None:
        """Adds a problem at this position."""
        self._problems.append(f"{self.place}: {text}")

    def dump(self) -> str:
        """Returns the value as compact JSON."""
        return json.dumps(self.value, ensure_ascii=False, separators=(",", ":"))

    def is_object(self, *known: str) -> bool:
        """Returns whether this is an object; adds a problem if it is not, and one per unknown key."""
        if not isinstance(self.value, dict):
            self.problem("must be an object with the keys " + ", ".join(known))
            return False
        for key in self.value:
            if key not in known:
                self.problem(f"unknown key '{printable(key)}'{self._program.hint(key, known)}; known: "
                             + ", ".join(known))
        return True

    def get(self, key: str) -> JsonPlace | None:
        """Returns a member; None if it is missing."""
        return self._child(self.value[key], key) if isinstance(self.value, dict) and key in self.value else None

    def text_of(self, key: str, is_required: bool = False) -> str:
        """Returns the text of a member; if it is not required, it may be missing or empty."""
        found = self.required(key) if is_required else self.get(key)
        return "" if found is None or found.value == "" and not is_required else found.text()

    def required(self, key: str) -> JsonPlace | None:
        """Returns a member; adds a problem and returns None if it is missing."""
        if found := self.get(key):
            return found
        self.problem(f"the key '{key}' is missing")
        return None

    # Values. For another type they add a problem and return an empty value.
    def text(self) -> str:
        """Returns a non-empty text."""
        return self.value if isinstance(self.value, str) and self.value else self._wrong("a non-empty text", "")

    def number(self) -> float:
        """Returns a number; one like 1e999 is read as infinite."""
        is_number = isinstance(self.value, (int, float)) and not isinstance(self.value, bool) and math.isfinite(self.value)
        return float(self.value) if is_number else self._wrong("a finite number", 0.0)

    def unsigned(self) -> int | None:
        """Returns a whole number that is not negative; None, without a problem, for another value."""
        is_unsigned = isinstance(self.value, int) and not isinstance(self.value, bool) and self.value >= 0
        return self.value if is_unsigned else None

    def boolean(self) -> bool:
        """Returns true or false."""
        return self.value if isinstance(self.value, bool) else self._wrong("true or false", False)

    def list(self) -> list[JsonPlace]:
        """Returns the items of a non-empty list."""
        if not isinstance(self.value, list) or not self.value:
            return self._wrong("a non-empty list", [])
        return [self._child(value, str(number)) for number, value in enumerate(self.value, 1)]

    def members(self) -> Sequence[tuple[str, JsonPlace]]:
        """Returns the members of an object, in their order."""
        if not isinstance(self.value, dict):
            return self._wrong("an object", [])
        return [(key, self._child(value, key)) for key, value in self.value.items()]

    def word(self, known: Sequence[str], what: str) -> str:
        """Returns one of the known words."""
        given = self.text()
        if not given or given in known:
            return given
        names = ", ".join(known[:60]) + (f", ... ({len(known)} in all)" if len(known) > 60 else "")
        self.problem(f"'{printable(given)}' is not a known {what}{self._program.hint(given, known)}; known: {names}")
        return ""

    def _wrong(self, wanted: str, empty: Any) -> Any:
        self.problem(f"must be {wanted}, not {printable(self.dump())}")
        return empty

    def _child(self, value: Any, key: str) -> JsonPlace:
        return JsonPlace(value, self._file, f"{self._path}/{key}" if self._path else key, self._problems, self._program)
