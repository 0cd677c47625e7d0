"""Statistical tests of means over seeds, at the level SIGNIFICANCE."""
from __future__ import annotations

import dataclasses
import math
from collections.abc import Sequence
from typing import Any

SIGNIFICANCE = 0.05
"""Probability that a test finds a difference if there is none."""


@dataclasses.dataclass(frozen=True)
class SampleMean:
    """Mean of independent, normally distributed measurements of a quantity, in any unit.

    Attributes
    ----------
    n : int
        Number of measurements, >= 1.
    variance : float
        Sample variance of one measurement, n - 1 degrees of freedom; unused if n is 1.
    min_variance : float
        Squared uncertainty of one measurement; 0: unknown.
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
    adjusted = list(p_values)
    last = 0.0
    order = sorted((i for i, p in enumerate(p_values) if not math.isnan(p)), key=lambda i: p_values[i])
    for rank, i in enumerate(order):
        last = max(last, (len(p_values) - rank) * p_values[i])
        adjusted[i] = min(last, 1.0)
    return adjusted


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
    import numpy as np
    from scipy.special import ndtri
    n_draws = 20000
    draws = _mersenne_twister(19590601, n_draws * len(weights))
    uniform = ((draws >> np.uint64(11)).astype(float) + 0.5) * 2.0**-53
    z = ndtri(uniform).reshape(n_draws, -1) / np.sqrt(np.asarray(weights, float))
    counts = [0] * len(weights)
    for row in z.tolist():
        counts[len(isotonic_blocks(row, weights)) - 1] += 1
    return [count / n_draws for count in counts]


def _mersenne_twister(seed: int, n: int) -> Any:
    """Returns n numbers of the 64-bit Mersenne twister (T. Nishimura, ACM Trans. Model. Comput. Simul. 10, 348 (2000))."""
    import numpy as np
    mask = 2**64 - 1
    state = [seed]
    for i in range(1, 312):
        state.append((6364136223846793005 * (state[-1] ^ state[-1] >> 62) + i) & mask)
    numbers: list[int] = []
    upper = mask ^ 0x7FFFFFFF
    while len(numbers) < n:
        for i in range(312):
            x = state[i] & upper | state[(i + 1) % 312] & 0x7FFFFFFF
            state[i] = state[(i + 156) % 312] ^ x >> 1 ^ (0xB5026F5AA96619E9 if x & 1 else 0)
        numbers += state
    y = np.array(numbers[:n], np.uint64)
    y ^= y >> np.uint64(29) & np.uint64(0x5555555555555555)
    y ^= y << np.uint64(17) & np.uint64(0x71D67FFFEDA60000)
    y ^= y << np.uint64(37) & np.uint64(0xFFF7EEE000000000)
    return y ^ y >> np.uint64(43)


def isotonic_test(samples: Sequence[SampleMean], levels: Sequence[float] | None = None) -> tuple[float, float] | None:
    """Returns p-values of a rise and of a fall, under equal means.

    p_rise: of an equally clear rise, small if the means rise; p_fall: of an equally clear violation of the order, small if the
    means fall somewhere. The tests of Robertson, Wright, and Dykstra, chapter 2, with a pooled variance.

    Parameters
    ----------
    levels
        As of :func:`level_probabilities`, the default.

    Returns
    -------
    tuple or None
        None for fewer than two samples, or without scatter.
    """
    k = len(samples)
    freedom = sum(sample.n - 1 for sample in samples)
    squares = sum((sample.n - 1) * sample.variance for sample in samples if sample.n > 1)
    if k < 2 or not squares > 0:
        return None
    weights = [float(sample.n) for sample in samples]
    total = sum(weights)
    centre = sum(sample.n * sample.mean for sample in samples) / total
    least = sum(sample.n * sample.min_variance for sample in samples) / total
    variance = SampleMean(0.0, 1, squares / freedom, least).floored_variance
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
