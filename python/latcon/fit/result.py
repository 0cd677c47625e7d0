"""Result of a fit: best sets, uncertainties, and what the observations do not determine."""
from __future__ import annotations

import functools
import math
import os
import pathlib
from collections.abc import Sequence

import numpy as np
import pandas as pd

from ..case import Case
from ..errors import LatconError
from ..frames import Floats
from .misfit import PRIOR, LocalModel, Table, fit_local_model, tabulate
from .problem import Problem
from .record import Evaluation

# A parameter or direction is determined if the observations reduce its standard deviation by this factor below that of a
# uniform distribution between the bounds.
_DETERMINED = 0.5
_CONFIDENCE = 0.95
# Eigenvalues of half the Hessian below this fraction of the largest are round-off and count as zero.
_ROUND_OFF = 1e-12
# Components of a direction that its description names.
_NAMED = 0.3


class Fit:
    """Result of a fit. :func:`latcon.fit.fit_case` returns it.

    Attributes
    ----------
    directory : pathlib.Path
        Directory of the fit.
    problem : latcon.fit.problem.Problem
        Resolved problem.
    """

    def __init__(self, directory: pathlib.Path, problem: Problem, evaluations: Sequence[Evaluation]) -> None:
        self.directory = directory
        self.problem = problem
        self._evaluations = tuple(evaluations)

    @functools.cached_property
    def _table(self) -> Table:
        return tabulate(self.problem, self._evaluations)

    @functools.cached_property
    def model(self) -> LocalModel | None:
        """Local quadratic model around the minimum, in coordinates that are 0 and 1 at the bounds; None if points are too few."""
        return fit_local_model(self._table)

    @functools.cached_property
    def points(self) -> pd.DataFrame:
        """Evaluated points: a row per point.

        Columns ``stage`` (``sobol``, ``tpe``, ``local``), ``ended`` (``done``, ``refused``, ``failed``), ``message``, the
        parameters, the means of the observed quantities over seeds, ``misfit`` (infinite unless done). The index is the number.
        """
        table = self._table
        columns: dict[str, object] = {name: [getattr(evaluation, name) for evaluation in self._evaluations]
                                      for name in ("stage", "ended", "message")}
        columns |= {axis.key: [evaluation.values[axis.key] for evaluation in self._evaluations] for axis in self.problem.axes}
        columns |= {one.quantity: means for one, means in zip(self.problem.observations, table.means.T)}
        index = pd.Index([evaluation.number for evaluation in self._evaluations], int, name="number")
        return pd.DataFrame(columns | {"misfit": table.misfits}, index)

    @property
    def misfit(self) -> float:
        """Least misfit of an evaluated point; infinite if no point is done.

        About the number of observations less that of parameters if the case can meet the observations within their uncertainties.
        """
        return math.inf if self._table.best is None else float(self._table.misfits[self._table.best])

    @property
    def best(self) -> dict[str, float]:
        """Values of the evaluated point of least misfit, in SI units, by key.

        Raises
        ------
        LatconError
            If no point is done.
        """
        if self._table.best is None:
            raise LatconError(f"{self.directory}: no evaluated point is done")
        return dict(self._evaluations[self._table.best].values)

    @property
    def case(self) -> Case:
        """Base case with the values of `best`."""
        return self.problem.of(Case(self.directory / "case.prm"), self.best)

    @functools.cached_property
    def near_equal(self) -> pd.DataFrame:
        """Rows of `points` that the observations do not distinguish from the best with 95 % confidence, best first."""
        from scipy.stats import chi2
        points = self.points
        limit = float(chi2.ppf(_CONFIDENCE, len(self.problem.axes)))
        return points[points["misfit"] - self.misfit <= limit].sort_values("misfit")

    @functools.cached_property
    def parameters(self) -> pd.DataFrame:
        """Estimates of the parameters: a row per parameter.

        Columns ``estimate`` (minimum of the local model), ``uncertainty`` (one standard deviation with all other parameters
        free), ``fixed_others`` (with all others known), ``lower``, ``upper``, ``unit``, ``determined``: whether the uncertainty
        is less than half that of a uniform distribution between the bounds. NaN without a local model.
        """
        rows = []
        for number, axis in enumerate(self.problem.axes):
            if self.model is None:
                estimate, free, fixed = math.nan, math.nan, math.nan
            else:
                at, free = self.model.center[number], math.sqrt(self.model.covariance[number, number])
                fixed = 1 / math.sqrt(self.model.metric[number, number])
                estimate = axis.value(float(at))
            # Derivative of the value by the coordinate.
            slope = estimate * math.log(axis.upper / axis.lower) if axis.logarithmic else axis.upper - axis.lower
            rows.append((estimate, free * slope, fixed * slope, axis.lower, axis.upper, axis.unit, free < _DETERMINED * PRIOR))
        return pd.DataFrame(rows, index=pd.Index([axis.key for axis in self.problem.axes], name="parameter"),
                            columns=["estimate", "uncertainty", "fixed_others", "lower", "upper", "unit", "determined"])

    @functools.cached_property
    def directions(self) -> pd.DataFrame:
        """Combinations of parameters from the best to the worst determined: eigenvectors of half the Hessian of the misfit.

        Columns ``uncertainty`` (distance along the direction that raises the misfit by 1), ``determined``, and the component of
        each parameter; all in fractions of the range between the bounds. Empty without a local model. Directions along which the
        misfit does not change have no unique basis: the first of them is that of the parameter which can change most along them.
        """
        names = [axis.key for axis in self.problem.axes]
        if self.model is None:
            return pd.DataFrame(columns=["uncertainty", "determined", *names])
        values, vectors = np.linalg.eigh(self.model.metric - np.eye(len(names)) / PRIOR**2)
        order = np.argsort(-values)
        free = values[order] <= _ROUND_OFF * values.max()
        vectors[:, order[free]] = _pivoted_basis(vectors[:, order[free]])
        uncertainty = 1 / np.sqrt(np.maximum(np.where(free, 0, values[order]), 1e-12))
        total = 1 / np.sqrt(1 / uncertainty**2 + 1 / PRIOR**2)
        rows = vectors[:, order].T
        largest = np.take_along_axis(rows, np.abs(rows).argmax(axis=1)[:, None], axis=1)
        table = pd.DataFrame(rows * np.sign(largest), columns=names)
        table.insert(0, "determined", total < _DETERMINED * PRIOR)
        table.insert(0, "uncertainty", uncertainty)
        return table

    @functools.cached_property
    def observations(self) -> pd.DataFrame:
        """Observations: a row per quantity.

        Columns ``observed``, ``uncertainty``, ``scatter`` (standard deviation from seed to seed), ``best`` (mean at the best
        point), ``difference`` (in units of the uncertainty of both).
        """
        table, best = self._table, self._table.best
        means = np.full(len(table.targets), math.nan) if best is None else table.means[best]
        return pd.DataFrame({"observed": table.targets, "uncertainty": table.sigmas, "scatter": table.scatter, "best": means,
                             "difference": (means - table.targets) / table.totals},
                            index=pd.Index([observation.quantity for observation in self.problem.observations], name="quantity"))

    def to_html(self, path: str | os.PathLike[str] | None = None) -> pathlib.Path:
        """Writes a self-contained page with tables and pictures, and returns its path.

        Parameters
        ----------
        path
            The page; default: `fit.html` in the directory of the fit.
        """
        from .page import write_page
        return write_page(self, self.directory / "fit.html" if path is None else pathlib.Path(path))

    def describe_directions(self) -> list[str]:
        """A sentence per direction that the observations do not determine."""
        found = []
        for _, row in self.directions.iterrows():
            if not row["determined"]:
                parts = [(axis.key, float(row[axis.key])) for axis in self.problem.axes if abs(row[axis.key]) >= _NAMED]
                if len(parts) == 1:
                    found.append(f"{parts[0][0]} is not determined")
                else:
                    terms = " ".join(f"{component:+.2f} {key}" for key, component in parts)
                    found.append(f"trade-off, not determined: {terms} (in fractions of the ranges)")
        return found

    def __str__(self) -> str:
        lines = [f"{_count(len(self._evaluations), 'point')}, least misfit {self.misfit:.4g} with "
                 f"{_count(len(self.problem.observations), 'observation')} and {_count(len(self.problem.axes), 'parameter')}"]
        for ended in ("refused", "failed"):
            if count := sum(evaluation.ended == ended for evaluation in self._evaluations):
                lines.append(f"{count} {ended}")
        for key, row in self.parameters.iterrows():
            value = f"{row['estimate']:.6g} ± {row['uncertainty']:.2g} {row['unit']}"
            lines.append(f"{key}: {value}" + ("" if row["determined"] else " (not determined)"))
        if self.model is None:
            lines[-len(self.problem.axes):] = ["no estimate: too few points are done"]
        return "\n".join([*lines, *self.describe_directions()])


def _count(number: int, thing: str) -> str:
    return f"{number} {thing}{'s' * (number != 1)}"


def _pivoted_basis(vectors: Floats) -> Floats:
    """Orthonormal basis, by columns, of the space that orthonormal columns span; independent of their choice."""
    from scipy.linalg import qr
    basis, triangle, _ = qr(vectors @ vectors.T, pivoting=True)
    n = vectors.shape[1]
    return np.asarray(basis[:, :n] * np.sign(np.diag(triangle)[:n]))
