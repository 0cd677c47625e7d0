"""Choice of the points that a fit evaluates: Sobol points, then Optuna's TPE, then points around the local minimum."""
from __future__ import annotations

import warnings

import numpy as np

from ..errors import optional_package
from ..frames import Floats
from .local_model import LocalModel, fit_local_model
from .misfit import Table

# Points around the minimum of the local model are spread by this many standard deviations, which determines its slopes well
# without leaving the quadratic neighbourhood.
_SPREAD = 1.5
# Largest standard deviation of such points, as a fraction of the box, in the first batch and in later ones.
_WIDEST, _SHRINKING, _NARROWEST = 0.15, 0.8, 0.02


def propose(table: Table, parameters: int, first: int, count: int, evaluations: int, seed: int) -> list[tuple[str, Floats]]:
    """Next points to evaluate, with the name of their stage.

    They depend on the evaluated points, the number of the first and the seed alone: not on how often the fit was interrupted.

    Parameters
    ----------
    table
        Points before `first`.
    parameters
        Number of parameters.
    first
        Number of the first point.
    count
        Points in this batch.
    evaluations
        Points of the whole fit, whose first quarter are Sobol points and whose second are TPE's.
    seed
        Seed of the search.
    """
    sobol = min(evaluations, max(2 * parameters + 1, evaluations // 4))
    tpe = max(sobol, evaluations // 2)
    points = [("sobol", point) for point in _sobol(parameters, seed, sobol)[first:first + count]]
    if left := min(count, tpe - first) - len(points):
        if left > 0:
            points += [("tpe", point) for point in _tpe(table, parameters, first, left, seed)]
    left = count - len(points)
    if left > 0:
        model = fit_local_model(table)
        if model is None:
            points += [("tpe", point) for point in _tpe(table, parameters, first, left, seed)]
        else:
            points += [("local", point) for point in _around(model, first, left, (first - tpe) / max(1, count), seed)]
    return points


def _sobol(parameters: int, seed: int, count: int) -> list[Floats]:
    qmc = optional_package("scipy.stats.qmc", "fits need", "scipy (Debian: python3-scipy)")
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")  # a number of points that is no power of two
        return list(qmc.Sobol(parameters, seed=seed).random(count))


def _tpe(table: Table, parameters: int, first: int, count: int, seed: int) -> list[Floats]:
    optuna = optional_package("optuna", "fits need", "optuna (Debian: python3-optuna)")
    optuna.logging.set_verbosity(optuna.logging.WARNING)
    names = [str(axis) for axis in range(parameters)]
    box = {name: optuna.distributions.FloatDistribution(0, 1) for name in names}
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", optuna.exceptions.ExperimentalWarning)
        sampler = optuna.samplers.TPESampler(seed=seed + first, multivariate=True, constant_liar=True, n_startup_trials=1)
        study = optuna.create_study(sampler=sampler)
        finite = table.misfits[np.isfinite(table.misfits)]
        worst = 2 * finite.max() + 1 if finite.size else 1.0  # of runs that were refused or failed
        for at, misfit in zip(table.coordinates, table.misfits):
            study.add_trial(optuna.create_trial(params={name: min(max(float(x), 0), 1) for name, x in zip(names, at)},
                                                distributions=box, value=float(misfit) if np.isfinite(misfit) else worst))
        found = []
        for _ in range(count):
            trial = study.ask(box)
            found.append(np.array([trial.params[name] for name in names]))
    return found


def _around(model: LocalModel, first: int, count: int, batch: float, seed: int) -> list[Floats]:
    """The minimum of the local model, and normal points around it, reflected into the box."""
    width = max(_NARROWEST, _WIDEST * _SHRINKING**batch)
    metric = model.metric / _SPREAD**2 + np.eye(len(model.center)) / width**2
    generator = np.random.default_rng([seed, first])
    drawn = generator.multivariate_normal(model.center, np.linalg.inv(metric), count - 1)
    folded = np.abs(drawn) % 2
    return [model.center, *np.minimum(folded, 2 - folded)]
