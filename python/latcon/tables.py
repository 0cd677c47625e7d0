"""Numbers of a crack that follow from its tables: scatter, growth or decay of its path, and energies per area."""
from __future__ import annotations

import math
import pathlib
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from .errors import UnreadableFile
from .files import read_columns

_COLUMN = 2.0  # spacings over which hops of the tip are averaged, as in the measurement of a path
_LONGEST_CORRELATION = 0.9


def table_values(folder: str, spacing: float, begin: float, end: float) -> dict[str, float]:
    """Numbers of the path between two X, and energies per area of crack between the first and the last rows of energies there.

    `folder` is the output directory of a crack, `spacing` d of the lattice [m], `begin` and `end` the window of the
    measurement, undeformed [m]. Returns ``path_rms`` [m], ``path_growth`` [1/m] and its uncertainty, ``viscous_per_area`` and
    ``broken_per_area`` [J/m^2]; those that can be measured.
    """
    try:
        tip = read_columns(pathlib.Path(folder, "crack.csv"), ("t", "X", "Y"))
        energy = read_columns(pathlib.Path(folder, "energy.csv"), ("t", "viscous", "broken"))
    except UnreadableFile:
        return {}
    inside = (tip["X"] >= begin) & (tip["X"] <= end)
    X, Y, t = tip["X"][inside], tip["Y"][inside], tip["t"][inside]
    if len(X) < 2:
        return {}
    values = {"path_rms": float(np.std(Y))}
    if fit := path_growth(X, Y, spacing):
        values |= dict(zip(("path_growth", "path_growth_uncertainty"), fit))
    rows = np.flatnonzero((energy["t"] >= t[0]) & (energy["t"] <= t[-1]))
    if len(rows) > 1:
        advance = np.diff(np.interp(energy["t"][rows[[0, -1]]], t, X))[0]
        values |= {f"{name}_per_area": float((energy[name][rows[-1]] - energy[name][rows[0]]) / advance)
                   for name in ("viscous", "broken") if advance > 0}
    return values


def path_growth(X: ArrayLike, Y: ArrayLike, spacing: float) -> tuple[float, float] | None:
    """Fits exp(s X), or exp(s X) (a cos k X + b sin k X), to a path about the middle of the sheet, as a linear instability has
    it.

    Of the two the one with the higher Bayesian evidence (BIC) is taken. A path that returns to the middle has s < 0. Returns s
    and its standard deviation [1/m], that of least squares whose residuals are correlated from column to column; None for a
    path of fewer than 10 columns of 2 d, and for one that stays on the middle.
    """
    from scipy.optimize import least_squares
    x, y = np.asarray(X, float) / spacing, np.asarray(Y, float) / spacing
    column = np.floor((x - x[0]) / _COLUMN).astype(int)
    count = np.bincount(column)
    kept = count > 0
    x, y = np.bincount(column, x)[kept] / count[kept], np.bincount(column, y)[kept] / count[kept]
    n, x, length = len(x), x - x.mean(), x[-1] - x[0]
    if n < 10 or not np.abs(y).max() > 1e-3:
        return None

    def residuals(p: Any) -> Any:
        waves = [np.ones(n)] if len(p) == 1 else [np.cos(p[1] * x), np.sin(p[1] * x)]
        basis = (np.exp(p[0] * x) * waves).T
        return y - basis @ np.linalg.lstsq(basis, y, rcond=None)[0]

    rates = np.linspace(-6.0, 6.0, 7) / length
    # From three quarters of a period to a wavelength of 8 d, the shortest of the measurement.
    wavenumbers = 2.0 * math.pi / length * np.arange(0.75, length / 8.0, 0.5)
    starts: list[list[tuple[float, ...]]] = [[(rate,) for rate in rates], [(rate, k) for rate in rates for k in wavenumbers]]
    fits = [least_squares(residuals, min(some, key=lambda p: float(residuals(p) @ residuals(p))), x_scale=1.0 / length)
            for some in starts if some]
    # One or two amplitudes besides the parameters.
    best = min(fits, key=lambda fit: n * math.log(max(2.0 * fit.cost, 1e-12)) + 2 * len(fit.x) * math.log(n))
    rest = best.fun
    correlation = min(max(float(rest[1:] @ rest[:-1]) / max(float(rest @ rest), 1e-300), 0.0), _LONGEST_CORRELATION)
    variance = 2.0 * best.cost / max(n - 2 * len(best.x), 1) * (1.0 + correlation) / (1.0 - correlation)
    covariance = np.linalg.pinv(best.jac.T @ best.jac) * variance
    return float(best.x[0]) / spacing, math.sqrt(covariance[0, 0]) / spacing
