"""Grids of small axes for the plots of claims: theory dashed, simulations solid or with markers, legends outside the axes."""
import math

import matplotlib.pyplot as plt
import numpy as np
from matplotlib.lines import Line2D
from matplotlib.ticker import FuncFormatter, LogLocator, NullLocator

from .claim_tables import Table, fitted_order, groups, range_text, sorted_by, states
from .pictures import BLACK, BLUE, GREEN, RED, WIDTH, Page

LEFT, RIGHT, GAP = 0.95, 0.2, 0.85  # margins of the grid and space between its columns [in]
NAME, TITLE, HEIGHT, FOOT = 0.27, 0.35, 2.25, 0.6  # heights in a row: name, titles of axes, axes, space below [in]
LEGEND_LINE = 0.24  # [in]
WAVES = {"L": "longitudinal", "S": "shear"}
MARKERS = {"L": "^", "S": "o"}
LAW_COLOURS = {"local": RED, "gradient": BLUE, "isotropic": GREEN, "filtered": GREEN}


class Grid:
    """Rows and columns of axes under a legend. Either all rows have a name or none has."""

    def __init__(self, row_names, columns, legend, per_line=4, gap=GAP):
        lines = -(-len(legend) // per_line)
        self.top = 0.1 + LEGEND_LINE * lines
        self.columns, self.gap = columns, gap
        self.width = (WIDTH - LEFT - RIGHT - gap * (columns - 1)) / columns
        self.head = TITLE + (NAME if any(row_names) else 0)
        self.page = Page(self.top + len(row_names) * (self.head + HEIGHT + FOOT))
        for row, name in enumerate(row_names):
            self.page.figure.text(LEFT / WIDTH, 1 - (self.row_top(row) - 0.33) / self.page.height, name, fontsize=11,
                                  fontweight="bold", va="bottom")
        # matplotlib fills legends column by column; the entries are meant to be read line by line.
        legend = [legend[i] for column in range(per_line) for i in range(column, len(legend), per_line)]
        self.page.figure.legend(handles=legend, loc="upper left", bbox_to_anchor=(LEFT / WIDTH - 0.005, 1),
                                ncol=per_line, borderaxespad=0.3, fontsize=9, columnspacing=1.6, handlelength=2.4)

    def row_top(self, row):
        """Upper end of the axes of a row, from the top of the page [in]."""
        return self.top + row * (self.head + HEIGHT + FOOT) + self.head

    def axes(self, row, column, **options):
        """Axes of one panel."""
        return self.page.axes(LEFT + column * (self.width + self.gap), self.row_top(row), self.width, HEIGHT, **options)

    def each(self, rows, titles, xlabel):
        """Rows of the grid with a panel for each title: (name, part, [axes, ...]) of each (name, part)."""
        for number, (name, part) in enumerate(rows):
            yield name, part, [self.axes(number, column, title=title, xlabel=xlabel)
                               for column, title in enumerate(titles)]


def entry(label, style, color=BLACK, marker=None, filled=False):
    """Entry of a legend."""
    return Line2D([], [], linestyle=style, color=color, marker=marker, markersize=5, label=label,
                  markerfacecolor=color if filled else "white")


def colours_of(values, name, unit=""):
    """Colours for numbers, and the entries of a legend: ({value: colour}, [entry, ...])."""
    values = sorted(set(values))
    shades = plt.get_cmap("viridis")(np.linspace(0, 0.85, max(len(values), 2)))
    colours = dict(zip(values, shades))
    return colours, [entry(f"{name} {value:.4g}{unit}", "-", colours[value]) for value in values]


def logarithmic(axes, x=True):
    """Makes axes logarithmic: decades along y, at least two, and plain numbers along x. Call this after drawing."""
    axes.set_yscale("log")
    low, high = (math.log10(end) for end in axes.get_ylim())
    if math.floor(high) - math.ceil(low) < 1:
        axes.set_ylim(10.0**math.floor(low), 10.0**math.ceil(high))
    axes.yaxis.set_major_locator(LogLocator(numticks=7))
    axes.yaxis.set_minor_locator(NullLocator())
    if x:
        logarithmic_along_x(axes)


def logarithmic_along_x(axes):
    """Makes the x axis logarithmic, with plain numbers."""
    if not any(np.isfinite(np.asarray(line.get_ydata(), dtype=float)).any() for line in axes.lines):
        axes.set_xlim(0.1, 1)  # no data: without limits the logarithm would fail
    axes.set_xscale("log")
    axes.xaxis.set_major_locator(LogLocator(subs=(1, 2, 5)))
    axes.xaxis.set_major_formatter(FuncFormatter(lambda value, _: f"{value:.4g}"))
    axes.xaxis.set_minor_locator(NullLocator())


def note(axes, lines, corner="upper left"):
    """Writes short lines of text [(text, colour)] into a corner of a panel, on top of the curves."""
    top = corner.startswith("upper")
    left = corner.endswith("left")
    for number, (text, colour) in enumerate(lines if top else lines[::-1]):
        axes.annotate(text, (0.03 if left else 0.97, 0.97 if top else 0.03), xycoords="axes fraction",
                      xytext=(0, -13 * number if top else 13 * number), textcoords="offset points", color=colour,
                      fontsize=9, ha="left" if left else "right", va="top" if top else "bottom",
                      bbox={"facecolor": "white", "alpha": 0.8, "linewidth": 0, "pad": 1})


def curve(axes, x, y, style, colour):
    """One curve in a style of matplotlib: markers are open, and "-x" joins the values that were computed."""
    shown = np.isfinite(y) if style == "-x" else slice(None)
    options = {} if style in ("--", ":") else {"linewidth": 1, "markersize": 5} if style == "-x" else {
        "markerfacecolor": "none", "markersize": 6}
    axes.plot(x[shown], y[shown], style, color=colour, **options)


def draw_waves(table, titles, ylabel, legend, styles, value, errors):
    """A row of panels for each state: curves of longitudinal and of shear waves against k d, one colour for each
    direction, and the errors of laws. styles: {side: style}; value(part, side) and errors(state), {law: column}, are what
    is drawn. Returns the grid and [(name of the state, its rows, {law: its orders in words})]."""
    colours, angles = colours_of(table["angle [deg]"], "waves along", "°")
    rows = states(table)
    grid = Grid([name for name, _ in rows], 3, legend + angles)
    drawn = []
    for name, state, (*panels, axes) in grid.each(rows, titles, "k d [1]"):
        panels[0].set_ylabel(ylabel)
        panels = dict(zip(WAVES, panels))
        for (wave, angle), part in groups(state, "wave", "angle [deg]"):
            part = sorted_by(part, "k d")
            for side, style in styles.items():
                curve(panels[wave], part["k d"], value(part, side), style, colours[angle])
        drawn.append((name, state, draw_errors(axes, state, errors(state))))
    return grid, drawn


def draw_errors(axes, state, errors):
    """Errors of laws against k d, logarithmic, with their orders in a note. errors: {law: column of errors}.
    Returns {law: its orders in words}, of the laws that have one."""
    orders = {}
    for law, error in errors.items():
        found = []
        for (wave, _), part in groups(Table(state.path, {**state, "error": np.abs(error)}), "wave", "angle [deg]"):
            part = sorted_by(part, "k d")
            axes.plot(part["k d"], np.where(part["error"] > 0, part["error"], np.nan), "-", marker=MARKERS[wave],
                      markersize=3, color=LAW_COLOURS[law], linewidth=0.8)
            found.append(fitted_order(part["k d"], part["error"], share=0.5))
        orders[law] = range_text(found)
    logarithmic(axes)
    headroom(axes, 2.2)
    note(axes, [(f"{law}{f': order {order}' if order else ''}", LAW_COLOURS[law]) for law, order in orders.items()])
    return {law: order for law, order in orders.items() if order}


def headroom(axes, decades):
    """Extends a logarithmic panel upwards to make room for a note."""
    low, high = axes.get_ylim()
    axes.set_ylim(low, high * 10.0**decades)
