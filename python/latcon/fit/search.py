"""The search of a fit: batches of points are chosen, run and recorded.

Sobol points come first, then those of Optuna's TPE, then points around the local minimum.
"""
from __future__ import annotations

import os
import pathlib
import shutil
import time
import warnings
from collections.abc import Callable, Iterable, Mapping, Sequence

import numpy as np

from ..case import Case
from ..commands import CaseLike, run_words
from ..errors import INTERRUPTED, BadInput, ClaimFailed, LatconError, OutputFailed, error_of, optional_package
from ..files import content
from ..folder import FolderLock, absolute, prepare_run
from ..frames import Floats
from ..program import Progress, find_program, progress_indicator
from ..results import open_run
from ..schema import SEED_ENTRY
from ..study.outcome import last_words, unfit_rows
from ..study.pool import run_processes
from .misfit import LocalModel, Table, fit_local_model, tabulate
from .problem import Entries, Observation, Parameter, Problem, resolve_problem
from .record import Evaluation, Outcome, Record
from .result import Fit

# Points around the minimum of the local model are spread by this many standard deviations, which determines its slopes well
# without leaving the quadratic neighbourhood.
_SPREAD = 1.5
# Largest standard deviation of such points, as a fraction of the box, in the first batch and in later ones.
_WIDEST, _SHRINKING, _NARROWEST = 0.15, 0.8, 0.02


