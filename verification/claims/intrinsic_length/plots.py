"""Plots of the claim on the intrinsic length."""
import numpy as np

from latcon.report.claim_tables import Plot, groups, largest, largest_text, range_text, sorted_by
from latcon.report.panels import Grid, curve, entry, headroom, logarithmic, note
from latcon.report.pictures import BLACK, BLUE, GREEN, GREY, RED, SKY

OTHER_COLOURS = ("#cc79a7", SKY, BLACK, GREY)


def draw_dispersion(tables):
    """The coefficient alpha of both waves against direction, and the values fitted to runs."""
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
            curve(axes, angle, alpha, "--", colour)
            axes.plot(angle, part[f"nearest_{wave}"], ":", color=colour, linewidth=1.2)
            axes.plot(angle, part[f"isotropic_{wave}"], "-.", color=colour, linewidth=1)
            for (other,), measured in groups(runs, "shells") if runs is not None else ():
                if other == name:
                    curve(axes, measured["angle [deg]"], measured[f"alpha_{wave}"], "o", colour)
                    exact = np.interp(measured["angle [deg]"], angle, alpha)
                    worst.append(measured[f"alpha_{wave}"] / exact - 1)
        axes.set_ylim(bottom=min(0, axes.get_ylim()[0]))
        text = f"; fitted to runs off the exact one by {largest_text(np.concatenate(worst))}" if worst else ""
        spread = ", ".join(f"{name} {range_text(part[f'alpha_{wave}'], '.4f')}" for wave, (name, _) in waves.items())
        metrics.append(f"{name}: α {spread}{text}")
    return grid, metrics


def draw_edge_layer(tables):
    """Relative differences between the spacings of rows near a free edge and in the bulk."""
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
    return grid, metrics


def decay_of(deviation):
    """Factor from row to row over the rows that are above a millionth of the first, its sign from the first two; nan if
    there are not two."""
    usable = np.abs(deviation) > 1e-6 * np.abs(deviation[0])
    n = int(np.argmin(usable)) if not usable.all() else len(usable)
    if n < 2:
        return float("nan")
    slope = np.polyfit(np.arange(n), np.log(np.abs(deviation[:n])), 1)[0]
    return float(np.sign(deviation[1] / deviation[0]) * np.exp(slope))


PLOTS = (
    Plot("dispersion", draw_dispersion,
         "The speed of waves falls as c (1 − α (k d)²/2), where k is the wave number and α depends on the "
         "direction.",
         "α of ω² = c² k² (1 − α (k d)²) against the direction of the wave. Dashed: from the exact dispersion; "
         "dotted: the part that nearest bonds contribute; dash-dotted: what an isotropic gradient energy can have; "
         "circles: fitted to runs of the lattice in time.", others=("dispersion_runs",)),
    Plot("edge_layer", draw_edge_layer,
         "At free edges the spacings of rows differ from the bulk if, and only if, there are next-nearest bonds.",
         "Distance between rows near a free edge, relative to that in the bulk, in a stretched sheet; full where "
         "it is wider, open where it is narrower. Dashed: theory; circles: relaxed lattice."),
)
