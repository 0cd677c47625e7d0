"""Evaluation of the rows of a study: measured values and verdicts."""
from __future__ import annotations

import dataclasses
import enum
import math
from collections.abc import Mapping, Sequence
from typing import Any

from ..quantities import quantity_text
from ..rows import judged_row
from .outcome import RunOutcome, SeedStatistics, group_by_run, statistics
from .plan import PlannedRun
from .statistical_tests import SIGNIFICANCE, Interval, OnsetFit, adjust_by_holm, fit_onset, isotonic_test, welch_p_value
from .study_file import Rule, Study, StudyClaim, StudyRow

_NO_SCATTER = "the scatter of the seeds is unknown: at least two seeds with different values are needed"


class Verdict(enum.Enum):
    """Verdict on a row, or on a claim."""

    HOLDS = "holds"
    DOES_NOT_HOLD = "does not hold"
    REPORTED = "reported"  # the row has no rule
    NOT_MEASURED = "not measured"  # too few seeds or runs have the quantity, or their scatter is unknown
    INCOMPLETE = "incomplete"  # of a claim: some rows hold, others were not measured


def _number(value: float) -> str:
    return quantity_text(value, None, "1")


def _p_text(p: float) -> str:
    return "p < 0.0001" if p < 1e-4 else "p = " + _number(math.floor(1e4 * p + 0.5) / 1e4)


@dataclasses.dataclass
class RowOutcome:
    """Judged row.

    `bound` is that of a rule with one, None if the run that gives it was not measured. `measured` and `note` describe the
    result, and missing seeds and runs. `runs` are in the order of the row, or sorted by `against`. `number` is that of the row
    as a whole: mean, share of seeds with the pattern, exponent, middle of the bracket. The row holds if `misfit` is not larger
    than `allowed`; it is None unless the row was judged.
    """

    row: StudyRow
    bound: Any = None
    verdict: Verdict = Verdict.NOT_MEASURED
    measured: list[str] = dataclasses.field(default_factory=list)
    note: list[str] = dataclasses.field(default_factory=list)
    runs: list[SeedStatistics] = dataclasses.field(default_factory=list)
    number: float | None = None
    onset: OnsetFit | None = None
    misfit: float | None = None

    @property
    def is_test(self) -> bool:
        """True if the rule is a statistical test, whose misfit is a p-value."""
        return self.row.rule in (Rule.RISES, Rule.FALLS) or bool(self.row.bound_run) and self.row.rule is not Rule.IS_NEAR

    @property
    def allowed(self) -> float:
        """Largest misfit with which the row holds."""
        if self.row.rule in (Rule.IS_NEAR, Rule.ONSET_EXPONENT):
            return self.row.tolerance
        return SIGNIFICANCE if self.is_test else 0.0

    @property
    def has_bound(self) -> bool:
        """True if the rule compares with a bound."""
        return self.row.rule in (Rule.IS_NEAR, Rule.ABOVE, Rule.BELOW, Rule.ONSET_EXPONENT)

    @property
    def expected(self) -> str:
        """Description of the rule; empty if there is none."""
        row = self.row
        value = "" if self.bound is None else quantity_text(self.bound, None, row.unit)
        if row.bound_run:
            value = f"that of {row.bound_run}" + (f" ({value})" if value else "")
        return {
            Rule.REPORTED: "",
            Rule.IS: row.pattern,
            Rule.IS_NEAR: f"near {value} within {_number(100 * row.tolerance)} %",
            Rule.ABOVE: ("above " if row.bound_run else "at least ") + value,
            Rule.BELOW: ("below " if row.bound_run else "at most ") + value,
            Rule.RISES: f"rises with {row.against}",
            Rule.FALLS: f"falls with {row.against}",
            Rule.ONSET_EXPONENT: f"rises above an onset with an exponent of {_number(row.bound)} ± {_number(row.tolerance)}",
            Rule.BRACKET: f"{row.start} at small {row.against}, {row.to} at large"}[row.rule]

    def result(self, claim: str) -> dict[str, Any] | None:
        """Returns the row for `results.json`, which fails if it has a rule and was not measured; None if the row has neither a
        number nor a rule."""
        if self.number is None and self.verdict is Verdict.REPORTED:
            return None
        row = self.row
        quantity, unit = ", ".join(row.runs) + ": " + row.quantity, row.unit
        if row.rule.is_along:
            quantity, unit = quantity + ", " + self.expected, "1"
        theory = 1.0 if row.rule is Rule.IS else self.bound
        if self.verdict is Verdict.REPORTED:
            return judged_row(claim, quantity, unit, self.number, theory=theory)
        # Excess beyond the bound; 0 inside.
        error = math.nan if self.misfit is None else self.misfit if not self.misfit < 0 else 0.0
        reason = "error: " + (
            "p of the test, 1 if means contradict the rule" if self.is_test else
            {Rule.IS: "share of seeds with another pattern", Rule.IS_NEAR: "relative difference",
             Rule.ONSET_EXPONENT: "distance of the interval from the expected exponent",
             Rule.BRACKET: "number of contradictions to one critical value"}.get(
                 row.rule, "excess beyond the bound, in the unit of the quantity"))
        return judged_row(claim, quantity, unit, self.number, theory=theory, error=error, tolerance=self.allowed, reason=reason)


