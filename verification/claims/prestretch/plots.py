"""Plots of the claim on pre-stretch: errors around holes and notches."""
from functools import partial

import numpy as np

from latcon.report.claim_tables import Plot, fitted_order, groups, sorted_by, states
from latcon.report.panels import LAW_COLOURS, Grid, entry, logarithmic, note
from latcon.report.pictures import BLACK, GREY, SKY

PARTS = ("displacement", "stress", "energy", "reaction", "shape")
OTHER_COLOURS = ("#cc79a7", SKY, BLACK, GREY)


def draw_cut(tables, name, size, label):
    """Errors of the continua around a cut: a row of panels per state, a panel per quantity, a line per law."""
    table = tables[name]
    laws = list(dict.fromkeys(table["law"]))
    others = iter(OTHER_COLOURS)
    colours = {law: next((colour for word, colour in LAW_COLOURS.items() if word in law), None) for law in laws}
    for law in laws:  # laws without a colour, or two laws with the same
        if colours[law] is None or list(colours.values()).count(colours[law]) > 1:
            colours[law] = next(others, BLACK)
    rows = states(table)
    shown = [part for part in PARTS if np.isfinite(table[part]).any()] or PARTS
    legend = [entry(law, "-", colours[law], "o", True) for law in laws]
    grid = Grid([name for name, _ in rows], max(3, len(shown)), legend, gap=0.2)
    metrics = []
    for number, (name, state) in enumerate(rows):
        first, panels, orders = None, [], {law: [] for law in laws}
        for column, what in enumerate(shown):
            axes = grid.axes(number, column, title=what, xlabel=label, sharey=first)
            panels.append((axes, []))
            for (law,), part in groups(state, "law"):
                part = sorted_by(part, size)
                error = np.abs(part[what])
                axes.plot(1 / part[size], np.where(error > 0, error, np.nan), "-o", color=colours[law], markersize=4)
                order = fitted_order(1 / part[size], error)
                if order is not None:
                    orders[law].append(f"{what} {order:.2f}")
                    if law == laws[0]:  # the others' are below the picture
                        panels[-1][1].append((f"{law}: order {order:.2f}", colours[law]))
            if first is None:
                first = axes
                axes.set_ylabel("relative difference\nfrom the lattice [1]")
            else:
                axes.tick_params(labelleft=False)
        errors = np.abs(np.concatenate([state[what] for what in shown]))
        errors = errors[np.isfinite(errors) & (errors > 0)]
        first.set_ylim(*((errors.min() / 2, errors.max() * 6) if len(errors) else (1e-3, 1)))  # room for the note
        for axes, lines in panels:
            logarithmic(axes)
            note(axes, lines)
        metrics += [f"{name}, {law}: order of {', '.join(orders[law])}" for law in laws if orders[law]]
    return grid, metrics


PLOTS = (
    Plot("hole", partial(draw_cut, name="hole", size="R/d", label="d / R [1]"),
         "Around a hole, where the deformation varies, they differ by a power of d over its radius.",
         "Stretched sheets with a round hole of radius R: relative differences between finite elements and lattice "
         "against d/R, a line for each law of the finite elements. The order is the slope of a line."),
    Plot("notch", partial(draw_cut, name="notch", size="length/d", label="d / length [1]"),
         "At a notch they differ by a power of d over its length.",
         "Stretched sheets with a notch: relative differences between finite elements and lattice against d over "
         "its length, a line for each law of the finite elements. The order is the slope of a line."),
)
