"""The search of a fit and its model: points, misfits and uncertainties, on evaluations made up for them."""
import math
import types
from unittest import mock

import numpy as np
import pytest
from scipy.stats import chi2

from latcon.fit import Fit, Observation, search
from latcon.fit.misfit import PRIOR, UNDETERMINED, fit_local_model, tabulate
from latcon.fit.problem import Axis, Problem
from latcon.fit.record import Evaluation, Outcome
from latcon.fit.result import _pivoted_basis
from latcon.fit.search import propose


def made_problem(parameters, observations, seeds=2):
    axes = tuple(Axis(f"p{number}", "1", 0.0, 1.0, False, False) for number in range(parameters))
    return Problem("fracture", "", axes, tuple(observations), tuple(range(seeds)), True)


def made_evaluation(problem, number, at, measured):
    """Evaluation with the quantities of each seed."""
    names = [observation.quantity for observation in problem.observations]
    outcomes = tuple(Outcome(seed, "done", "", {name: (value, math.nan) for name, value in zip(names, values)})
                     for seed, values in zip(problem.seeds, measured))
    return Evaluation(number, "", problem.values(at), outcomes)


@pytest.mark.parametrize("unknown", [math.nan, math.inf])
def test_misfit_knows_the_scatter_over_seeds(unknown):
    problem = made_problem(1, [Observation("a", 1.0, 0.3), Observation("b", "word", 0.5)], seeds=3)
    rows = [made_evaluation(problem, 0, [0.2], [(1.0, "word"), (2.0, "word"), (3.0, "other")]),
            made_evaluation(problem, 1, [0.4], [(unknown, "word"), (2.0, "word"), (4.0, "word")])]
    table = tabulate(problem, rows)
    ratios = np.array([(1 - 2 / 18)**3, (1 - 2 / 9)**3])  # medians of the variances of three and two numbers
    variance = np.median([1.0 / ratios[0], 2.0 / ratios[1]])
    np.testing.assert_allclose(table.scatter, [math.sqrt(variance), 0])
    first = 1.0 / (0.09 + variance / 3) + (1 / 3 / 0.5)**2
    second = 2 / 3 * 4.0 / (0.09 + variance / 2) + UNDETERMINED / 3
    np.testing.assert_allclose(table.misfits, [first, second])
    np.testing.assert_allclose(table.means, [[2, 2 / 3], [3, 1]])


def trial(number, seeds=2):
    """Distance of estimate and known parameters of two quantities with noise and scatter, in the metric of the covariance."""
    generator = np.random.default_rng([7, number])
    known = generator.uniform(0.2, 0.8, 2)
    sigma, scatter = np.array([0.05, 0.2]), np.array([0.03, 0.1])

    def quantities(at):
        return np.array([at[0] + 0.5 * at[1] + 0.3 * at[0] * at[1], 2 * at[1] - at[0]**2])
    observed = quantities(known) + generator.normal(0, sigma)
    problem = made_problem(2, [Observation("a", observed[0], sigma[0]), Observation("b", observed[1], sigma[1])], seeds)
    common = generator.normal(0, scatter, (seeds, 2)) / math.sqrt(2)  # of a seed at all points
    evaluations = []
    for first in range(0, 24, 8):
        for offset, (_, at) in enumerate(propose(tabulate(problem, evaluations), 2, first, 8, 24, number)):
            own = generator.normal(0, scatter, (seeds, 2)) / math.sqrt(2)
            evaluations.append(made_evaluation(problem, first + offset, at, quantities(at) + common + own))
    model = fit_local_model(tabulate(problem, evaluations))
    offset = model.center - known
    return offset @ model.metric @ offset


def test_uncertainties_are_those_of_many_trials():
    distances = np.array([trial(number) for number in range(30)])
    for probability, least, most in ((0.68, 13, 28), (0.95, 25, 30)):  # three standard deviations of a binomial
        assert least <= (distances <= chi2.ppf(probability, 2)).sum() <= most


