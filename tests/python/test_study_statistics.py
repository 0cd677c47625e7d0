"""Statistics of studies: known values, simulated rates of decisions, power laws above an onset, refinement, verdicts."""
import math

import numpy as np
import pytest

from latcon.quantities import quantity_text
from latcon.study.command import refined_runs
from latcon.study.outcome import RunOutcome, RunState, statistics
from latcon.study.plan import PlannedRun
from latcon.study.record import table_of_rows
from latcon.study.statistical_tests import SampleMean, adjust_by_holm, fit_onset, isotonic_test, level_probabilities, welch_p_value
from latcon.study.study_file import Rule, Study, StudyRow, StudyRun
from latcon.study.table import Verdict, judge


def drawn(generator, mean, n, deviation=1.0):
    values = mean + deviation * generator.standard_normal(n)
    return SampleMean(float(values.mean()), n, float(values.var(ddof=1)))


def test_welch_has_the_known_probability():
    # Student's t of 12.2474 with 4 degrees of freedom; of sqrt 20 with 1.47, rounded down to 1.
    assert welch_p_value(SampleMean(0.021, 3, 1e-6), SampleMean(0.031, 3, 1e-6)) == pytest.approx(1.2761e-4, abs=1e-8)
    assert welch_p_value(SampleMean(0.0, 2, 0.02), SampleMean(1.0, 2, 0.08)) == pytest.approx(0.0700243, abs=1e-7)
    assert welch_p_value(SampleMean(1.0, 4, 1.0), SampleMean(1.0, 4, 2.0)) == pytest.approx(0.5, abs=1e-15)


@pytest.mark.parametrize("smaller, larger", [
    ((0.0, 1), (1.0, 5, 0.1)), ((0.0, 5, 0.1), (1.0, 1)), ((0.0, 2, 0.0), (1.0, 2, 0.0)), ((math.nan, 2, 1.0), (1.0, 2, 1.0))])
def test_welch_knows_nothing_without_an_estimate_of_the_error(smaller, larger):
    assert welch_p_value(SampleMean(*smaller), SampleMean(*larger)) is None


@pytest.mark.parametrize("n, m, difference, low, high", [
    (2, 2, 0.0, 0.0, 0.064), (3, 5, 0.0, 0.0, 0.064), (5, 5, 0.0, 0.035, 0.064), (5, 5, 2.5, 0.9, 1.0), (2, 5, 10.0, 0.9, 1.0)])
def test_welch_finds_differences_as_often_as_it_says(n, m, difference, low, high):
    generator = np.random.default_rng(1947)
    found = [welch_p_value(drawn(generator, 0.0, n), drawn(generator, difference, m)) <= 0.05 for _ in range(4000)]
    assert low <= np.mean(found) <= high


def test_holm_adjusts_each_by_the_number_of_those_that_are_left():
    adjusted = adjust_by_holm([0.04, 0.01, 0.03, math.nan])
    assert adjusted[:3] == pytest.approx([0.09, 0.04, 0.09]) and math.isnan(adjusted[3])
    assert adjust_by_holm([0.9, 0.8])[0] == 1 and adjust_by_holm([]) == []


def test_level_probabilities_are_the_known_ones():
    digits = 4 * math.sqrt(0.25 / 20000)  # standard deviations of the draws
    assert level_probabilities([1, 1, 1, 1]) == pytest.approx([6 / 24, 11 / 24, 6 / 24, 1 / 24], abs=digits)
    rho = -math.sqrt(2 * 5 / ((2 + 2) * (2 + 5)))
    share = math.asin(rho) / (2 * math.pi)
    assert level_probabilities([2, 2, 5]) == pytest.approx([0.25 - share, 0.5, 0.25 + share], abs=digits)


def test_isotonic_test_finds_trends_as_often_as_it_says():
    generator = np.random.default_rng(1959)
    levels = level_probabilities([3] * 4)

    def shares(means):
        tests = [isotonic_test([drawn(generator, mean, 3) for mean in means], levels) for _ in range(3000)]
        return np.mean(np.array(tests) <= 0.05, axis=0)
    flat = shares([0, 0, 0, 0])
    assert np.all((0.03 < flat) & (flat < 0.066))
    rise, fall = shares([0, 2, 4, 4])
    assert rise > 0.99 and fall < 0.05
    assert shares([0, 3, 6, 0])[1] > 0.99


