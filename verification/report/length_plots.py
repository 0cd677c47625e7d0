"""Plots of the intrinsic length and of fields that vary. Each draws a PNG file and returns error metrics in words."""
import numpy as np

from claim_tables import fitted_order, groups, largest, largest_text, range_text, sorted_by, states
from panels import LAW_COLOURS, MARKERS, Grid, colours_of, entry, headroom, logarithmic, note
from pictures import BLACK, BLUE, GREEN, GREY, RED, SKY, save

PARTS = ("displacement", "stress", "energy", "reaction", "shape")
OTHER_COLOURS = ("#cc79a7", SKY, BLACK, GREY)


def draw_dispersion(tables, path):
    """The coefficient alpha of both waves against direction, with what was fitted to runs."""
    table, runs = tables["dispersion"], tables.get("dispersion_runs")
    waves = {"L": ("longitudinal", RED), "S": ("shear", BLUE)}
    legend = [entry(f"{name}, exact", "--", colour) for name, colour in waves.values()]
    legend += [entry("share of the nearest bonds", ":", GREY), entry("isotropic gradient energy", "-.", GREY)]
    if runs is not None:
        legend += [entry("fitted to runs of the lattice", "", marker="o")]
    shells = [shells for (shells,), _ in groups(table, "shells")]
    grid = Grid([""], max(2, len(shells)), legend, per_line=3)
    metrics = []
    for column, ((name,), part) in enumerate(groups(table, "shells")):
        part = sorted_by(part, "angle [deg]")
        axes = grid.axes(0, column, title=name, xlabel="angle of the wave to x [°]",
                         ylabel="softening α [1]" if column == 0 else "")
        worst = []
        for wave, (_, colour) in waves.items():
            angle, alpha = part["angle [deg]"], part[f"alpha_{wave}"]
            axes.plot(angle, alpha, "--", color=colour)
            axes.plot(angle, part[f"nearest_{wave}"], ":", color=colour, linewidth=1.2)
            axes.plot(angle, part[f"isotropic_{wave}"], "-.", color=colour, linewidth=1)
            for (other,), measured in groups(runs, "shells") if runs is not None else ():
                if other == name:
                    axes.plot(measured["angle [deg]"], measured[f"alpha_{wave}"], "o", color=colour,
                              markerfacecolor="none", markersize=6)
                    exact = np.interp(measured["angle [deg]"], angle, alpha)
                    worst.append(measured[f"alpha_{wave}"] / exact - 1)
        axes.set_ylim(bottom=min(0, axes.get_ylim()[0]))
        text = f"; fitted to runs off the exact one by {largest_text(np.concatenate(worst))}" if worst else ""
        spread = ", ".join(f"{name} {range_text(part[f'alpha_{wave}'], '.4f')}" for wave, (name, _) in waves.items())
        metrics.append(f"{name}: α {spread}{text}")
    save(grid.page.figure, path)
    return metrics


def draw_edge_layer(tables, path):
    """How far the spacings of rows near a free edge are off the bulk's."""
    table = tables["edge_layer"]
    names = [shells for (shells,), _ in groups(table, "shells")]
    colours = dict(zip(names, (BLUE, RED, GREEN, *OTHER_COLOURS)))
    legend = [entry("theory", "--"), entry("lattice, wider than in the bulk", "", marker="o", filled=True),
              entry("lattice, narrower", "", marker="o")] + [entry(name, "-", colours[name]) for name in names]
    grid = Grid([""], 1, legend, per_line=3)
    axes = grid.axes(0, 0, xlabel="row, counted from the edge [1]", ylabel="|row spacing / bulk − 1| [1]")
    metrics = []
    for (name,), part in groups(table, "shells"):
        part = sorted_by(part, "row")
        row, deviation, theory = part["row"], part["deviation"], part["theory"]
        for values, style in ((theory, {"linestyle": "--"}), (deviation, {"linestyle": "-", "linewidth": 0.6})):
            axes.plot(row, np.where(values != 0, np.abs(values), np.nan), color=colours[name], **style)
        for wider in (True, False):
            shown = deviation > 0 if wider else deviation < 0
            axes.plot(row[shown], np.abs(deviation[shown]), "o", color=colours[name], markersize=6,
                      markerfacecolor=colours[name] if wider else "white")
        worst = largest(deviation)
        if not np.isfinite(deviation).all():
            metrics.append(f"{name}: not computed")
            continue
        if worst < 1e-10:
            metrics.append(f"{name}: no layer, every row within {worst:.1e} of the bulk")
            continue
        decay, expected = decay_of(deviation), decay_of(theory)
        metrics.append(f"{name}: first row off the bulk by {deviation[0]:+.3e} (theory {theory[0]:+.3e}); "
                       f"factor from row to row {decay:+.4f} (theory {expected:+.4f}); "
                       f"off the theory by up to {largest(deviation - theory):.1e}")
    logarithmic(axes, x=False)
    axes.xaxis.get_major_locator().set_params(integer=True)
    note(axes, [(text.split("; off")[0], colours[name]) for name, text in zip(names, metrics)], "upper right")
    headroom(axes, 1.5)
    save(grid.page.figure, path)
    return metrics


