"""Page of a fit: tables and pictures in one file."""
from __future__ import annotations

import io
import math
import pathlib
from typing import TYPE_CHECKING

import numpy as np

from ..errors import optional_package

if TYPE_CHECKING:
    import matplotlib.axes
    import matplotlib.figure
    import pandas as pd

    from .result import Fit

# Near-equal sets and failed points that the page lists.
_LISTED = 20
# Parameters that the picture of pairs shows.
_PAIRED = 5


def write_page(fit: Fit, path: pathlib.Path) -> pathlib.Path:
    """Writes the page of a fit.

    Raises
    ------
    LatconError
        If matplotlib or jinja2 is missing.
    """
    for package in ("matplotlib", "jinja2"):
        optional_package(package, "the page of a fit needs", f"{package} (Debian: python3-{package})")
    from ..report import pages
    points = fit.points
    lost = points[points["ended"] != "done"]
    pages.write_page(
        path, "fit.html", title="Fit of a case to observations", with_viewer=False, with_plots=False, summary=str(fit),
        observations=_table(fit.observations), parameters=_table(fit.parameters), directions=_table(fit.directions),
        progress=_png(_draw_progress(fit)), pairs=_png(_draw_pairs(fit)), n_near=len(fit.near_equal), n_lost=len(lost),
        near=_table(fit.near_equal.drop(columns=["message", "ended"]).head(_LISTED)),
        lost=_table(lost.drop(columns=["misfit", "stage", *fit.observations.index]).head(_LISTED)))
    return path


def _table(table: pd.DataFrame) -> tuple[list[str], list[tuple[str, list[str]]]]:
    """Head and rows for the template."""
    def text(value: object) -> str:
        if not isinstance(value, float):
            return str(value)
        return "not determined" if math.isnan(value) else f"{value:.5g}"
    return (["", *(f"#{name}" for name in table.columns)],
            [("", [str(index), *map(text, row)]) for index, *row in table.itertuples(name=None)])


def _png(figure: matplotlib.figure.Figure) -> bytes:
    buffer = io.BytesIO()
    figure.savefig(buffer, format="png", dpi=100)
    return buffer.getvalue()


def _draw_progress(fit: Fit) -> matplotlib.figure.Figure:
    from matplotlib.figure import Figure
    figure = Figure(figsize=(8, 3), layout="constrained")
    axes = figure.subplots()
    done = fit.points[np.isfinite(fit.points["misfit"])]
    for stage in ("sobol", "tpe", "local"):
        chosen = done[done["stage"] == stage]
        axes.scatter(chosen.index, chosen["misfit"], s=14, label=stage)
    axes.step(done.index, done["misfit"].cummin(), where="post", color="0.3", linewidth=1, label="least so far")
    axes.set(xlabel="number of the point", ylabel="misfit")
    if len(done) and done["misfit"].min() > 0:
        axes.set_yscale("log")
    axes.legend()
    return figure


def _draw_pairs(fit: Fit) -> matplotlib.figure.Figure:
    keys = list(fit.parameters.index)[:_PAIRED]
    pairs = [(first, second) for second in range(1, len(keys)) for first in range(second)]
    size = max(1, len(keys) - 1)
    from matplotlib.figure import Figure
    figure = Figure(figsize=(4.5 * size + 1, 3.8 * size), layout="constrained")
    grid = figure.subplots(size, size, squeeze=False)
    for axes in grid.flat:
        axes.set_visible(False)
    done = fit.points[np.isfinite(fit.points["misfit"])].sort_values("misfit", ascending=False)
    excess = np.sqrt(np.maximum(done["misfit"] - fit.misfit, 0)) if len(done) else done["misfit"]
    if not pairs:
        axes = grid[0][0]
        axes.set_visible(True)
        axes.scatter(done[keys[0]], done["misfit"], s=14)
        axes.set(xlabel=_label(fit, keys[0]), ylabel="misfit")
        return figure
    shown = None
    for first, second in pairs:
        axes = grid[second - 1][first]
        axes.set_visible(True)
        shown = axes.scatter(done[keys[first]], done[keys[second]], c=excess, s=14, vmin=0, vmax=5, cmap="viridis_r")
        _draw_ellipses(fit, axes, first, second)
        axes.set(xlabel=_label(fit, keys[first]), ylabel=_label(fit, keys[second]))
    if shown is not None:
        figure.colorbar(shown, ax=grid, label="standard deviations from the best")
    return figure


def _label(fit: Fit, key: str) -> str:
    unit = fit.parameters.loc[key, "unit"]
    return key if unit == "1" else f"{key} [{unit}]"


def _draw_ellipses(fit: Fit, axes: matplotlib.axes.Axes, first: int, second: int) -> None:
    """Regions of 68 % and 95 % confidence of two parameters, with the others free."""
    if fit.model is None:
        return
    chosen = [first, second]
    root = np.linalg.cholesky(fit.model.covariance[np.ix_(chosen, chosen)])
    angle = np.linspace(0, 2 * math.pi, 100)
    circle = np.stack([np.cos(angle), np.sin(angle)])
    axes.plot(*fit.parameters["estimate"].iloc[chosen], "+", color="crimson", markersize=10)
    for probability in (0.68, 0.95):
        curve = fit.model.center[chosen][:, None] + math.sqrt(-2 * math.log(1 - probability)) * (root @ circle)
        values = [[fit.problem.axes[number].value(float(at)) for at in line] for number, line in zip(chosen, curve)]
        axes.plot(*values, color="crimson", linewidth=1)