def test_all_points_are_in_the_box_and_later_ones_around_the_minimum():
    problem = made_problem(2, [Observation("a", 0.0, 0.01), Observation("b", 0.0, 0.01)], seeds=1)
    evaluations = []
    for first in range(0, 40, 8):
        for offset, (stage, at) in enumerate(propose(tabulate(problem, evaluations), 2, first, 8, 40, 3)):
            assert (at >= 0).all() and (at <= 1).all()
            assert stage == ("sobol" if first + offset < 10 else "tpe" if first + offset < 20 else "local")
            evaluations.append(made_evaluation(problem, first + offset, at, [(at[0] - 0.95, at[1] - 0.02)]))
    model = fit_local_model(tabulate(problem, evaluations))
    np.testing.assert_allclose(model.center, [0.95, 0.02], atol=1e-6)
    np.testing.assert_allclose(model.covariance, np.eye(2) / (1e4 + 1 / PRIOR**2), rtol=1e-3, atol=1e-9)
    assert model.degree == 2
    with mock.patch.object(search, "_around", return_value=[]) as around:  # of a shorter batch
        propose(tabulate(problem, evaluations), 2, 40, 8, 42, 3)
    assert around.call_args.args[2:4] == (2, (40 - 21) / 8)
    # A batch over the end of TPE's share, before there is a model.
    points = [tuple(at) for _, at in propose(tabulate(problem, evaluations[:4]), 2, 4, 4, 12, 3)]
    assert len(set(points)) == 4
    # Of few evaluations 2 n + 1 for n parameters.
    assert sum(stage == "sobol" for stage, _ in propose(tabulate(problem, []), 2, 0, 8, 12, 3)) == 5


def test_quantities_may_jump_where_a_word_changes():
    problem = made_problem(1, [Observation("a", 0.45, 0.01), Observation("b", True)], seeds=1)
    positions = np.linspace(0.3, 0.6, 13)
    evaluations = [made_evaluation(problem, number, [at], [(at if at < 0.5 else at + 5, bool(at < 0.5))])
                   for number, at in enumerate(positions)]
    model = fit_local_model(tabulate(problem, evaluations))
    assert model.center[0] == pytest.approx(0.45, abs=1e-6) and (positions[model.rows] < 0.5).all()


def test_undetermined_directions_do_not_depend_on_round_off():
    generator = np.random.default_rng(1)
    # A plane that contains the second axis and another direction.
    plane = np.linalg.qr(np.array([[0, 1, 0, 0], [0.6, 0.1, -0.4, 0.7]]).T)[0]
    found = [_pivoted_basis(plane @ np.linalg.qr(generator.normal(size=(2, 2)))[0]) for _ in range(5)]
    for basis in found:
        np.testing.assert_allclose(basis, found[0], atol=1e-12)
        np.testing.assert_allclose(basis.T @ basis, np.eye(2), atol=1e-12)
        np.testing.assert_allclose(basis @ basis.T, plane @ plane.T, atol=1e-12)
    np.testing.assert_allclose(found[0][:, 0], [0, 1, 0, 0], atol=1e-12)  # the parameter that is free


def test_a_fit_of_failed_points_has_none_near_the_best(tmp_path):
    problem = made_problem(1, [Observation("a", 0.5, 0.01)], seeds=1)
    assert Fit(tmp_path, problem, [Evaluation(0, "sobol", {"p0": 0.5}, (Outcome(0, "failed", "", {}),))]).near_equal.empty


def test_directions_within_round_off_are_equally_undetermined(tmp_path):
    result = Fit(tmp_path, made_problem(3, [Observation("a", 0.5, 0.01)], seeds=1), [])
    result.__dict__["model"] = types.SimpleNamespace(metric=np.diag([1e10, 3e-3, -2e-3]) + np.eye(3) / PRIOR**2)
    directions = result.directions
    assert list(directions["determined"]) == [True, False, False]
    assert directions["uncertainty"][0] == pytest.approx(1e-5)
    assert directions["uncertainty"][1] == directions["uncertainty"][2]
