"""Runs of a fit on the pool of processes that studies have."""
from __future__ import annotations

import os
import pathlib
import shutil
from collections.abc import Callable, Iterable, Mapping

from ..case import Case
from ..commands import run_words
from ..errors import BadInput, ClaimFailed, Interrupted, OutputFailed, error_of
from ..folder import prepare_run
from ..program import find_program
from ..results import Run, open_run
from ..study.outcome import content, last_words, unfit_rows
from ..study.pool import run_processes
from ..schema import SEED_ENTRY
from .problem import Measurement, Problem
from .record import Evaluation, Outcome, Record

Point = tuple[int, str, Mapping[str, float]]
"""Number, stage and values of a point to evaluate."""


def evaluate(record: Record, points: Iterable[Point], workers: int, keep_runs: bool, added: Callable[[], None]
             ) -> None:
    """Runs points, and adds each to the record once its runs have ended.

    `added` is called after each. An exception, Ctrl-C included, stops all runs; they are continued when the fit is called again.

    Raises
    ------
    OutputFailed
        If a run could not write its files.
    Interrupted
        If a signal ended a run.
    ValueError
        If a run does not have an observed quantity.
    """
    problem = record.problem
    wanted = {number: (stage, values) for number, stage, values in points}
    outcomes: dict[int, dict[int, Outcome]] = {number: {} for number in wanted}
    jobs = [(number, seed) for number in wanted for seed in problem.seeds]

    def folder(job: int) -> pathlib.Path:
        return record.directory / "runs" / "{:05}-{}".format(*jobs[job])

    def start(job: int) -> tuple[list[str], str]:
        number, seed = jobs[job]
        case, place = case_of(problem, record.case, wanted[number][1], seed), folder(job)
        continues = prepare_run(os.fspath(place), lambda: content(f"{place}/case.prm") == case.text())
        options = [] if problem.command != "fracture" else ["--no-report", *["--skip-verification"] * problem.skip_verification]
        words = run_words(problem.command, case, place, 1, continues, False, options)
        return [os.fspath(find_program()), *words], f"{place}/log.txt"

    def ended(job: int, status: int) -> None:
        number, seed = jobs[job]
        outcomes[number][seed] = _outcome(problem, seed, folder(job), status)
        if not keep_runs:
            shutil.rmtree(folder(job), ignore_errors=True)
        if len(outcomes[number]) == len(problem.seeds):
            stage, values = wanted[number]
            record.add(Evaluation(number, stage, dict(values), tuple(outcomes[number][seed] for seed in problem.seeds)))
            added()

    run_processes(len(jobs), workers, start, ended, lambda _running: None, lambda: False)


def case_of(problem: Problem, file: pathlib.Path, values: Mapping[str, float], seed: int) -> Case:
    """Case of one run: the base case with the values of a point and a seed."""
    return problem.of(Case(file), values).set(SEED_ENTRY, seed)


def measure(problem: Problem, run: Run) -> dict[str, Measurement]:
    """Observed quantities of a run by name."""
    return {observation.quantity: observation.of(run) for observation in problem.observations}


def _outcome(problem: Problem, seed: int, folder: pathlib.Path, status: int) -> Outcome:
    message = last_words(content(f"{folder}/log.txt")).removeprefix("latcon: ")
    error = error_of(status, message, folder) if status else None
    if isinstance(error, (OutputFailed, Interrupted)):
        raise error
    if isinstance(error, ClaimFailed) and problem.command == "fracture" and (folder / "crack.json").is_file():
        # A crack that differs from the case's own reference values was measured; one whose energies do not balance was not.
        if unfit := unfit_rows(open_run(folder).info):
            return Outcome(seed, "refused", f"failed its checks: {unfit}", {})
    elif error:
        return Outcome(seed, "refused" if isinstance(error, (BadInput, ClaimFailed)) else "failed", message, {})
    return Outcome(seed, "done", "", measure(problem, open_run(folder)))
