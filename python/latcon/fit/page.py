"""Page of a fit: tables and pictures in one file."""
from __future__ import annotations

import base64
import html
import io
import math
import pathlib
from typing import TYPE_CHECKING

import numpy as np
import pandas as pd

from ..errors import LatconError
from .record import replace

if TYPE_CHECKING:
    import matplotlib.axes
    import matplotlib.figure

    from .result import Fit

_STYLE = ("body{font:15px/1.5 sans-serif;max-width:60em;margin:2em auto;padding:0 1em}table{border-collapse:collapse}"
          "td,th{padding:.2em .7em;text-align:right;border-bottom:1px solid #ccc}td:first-child,th:first-child{text-align:left}"
          "img{max-width:100%}")
# Near-equal sets and failed points that the page lists.
_LISTED = 20
# Parameters that the picture of pairs shows.
_PAIRED = 5


def write_page(fit: Fit, path: pathlib.Path) -> pathlib.Path:
    """Writes the page of a fit.

    Raises
    ------
    LatconError
        If matplotlib is missing.
    """
    points = fit.points
    lost = points[points["ended"] != "done"]
    parts = ["<h1>Fit of a case to observations</h1>", f"<pre>{html.escape(str(fit))}</pre>",
             "<h2>Observations</h2>", _html(fit.observations),
             "<p>The difference is in units of the uncertainty of the observation and of the mean over seeds.</p>",
             _picture(_draw_progress(fit), "Misfit of each point, and the least so far"),
             "<h2>Parameters</h2>", _html(fit.parameters),
             "<p><i>fixed_others</i>: uncertainty if all other parameters were known. If it is much smaller than the "
             "uncertainty, the parameter trades off with others.</p>",
             _picture(_draw_pairs(fit), "Points by misfit, the estimate, and its regions of 68 % and 95 % confidence"),
             "<h2>Determined and undetermined combinations</h2>", _html(fit.directions),
             "<p>Eigenvectors of half the Hessian of the misfit. A step of the uncertainty, in fractions of the range between the "
             "bounds, raises the misfit by 1.</p>",
             f"<h2>Sets near the best</h2><p>{len(fit.near_equal)} points are not distinguished from the best with 95 % "
             "confidence.</p>", _html(fit.near_equal.drop(columns=["message", "ended"]).head(_LISTED))]
    if len(lost):
        parts += [f"<h2>Points without result</h2><p>{len(lost)} points were refused or failed.</p>",
                  _html(lost.drop(columns=["misfit", "stage", *fit.observations.index]).head(_LISTED))]
    replace(path, f"<!DOCTYPE html><html lang=\"en\"><head><meta charset=\"utf-8\"><title>Fit</title><style>{_STYLE}</style>"
                  f"</head><body>{''.join(parts)}</body></html>\n")
    return path


def _html(table: pd.DataFrame) -> str:
    return str(table.to_html(float_format=lambda number: f"{number:.5g}", border=0, na_rep="not determined"))


def _picture(figure: matplotlib.figure.Figure, caption: str) -> str:
    buffer = io.BytesIO()
    figure.savefig(buffer, format="png", dpi=100)
    data = base64.b64encode(buffer.getvalue()).decode()
    return f"<p><img alt=\"{caption}\" src=\"data:image/png;base64,{data}\"><br><i>{caption}.</i></p>"


def _figure(width: float, height: float) -> matplotlib.figure.Figure:
    try:
        from matplotlib.figure import Figure
    except ImportError as error:
        raise LatconError("the page of a fit needs the Python package matplotlib (Debian: python3-matplotlib)") from error
    return Figure(figsize=(width, height), layout="constrained")


def _draw_progress(fit: Fit) -> matplotlib.figure.Figure:
    figure = _figure(8, 3)
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
    figure = _figure(4.5 * size + 1, 3.8 * size)
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