def points(generator, exponent, deviation, parameters=(1.75, 1.05, 1.1, 1.2, 1.35, 1.5, 1.02)):
    return [(p, drawn(generator, 2 * (p - 1)**exponent, 3, deviation)) for p in parameters]


@pytest.mark.parametrize("exponent", [0.25, 0.5, 1.0])
def test_onset_recovers_an_exact_power_law(exponent):
    fit = fit_onset([(p, SampleMean(7 * (p + 3)**exponent, 2, 1e-12)) for p in (-2.9, -2.5, -2.0, -1.0, 0.0)])
    # The scatter of 1e-6 moves exponent and onset by about as much; no error of the curve is larger.
    assert fit.exponent[0] == pytest.approx(exponent, abs=1e-5)
    assert fit.onset[0] == pytest.approx(-3, abs=1e-5)
    assert fit.prefactor == pytest.approx(7, abs=1e-4)
    assert fit.exponent[1] <= exponent <= fit.exponent[2] and fit.onset[1] <= -3 <= fit.onset[2] and fit.is_bounded


def test_onset_intervals_have_their_confidence():
    generator = np.random.default_rng(1883)
    fits = [fit_onset(points(generator, 0.5, 0.01)) for _ in range(30)]
    for inside in ([fit.exponent[1] <= 0.5 <= fit.exponent[2] for fit in fits], [fit.onset[1] <= 1 <= fit.onset[2] for fit in fits]):
        assert np.mean(inside) > 0.83  # 95 %, less three standard deviations of 30 draws
    assert np.mean([fit.exponent[0] for fit in fits]) == pytest.approx(0.5, abs=0.015)


def test_onset_far_above_it_is_unbounded():
    assert not fit_onset(points(np.random.default_rng(11), 0.5, 0.1, (4, 4.1, 4.2, 4.3, 4.4, 4.5))).is_bounded


@pytest.mark.parametrize("change", [
    lambda p, s: (p, SampleMean(math.nan, 3, 1.0)), lambda p, s: (math.nan, s), lambda p, s: (p, SampleMean(1.0, 3, math.nan)),
    lambda p, s: (p, SampleMean(0.0, 3, 1.0)), lambda p, s: (1.75, s)])
def test_onset_of_data_that_determine_nothing_is_none(change):
    good = points(np.random.default_rng(17), 0.5, 0.03)
    assert fit_onset(good) is not None and fit_onset(good[:4]) is None and fit_onset([]) is None
    assert fit_onset(good[:2] + [change(*good[2])] + good[3:]) is None
    assert fit_onset([(p, SampleMean(s.mean, 3)) for p, s in good]) is None  # no scatter


class MadeUpSweep:
    """Sweep of both strains over 3 x 2 points with two seeds, whose outcomes are made up."""

    def __init__(self):
        self.study = Study("made-up.json", swept=["Loading/strain x", "Loading/strain y"])
        self.plan, self.outcomes = [], []
        for x in ("1", "1.4", "2"):
            for y in ("1.5", "1.7"):
                own = {"Loading/strain x": x, "Loading/strain y": y}
                self.add(StudyRun(f"strain-x-{x}_strain-y-{y}", "", own, {"Sheet/height": "2 cm"} | own, [1, 2], True))

    def add(self, run):
        self.study.runs.append(run)
        values = {key: float(value) for key, value in run.own.items()}
        for seed in run.seeds:
            self.plan.append(PlannedRun(run.name, seed, False, [], values, "", 1e-3, None, 1, 1, 1, 1))
            self.outcomes.append(RunOutcome(run.name, seed, RunState.MEASURED, pattern="straight"))

    def show(self, run, *patterns):
        for outcome, pattern in zip((one for one in self.outcomes if one.run == run), patterns):
            outcome.pattern = pattern

    def refined(self, level):
        return refined_runs(self.study, self.plan, self.outcomes, level)

    def names(self, level):
        return [run.name for run in self.refined(level)]