@dataclasses.dataclass
class ClaimOutcome:
    """Judged claim."""

    claim: StudyClaim
    rows: list[RowOutcome]

    @property
    def verdict(self) -> Verdict:
        """Does not hold if a row does not; holds if all rows with a rule do."""
        verdicts = {row.verdict for row in self.rows}
        if Verdict.DOES_NOT_HOLD in verdicts:
            return Verdict.DOES_NOT_HOLD
        if Verdict.NOT_MEASURED in verdicts:
            return Verdict.INCOMPLETE if Verdict.HOLDS in verdicts else Verdict.NOT_MEASURED
        return Verdict.HOLDS if Verdict.HOLDS in verdicts else Verdict.REPORTED


def judge_study(study: Study, plan: Sequence[PlannedRun], outcomes: Sequence[RunOutcome]) -> list[ClaimOutcome]:
    """Judges all rows of a study (docs/reference-studies.md), whose runs and their outcomes are in the same order."""
    groups = group_by_run(outcomes)
    planned = {run.run: run for run in plan}
    return [ClaimOutcome(claim, [judge(row, planned, groups, study.left_out) for row in claim.rows]) for claim in study.claims]


def judge(row: StudyRow, planned: Mapping[str, PlannedRun], outcomes: Mapping[str, Sequence[RunOutcome]],
          left_out: Sequence[str]) -> RowOutcome:
    """Judges a row. `planned` are runs, for the values of `against`, `outcomes` those of their seeds, by name; `left_out` the
    runs that this size of the study omits.
    """
    outcome = RowOutcome(row)
    other = statistics(row.bound_run, row.quantity, outcomes.get(row.bound_run, ()))
    if row.bound_run and not other.is_measured:
        outcome.note.append(f"{row.bound_run}, the run to compare with, was not measured")
    elif row.bound_run:
        outcome.bound = other.mean
    elif outcome.has_bound:
        outcome.bound = row.bound
    without = [name for name in row.runs if name in left_out]
    for name in row.runs:
        if name not in left_out:
            outcome.runs.append(statistics(name, row.quantity, outcomes.get(name, ())))
            if row.against and name in planned:
                outcome.runs[-1].abscissa = planned[name].value(row.against)
    outcome.runs.sort(key=lambda run: -math.inf if run.abscissa is None else run.abscissa)

    # Cracks without the quantity are an answer along `against`; runs that were omitted or lost are none.
    if without or any(run.is_lost for run in outcome.runs) or row.rule is Rule.REPORTED or (
            outcome.is_test and outcome.has_bound and outcome.bound is None):
        if len(outcome.runs) == 1:
            outcome.number = outcome.runs[0].mean
    elif row.rule.is_along and len({run.abscissa for run in _points(outcome)}) < len(_points(outcome)):
        outcome.note.append(f"several runs have one value of {row.against}")
    elif row.rule is Rule.BRACKET:
        _judge_bracket(outcome)
    elif row.rule is Rule.ONSET_EXPONENT:
        _judge_onset(outcome)
    elif row.rule.is_along:
        _judge_trend(outcome)
    else:
        _judge_each(outcome, other)

    if row.rule is Rule.REPORTED:
        outcome.verdict = Verdict.REPORTED
    elif outcome.misfit is not None:
        outcome.verdict = Verdict.HOLDS if outcome.misfit <= outcome.allowed else Verdict.DOES_NOT_HOLD
    for run in outcome.runs:
        at = run.run if run.abscissa is None else _number(run.abscissa)
        outcome.measured.append((f"{at}: " if len(outcome.runs) > 1 else "") + run.text(row.unit))
    outcome.note += [f"{name} is omitted in the quick study" for name in without]
    outcome.note += [f"{run.run}: not measured in {len(run.missing)} of {run.n_seeds} ({', '.join(run.missing)})"
                     for run in outcome.runs if run.missing]
    return outcome


