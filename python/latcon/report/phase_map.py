"""Map of patterns over two quantities: cells coloured by pattern, boundaries, contours of a third quantity."""
from collections import namedtuple
from dataclasses import dataclass, replace

import numpy as np
from matplotlib.colors import to_rgb
from matplotlib.patches import Patch, Rectangle
from matplotlib.ticker import MaxNLocator

from .pictures import BLACK, BLUE, GREEN, GREY, RED, WIDTH, Page, save

COLOURS = {"oscillating": BLUE, "straight": GREEN, "branching": RED, "arrested": GREY, "undecided": "#e6c800"}
OTHER = "#cc79a7"  # of a pattern that is not in COLOURS
SHADE = 0.6  # share of the colour of a cell, the rest white: contours and numbers on it are black
LEFT, FOOT, HEAD, RIGHT = 0.95, 0.7, 0.75, 0.3  # around the axes [in]


@dataclass(frozen=True)
class Cell:
    """One point of the map."""

    x: float
    y: float
    patterns: dict  # {pattern: number of seeds}; empty if nothing was measured
    value: float = None  # of the contours; None if there is none
    level: int = 0  # of refinement: between neighbours of the level before

    @property
    def pattern(self):
        """The pattern of all seeds; None if they disagree or it is undecided."""
        (pattern,) = self.patterns if len(self.patterns) == 1 else (None,)
        return None if pattern == "undecided" else pattern


# Two points on a line along one axis (0: x, 1: y) with the other coordinate `across`, and the patterns there, which differ.
Bracket = namedtuple("Bracket", "axis across low high patterns")


def is_over_decades(values):
    """Returns whether the largest value is so many times the smallest that their axis is logarithmic."""
    return min(values) > 0 and max(values) > 30 * min(values)


def draw_phase_map(cells, x_label, y_label, path, contour_label=None, height=5.2):
    """Draws the map. Cells whose seeds disagree are divided between their patterns, in proportion, and marked by a dot.

    Points need not fill a grid: only cells with a point are drawn, and points of a refinement as smaller cells on top. Contours
    are drawn where four neighbouring cells of the grid have a value. Bars span the points that bracket a boundary.
    @return whether any pattern was measured
    """
    if not any(cell.patterns for cell in cells):
        return False
    cells = sorted(cells, key=lambda cell: cell.level)
    page = Page(HEAD + height + FOOT)
    axes = page.axes(LEFT, HEAD, WIDTH - LEFT - RIGHT, height)
    for name, axis in (("x", axes.xaxis), ("y", axes.yaxis)):
        if is_over_decades([getattr(cell, name) for cell in cells]):
            cells = [replace(cell, **{name: np.log10(getattr(cell, name))}) for cell in cells]
            axis.set_major_locator(MaxNLocator(integer=True))
            axis.set_major_formatter(lambda power, _: f"{10**power:.4g}")
    xs, ys = grid_of(cells)
    x_edges, y_edges = edges(xs), edges(ys)
    values = np.full((len(ys), len(xs)), np.nan)
    mixed, unmeasured = [], []
    for cell in cells:
        if not cell.patterns:
            unmeasured.append((cell.x, cell.y))
            continue
        fill(axes, ends(cell.x, xs, x_edges, cell.level), ends(cell.y, ys, y_edges, cell.level), cell.patterns)
        if len(cell.patterns) > 1:
            mixed.append((cell.x, cell.y))
        if cell.value is not None and cell.level == 0:
            values[np.searchsorted(ys, cell.y), np.searchsorted(xs, cell.x)] = cell.value
    axes.set(xlim=x_edges[[0, -1]], ylim=y_edges[[0, -1]], xlabel=x_label, ylabel=y_label)
    axes.grid(False)
    if contour_label and draw_contours(axes, xs, ys, values):
        axes.set_title(f"contours: {contour_label}", fontsize=10)
    found = {pattern for cell in cells for pattern in cell.patterns}
    order = [pattern for pattern in COLOURS if pattern in found] + sorted(found - set(COLOURS))
    handles = [Patch(facecolor=shaded(pattern), label=pattern) for pattern in order] + draw_brackets(axes, brackets(cells))
    for points, style, label in ((mixed, {"marker": "o", "color": BLACK}, "seeds disagree"),
                                 (unmeasured, {"marker": "x", "color": GREY}, "not measured")):
        if points:
            handles += axes.plot(*np.transpose(points), linestyle="none", markersize=5, label=label, **style)
    page.figure.legend(handles=handles, loc="upper left", bbox_to_anchor=(LEFT / WIDTH - 0.005, 1), ncol=6,
                       borderaxespad=0.3, columnspacing=1.4, handlelength=1.4)
    save(page.figure, path)
    return True


