"""Runs of a fit on a local pool of processes."""
from __future__ import annotations

import concurrent.futures
import fcntl
import os
import pathlib
import shutil
import threading
from collections.abc import Callable, Iterable, Mapping

from .. import commands
from ..case import Case
from ..errors import BadInput, ClaimFailed, OutputFailed, ProgramError
from ..program import Progress
from ..results import Run, open_run
from .problem import SEED, Measurement, Problem
from .record import Evaluation, Outcome, Record

Point = tuple[int, str, Mapping[str, float]]
"""Number, stage and values of a point to evaluate."""

# Seconds between attempts to lock a folder in which a run of a killed fit continues.
_LOCK_INTERVAL = 0.2


class _Stopped(Exception):
    """The fit stops; raised in the threads of the pool."""


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
    stop = threading.Event()
    with concurrent.futures.ThreadPoolExecutor(workers) as pool:
        waiting: dict[concurrent.futures.Future[Outcome], int] = {}
        outcomes: dict[int, dict[int, Outcome]] = {}
        wanted = {number: (stage, values) for number, stage, values in points}
        try:
            for number, (_, values) in wanted.items():
                outcomes[number] = {}
                for seed in record.problem.seeds:
                    waiting[pool.submit(_run_one, record, number, values, seed, keep_runs, stop)] = number
            for ended in concurrent.futures.as_completed(waiting):
                number, outcome = waiting[ended], ended.result()
                outcomes[number][outcome.seed] = outcome
                if len(outcomes[number]) == len(record.problem.seeds):
                    stage, values = wanted[number]
                    in_order = tuple(outcomes[number][seed] for seed in record.problem.seeds)
                    record.add(Evaluation(number, stage, dict(values), in_order))
                    added()
        except BaseException:
            stop.set()
            for future in waiting:
                future.cancel()
            raise


def case_of(problem: Problem, file: pathlib.Path, values: Mapping[str, float], seed: int) -> Case:
    """Case of one run: the base case with the values of a point and a seed."""
    return problem.of(Case(file), values).set(SEED, seed)


def _run_one(record: Record, number: int, values: Mapping[str, float], seed: int, keep_runs: bool, stop: threading.Event
             ) -> Outcome:
    problem = record.problem
    case = case_of(problem, record.case, values, seed)
    folder = record.directory / "runs" / f"{number:05}-{seed}"

    def check(_line: str) -> None:
        if stop.is_set():
            raise _Stopped
    try:
        check("")
        is_begun = folder.exists()
        if is_begun:
            _wait_for(folder, stop)
            is_begun = _holds(folder, case)
        outcome = Outcome(seed, "done", "", measure(problem, _run(problem, case, folder, is_begun, check)))
    except ProgramError as error:
        if isinstance(error, OutputFailed):
            raise
        ended = "refused" if isinstance(error, (BadInput, ClaimFailed)) else "failed"
        outcome = Outcome(seed, ended, error.message, {})
    if not keep_runs:
        shutil.rmtree(folder, ignore_errors=True)
    return outcome


def measure(problem: Problem, run: Run) -> dict[str, Measurement]:
    """Observed quantities of a run by name."""
    return {observation.quantity: observation.of(run) for observation in problem.observations}


def _run(problem: Problem, case: Case, folder: pathlib.Path, resume: bool, progress: Progress) -> Run:
    try:
        return _start(problem, case, folder, resume, progress)
    except ClaimFailed:
        if not (problem.command == "fracture" and (folder / "crack.json").is_file()):
            raise
    # A crack that differs from the case's own reference values was measured; one whose energies do not balance was not.
    run = open_run(folder)
    failed = run.info.get("failed_rows") or {"run.json does not say which rows failed": "unknown"}
    if unfit := [f"{row} ({kind})" for row, kind in failed.items() if kind != "reference"]:
        raise ClaimFailed("failed its checks: " + "; ".join(unfit), 3, folder)
    return run


def _start(problem: Problem, case: Case, folder: pathlib.Path, resume: bool, progress: Progress) -> Run:
    if problem.command == "fracture":
        return commands.fracture(case, folder, threads=1, resume=resume, skip_verification=problem.skip_verification,
                                 report=False, progress=progress)
    command = commands.lattice if problem.command == "lattice" else commands.continuum
    return command(case, folder, threads=1, resume=resume, progress=progress)


def _wait_for(folder: pathlib.Path, stop: threading.Event) -> None:
    """Waits for a run that outlived a killed fit."""
    with open(folder / ".latcon.lock", "ab") as file:
        while True:
            try:
                fcntl.flock(file, fcntl.LOCK_EX | fcntl.LOCK_NB)
                return
            except BlockingIOError:
                if stop.wait(_LOCK_INTERVAL):
                    raise _Stopped from None
            except OSError:  # a file system without locks
                return


def _holds(folder: pathlib.Path, case: Case) -> bool:
    """Whether a folder holds a run of the case; removes any other."""
    try:
        if (folder / "case.prm").read_text(encoding="utf-8") == case.text():
            return True
    except OSError:
        pass
    shutil.rmtree(folder)
    return False


def available_cores() -> int:
    """Cores that this process may use."""
    return len(os.sched_getaffinity(0))