def _judge_each(outcome: RowOutcome, other: SeedStatistics) -> None:
    """Judges rules for individual runs: all must satisfy the rule, beside another run significantly; the largest misfit counts, and
    one that is not a number is larger than all."""
    rule, bound = outcome.row.rule, outcome.bound
    if outcome.has_bound and bound is None:
        return
    pairs = []
    for run in outcome.runs:
        if not run.is_measured:
            return
        number: float = run.patterns.get(outcome.row.pattern, 0) / run.n if rule is Rule.IS else run.mean
        if rule is Rule.IS:
            misfit = 1.0 - number
        elif outcome.is_test:
            smaller, larger = (other, run) if rule is Rule.ABOVE else (run, other)
            p = welch_p_value(smaller.sample(), larger.sample())
            if p is None:
                outcome.note.append(f"{run.run} compared with {other.run}: {_NO_SCATTER}")
                return
            misfit = p
        elif rule is Rule.IS_NEAR:
            misfit = abs(number / bound - 1) if bound else 0.0 if number == bound else math.nan
        else:
            misfit = bound - number if rule is Rule.ABOVE else number - bound
        pairs.append((misfit, number))
    outcome.misfit, outcome.number = max(pairs, key=lambda pair: math.inf if math.isnan(pair[0]) else pair[0])
    if outcome.is_test:
        outcome.measured.append(_p_text(outcome.misfit))


def _points(outcome: RowOutcome) -> list[SeedStatistics]:
    return [run for run in outcome.runs if run.is_measured and run.abscissa is not None]


def _exponent(points: Sequence[SeedStatistics]) -> float | None:
    """Returns the least-squares slope of ln(mean) over ln(abscissa); None unless all are positive and the abscissas differ."""
    if not all(point.abscissa > 0 and point.mean > 0 for point in points):
        return None
    n, sx, sy, sxx, sxy = len(points), 0.0, 0.0, 0.0, 0.0
    for point in points:
        x, y = math.log(point.abscissa), math.log(point.mean)
        sx, sy, sxx, sxy = sx + x, sy + y, sxx + x * x, sxy + x * y
    spread = n * sxx - sx * sx
    return (n * sxy - sx * sy) / spread if spread > 1e-12 * n * sxx else None


