"""Tables that claims write beside results.json, their plots, and functions that evaluate their rows."""
from dataclasses import dataclass
from typing import Callable

import numpy as np

from latcon.errors import UnreadableFile
from latcon.report.pictures import save

# Errors below this are round-off and have no order.
ROUND_OFF = 1e-12


class Table(dict):
    """Columns of a table of a claim: {name: array}. A missing column that is read makes its file unreadable."""

    def __init__(self, path, columns):
        super().__init__(columns)
        self.path = path

    def __missing__(self, column):
        raise UnreadableFile(self.path, f"has no column {column!r}")

    def where(self, rows):
        """The table of some rows, in the order of their numbers, or where a condition holds."""
        return Table(self.path, {name: values[rows] for name, values in self.items()})


@dataclass(frozen=True)
class Plot:
    """Picture NAME.png of the table NAME.csv."""

    name: str
    draw: Callable  # tables -> (grid of panels, error metrics as text)
    claimed: str  # statement of the claim where it wrote this table
    caption: str  # content of the picture
    few_colours: bool = True
    others: tuple = ()  # tables that it draws besides

    def write(self, tables, path):
        """Draws the picture into a PNG file. Returns the error metrics."""
        grid, metrics = self.draw(tables)
        save(grid.page.figure, path, self.few_colours)
        return metrics


def groups(table, *columns):
    """Parts of a table in which these columns have one value each, in the order of first rows: [(values, part)]."""
    keys = list(zip(*(table[column] for column in columns)))
    return [(key, table.where([k == key for k in keys])) for key in dict.fromkeys(keys)]


def states(table):
    """Groups of one set of shells and one deformation, each with its name: [(name, part)]."""
    return [(f"{shells}, F = I" if xx == yy == 1 else f"{shells}, F = diag({xx:.4g}, {yy:.4g})", part)
            for (shells, xx, yy), part in groups(table, "shells", "F_xx", "F_yy")]


def sorted_by(part, column):
    """A part with its rows in the order of one of its columns."""
    return part.where(np.argsort(part[column], kind="stable"))


def fitted_order(x, error, share=1.0):
    """Slope of log(error) over log(x), least squares; None with fewer than three errors above round-off.

    share: the part of the points, those of the smallest x, that the fit takes; never fewer than three.
    """
    usable = np.isfinite(error) & (error > ROUND_OFF) & (x > 0)
    x, error = x[usable], error[usable]
    if len(np.unique(x)) < 3:
        return None
    nearest = np.argsort(x)[:max(3, int(np.ceil(share * len(x))))]
    return float(np.polyfit(np.log(x[nearest]), np.log(error[nearest]), 1)[0])


def range_text(values, form=".2f"):
    """Values as one number or as a range, "1.98 to 2.03", with the number of those that are not finite; None for none."""
    values = np.array([value for value in values if value is not None], dtype=float)
    finite = values[np.isfinite(values)]
    if not len(finite):
        return None
    low, high = format(finite.min(), form), format(finite.max(), form)
    return (low if low == high else f"{low} to {high}") + not_computed(values)


def largest(values):
    """The largest finite absolute value; None if there is none."""
    values = np.abs(np.asarray(values, dtype=float))
    values = values[np.isfinite(values)]
    return float(values.max()) if len(values) else None


def largest_text(values):
    """The largest absolute value in words, "up to 1.2e-07", with the number of values that are not finite."""
    worst = largest(values)
    return ("an amount that could not be computed" if worst is None else f"up to {worst:.1e}") + not_computed(values)


def not_computed(values):
    """Text on the number of values that are not finite: " (1 of 32 not computed)"; nothing if all are."""
    missing = np.count_nonzero(~np.isfinite(values))
    return f" ({missing} of {len(values)} not computed)" if missing else ""


def off(what, values, reference, of):
    """The largest relative difference as text."""
    return f"{what} off {of} by {largest_text(values / reference - 1)}"
