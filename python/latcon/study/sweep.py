"""Sweeps: values of entries on the command line or in a study file, and their combinations."""
from __future__ import annotations

import dataclasses
import hashlib
import itertools
import json
import math
import re
from collections.abc import Callable, Mapping, Sequence
from typing import Any, NoReturn

from ..schema import SEED_ENTRY
from .program import InputError, Program, printable

MAX_RUNS = 100000
"""Largest number of runs of a sweep, with all seeds."""

MAX_NAME_LENGTH = 150
"""Largest number of letters of the name of a swept run, which is the name of a folder."""

_DIGEST = 16  # hexadecimal digits: of 100,000 runs two agree with a probability of 3e-10
_BLANKS = " \t\r\n\f\v"


@dataclasses.dataclass(frozen=True)
class Sweep:
    """Values of one entry: at least two, distinct (numbers in SI), as a case file would hold them.

    `is_continuous`: all of them are numbers between which there are others, not whole numbers or words.
    """

    entry: str
    values: list[str]
    is_continuous: bool = False


def parse_sweep(program: Program, text: str) -> Sweep:
    """Parses ``Section/Name=START:STOP:COUNT``, both ends included, or ``Section/Name=VALUE,VALUE,...``; raises InputError that
    names the wrong part.
    """
    def refuse(reason: str) -> NoReturn:
        raise InputError(f"sweep '{printable(text)}': {reason}")

    name, equals, values = text.partition("=")
    if not equals:
        refuse("expected Section/Name=START:STOP:COUNT or Section/Name=VALUE,VALUE,...")
    name, values = name.strip(_BLANKS), values.strip(_BLANKS)
    entry = program.entries.get(name)
    if entry is None:
        refuse(f"'{printable(name)}' is not an entry of a case"
               + (program.hint(name, list(program.entries)) or "; latcon entries lists them"))
    if name == SEED_ENTRY:
        refuse("seeds are set by --seeds")
    if entry.type == "numbers":
        refuse(f"{name} is a list; to vary lists, write a study file")
    if ":" in values:
        if entry.type not in ("number", "integer"):
            refuse(f"{name} is not a number; give its values separated by commas")
        found = _grid(program, refuse, values, entry.unit or "1")
    else:
        found = [value.strip(_BLANKS) for value in values.split(",")]
    if len(found) < 2:
        refuse("expected two values or more; for one value use --set")
    canonical: list[float | str] = list(found)
    if entry.type in ("number", "integer"):
        canonical = [value if number["wrong"] else float(number["value"])
                     for value, number in zip(found, program.ask(numbers=found, unit=entry.unit or "1"))]
    earlier: dict[float | str, str] = {}
    for number, (value, same) in enumerate(zip(found, canonical), 1):
        if not value:
            refuse(f"value {number} is empty")
        if same in earlier:
            also = "" if earlier[same] == value else ", also as " + printable(earlier[same])
            refuse(f"the value {printable(value)} is given twice{also}")
        earlier[same] = value
    return Sweep(name, found, entry.type == "number" and all(isinstance(value, float) for value in canonical))


