"""Misfit of evaluated points (squared differences between means over seeds and observations, in units of their uncertainty), and
its local quadratic model around the best point."""
from __future__ import annotations

import dataclasses
import itertools
import math
from collections.abc import Sequence

import numpy as np
import numpy.typing as npt

from ..frames import Floats
from .problem import Problem
from .record import Evaluation

# Least contribution of an observation that a run does not determine: ten standard deviations.
UNDETERMINED = 100.0


@dataclasses.dataclass(frozen=True)
class Table:
    """Evaluated points as arrays; row per point, column per observation.

    `coordinates` are 0 at the lower bound, 1 at the upper. `means` are those over the seeds that determine the quantity, of a
    word the fraction of seeds that have it, NaN if none does; `scatter` is the standard deviation from seed to seed, 0 if
    unknown. `targets` and `sigmas` are the observed values and their uncertainties, `totals` the uncertainty of observation and
    mean over all seeds together. `is_word` is true of words and truth values. `misfits` are infinite for points whose runs were not
    all done.
    """

    coordinates: Floats
    means: Floats
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
                    value, own[row, column, seed] = outcome.measured[observation.quantity]
                    if observation.is_word and not isinstance(value, float):
                        value = value == observation.value
                    samples[row, column, seed] = value
    is_known = np.isfinite(samples)
    samples[~is_known] = np.nan
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
    return Table(coordinates.reshape(len(evaluations), len(problem.axes)), means, scatter, targets, sigmas,
                 np.sqrt(sigmas**2 + scatter**2 / count), np.array([observation.is_word for observation in observations]), misfits)


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


# Standard deviation of a coordinate that is uniform between its bounds.
PRIOR = 1 / np.sqrt(12)


@dataclasses.dataclass(frozen=True)
class LocalModel:
    """Quantities as polynomials of the coordinates, of degree 1 or 2, fitted to `rows` of the table around a minimum of the
    misfit.

    `center` is the minimum of the modelled misfit, `misfit` its value there. `covariance` is that of `center`: inverse of half
    the Hessian of the misfit, whose uncertainties include that of the model, plus that of a uniform distribution between the
    bounds.
    """

    center: Floats
    covariance: Floats
    misfit: float
    degree: int
    rows: npt.NDArray[np.int_]

    @property
    def metric(self) -> Floats:
        """Inverse of the covariance."""
        return np.linalg.inv(self.covariance)


def fit_local_model(table: Table) -> LocalModel | None:
    """Fits the model to the points nearest to the best one; None if there are too few.

    Points are nearest first in the box, then in the metric of the model so found, so that a valley of nearly equal misfit is
    modelled along its length.
    """
    best = table.best
    if best is None:
        return None
    center, metric = table.coordinates[best], np.eye(table.coordinates.shape[1]) / PRIOR**2
    model = None
    for _ in range(3):
        found = _fit_near(table, center, metric)
        if found is None:
            return model
        model, center, metric = found, found.center, found.metric
    return model


def _fit_near(table: Table, center: Floats, metric: Floats) -> LocalModel | None:
    usable = np.isfinite(table.misfits) & _is_in_regime(table)
    varies = np.ptp(np.nan_to_num(table.means[usable]), axis=0) > 0 if usable.any() else np.zeros(len(table.targets), bool)
    columns = np.flatnonzero(varies & ~table.is_word)
    usable &= np.isfinite(table.means[:, columns]).all(axis=1)
    rows = np.flatnonzero(usable)
    parameters = table.coordinates.shape[1]
    sizes = {2: (parameters + 1) * (parameters + 2) // 2, 1: parameters + 1}
    degree = next((degree for degree, size in sizes.items() if len(rows) >= size + max(3, size // 2)), 0)
    if not degree or not columns.size:
        return None
    offsets = table.coordinates[rows] - center
    distances = np.sqrt(np.einsum("ij,jk,ik->i", offsets, metric, offsets))
    order = np.argsort(distances, kind="stable")[:3 * sizes[degree] + 2]
    rows, distances = rows[order], distances[order]
    weights = np.maximum(1 - (distances / (1.1 * distances[-1] + 1e-300))**3, 1e-3)**1.5  # square roots of tricube weights
    scale = np.maximum(np.abs(table.coordinates[rows] - center).max(axis=0), 1e-9)

    def basis(points: Floats) -> Floats:
        linear = list(((points - center) / scale).T)
        products = itertools.combinations_with_replacement(linear, 2) if degree == 2 else ()
        return np.stack([np.ones(len(points)), *linear, *(first * second for first, second in products)], axis=1)
    matrix = basis(table.coordinates[rows]) * weights[:, None]
    inverse = np.linalg.pinv(matrix, rcond=1e-10)
    coefficients = inverse @ (table.means[rows][:, columns] * weights[:, None])
    residuals = table.means[rows][:, columns] * weights[:, None] - matrix @ coefficients
    freedom = max(1.0, float((weights**2).sum()) - matrix.shape[1])
    variances = (residuals**2).sum(axis=0) / freedom
    # Of the estimated coefficients, in units of the variance of one mean; the weights are no uncertainties.
    spread = inverse @ np.diag(weights**2) @ inverse.T

    def sigmas(point: Floats) -> Floats:
        row = basis(point[None])[0]
        return np.sqrt(table.totals[columns]**2 + variances * float(row @ spread @ row))

    def residual(point: Floats, fixed: Floats) -> Floats:
        return np.asarray((basis(point[None])[0] @ coefficients - table.targets[columns]) / fixed)
    from scipy.optimize import least_squares
    low = np.maximum(0, table.coordinates[rows].min(axis=0))
    high = np.minimum(1, table.coordinates[rows].max(axis=0))
    low, high = np.maximum(0, low - 0.25 * (high - low) - 1e-9), np.minimum(1, high + 0.25 * (high - low) + 1e-9)
    # A quadratic may have several minima between the points: from the best of them, and from the center.
    starts = [table.coordinates[rows[np.argmin(table.misfits[rows])]], center]
    found = min((least_squares(residual, np.clip(start, low + 1e-12, high - 1e-12), bounds=(low, high), args=(sigmas(start),))
                 for start in starts), key=lambda result: result.cost)
    fixed = sigmas(found.x)
    steps = 1e-5 * np.eye(parameters)  # central differences are exact for a quadratic but for round-off
    jacobian = np.stack([(residual(found.x + step, fixed) - residual(found.x - step, fixed)) / (2 * 1e-5) for step in steps], axis=1)
    half_hessian = jacobian.T @ jacobian
    covariance = np.linalg.inv(half_hessian + np.eye(parameters) / PRIOR**2)
    return LocalModel(found.x, covariance, float((residual(found.x, fixed)**2).sum()), degree, rows)


def _is_in_regime(table: Table) -> npt.NDArray[np.bool_]:
    """Points at which all words are as observed, within two standard deviations or as well as at the best point.

    Quantities may jump where a word changes, and no polynomial does.
    """
    deviations = np.abs(table.means - table.targets)[:, table.is_word]
    best = table.best
    assert best is not None
    return np.asarray((deviations <= np.maximum(2 * table.sigmas[table.is_word], deviations[best])).all(axis=1))