def decay_of(deviation):
    """Factor from row to row over the rows that are above a millionth of the first, its sign from the first two; nan if
    there are not two."""
    usable = np.abs(deviation) > 1e-6 * np.abs(deviation[0])
    n = int(np.argmin(usable)) if not usable.all() else len(usable)
    if n < 2:
        return float("nan")
    slope = np.polyfit(np.arange(n), np.log(np.abs(deviation[:n])), 1)[0]
    return float(np.sign(deviation[1] / deviation[0]) * np.exp(slope))


def draw_sinusoidal_energy(tables, path):
    """Energy of a sheet displaced along a sinusoid over that of the local continuum, and what is off the lattice's."""
    table = tables["sinusoidal_energy"]
    colours, angles = colours_of(table["angle [deg]"], "waves along", "°")
    laws = ("local", "gradient", "filtered")
    legend = [entry("lattice", "", marker="o"), entry("gradient energy", "--"), entry("filtered", ":"),
              entry("finite elements", "-", marker="x")] + angles
    rows = states(table)
    grid = Grid([name for name, _ in rows], 3, legend)
    metrics = []
    for number, (name, state) in enumerate(rows):
        panels = {wave: grid.axes(number, column, title=f"{word} waves", xlabel="k d [1]") for column, (wave, word) in
                  enumerate((("L", "longitudinal"), ("S", "shear")))}
        panels["L"].set_ylabel("energy / local [1]")
        error = grid.axes(number, 2, title="off the lattice's, relative [1]", xlabel="k d [1]")
        found = {law: [] for law in laws}
        for (wave, angle), part in groups(state, "wave", "angle [deg]"):
            part = sorted_by(part, "k d")
            k, axes, colour = part["k d"], panels[wave], colours[angle]
            axes.plot(k, part["gradient"], "--", color=colour)
            axes.plot(k, part["filtered"], ":", color=colour)
            done = np.isfinite(part["fem"])
            axes.plot(k[done], part["fem"][done], "-x", color=colour, linewidth=1, markersize=5)
            axes.plot(k, part["lattice"], "o", color=colour, markerfacecolor="none", markersize=6)
            for law in laws:
                difference = np.abs(part[law] / part["lattice"] - 1)
                error.plot(k, np.where(difference > 0, difference, np.nan), "-", marker=MARKERS[wave], markersize=3,
                           color=LAW_COLOURS[law], linewidth=0.8)
                found[law].append(fitted_order(k, difference, share=0.5))
        logarithmic(error)
        headroom(error, 2.2)
        orders = {law: range_text(found[law]) for law in laws}
        note(error, [(f"{law}{f': order {orders[law]}' if orders[law] else ''}", LAW_COLOURS[law]) for law in laws])
        found = [f"order of the {law} energy {orders[law]}" for law in laws if orders[law]]
        found.append(f"finite elements off the gradient energy by {largest_text(state['fem'] / state['gradient'] - 1)}")
        metrics.append(f"{name}: {'; '.join(found)}")
    save(grid.page.figure, path)
    return metrics


def draw_hole(tables, path):
    """Errors of the continua around a hole against d/R."""
    return draw_cut(tables["hole"], "R/d", "d / R [1]", path)


def draw_notch(tables, path):
    """Errors of the continua around a notch against d over its length."""
    return draw_cut(tables["notch"], "length/d", "d / length [1]", path)


def draw_cut(table, size, label, path):
    """A row of panels a state, one panel for each quantity, a line for each law."""
    laws = list(dict.fromkeys(table["law"]))
    others = iter(OTHER_COLOURS)
    colours = {law: next((colour for word, colour in LAW_COLOURS.items() if word in law), None) for law in laws}
    for law in laws:  # laws with names of their own, or two of one kind
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
    save(grid.page.figure, path)
    return metrics