def test_refinement_adds_the_points_between_neighbours_that_differ():
    sweep = MadeUpSweep()
    assert sweep.refined(1) == []
    sweep.show("strain-x-2_strain-y-1.7", "oscillating", "oscillating")
    assert sweep.names(1) == ["strain-x-1.7_strain-y-1.7", "strain-x-2_strain-y-1.6"]
    run = sweep.refined(1)[0]
    assert (run.level, run.seeds, run.own) == (1, [1, 2], {"Loading/strain x": "1.7", "Loading/strain y": "1.7"})


def test_refinement_continues_between_the_points_of_the_level_before():
    sweep = MadeUpSweep()
    for name in ("strain-x-2_strain-y-1.5", "strain-x-2_strain-y-1.7"):
        sweep.show(name, "oscillating", "oscillating")
    for run in sweep.refined(1):
        sweep.add(run)
    assert sweep.refined(1) == []
    assert sweep.names(2) == ["strain-x-1.85_strain-y-1.5", "strain-x-1.85_strain-y-1.7"]
    sweep.show("strain-x-1.7_strain-y-1.5", "oscillating", "oscillating")
    assert sweep.names(2) == ["strain-x-1.55_strain-y-1.5", "strain-x-1.85_strain-y-1.7"]


def test_refinement_compares_seeds_and_ignores_what_was_not_measured():
    sweep = MadeUpSweep()
    sweep.show("strain-x-1_strain-y-1.5", "straight", "oscillating")
    assert sweep.names(1) == ["strain-x-1_strain-y-1.6", "strain-x-1.2_strain-y-1.5"]
    sweep.show("strain-x-1_strain-y-1.7", "oscillating", "straight")  # as mixed as its neighbour
    assert sweep.names(1) == ["strain-x-1_strain-y-1.6", "strain-x-1.2_strain-y-1.5", "strain-x-1.2_strain-y-1.7"]
    sweep.show("strain-x-1_strain-y-1.7", "straight", "straight")
    for outcome in sweep.outcomes[:2]:
        outcome.state = RunState.FAILED
    assert sweep.refined(1) == []


@pytest.mark.parametrize("value, deviation, unit, text", [
    (0.0229, None, "m", "2.29 cm"), (0.0229, 4e-4, "m", "2.290 ± 0.040 cm"), (1e-5, None, "m^2", "10 mm²"),
    (30.0, None, "degrees", "30°"), (1e-9, 2e-10, "1", "1.00e-09 ± 2.0e-10"), (123456.0, None, "Pa", "1.235e+05 Pa")])
def test_numbers_have_readable_units(value, deviation, unit, text):
    assert quantity_text(value, deviation, unit) == text


def judged(row, patterns=None, means=None, at=range(1, 9)):
    """Judges a row about runs a, b, ... with three seeds each, at abscissas `at`."""
    outcomes, planned = {}, {}
    for i, value in enumerate(patterns or means):
        name = "abcdefgh"[i]
        row.runs.append(name)
        planned[name] = PlannedRun(name, 1, False, [], {}, "", 1e-3, float(at[i]), 1, 1, 1, 1)
        seeds = value if patterns else [value - 0.01, value, value + 0.01]
        outcomes[name] = [RunOutcome(name, seed, RunState.MEASURED, pattern=one if patterns else "straight",
                                     values={} if patterns else {"speed": one}) for seed, one in enumerate(seeds)]
    return judge(row, planned, outcomes, [])


S, O, B = (["straight"] * 3, ["oscillating"] * 3, ["straight", "oscillating", "branching"])


@pytest.mark.parametrize("patterns, verdict, number", [
    ([S, S, O], Verdict.HOLDS, 2.5), ([S, B, O], Verdict.HOLDS, 2.0), ([O, O, S], Verdict.DOES_NOT_HOLD, None),
    ([S, O, S, O], Verdict.DOES_NOT_HOLD, None), ([S, S, S], Verdict.DOES_NOT_HOLD, None),
    ([S, S, O, ["oscillating", "straight", "undecided"]], Verdict.DOES_NOT_HOLD, None),
    ([["straight", "oscillating", "undecided"], S, O], Verdict.DOES_NOT_HOLD, None),
    ([S, S, O, ["oscillating", "undecided", "undecided"]], Verdict.HOLDS, 2.5)])