def _grid(program: Program, refuse: Callable[[str], NoReturn], values: str, unit: str) -> list[str]:
    parts = [part.strip(_BLANKS) for part in values.split(":")]
    if len(parts) != 3:
        refuse(f"expected START:STOP:COUNT, for example 1.5:1.9:5; '{printable(values)}' has {len(parts)} parts")
    for part, name in zip(parts, ("START", "STOP", "COUNT")):
        if not part:
            refuse(f"{name} is empty")
    ends = []
    for part, name, number in zip(parts, ("START", "STOP"), program.ask(numbers=parts[:2], unit=unit)):
        if number["wrong"]:
            refuse(f"{name} '{printable(part)}': {number['wrong']}")
        match = re.match(r"[+-]?(\d+\.?\d*|\.\d+)([eE][+-]?\d+)?", part)
        if match is None:
            refuse(f"{name} '{printable(part)}' is not a number")
        ends.append((float(match[0]), part[match.end():].strip(_BLANKS)))
    (start, start_unit), (stop, stop_unit) = ends
    if start_unit != stop_unit:
        refuse(f"START and STOP must have the same unit, or none; '{printable(parts[0])}' and '{printable(parts[1])}' differ")
    count = int(parts[2]) if re.fullmatch(r"[0-9]{1,18}", parts[2]) else 0
    if not 2 <= count <= MAX_RUNS:
        refuse(f"COUNT '{printable(parts[2])}' must be a whole number from 2 to {MAX_RUNS}")
    if start == stop:
        refuse("START and STOP must differ")
    if not math.isfinite(stop - start):
        refuse(f"START '{printable(parts[0])}' and STOP '{printable(parts[1])}' are too far apart for floating-point numbers")
    # Twelve digits of the larger end are also where rounding leaves 1e-17 in place of 0.
    smallest = max(abs(start), abs(stop)) * 1e-12
    points = (start + i / (count - 1) * (stop - start) for i in range(count))
    return [plain_number(0.0 if abs(value) < smallest else value) + (start_unit and " " + start_unit) for value in points]


def plain_number(number: float) -> str:
    """Formats a number with twelve digits: 1.7 instead of 1.7000000000000002."""
    return f"{number:.12g}"


def combination_name(entries: Sequence[str], values: Sequence[str]) -> str:
    """Returns the name of a run, formed from its values, such as ``strain-y-1.5_height-2cm``."""
    tails = [entry.partition("/")[2] for entry in entries]
    return "_".join(_name_of(entry if tails.count(tail) > 1 else tail, "-") + "-" + _name_of(value, "")
                    for entry, tail, value in zip(entries, tails, values))


def _name_of(text: str, blank: str) -> str:
    """Letters that a name of a run may have; other bytes become ``-``."""
    return re.sub(r"[^A-Za-z0-9._-]", lambda letter: "-" * len(letter[0].encode()), text.replace("+", "").replace(" ", blank))


def combinations(sweeps: Sequence[Sweep], n_seeds: int) -> dict[str, dict[str, str]]:
    """Returns all combinations of values by their names; values of the last sweep vary fastest.

    A name that is too long, or that an earlier combination has, is cut, and ends in 16 digits of the SHA-256 of the settings.
    Raises InputError for an entry that is swept twice, or more than 100,000 runs.
    """
    entries = [sweep.entry for sweep in sweeps]
    if twice := [entry for i, entry in enumerate(entries) if entry in entries[:i]]:
        raise InputError(f"sweep: {twice[0]} is swept twice")
    if math.prod(len(sweep.values) for sweep in sweeps) > MAX_RUNS // n_seeds:
        raise InputError(f"sweep: more than {MAX_RUNS} runs, with {n_seeds} seeds for each combination of values")
    cases: dict[str, dict[str, str]] = {}
    for values in itertools.product(*(sweep.values for sweep in sweeps)):
        name = combination_name(entries, values)
        own = dict(zip(entries, values))
        if len(name) > MAX_NAME_LENGTH or name in cases:
            settings = "".join(f"{key}={value}\n" for key, value in own.items())
            name = name[:MAX_NAME_LENGTH - _DIGEST - 1] + "-" + hashlib.sha256(settings.encode()).hexdigest()[:_DIGEST]
        cases[name] = own
    return cases


def sweep_study(program: Program, sweeps: Sequence[str], case_name: str, base: str, settings: Mapping[str, str],
                n_seeds: int) -> str:
    """Returns the text of a study file that runs sweeps, with the seeds 1 to `n_seeds` (0: 1)."""
    entries = []
    for text in sweeps:
        entries.append(parse_sweep(program, text).entry)
        if entries[-1] in settings:
            raise InputError(f"--set: {entries[-1]} is also an entry of --sweep")
    document: dict[str, Any] = {"title": f"Sweep of {', '.join(entries)} ({case_name})", "base": base,
                **({"set": dict(settings)} if settings else {}),
                "seeds": list(range(1, max(n_seeds, 1) + 1)), "sweep": list(sweeps)}
    return json.dumps(document, indent=1, ensure_ascii=False) + "\n"
