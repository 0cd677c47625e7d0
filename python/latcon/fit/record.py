"""Evaluated points of a fit in its directory, one line per point."""
from __future__ import annotations

import dataclasses
import json
import math
import os
import pathlib
from collections.abc import Iterable, Mapping

from ..errors import LatconError, UnreadableFile
from ..files import read_json, read_text
from ..folder import write_atomically
from .problem import Measurement, Problem

FORMAT_VERSION = 1


@dataclasses.dataclass(frozen=True)
class Outcome:
    """End of one run of a point.

    `ended` is ``done``, ``refused`` (bad input, or a claim or the energy ledger of the run does not hold) or ``failed``;
    `message` that of the program unless done; `measured` are the quantities by name.
    """

    seed: int
    ended: str
    message: str
    measured: Mapping[str, Measurement]


@dataclasses.dataclass(frozen=True)
class Evaluation:
    """Evaluated point: values of the parameters, and its runs."""

    number: int
    stage: str
    values: Mapping[str, float]
    outcomes: tuple[Outcome, ...]

    @property
    def ended(self) -> str:
        """``done`` if all runs are, otherwise the end of the first that is not."""
        return next((outcome.ended for outcome in self.outcomes if outcome.ended != "done"), "done")

    @property
    def message(self) -> str:
        """Its message; empty if all runs are done."""
        return next((outcome.message for outcome in self.outcomes if outcome.ended != "done"), "")


class Record:
    """Directory of a fit, which is locked: the problem, and the evaluated points so far.

    Files: `case.prm`, the resolved base case; `fit.json`, the problem; `evaluations.jsonl`, a line of JSON per evaluated point,
    appended when its runs have ended. Raises LatconError if the directory holds another case.prm or fit, UnreadableFile if a file is
    damaged. An incomplete last line, which a killed process leaves, is removed.
    """

    def __init__(self, directory: pathlib.Path, problem: Problem) -> None:
        self.directory = directory
        self.problem = problem
        self.case = directory / "case.prm"  # the resolved base case
        self._open_problem()
        self.evaluations = _read_evaluations(directory)

    def add(self, evaluation: Evaluation) -> None:
        """Appends an evaluated point."""
        # Numbers that are not finite become null.
        plain = json.loads(json.dumps(dataclasses.asdict(evaluation)), parse_constant=lambda word: None)
        line = json.dumps(plain, separators=(",", ":")) + "\n"
        with open(self.directory / "evaluations.jsonl", "ab", buffering=0) as file:
            end = file.seek(0, os.SEEK_END)
            try:
                data = line.encode()
                while data:
                    data = data[file.write(data):]
                os.fsync(file.fileno())
            except BaseException:
                file.truncate(end)  # a full disk: no half line
                raise
        self.evaluations = _by_number([*self.evaluations.values(), evaluation])

    def _open_problem(self) -> None:
        path = self.directory / "fit.json"
        wanted = {"format": "latcon-fit", "format_version": FORMAT_VERSION, **self.problem.identity()}
        if not path.exists():
            if (self.directory / "run.json").exists() or (self.case.exists() and read_text(self.case) != self.problem.case):
                raise LatconError(f"{self.directory}: holds a case.prm, which would be replaced; choose another directory")
            write_atomically(os.fspath(self.case), self.problem.case)
            write_atomically(os.fspath(path), json.dumps(wanted, indent=1) + "\n")  # last: a fit without it has no evaluations
            return
        held = read_json(path)
        different = [name for name in wanted if held.get(name) != wanted[name]]
        if read_text(self.case) != self.problem.case:
            different.append("case")
        if different:
            raise LatconError(f"{self.directory}: holds another fit; different: {', '.join(different)}; choose another directory")


def _by_number(evaluations: Iterable[Evaluation]) -> dict[int, Evaluation]:
    return {one.number: one for one in sorted(evaluations, key=lambda one: one.number)}


def _read_evaluations(directory: pathlib.Path) -> dict[int, Evaluation]:
    """Evaluated points of a fit by number; raises UnreadableFile if a complete line is damaged."""
    path = directory / "evaluations.jsonl"
    if not path.exists():
        return {}
    text = read_text(path)
    complete = text[:text.rfind("\n") + 1]
    if complete != text:
        os.truncate(path, len(complete.encode()))
    found = []
    for number, line in enumerate(complete.splitlines(), start=1):
        try:
            item = json.loads(line)
            outcomes = [Outcome(run["seed"], run["ended"], run["message"],
                                {name: (math.nan if value is None else value, math.nan if uncertainty is None else uncertainty)
                                 for name, (value, uncertainty) in run["measured"].items()}) for run in item["outcomes"]]
            evaluation = Evaluation(int(item["number"]), item["stage"], {key: float(value) for key, value in item["values"].items()},
                                    tuple(outcomes))
        except (ValueError, TypeError, KeyError, AttributeError) as error:
            raise UnreadableFile(path, f"line {number} is no evaluated point: {error}") from error
        found.append(evaluation)
    return _by_number(found)
