"""The search itself: batches of points, evaluated and recorded."""
from __future__ import annotations

import os
import time
from collections.abc import Callable, Sequence

from ..commands import CaseLike
from ..errors import LatconError
from ..folder import absolute
from ..program import Progress, progress_indicator
from .misfit import tabulate
from .problem import Entries, Observation, Parameter, Problem, resolve_problem
from .record import Record
from .result import Fit
from .runs import evaluate
from .search import propose


def fit_case(case: CaseLike, parameters: Sequence[Parameter], observations: Sequence[Observation],
             directory: str | os.PathLike[str], *, command: str = "fracture", seeds: Sequence[int] | None = None,
             entries: Entries | None = None, evaluations: int = 40, batch: int = 8, workers: int | None = None,
             skip_verification: bool = False, keep_runs: bool = False, search_seed: int = 0, progress: Progress = True) -> Fit:
    """Fits parameters of a case to observations.

    Sobol points come first, then those of Optuna's TPE sampler, and the second half of the points lies around the minimum of a
    local quadratic model of the quantities. Each point is a run per seed. A fit that was interrupted or killed continues if it
    is called again with the same directory, also with more evaluations, or with other observed values of the same quantities.
    Without an interruption the points are the same, and for any number of workers.

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
        If the directory holds another fit or is in use, optuna or scipy is missing, or no run of the first batch is done.
    OutputFailed
        If a run cannot write its files. Other errors of a run are recorded with the point, which gets a misfit worse than
        that of all others.
    KeyboardInterrupt
        After Ctrl-C, or a signal to a run: all runs are stopped, with checkpoints.
    """
    for name, number in (("evaluations", evaluations), ("batch", batch), ("workers", workers or 1)):
        if number < 1:
            raise ValueError(f"{name} = {number}: must be positive")
    problem = resolve_problem(case, parameters, observations, command, seeds, skip_verification, entries)
    with Record(absolute(directory), problem) as record:
        _Search(problem, record, evaluations, batch, workers or len(os.sched_getaffinity(0)), keep_runs, search_seed).run(progress)
        return Fit(record.directory, problem, tuple(record.evaluations.values()))


class _Search:
    """Loop over the batches of a fit."""

    def __init__(self, problem: Problem, record: Record, evaluations: int, batch: int, workers: int, keep_runs: bool, seed: int
                 ) -> None:
        self._problem = problem
        self._record = record
        self._evaluations = evaluations
        self._batch = batch
        self._workers = workers
        self._keep_runs = keep_runs
        self._seed = seed

    def run(self, progress: Progress) -> None:
        indicator = progress_indicator(progress)
        begin, held = time.monotonic(), len(self._record.evaluations)

        def show() -> None:
            done = len(self._record.evaluations)
            rate = (time.monotonic() - begin) / max(1, done - held)
            misfits = tabulate(self._problem, list(self._record.evaluations.values())).misfits
            left = max(0, self._evaluations - done) * rate
            indicator.line(f"{done} of {self._evaluations} points, least misfit {misfits.min():.4g}, {left:.0f} s left", left)
        try:
            for first in range(0, self._evaluations, self._batch):
                numbers = range(first, min(first + self._batch, self._evaluations))
                if missing := [number for number in numbers if number not in self._record.evaluations]:
                    self._evaluate(numbers, missing, show)
                if first == 0:
                    self._check_first_batch()
        finally:
            indicator.close()

    def _evaluate(self, numbers: range, missing: list[int], show: Callable[[], None]) -> None:
        earlier = [evaluation for number, evaluation in self._record.evaluations.items() if number < numbers.start]
        chosen = propose(tabulate(self._problem, earlier), len(self._problem.axes), numbers.start, len(numbers),
                         self._evaluations, self._seed)
        points = [(number, stage, self._problem.values(at)) for number, (stage, at) in zip(numbers, chosen) if number in missing]
        evaluate(self._record, points, self._workers, self._keep_runs, show)

    def _check_first_batch(self) -> None:
        found = list(self._record.evaluations.values())[:self._batch]
        if not any(outcome.ended == "done" for evaluation in found for outcome in evaluation.outcomes):
            outcome = found[0].outcomes[0]
            raise LatconError(f"{self._record.directory}: no run of the first {len(found)} points is done; the first was "
                              f"{outcome.ended}: {outcome.message}")
