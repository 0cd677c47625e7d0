"""Statistical tests of means over seeds, at the level SIGNIFICANCE, and power laws of means above an onset."""
from __future__ import annotations

import dataclasses
import math
from collections.abc import Callable, Sequence
from typing import Any

import numpy as np

SIGNIFICANCE = 0.05
"""Probability that a test finds a difference if there is none."""


@dataclasses.dataclass(frozen=True)
class SampleMean:
    """Mean of `n` >= 1 independent, normally distributed measurements of a quantity, in any unit.

    `variance` is that of one measurement with n - 1 degrees of freedom, unused if n is 1; `min_variance` the squared
    uncertainty of one measurement, 0 if unknown.
    """

    mean: float
    n: int
    variance: float = 0.0
    min_variance: float = 0.0

    @property
    def floored_variance(self) -> float:
        """Variance of one measurement, at least `min_variance`, which the sample variance includes: it is smaller only by chance.
        With the larger value tests find fewer differences, never more."""
        return max(self.variance, self.min_variance)


def welch_p_value(smaller: SampleMean, larger: SampleMean) -> float | None:
    """Returns the one-sided p-value of Welch's t-test, small if the mean of `larger` exceeds that of `smaller`.

    B. L. Welch, Biometrika 34, 28 (1947), with the degrees of freedom of F. E. Satterthwaite, Biometrics Bull. 2, 110 (1946),
    rounded down: for equal means the value is below 0.05 in at most 5 % of cases with two to five measurements of equal variance,
    and in 6.2 % for samples of two and five of which the latter has a third of the standard deviation. None if the error cannot
    be estimated: fewer than two measurements in a sample, or zero variance in both.
    """
    if smaller.n < 2 or larger.n < 2:
        return None
    a, b = smaller.variance / smaller.n, larger.variance / larger.n
    if not a + b > 0:
        return None
    # From the sample variances, so that the floor does not add degrees of freedom. 1e-9 compensates round-off below an integer.
    freedom = (a + b)**2 / (a * a / (smaller.n - 1) + b * b / (larger.n - 1)) + 1e-9
    t = (larger.mean - smaller.mean) / math.sqrt(smaller.floored_variance / smaller.n + larger.floored_variance / larger.n)
    if not math.isfinite(t) or not math.isfinite(freedom):
        return None
    from scipy.special import stdtr
    return float(stdtr(math.floor(freedom), -t))


def adjust_by_holm(p_values: Sequence[float]) -> list[float]:
    """Adjusts the p-values of several comparisons after Holm (S. Holm, Scand. J. Statist. 6, 65 (1979)).

    The probability that at least one of them falls below a bound by chance is at most that bound. NaN remains NaN, and counts.
    """
    p = np.array(p_values, float)
    order = np.argsort(p)  # NaN last
    p[order] = np.minimum(np.maximum.accumulate(np.arange(len(p), 0, -1) * p[order]), 1.0)
    return p.tolist()


def isotonic_blocks(means: Sequence[float], weights: Sequence[float]) -> list[tuple[float, float, int]]:
    """Returns mean, weight and length of the blocks of the closest non-decreasing sequence, by pooling adjacent violators."""
    blocks: list[tuple[float, float, int]] = []
    for mean, weight in zip(means, weights):
        n = 1
        while blocks and blocks[-1][0] >= mean:
            before, w, m = blocks.pop()
            mean, weight, n = (w * before + weight * mean) / (w + weight), w + weight, m + n
        blocks.append((mean, weight, n))
    return blocks


def level_probabilities(weights: Sequence[float]) -> list[float]:
    """Returns the probabilities that the isotonic fit to k normal numbers with variances 1 / w has 1 to k different values.

    P(l, k; w) of Robertson, Wright, and Dykstra, Order Restricted Statistical Inference, Wiley 1988, section 2.3, estimated from
    20,000 draws of a fixed sequence of random numbers, with a standard deviation of at most 0.004.
    """
    n_draws = 20000
    # RandomState, since no later version of numpy changes its numbers.
    draws = np.random.RandomState(19590601).standard_normal((n_draws, len(weights))) / np.sqrt(weights)
    n_blocks = [len(isotonic_blocks(row, weights)) for row in draws.tolist()]
    return [n_blocks.count(n) / n_draws for n in range(1, len(weights) + 1)]


def pooled_variance(samples: Sequence[SampleMean]) -> tuple[float, int] | None:
    """Returns the common variance of one measurement, floored, and its degrees of freedom; None without scatter."""
    freedom = sum(sample.n - 1 for sample in samples)
    squares = sum((sample.n - 1) * sample.variance for sample in samples if sample.n > 1)
    least = sum(sample.n * sample.min_variance for sample in samples) / sum(sample.n for sample in samples)
    return (SampleMean(0.0, 1, squares / freedom, least).floored_variance, freedom) if squares > 0 else None


