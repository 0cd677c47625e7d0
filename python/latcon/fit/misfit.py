"""Misfit of evaluated points: squared differences between means over seeds and observations, in units of their uncertainty."""
from __future__ import annotations

import dataclasses
import math
from collections.abc import Sequence

import numpy as np
import numpy.typing as npt

from ..frames import Floats
from .problem import Observation, Problem
from .record import Evaluation

# Least contribution of an observation that a run does not determine: ten standard deviations.
UNDETERMINED = 100.0


@dataclasses.dataclass(frozen=True)
class Table:
    """Evaluated points as arrays; row per point, column per observation.

    Attributes
    ----------
    numbers : (points,) array
        Numbers of the points, ascending.
    coordinates : (points, parameters) array
        0 at the lower bound, 1 at the upper.
    means : (points, observations) array
        Means over the seeds that determine the quantity, of a word the fraction of seeds that have it; NaN if none does.
    determined : (points, observations) array
        Fraction of seeds that determine the quantity.
    scatter : (observations,) array
        Standard deviation of a quantity from seed to seed; 0 if unknown.
    targets, sigmas : (observations,) array
        Observed values and their uncertainties.
    totals : (observations,) array
        Uncertainty of observation and mean over all seeds together.
    is_word : (observations,) array
        Whether the quantity is a word or truth value.
    misfits : (points,) array
        Misfit of each point; infinite if its runs were not all done.
    """

    numbers: npt.NDArray[np.int_]
    coordinates: Floats
    means: Floats
    determined: Floats
    scatter: Floats
    targets: Floats
    sigmas: Floats
    totals: Floats
    is_word: npt.NDArray[np.bool_]
    misfits: Floats

    @property
    def best(self) -> int | None:
        """Row of the smallest misfit; None without a point that is done."""
        return int(np.argmin(self.misfits)) if np.isfinite(self.misfits).any() else None


def tabulate(problem: Problem, evaluations: Sequence[Evaluation]) -> Table:
    r"""Misfits of evaluated points.

    The misfit is the sum over observations of :math:`(m - y)^2 / (\sigma^2 + s^2 / n)`, with the mean :math:`m` over :math:`n`
    seeds, the observed value :math:`y \pm \sigma` and the scatter :math:`s` between seeds. The scatter is that of all points
    together, since that of one point is known poorly. An observation that a fraction of the seeds does not determine contributes
    that fraction of the largest contribution of any point, at least of :data:`UNDETERMINED`.
    """
    count, observations = len(problem.seeds), problem.observations
    samples = np.full((len(evaluations), len(observations), count), np.nan)
    own = np.full_like(samples, np.nan)
    for row, evaluation in enumerate(evaluations):
        for seed, outcome in enumerate(evaluation.outcomes):
            for column, observation in enumerate(observations):
                if outcome.ended == "done":
                    measured = outcome.measured[observation.quantity]
                    samples[row, column, seed], own[row, column, seed] = _number(observation, measured)
    is_known = np.isfinite(samples)
    known = is_known.sum(axis=2)
    means = np.where(known > 0, np.where(is_known, samples, 0).sum(axis=2) / np.maximum(known, 1), np.nan)
    scatter = np.array([0.0 if observation.is_word else _scatter(samples[:, column], own[:, column])
                        for column, observation in enumerate(observations)])
    targets = np.array([1.0 if observation.is_word else float(observation.value) for observation in observations])
    sigmas = np.array([observation.sigma for observation in observations])
    fraction = known / count
    terms = np.where(known > 0, (means - targets)**2 / (sigmas**2 + scatter**2 / np.maximum(known, 1)), 0)
    undetermined = np.maximum(UNDETERMINED, terms.max(axis=0, initial=0))  # no better than any determined one
    misfits = (fraction * terms + (1 - fraction) * undetermined).sum(axis=1)
    misfits[[evaluation.ended != "done" for evaluation in evaluations]] = math.inf
    coordinates = np.array([problem.coordinates(evaluation.values) for evaluation in evaluations])
    return Table(np.array([evaluation.number for evaluation in evaluations], int),
                 coordinates.reshape(len(evaluations), len(problem.axes)), means, fraction, scatter, targets, sigmas,
                 np.sqrt(sigmas**2 + scatter**2 / count), np.array([observation.is_word for observation in observations]), misfits)


def _number(observation: Observation, measured: tuple[float | str | bool, float]) -> tuple[float, float]:
    value, uncertainty = measured
    if observation.is_word:
        return (float("nan") if isinstance(value, float) else float(value == observation.value)), math.nan
    return float(value), uncertainty


def _scatter(samples: Floats, own: Floats) -> float:
    """Standard deviation between seeds: median over points; from one seed the median of the runs' own uncertainties."""
    known = np.isfinite(samples).sum(axis=1)
    several = known >= 2
    if several.any():
        # Median of the variance of n normal numbers over its mean, Wilson and Hilferty's approximation.
        freedom = known[several] - 1
        ratio = (1 - 2 / (9 * freedom))**3
        return math.sqrt(float(np.median(np.nanvar(samples[several], axis=1, ddof=1) / ratio)))
    own = own[np.isfinite(own)]
    return float(np.median(own)) if own.size else 0.0
