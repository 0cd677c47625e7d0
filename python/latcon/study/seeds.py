"""Statistics of a quantity of one run over its seeds."""
from __future__ import annotations

import dataclasses
import math
from collections import Counter
from collections.abc import Sequence
from typing import Any

from ..quantities import quantity_text
from .outcome import RunOutcome, RunState
from .statistical_tests import SampleMean
from .study_file import UNDECIDED


@dataclasses.dataclass
class SeedStatistics:
    """Statistics of a quantity of one run.

    Attributes
    ----------
    n_seeds, n : int
        Planned seeds, and seeds that have the quantity.
    abscissa : float or None
        Value of the row's `against`.
    mean, deviation : float or None
        Mean, and standard deviation over the seeds, n - 1; None if n = 0, or for the pattern, and if n < 2.
    uncertainty : float or None
        Root mean square of the uncertainties of single measurements, over seeds with one.
    patterns : dict
        Number of seeds per pattern, sorted, without ``undecided``.
    n_lost : int
        Seeds whose run was refused, rejected, failed, or not run.
    missing : list of str
        ``seed 3 failed``, for each seed without the quantity.
    """

    run: str
    n_seeds: int = 0
    n: int = 0
    abscissa: Any = None
    mean: Any = None
    deviation: float | None = None
    uncertainty: float | None = None
    patterns: dict[str, int] = dataclasses.field(default_factory=dict)
    n_undecided: int = 0
    n_lost: int = 0
    missing: list[str] = dataclasses.field(default_factory=list)

    @property
    def is_measured(self) -> bool:
        """Whether at least three quarters of the seeds have the quantity, as every rule requires. The mean is biased if seeds lack
        it systematically: by 0.42 standard deviations without the lowest quarter of a normal distribution, by 0.80 without the
        lowest half."""
        return self.n > 0 and 4 * self.n >= 3 * self.n_seeds

    @property
    def is_lost(self) -> bool:
        """Whether more than a quarter of the seeds ended without a measurement. A run that is not lost may still lack the quantity,
        as a straight crack has no amplitude."""
        return 4 * self.n_lost > self.n_seeds

    @property
    def count(self) -> str:
        """Number of seeds that have the quantity: "5", or "4 of 5"."""
        return f"{self.n} of {self.n_seeds}" if self.n < self.n_seeds else f"{self.n}"

    def sample(self) -> SampleMean:
        """Returns mean and scatter over the seeds, for tests. The run must have a mean."""
        return SampleMean(self.mean, self.n, (self.deviation or 0.0)**2, (self.uncertainty or 0.0)**2)

    def shows(self, pattern: str) -> bool:
        """Returns whether the pattern is measured and all seeds with a pattern have this one."""
        return self.is_measured and list(self.patterns) == [pattern]

    def text(self, unit: str) -> str:
        """Describes the result: "2.29 ± 0.04 cm (5)", or "(4 of 5)" if a seed lacks it; "oscillating 4/5, undecided 1/5"."""
        if self.mean is not None:
            return f"{quantity_text(self.mean, self.deviation, unit)} ({self.count})"
        counts = self.patterns | ({UNDECIDED: self.n_undecided} if self.n_undecided else {})
        return ", ".join(f"{pattern} {count}/{self.n_seeds}" for pattern, count in counts.items()) or "not measured"


def group_by_run(outcomes: Sequence[RunOutcome]) -> dict[str, list[RunOutcome]]:
    """Returns the outcomes of the seeds of each run."""
    groups: dict[str, list[RunOutcome]] = {}
    for outcome in outcomes:
        groups.setdefault(outcome.run, []).append(outcome)
    return groups


def statistics(run: str, quantity: str, outcomes: Sequence[RunOutcome]) -> SeedStatistics:
    """Computes the statistics of one quantity over the outcomes of the seeds of a run."""
    seeds = SeedStatistics(run, len(outcomes))
    values, uncertainties = [], []
    patterns: Counter[str] = Counter()
    for outcome in outcomes:
        if outcome.state is not RunState.MEASURED:
            seeds.n_lost += 1
            seeds.missing.append(f"seed {outcome.seed} {outcome.state.value}")
        elif quantity == "pattern" and outcome.pattern != UNDECIDED:
            patterns[outcome.pattern] += 1
        elif quantity in outcome.values:
            values.append(outcome.values[quantity])
            if quantity + "_uncertainty" in outcome.values:
                uncertainties.append(outcome.values[quantity + "_uncertainty"])
        else:  # a crack with this pattern does not have this quantity
            seeds.n_undecided += quantity == "pattern"
            seeds.missing.append(f"seed {outcome.seed} {outcome.pattern}")
    seeds.patterns = dict(sorted(patterns.items()))
    seeds.n = len(values) + patterns.total()
    if values:
        mean = seeds.mean = _sum(values) / len(values)
        if len(values) > 1:
            seeds.deviation = math.sqrt(_sum([(value - mean) * (value - mean) for value in values]) / (len(values) - 1))
        if uncertainties:
            seeds.uncertainty = math.sqrt(_sum([value * value for value in uncertainties]) / len(uncertainties))
    return seeds


def _sum(values: Sequence[float]) -> float:
    """Adds in order: the sum of Python 3.12 is compensated, and tables would depend on the version."""
    total = 0.0
    for value in values:
        total += value
    return total