def edges(values):
    """Edges of the cells around sorted values: half way between neighbours."""
    if len(values) == 1:
        return np.array([values[0] - 0.5, values[0] + 0.5])
    middles = (values[1:] + values[:-1]) / 2
    return np.concatenate(([2 * values[0] - middles[0]], middles, [2 * values[-1] - middles[-1]]))


def grid_of(cells):
    """Sorted coordinates of the points that are not of a refinement: (x, y)."""
    return tuple(np.unique([getattr(cell, name) for cell in cells if cell.level == 0]) for name in "xy")


def ends(centre, values, value_edges, level):
    """Both ends of a cell along one axis: the edges of the grid, or about a point of a refinement."""
    if level == 0:
        place = np.searchsorted(values, centre)
        return value_edges[place:place + 2]
    place = min(max(np.searchsorted(values, centre), 1), len(values) - 1)
    half = (values[place] - values[place - 1]) / 2 ** (level + 1) if len(values) > 1 else 0.5 / 2 ** level
    return np.array([centre - half, centre + half])


def brackets(cells):
    """Changes of the pattern along lines of the map: between the last point at which all seeds show one pattern and the
    first at which all show another, with only mixed and undecided ones in between, and no gap wider than the grid's."""
    found = []
    for axis, (name, other) in enumerate((("x", "y"), ("y", "x"))):
        grid = grid_of(cells)[axis]
        if len(grid) < 2:
            continue
        widest = np.diff(grid).max() * (1 + 1e-6)
        lines = {}
        for cell in cells:
            if cell.patterns:
                lines.setdefault(round(getattr(cell, other), 9), []).append((getattr(cell, name), cell.pattern))
        for across, points in sorted(lines.items()):
            last = before = None  # the last point with a pattern, and the last point
            for at, pattern in sorted(points, key=lambda point: point[0]):
                if before is not None and at - before > widest:
                    last = None
                before = at
                if pattern is None:
                    continue
                if last is not None and last[1] != pattern:
                    found.append(Bracket(axis, across, last[0], at, (last[1], pattern)))
                last = (at, pattern)
    return found


def draw_brackets(axes, found):
    """Draws brackets as bars with a point in the middle. @return legend entries"""
    handles = []
    for bracket in found:
        middle, half = (bracket.low + bracket.high) / 2, (bracket.high - bracket.low) / 2
        x, y = (middle, bracket.across) if bracket.axis == 0 else (bracket.across, middle)
        bar = axes.errorbar(x, y, **{"xerr" if bracket.axis == 0 else "yerr": half}, fmt=".", color=BLACK, markersize=5,
                            elinewidth=1.2, capsize=2, label="boundary")
        handles = handles or [bar]
    return handles


def shaded(pattern):
    """Colour of a cell. Opaque, since points of a refinement lie on cells of the grid."""
    return tuple(1 - SHADE * (1 - part) for part in to_rgb(COLOURS.get(pattern, OTHER)))


def fill(axes, x, y, patterns):
    """Fills a cell with the colours of its patterns, side by side, the most frequent first."""
    total = sum(patterns.values())
    left = x[0]
    for pattern, count in sorted(patterns.items(), key=lambda item: (-item[1], item[0])):
        width = (x[1] - x[0]) * count / total
        axes.add_patch(Rectangle((left, y[0]), width, y[1] - y[0], facecolor=shaded(pattern),
                                 edgecolor="white", linewidth=0.6))
        left += width


def draw_contours(axes, xs, ys, values):
    """Draws contours of values on a grid, NaN where there are none. @return whether there are any"""
    finite = np.isfinite(values)
    whole = finite[1:, 1:] & finite[1:, :-1] & finite[:-1, 1:] & finite[:-1, :-1]
    if not whole.any() or np.ptp(values[finite]) == 0:
        return False
    lines = axes.contour(xs, ys, np.ma.masked_invalid(values), levels=6, colors=BLACK, linewidths=1)
    axes.clabel(lines, fontsize=9)
    return True