def test_brackets(patterns, verdict, number):
    row = StudyRow(quantity="pattern", rule=Rule.BRACKET, start="straight", to="oscillating", against="zeta")
    outcome = judged(row, patterns)
    assert (outcome.verdict, outcome.number) == (verdict, number)


@pytest.mark.parametrize("rule, means, options, verdict", [
    (Rule.RISES, [1, 2, 3, 3], {}, Verdict.HOLDS), (Rule.RISES, [1, 2, 3, 2], {}, Verdict.DOES_NOT_HOLD),
    (Rule.FALLS, [3, 2, 1], {}, Verdict.HOLDS), (Rule.FALLS, [1, 1, 1], {}, Verdict.DOES_NOT_HOLD),
    (Rule.ABOVE, [2, 3], {"bound": 1.5}, Verdict.HOLDS), (Rule.ABOVE, [1, 3], {"bound": 1.5}, Verdict.DOES_NOT_HOLD),
    (Rule.BELOW, [1, 1.4], {"bound": 1.5}, Verdict.HOLDS), (Rule.ABOVE, [1, 3], {"bound_run": "a"}, Verdict.DOES_NOT_HOLD),
    (Rule.IS_NEAR, [1.01], {"bound": 1, "tolerance": 0.02}, Verdict.HOLDS),
    (Rule.IS_NEAR, [1.03], {"bound": 1, "tolerance": 0.02}, Verdict.DOES_NOT_HOLD), (Rule.REPORTED, [1], {}, Verdict.REPORTED),
    (Rule.ONSET_EXPONENT, [math.sqrt(x - 0.5) for x in range(1, 7)], {"bound": 0.5, "tolerance": 0.1}, Verdict.HOLDS),
    (Rule.ONSET_EXPONENT, [1, 2, 3], {"bound": 0.5, "tolerance": 0.1}, Verdict.NOT_MEASURED)])
def test_rules_of_numbers(rule, means, options, verdict):
    against = "zeta" if rule.is_along else ""
    assert judged(StudyRow(quantity="speed", rule=rule, against=against, **options), means=means).verdict is verdict


@pytest.mark.parametrize("rule, values", [(Rule.BRACKET, {"patterns": [S, S, O, O]}), (Rule.RISES, {"means": [1, 2, 3, 4]})])
def test_runs_at_one_abscissa_have_no_order(rule, values):
    row = StudyRow(quantity="pattern" if rule is Rule.BRACKET else "speed", rule=rule, start="straight", to="oscillating", against="zeta")
    outcome = judged(row, at=(1, 2, 2, 3), **values)
    assert (outcome.verdict, outcome.note) == (Verdict.NOT_MEASURED, ["several runs have one value of zeta"])


def test_the_table_names_the_rows_that_fail():
    row = {"claim": "energy", "quantity": "drift", "unit": "1", "lattice": 1.0, "continuum": None, "theory": None, "error": 0.5, "tolerance": 0.1}
    text = table_of_rows([row | {"verdict": "holds"}, row | {"verdict": "fails"}])
    assert text.splitlines()[-2:] == ["1 of 2 checks fails:", "  energy: drift: error 0.5, tolerance 0.1"]


def test_rules_need_three_quarters_of_the_seeds():
    outcomes = [RunOutcome("a", seed, RunState.MEASURED if seed < n else RunState.FAILED, pattern="straight")
                for n, seed in ((3, 0), (3, 1), (3, 2), (3, 3))]
    assert statistics("a", "pattern", outcomes).is_measured and not statistics("a", "pattern", outcomes).is_lost
    outcomes[0].state = RunState.REFUSED
    seeds = statistics("a", "pattern", outcomes)
    assert not seeds.is_measured and seeds.is_lost and seeds.missing == ["seed 0 refused: verification", "seed 3 failed"]


def test_equal_values_have_no_deviation():
    values = [0.02] * 10
    mean = sum(values) / 10
    deviation = math.sqrt(sum((value - mean) ** 2 for value in values) / 9)
    assert quantity_text(mean, deviation, "m") == quantity_text(0.02, 1e-17, "m") == "2 cm"
