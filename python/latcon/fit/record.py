"""Evaluated points of a fit in its directory, one line per point."""
from __future__ import annotations

import dataclasses
import json
import math
import os
import pathlib
from collections.abc import Mapping
from typing import Any

from ..errors import LatconError, UnreadableFile
from ..files import read_json, read_text
from ..folder import FolderLock, write_atomically
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
    """Directory of a fit: the problem, and the evaluated points so far.

    Files: `case.prm`, the resolved base case; `fit.json`, the problem; `evaluations.jsonl`, a line of JSON per evaluated point,
    appended when its runs have ended. Raises LatconError if the directory holds another fit, or one that another process works
    on, UnreadableFile if a file is damaged. An incomplete last line, which a killed process leaves, is removed.
    """

    def __init__(self, directory: pathlib.Path, problem: Problem) -> None:
        self.directory = directory
        self.problem = problem
        directory.mkdir(parents=True, exist_ok=True)
        self._lock = FolderLock(os.fspath(directory))
        try:
            self._open_problem()
            self.evaluations = _read_evaluations(directory)
        except BaseException:
            self._lock.release()
            raise

    def __enter__(self) -> Record:
        return self

    def __exit__(self, *_: object) -> None:
        self._lock.release()

    @property
    def case(self) -> pathlib.Path:
        """File of the resolved base case."""
        return self.directory / "case.prm"

    def add(self, evaluation: Evaluation) -> None:
        """Appends an evaluated point."""
        line = json.dumps(_plain(dataclasses.asdict(evaluation)), separators=(",", ":"), allow_nan=False) + "\n"
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
        self.evaluations[evaluation.number] = evaluation

    def _open_problem(self) -> None:
        path = self.directory / "fit.json"
        wanted = {"format": "latcon-fit", "format_version": FORMAT_VERSION, **self.problem.identity()}
        if not path.exists():
            write_atomically(os.fspath(self.case), self.problem.case)
            write_atomically(os.fspath(path), json.dumps(wanted, indent=1) + "\n")  # last: a fit without it has no evaluations
            return
        held = read_json(path)
        different = [name for name in wanted if held.get(name) != wanted[name]]
        if read_text(self.case) != self.problem.case:
            different.append("case")
        if different:
            raise LatconError(f"{self.directory}: holds another fit; different: {', '.join(different)}; choose another directory")


def _read_evaluations(directory: pathlib.Path) -> dict[int, Evaluation]:
    """Evaluated points of a fit by number; raises UnreadableFile if a complete line is damaged."""
    path = directory / "evaluations.jsonl"
    if not path.exists():
        return {}
    text = read_text(path)
    complete = text[:text.rfind("\n") + 1]
    if complete != text:
        os.truncate(path, len(complete.encode()))
    found = {}
    for number, line in enumerate(complete.splitlines(), start=1):
        try:
            evaluation = _evaluation(json.loads(line))
        except (ValueError, TypeError, KeyError, AttributeError) as error:
            raise UnreadableFile(path, f"line {number} is no evaluated point: {error}") from error
        found[evaluation.number] = evaluation
    return dict(sorted(found.items()))


def _evaluation(line: Mapping[str, Any]) -> Evaluation:
    outcomes = tuple(Outcome(item["seed"], item["ended"], item["message"],
                             {name: (math.nan if value is None else value, math.nan if uncertainty is None else uncertainty)
                              for name, (value, uncertainty) in item["measured"].items()})
                     for item in line["outcomes"])
    return Evaluation(int(line["number"]), line["stage"], {key: float(value) for key, value in line["values"].items()}, outcomes)


def _plain(value: Any) -> Any:
    """Value for JSON: not-a-number and infinity become null."""
    if isinstance(value, float):
        return value if math.isfinite(value) else None
    if isinstance(value, Mapping):
        return {key: _plain(item) for key, item in value.items()}
    if isinstance(value, (list, tuple)):
        return [_plain(item) for item in value]
    return value