def isotonic_test(samples: Sequence[SampleMean], levels: Sequence[float] | None = None) -> tuple[float, float] | None:
    """Returns p-values of a rise and of a fall, under equal means; None for fewer than two samples, or without scatter.

    p_rise: of an equally clear rise, small if the means rise; p_fall: of an equally clear violation of the order, small if the
    means fall somewhere. The tests of Robertson, Wright, and Dykstra, chapter 2, with a pooled variance. `levels` are those of
    :func:`level_probabilities`, the default.
    """
    k = len(samples)
    if k < 2 or (pooled := pooled_variance(samples)) is None:
        return None
    variance, freedom = pooled
    weights = [float(sample.n) for sample in samples]
    total = sum(weights)
    centre = sum(sample.n * sample.mean for sample in samples) / total
    fit = isotonic_blocks([sample.mean for sample in samples], weights)
    explained = sum(weight * (mean - centre)**2 for mean, weight, _ in fit) / variance
    fitted = [mean for mean, _, n in fit for _ in range(n)]
    left = sum(weight * (sample.mean - mean)**2 for weight, sample, mean in zip(weights, samples, fitted)) / variance
    if not math.isfinite(explained) or not math.isfinite(left):
        return None
    from scipy.special import fdtrc
    levels = levels or level_probabilities(weights)
    # If the fit explains nothing, or everything, every sequence is at least as extreme.
    p_rise = 1.0 if len(fit) == 1 else sum(levels[l] * float(fdtrc(l, freedom, explained / l)) for l in range(1, k))
    p_fall = 1.0 if len(fit) == k else sum(levels[l - 1] * float(fdtrc(k - l, freedom, left / (k - l))) for l in range(1, k))
    return p_rise, p_fall


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

    `exponent` and `onset` are beta and p_c with their intervals; an end of the exponent at MIN_EXPONENT or MAX_EXPONENT is not
    bounded by the data. `prefactor` is C, `p_fit` the probability that the scatter of the seeds explains distances of the means
    from the curve as large as these.
    """

    exponent: Interval
    onset: Interval
    prefactor: float
    p_fit: float

    @property
    def is_bounded(self) -> bool:
        """True if the data bound the exponent on both sides."""
        return self.exponent[1] > MIN_EXPONENT and self.exponent[2] < MAX_EXPONENT


def fit_onset(points: Sequence[tuple[float, SampleMean]]) -> OnsetFit | None:
    """Fits A = C (p - p_c)^beta to means above an onset by least squares, weighted with the numbers of seeds.

    For a supercritical Hopf bifurcation beta = 1/2 (S. H. Strogatz, Nonlinear Dynamics and Chaos, section 8.2). C is linear and
    eliminated; p_c is minimised over for each beta, from ten times the range of the parameters below the smallest of them up to
    it. The intervals are those of the profile likelihood for normal errors of common variance s^2: all values for which the
    least sum of squares S exceeds its minimum by at most F(1, nu; 95 %) s^2 (D. M. Bates, D. G. Watts, Nonlinear Regression
    Analysis and its Applications, Wiley 1988, section 6.1). s^2 is the larger of the pooled variance of the seeds (at least the
    squared uncertainty of single measurements) and of the mean square of what the curve leaves, so that a curve that does not
    fit has wider intervals; nu are the degrees of freedom of that one.

    `points` are parameters and means in any order. None for fewer than five, for parameters that are not distinct, numbers that
    are not finite, means that are not positive, or seeds without scatter.
    """
    if any(math.isnan(parameter) for parameter, _ in points):
        return None
    points = sorted(points, key=lambda point: point[0])
    p = [parameter for parameter, _ in points]
    samples = [sample for _, sample in points]
    if (len(p) < 5 or not all(map(math.isfinite, p)) or any(a >= b for a, b in zip(p, p[1:]))
            or not all(math.isfinite(sample.mean) and sample.mean > 0 and sample.n >= 1 for sample in samples)):
        return None
    if (pooled := pooled_variance(samples)) is None or not math.isfinite(pooled[0]):
        return None
    variance, freedom = pooled

    from scipy.special import fdtrc, fdtri
    start, extent = p[0], p[-1] - p[0]
    x = (np.array(p) - start) / extent
    y = np.array([sample.mean for sample in samples])
    weight = np.array([float(sample.n) for sample in samples])

    # Of exponents and u [...], single ones or arrays.
    def powers(exponent: Any, u: Any) -> Any:
        return (x + np.vectorize(math.exp)(u)[..., np.newaxis])**np.asarray(exponent)[..., np.newaxis]

    def prefactor(power: Any) -> Any:
        return (weight * power * y).sum(-1) / (weight * power * power).sum(-1)

    def squares(exponent: Any, u: Any) -> Any:
        power = powers(exponent, u)
        return (weight * (y - prefactor(power)[..., np.newaxis] * power)**2).sum(-1)

    def over_onset(exponent: float) -> tuple[float, float]:
        return _minimum(lambda u: squares(exponent, u), _MIN_U, _MAX_U, 120)

    def of_exponent(exponent: float) -> float:
        return over_onset(exponent)[1]

    def of_onset(u: float) -> float:
        return _minimum(lambda exponent: squares(exponent, u), MIN_EXPONENT, MAX_EXPONENT, 60)[1]

    exponent, smallest = _minimum(np.vectorize(of_exponent), MIN_EXPONENT, MAX_EXPONENT, 60)
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
        float(prefactor(powers(exponent, u))) / extent**exponent, float(fdtrc(freedom_of_fit, freedom, mean_square / variance)))


def _minimum(function: Callable[[Any], Any], low: float, high: float, n_steps: int) -> tuple[float, float]:
    """Returns place and value of the minimum of a function of arrays: a scan, then Brent's method about its smallest value."""
    from scipy.optimize import minimize_scalar
    step = (high - low) / n_steps
    scan = low + step * np.arange(n_steps + 1)
    values = function(scan)
    value, at = float(values.min()), float(scan[values.argmin()])
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