def propose(table: Table, parameters: int, first: int, batch: int, evaluations: int, seed: int) -> list[tuple[str, Floats]]:
    """Next points to evaluate, with the name of their stage.

    They depend on the evaluated points before `first`, the number of the first, and the seed of the search alone: not on how
    often the fit was interrupted. Of all `evaluations` the first quarter, at least 2 `parameters` + 1, are Sobol points and the
    next, up to half, TPE's; `batch` is the size of a batch, of which the last may be shorter.
    """
    count = min(batch, evaluations - first)
    sobol = min(evaluations, max(2 * parameters + 1, evaluations // 4))
    tpe = max(sobol, evaluations // 2)
    qmc = optional_package("scipy.stats.qmc", "fits need", "scipy (Debian: python3-scipy)")
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")  # a number of points that is no power of two
        points = [("sobol", point) for point in qmc.Sobol(parameters, seed=seed).random(sobol)[first:first + count]]
    if left := count - len(points):
        model = fit_local_model(table) if first + count > tpe else None
        around = 0 if model is None else min(left, first + count - tpe)
        if left > around:
            points += [("tpe", point) for point in _tpe(table, parameters, first, left - around, seed)]
        if model is not None:
            points += [("local", point) for point in _around(model, first, around, (first - tpe) / batch, seed)]
    return points


def _tpe(table: Table, parameters: int, first: int, count: int, seed: int) -> list[Floats]:
    optuna = optional_package("optuna", "fits need", "optuna (Debian: python3-optuna)")
    optuna.logging.set_verbosity(optuna.logging.WARNING)
    names = [str(axis) for axis in range(parameters)]
    box = {name: optuna.distributions.FloatDistribution(0, 1) for name in names}
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", optuna.exceptions.ExperimentalWarning)
        sampler = optuna.samplers.TPESampler(seed=seed + first, multivariate=True, constant_liar=True, n_startup_trials=1)
        study = optuna.create_study(sampler=sampler)
        finite = table.misfits[np.isfinite(table.misfits)]
        worst = 2 * finite.max() + 1 if finite.size else 1.0  # of runs that were refused or failed
        for at, misfit in zip(table.coordinates, table.misfits):
            study.add_trial(optuna.create_trial(params={name: min(max(float(x), 0), 1) for name, x in zip(names, at)},
                                                distributions=box, value=float(misfit) if np.isfinite(misfit) else worst))
        found = []
        for _ in range(count):
            trial = study.ask(box)
            found.append(np.array([trial.params[name] for name in names]))
    return found


def _around(model: LocalModel, first: int, count: int, batch: float, seed: int) -> list[Floats]:
    """The minimum of the local model, and normal points around it, reflected into the box."""
    width = max(_NARROWEST, _WIDEST * _SHRINKING**batch)
    metric = model.metric / _SPREAD**2 + np.eye(len(model.center)) / width**2
    generator = np.random.default_rng([seed, first])
    drawn = generator.multivariate_normal(model.center, np.linalg.inv(metric), count - 1)
    folded = np.abs(drawn) % 2
    return [model.center, *np.minimum(folded, 2 - folded)]


Point = tuple[int, str, Mapping[str, float]]
"""Number, stage and values of a point to evaluate."""


def evaluate(record: Record, points: Iterable[Point], workers: int, keep_runs: bool, added: Callable[[], None]
             ) -> None:
    """Runs points, and adds each to the record once its runs have ended; calls `added` after each.

    An exception, Ctrl-C included, stops all runs; they are continued when the fit is called again. Raises OutputFailed if a run
    could not write its files, Interrupted or ProgramError if a signal ended one, ValueError if one does not have an observed quantity.
    """
    problem = record.problem
    wanted = {number: (stage, values) for number, stage, values in points}
    outcomes: dict[int, dict[int, Outcome]] = {number: {} for number in wanted}
    jobs = [(number, seed) for number in wanted for seed in problem.seeds]

    def folder(job: int) -> pathlib.Path:
        return record.directory / "runs" / "{:05}-{}".format(*jobs[job])

    def start(job: int) -> tuple[list[str], str]:
        number, seed = jobs[job]
        case, place = problem.of(Case(record.case), wanted[number][1]).set(SEED_ENTRY, seed), folder(job)
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


def _outcome(problem: Problem, seed: int, folder: pathlib.Path, status: int) -> Outcome:
    message = last_words(content(f"{folder}/log.txt")).removeprefix("latcon: ")
    if status > INTERRUPTED:  # 128 + the signal, as of a machine without memory: no property of the point
        message = f"{folder}: killed by signal {status - 128}"
    error = error_of(status, message, folder) if status else None
    if error and (status > 128 or isinstance(error, OutputFailed) or "no usable checkpoint" in message):
        raise error
    if isinstance(error, ClaimFailed) and problem.command == "fracture" and (folder / "crack.json").is_file():
        # A crack that differs from the case's own reference values was measured; one whose energies do not balance was not.
        if unfit := unfit_rows(open_run(folder).info):
            return Outcome(seed, "refused", f"failed its checks: {unfit}", {})
    elif error:
        return Outcome(seed, "refused" if isinstance(error, (BadInput, ClaimFailed)) else "failed", message, {})
    run = open_run(folder)
    return Outcome(seed, "done", "", {one.quantity: one.of(run) for one in problem.observations})


def fit_case(case: CaseLike, parameters: Sequence[Parameter], observations: Sequence[Observation],
             directory: str | os.PathLike[str], *, command: str = "fracture", seeds: Sequence[int] | None = None,
             entries: Entries | None = None, evaluations: int = 40, batch: int = 8, workers: int | None = None,
             skip_verification: bool = False, keep_runs: bool = False, search_seed: int = 0, progress: Progress = True) -> Fit:
    """Fits parameters of a case to observations.

    Sobol points come first, then those of Optuna's TPE sampler; those of the second half lie around the minimum of a local
    quadratic model of the quantities where there is one. Each point is a run per seed. A fit that was interrupted or killed
    continues if it is called again with the same directory, also with more evaluations, or with other observed values of the
    same quantities. Without an interruption the points are the same, and for any number of workers.

    Parameters
    ----------
    case
        Base case, or what :class:`latcon.Case` accepts.
    parameters
        Entries to vary, with bounds.
    observations
        Observed quantities with uncertainties.
    directory
        Directory of the fit; created if needed.
    command
        ``fracture``, ``lattice`` or ``continuum``.
    seeds
        Noise seeds over which quantities are averaged; default: that of the case.
    entries
        Function of the values of all parameters, by name, that returns further entries of the case: for parameters with a unit
        of their own, such as a factor of several entries or a number in a list. It must return the same for the same values.
    evaluations
        Points to evaluate, those of earlier calls included.
    batch
        Points that are chosen together. All runs of a batch may run at once.
    workers
        Concurrent runs, single-threaded each; default: all cores that this process may use.
    skip_verification
        Whether cracks run unverified. The verification before fracture takes about 15 s for each point whose rubber differs.
    keep_runs
        Whether the output of the runs stays in `runs/` of the directory.
    search_seed
        Seed of the search.
    progress
        Progress indicator, as in :func:`latcon.fracture`.

    Returns
    -------
    Fit
        The result.

    Raises
    ------
    ValueError
        If an argument is wrong, or a run does not have an observed quantity.
    BadInput
        If the case or a bound is wrong.
    LatconError
        If the directory holds another case.prm or fit, or is in use, optuna or scipy is missing, or no run of the first batch is done.
    OutputFailed, ProgramError
        If a run cannot write its files, or is killed. Other errors of a run are recorded with the point, which gets a misfit
        worse than that of all others.
    KeyboardInterrupt
        After Ctrl-C, or a signal to a run: all runs are stopped, with checkpoints.
    """
    for name, number in (("evaluations", evaluations), ("batch", batch), ("workers", workers or 1)):
        if number < 1:
            raise ValueError(f"{name} = {number}: must be positive")
    problem = resolve_problem(case, parameters, observations, command, seeds, skip_verification, entries)
    place = absolute(directory)
    place.mkdir(parents=True, exist_ok=True)
    with FolderLock(os.fspath(place)), progress_indicator(progress) as show_line:
        record, begin = Record(place, problem), time.monotonic()
        held = len(record.evaluations)

        def show() -> None:
            done = len(record.evaluations)
            left = max(0, evaluations - done) * (time.monotonic() - begin) / max(1, done - held)
            misfits = tabulate(problem, list(record.evaluations.values())).misfits
            show_line(f"{done} of {evaluations} points, least misfit {misfits.min():.4g}, {left:.0f} s left", left)

        for first in range(0, evaluations, batch):
            numbers = range(first, min(first + batch, evaluations))
            if not all(number in record.evaluations for number in numbers):
                earlier = tabulate(problem, [evaluation for number, evaluation in record.evaluations.items() if number < first])
                chosen = propose(earlier, len(problem.axes), first, batch, evaluations, search_seed)
                points = [(number, stage, problem.values(at)) for number, (stage, at) in zip(numbers, chosen)
                          if number not in record.evaluations]
                evaluate(record, points, workers or len(os.sched_getaffinity(0)), keep_runs, show)
            found = list(record.evaluations.values())[:batch]
            if first == 0 and not any(outcome.ended == "done" for one in found for outcome in one.outcomes):
                outcome = found[0].outcomes[0]
                raise LatconError(f"{record.directory}: no run of the first {len(found)} points is done; the first was "
                                  f"{outcome.ended}: {outcome.message}")
        return Fit(place, problem, tuple(record.evaluations.values()))
