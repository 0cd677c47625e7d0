"""Data of the interactive plots of the report: path and energies."""
import numpy as np

from .crack_path import measured_sinusoid
from .pictures import SHARES, energy_shares
from .runs import has_rows

MOST_ROWS = 2000  # per plot


def path_plot(run):
    """The path of the tip, with the sinusoid of an oscillating crack; None without a path."""
    if not has_rows(run.tip, 2):
        return None
    tip = thinned(run.tip)
    curves = {"X [cm]": 100 * tip["X"], "Y of the tip [mm]": 1e3 * tip["Y"]}
    curve = measured_sinusoid(run)
    crack = run.crack or {}
    window = [crack.get("window_begin"), crack.get("window_end")]
    if curve is not None:
        inside = (tip["X"] >= window[0]) & (tip["X"] <= window[1])
        curves["measured sinusoid [mm]"] = np.where(inside, 1e3 * curve(tip["X"]), np.nan)
    return {
        "labels": list(curves), "rows": rows_of(curves), "colours": ["--first", "--second"][:len(curves) - 1],
        "dashed": [False, True][:len(curves) - 1], "x": "X in the undeformed sheet [cm]", "y": "Y [mm]", "follows": "tip",
        "window": None if None in window or window[1] <= window[0] else [100 * end for end in window],
    }


def energy_plot(run):
    """Conversion of the elastic energy; None without energies."""
    if not has_rows(run.energy, 2):
        return None
    energy = thinned(run.energy)
    released, shares = energy_shares(energy)
    curves = {"t [ms]": 1e3 * energy["t"], "released [J/m]": released}
    curves.update({f"{SHARES[name][0]} [J/m]": values for name, values in shares})
    return {
        "labels": list(curves), "rows": rows_of(curves), "colours": ["--text", *(f"--{name}" for name, _ in shares)],
        "dashed": [True] + [False] * len(shares), "stacked": 2, "x": "time [ms]", "y": "energy [J/m]", "follows": "time",
        "window": None,
    }


def thinned(table):
    """A table reduced to at most MOST_ROWS rows, including the first and the last."""
    count = len(table["t"])
    rows = np.unique(np.round(np.linspace(0, count - 1, min(count, MOST_ROWS))).astype(int))
    return {name: values[rows] for name, values in table.items()}


def rows_of(curves):
    """Rows of numbers to seven digits, sorted by the first column without repeated values; None for NaN."""
    values = np.column_stack(list(curves.values()))
    _, first = np.unique(values[:, 0], return_index=True)
    return [[None if not np.isfinite(value) else float(f"{value:.7g}") for value in row] for row in values[first]]
