"""Local quadratic model of the observed quantities, and of the misfit, around the best point."""
from __future__ import annotations

import dataclasses
import itertools
from collections.abc import Callable

import numpy as np
import numpy.typing as npt

from ..frames import Floats
from .misfit import Table

# Standard deviation of a coordinate that is uniform between its bounds.
PRIOR = 1 / np.sqrt(12)


@dataclasses.dataclass(frozen=True)
class LocalModel:
    """Quantities as polynomials of the coordinates, fitted to the points around a minimum of the misfit.

    Attributes
    ----------
    center : (parameters,) array
        Coordinates of the minimum of the modelled misfit.
    covariance : (parameters, parameters) array
        Covariance of `center`: inverse of half the Hessian of the misfit, whose uncertainties include that of the model, plus
        that of a uniform distribution between the bounds.
    misfit : float
        Modelled misfit at `center`.
    degree : int
        1 or 2.
    rows : (used,) array
        Rows of the table that the model was fitted to.
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
        return _monomials((points - center) / scale, degree)
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
    jacobian = _jacobian(lambda point: residual(point, fixed), found.x)
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


def _monomials(points: Floats, degree: int) -> Floats:
    columns = [np.ones(len(points)), *points.T]
    if degree == 2:
        columns += [first * second for first, second in itertools.combinations_with_replacement(points.T, 2)]
    return np.stack(columns, axis=1)


def _jacobian(function: Callable[[Floats], Floats], point: Floats, step: float = 1e-5) -> Floats:
    """Derivatives by central differences, exact for a quadratic but for round-off."""
    columns = []
    for axis in range(len(point)):
        offset = np.zeros_like(point)
        offset[axis] = step
        columns.append((function(point + offset) - function(point - offset)) / (2 * step))
    return np.stack(columns, axis=1)