def _judge_trend(outcome: RowOutcome) -> None:
    """Along `against` the means must rise and must not fall anywhere; a quantity that saturates still rises."""
    points = _points(outcome)
    if len(points) < 2:
        return
    rises = outcome.row.rule is Rule.RISES
    samples = [point.sample() for point in points]
    if not rises:
        samples = [dataclasses.replace(sample, mean=-sample.mean) for sample in samples]
    outcome.number = _exponent(points)
    test = isotonic_test(samples)
    if test is None:
        outcome.note.append(_NO_SCATTER)
        return
    p_rise, p_fall = test
    is_broken = not p_fall > SIGNIFICANCE  # means that violate the rule anywhere do not hold
    outcome.misfit = 1.0 if is_broken else p_rise
    words = ("rise", "fall") if rises else ("fall", "rise")
    outcome.measured += [f"{words[0]}: {_p_text(p_rise)}", f"a {words[1]} in between: {_p_text(p_fall)}"]
    if is_broken:
        pairs = [(i, j) for i in range(len(samples)) for j in range(i + 1, len(samples))]
        p_values = [welch_p_value(samples[j], samples[i]) for i, j in pairs]
        adjusted = adjust_by_holm([math.nan if p is None else p for p in p_values])
        clear = [f"from {_number(points[i].abscissa)} to {_number(points[j].abscissa)}"
                 for (i, j), p in zip(pairs, adjusted) if p <= SIGNIFICANCE]
        outcome.measured += ["clearly " + ", ".join(clear)] if clear else []
    if outcome.number is not None:
        outcome.measured.append("exponent " + _number(outcome.number))


def _judge_bracket(outcome: RowOutcome) -> None:
    """Up to one value of `against` every run shows one pattern, and from another value on every run shows the other.

    Runs between the two values belong to the bracket, with mixed or other patterns, unless the first pattern comes back after the
    second: then there is no one critical value. Seeds outside the bracket may show no other pattern than that of their side, those
    of runs that are not measured included.
    """
    row, points = outcome.row, _points(outcome)
    n = len(points)
    if n < 2:
        return
    first = [point.shows(row.start) for point in points]
    second = [point.shows(row.to) for point in points]
    low = first.index(False) if False in first else n  # length of the beginning with the first pattern
    high = n - (second[::-1].index(False) if False in second else n)  # begin of the end with the second pattern
    returned = n - 1 - first[::-1].index(True) if True in first else -1
    reached = second.index(True) if True in second[:max(returned, 0)] else None
    problems = []
    if low == 0:
        problems.append(f"no {row.start} below {_number(points[0].abscissa)}")
    if high == n:
        problems.append(f"no {row.to} above {_number(points[-1].abscissa)}")
    if reached is not None:
        problems.append(f"{row.start} at {_number(points[returned].abscissa)} above {row.to} at {_number(points[reached].abscissa)}")
    if not problems:
        ends = points[low - 1].abscissa, points[high].abscissa
        problems = [f"{run.text('')} at {_number(run.abscissa)}" for run in outcome.runs if run.abscissa is not None and (
            run.abscissa < ends[0] and run.patterns.keys() - {row.start} or run.abscissa > ends[1] and run.patterns.keys() - {row.to})]
    outcome.misfit = float(len(problems))
    outcome.measured += problems
    if not problems:
        outcome.number = (ends[0] + ends[1]) / 2
        outcome.measured.append(f"{row.against} between {_number(ends[0])} and {_number(ends[1])}")


def _judge_onset(outcome: RowOutcome) -> None:
    """The confidence interval of the exponent must be within the tolerance of the bound; if it reaches beyond, nothing is said."""
    fit = outcome.onset = fit_onset([(run.abscissa, run.sample()) for run in _points(outcome) if run.mean is not None])
    if fit is None:
        outcome.note.append(f"no curve: five runs with different abscissas and positive means are needed, and {_NO_SCATTER}")
        return

    def text(interval: Interval) -> str:
        return f"{_number(interval[0])} ({_number(interval[1])} to {_number(interval[2])})"

    outcome.number, lowest, highest = fit.exponent
    outcome.measured += [f"exponent {text(fit.exponent)}, onset at {text(fit.onset)}, 95 % confidence",
                         f"means on the curve: {_p_text(fit.p_fit)}"]
    # Distances of the bound from the far and from the near end of the interval.
    low, high = outcome.row.bound - lowest, highest - outcome.row.bound
    if fit.is_bounded and max(low, high) <= outcome.row.tolerance:
        outcome.misfit = max(low, high)
    elif max(-low, -high) > outcome.row.tolerance:
        outcome.misfit = max(-low, -high)
    else:
        outcome.note.append("the interval of the exponent is too wide to tell")
