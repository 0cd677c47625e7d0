"""Power law of a quantity above its onset."""
from __future__ import annotations

import dataclasses
import math
from collections.abc import Callable, Sequence

from .statistical_tests import SIGNIFICANCE, SampleMean

MIN_EXPONENT, MAX_EXPONENT = 0.05, 3.0
"""Exponents that the fit considers: with 1/4 (tricritical), 1/2 (Hopf) and 1 (transcritical bifurcation)."""

# Distance of the onset below the smallest parameter, over the range of the parameters. Beyond the largest the curve is an
# exponential to within the scatter of any data; at 0 it vanishes at the first point, whatever the exponent.
_MIN_U, _MAX_U = math.log(1e-9), math.log(10.0)

Interval = tuple[float, float, float]
"""Estimate with the ends of its 95 % confidence interval."""


@dataclasses.dataclass(frozen=True)
class OnsetFit:
    """Fit of A = C (p - p_c)^beta.

    Attributes
    ----------
    exponent, onset : tuple
        beta and p_c with their intervals; an end of the exponent at MIN_EXPONENT or MAX_EXPONENT is not bounded by the data.
    prefactor : float
        C.
    p_fit : float
        Probability that the scatter of the seeds explains distances of the means from the curve as large as these.
    """

    exponent: Interval
    onset: Interval
    prefactor: float
    p_fit: float

    @property
    def is_bounded(self) -> bool:
        """Whether the data bound the exponent on both sides."""
        return self.exponent[1] > MIN_EXPONENT and self.exponent[2] < MAX_EXPONENT


def fit_onset(points: Sequence[tuple[float, SampleMean]]) -> OnsetFit | None:
    """Fits A = C (p - p_c)^beta to means above an onset by least squares, weighted with the numbers of seeds.

    For a supercritical Hopf bifurcation beta = 1/2 (S. H. Strogatz, Nonlinear Dynamics and Chaos, section 8.2). C is linear and
    eliminated; p_c is minimised over for each beta, from ten times the range of the parameters below the smallest of them up to
    it. The intervals are those of the profile likelihood for normal errors of common variance s^2: all values for which the least
    sum of squares S exceeds its minimum by at most F(1, nu; 95 %) s^2 (D. M. Bates, D. G. Watts, Nonlinear Regression Analysis and
    its Applications, Wiley 1988, section 6.1). s^2 is the larger of the pooled variance of the seeds (at least the squared
    uncertainty of single measurements) and of the mean square of what the curve leaves, so that a curve that does not fit has
    wider intervals; nu are the degrees of freedom of that one.

    Parameters
    ----------
    points
        Parameter and mean, above the onset, in any order.

    Returns
    -------
    OnsetFit or None
        None for fewer than five points, parameters that are not distinct, numbers that are not finite, means that are not
        positive, or seeds without scatter.
    """
    if any(math.isnan(parameter) for parameter, _ in points):
        return None
    points = sorted(points, key=lambda point: point[0])
    p = [parameter for parameter, _ in points]
    samples = [sample for _, sample in points]
    if (len(p) < 5 or not all(map(math.isfinite, p)) or any(a >= b for a, b in zip(p, p[1:]))
            or not all(math.isfinite(sample.mean) and sample.mean > 0 and sample.n >= 1 for sample in samples)):
        return None
    freedom = sum(sample.n - 1 for sample in samples)
    total = sum((sample.n - 1) * sample.variance for sample in samples if sample.n > 1)
    if not total > 0 or not math.isfinite(total):
        return None
    least = sum(sample.n * sample.min_variance for sample in samples) / sum(sample.n for sample in samples)
    variance = SampleMean(0.0, 1, total / freedom, least).floored_variance
    if not math.isfinite(variance):
        return None

    import numpy as np
    from scipy.special import fdtrc, fdtri
    start, extent = p[0], p[-1] - p[0]
    x = (np.array(p) - start) / extent
    y = np.array([sample.mean for sample in samples])
    weight = np.array([float(sample.n) for sample in samples])

    def prefactor(exponent: float, u: float) -> float:
        power = (x + math.exp(u))**exponent
        return float((weight * power * y).sum() / (weight * power * power).sum())

    def squares(exponent: float, u: float) -> float:
        return float((weight * (y - prefactor(exponent, u) * (x + math.exp(u))**exponent)**2).sum())

    def over_onset(exponent: float) -> tuple[float, float]:
        return _minimum(lambda u: squares(exponent, u), _MIN_U, _MAX_U, 120)

    def of_exponent(exponent: float) -> float:
        return over_onset(exponent)[1]

    def of_onset(u: float) -> float:
        return _minimum(lambda exponent: squares(exponent, u), MIN_EXPONENT, MAX_EXPONENT, 60)[1]

    exponent, smallest = _minimum(of_exponent, MIN_EXPONENT, MAX_EXPONENT, 60)
    u = over_onset(exponent)[0]
    freedom_of_fit = len(p) - 3
    mean_square = smallest / freedom_of_fit
    # A variance has the degrees of freedom of the data that it is estimated from.
    s2, nu = (mean_square, freedom_of_fit) if mean_square > variance else (variance, freedom)
    level = smallest + float(fdtri(1, nu, 1 - SIGNIFICANCE)) * s2

    def onset(u: float) -> float:
        return start - extent * math.exp(u)

    return OnsetFit(
        (exponent, _crossing(of_exponent, level, exponent, MIN_EXPONENT), _crossing(of_exponent, level, exponent, MAX_EXPONENT)),
        (onset(u), onset(_crossing(of_onset, level, u, _MAX_U)), onset(_crossing(of_onset, level, u, _MIN_U))),
        prefactor(exponent, u) / extent**exponent, float(fdtrc(freedom_of_fit, freedom, mean_square / variance)))


def _minimum(function: Callable[[float], float], low: float, high: float, n_steps: int) -> tuple[float, float]:
    """Returns place and value of the minimum: a scan, then Brent's method about its smallest value."""
    from scipy.optimize import minimize_scalar
    step = (high - low) / n_steps
    value, at = min((function(low + i * step), low + i * step) for i in range(n_steps + 1))
    found = minimize_scalar(function, bounds=(max(low, at - step), min(high, at + step)), method="bounded",
                            options={"xatol": 1e-8})
    return (float(found.x), float(found.fun)) if found.fun < value else (at, value)


def _crossing(function: Callable[[float], float], level: float, begin: float, end: float) -> float:
    """Returns the first place towards `end` where a function that is below a level at `begin` reaches it; `end` if none."""
    from scipy.optimize import brentq
    step = (end - begin) / 60
    if step == 0:
        return end
    before = begin
    for i in range(1, 61):
        at = begin + i * step
        if function(at) > level:
            return before if function(before) >= level else float(brentq(lambda x: function(x) - level, before, at, xtol=1e-9))
        before = at
    return end
