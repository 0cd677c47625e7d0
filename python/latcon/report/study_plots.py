"""Plots of a study: paths of cracks, quantities along a sweep, speeds by pattern; names and customary units of quantities."""
import itertools

import numpy as np
from matplotlib.lines import Line2D

from ..files import if_present, read_columns
from ..quantities import shown_unit
from .phase_map import COLOURS, Cell, draw_phase_map, is_over_decades
from .pictures import BLACK, BLUE, GREEN, GREY, RED, SKY, WIDTH, Page, save
from .study_runs import mean_of, patterns_of

# Columns of the tables of runs: quantity, scale to the unit shown, head.
MEASURED = (("speed_lagrangian", 1, "speed\n[m/s]"), ("wavelength", 100, "wavelength\n[cm]"),
            ("amplitude", 100, "amplitude of\nsinusoid [cm]"),
            ("crest_amplitude", 100, "half trough\nto crest [cm]"),
            ("bridged_length", 100, "bridged\nlength [cm]"), ("detached_sites", 1, "detached\nsites"))
NEAR_TIP = (("speed_over_shear", 1, "speed over\nshear speed"),
            ("negative_zone_area", 1e6, "area of negative\nvelocity [mm²]"),
            ("negative_zone_depth", 1, "most negative\nv_x [m/s]"),
            ("velocity_asymmetry", 1, "asymmetry\nof velocity"),
            ("process_zone_length", 1e3, "process\nzone [mm]"),
            ("opening_stress_ratio_4d", 1, "σ_yy at 4 d:\npeak / ahead"),
            ("opening_stress_angle_4d", 1, "angle of\nthe peak [°]"), ("wedge_angle", 1, "wedge\nangle [°]"))
# Quantities that describe the shape of a path.
PATH = ("wavelength", "amplitude", "crest_amplitude")
# Abscissas: scale to the unit shown, label.
AGAINST = {"zeta": (1, "ζ = (η/a) / (d √(ρ/a))"), "Sheet/spacing": (1e3, "d [mm]"),
           "Sheet/height": (100, "height of the sheet, undeformed [cm]"),
           "Sheet/length": (100, "length of the sheet, undeformed [cm]"),
           "Lattice/noise amplitude": (1, "noise amplitude / d"),
           "Loading/strain x": (1, "strain x, along the crack"), "Loading/strain y": (1, "strain y, across the crack")}


def quantity_axis(quantity, unit):
    """(scale to the unit shown, label) of a quantity with an SI unit."""
    for name, scale, head in MEASURED + NEAR_TIP:
        if name == quantity:
            return scale, head.replace("\n", " ")
    scale, shown = shown_unit(unit)
    return scale, f"{quantity.replace('_', ' ')} [{shown or '1'}]"


def entry_axis(name, unit):
    """(scale to the unit shown, label) of an entry of a case with an SI unit, or of zeta."""
    if name in AGAINST:
        return AGAINST[name]
    scale, shown = shown_unit(unit)
    return scale, f"{name} [{shown}]" if shown else name


def asked_quantities(rows):
    """Quantities of rows along one abscissa; those that describe the path in place of the pattern."""
    names = [name for row in rows for name in (PATH if row["quantity"] == "pattern" else (row["quantity"],))]
    return list(dict.fromkeys(names))


def sweeps_of(rows):
    """Rows with an abscissa, grouped by abscissa and runs: [[row, ...], ...]."""
    sweeps = {}
    for row in rows:
        if row["against"]:
            sweeps.setdefault((row["against"], *row["runs"]), []).append(row)
    return list(sweeps.values())


# Marker and colour of each pattern, as in the map.
PATTERNS = {pattern: (marker, COLOURS[pattern]) for pattern, marker in (
    ("oscillating", "o"), ("straight", "s"), ("branching", "v"), ("arrested", "X"), ("undecided", "D"))}
LEFT, RIGHT, GAP = 0.75, 0.2, 0.75  # of a grid of panels [in]
SEED_COLOURS = [BLUE, RED, GREEN, SKY, BLACK, GREY]
CONTOURS = ("wavelength", "speed_lagrangian")  # of the map of patterns: the first that was measured


def panels(count, columns, height):
    """A figure of axes of equal size in rows and columns, each with room for a title and labels: (figure, [axes, ...])."""
    width, pitch = (WIDTH - LEFT - RIGHT - GAP * (columns - 1)) / columns, height + 0.85
    page = Page(0.1 + -(-count // columns) * pitch)
    return page.figure, [page.axes(LEFT + number % columns * (width + GAP), 0.4 + number // columns * pitch, width, height)
                         for number in range(count)]


def draw_map(study, path):
    """Draws the map of patterns over the two entries that the runs of a sweep vary, with contours of the wavelength, or of
    the speed where no crack has one. @return caption, or None if there are not exactly two abscissas"""
    varied = study.abscissas
    if len(varied) != 2:
        return None
    (x_unit, x_label), (y_unit, y_label) = (entry_axis(entry["entry"], entry["unit"]) for entry in varied)
    means = {quantity: [mean_of(seeds, quantity) for _, _, seeds in study.runs.values()] for quantity in CONTOURS}
    quantity = next((name for name in CONTOURS if any(means[name])), CONTOURS[0])
    scale, label = quantity_axis(quantity, study.document["units"][quantity])
    cells = [Cell(x_unit * x, y_unit * y, patterns_of(seeds), scale * mean.mean if mean else None, run.get("level", 0))
             for x, y, run, (_, _, seeds), mean in zip(varied[0]["values"], varied[1]["values"], study.document["runs"],
                                                       study.runs.values(), means[quantity])]
    if not draw_phase_map(cells, x_label, y_label, path, label):
        return None
    return (f"Patterns over {varied[0]['entry']} and {varied[1]['entry']}. A cell whose seeds disagree is divided between "
            f"their patterns and has a dot. Bars: between the nearest points on a line at which all seeds show one pattern and "
            f"another, the boundary with its uncertainty. Contours, where neighbouring cells have one: {label}, mean over the seeds.")


MOST_PATHS = 60  # panels of a picture, whose height has a limit


def draw_paths(study, names, path):
    """Draws paths of the tip, one panel per run with its seeds superimposed. @return caption, or None if there are none"""
    tables = {name: [(seed, if_present(read_columns, seed.folder / "crack.csv", ("X", "Y"))) for seed in study.runs[name][2]]
              for name in names[:MOST_PATHS]}
    paths = {name: ways for name, found in tables.items()
             if (ways := [(seed, tip) for seed, tip in found if tip is not None and len(tip["X"]) > 1])}
    if not paths:
        return None
    tips = [tip for ways in paths.values() for _, tip in ways]
    right = 105 * max(tip["X"].max() for tip in tips)
    half = 115 * max(max(np.abs(tip["Y"]).max() for tip in tips), 1e-3)
    columns = min(2, len(paths))
    figure, grid = panels(len(paths), columns, 1.5 if columns == 2 else 2.4)
    for axes, (name, ways) in zip(grid, paths.items()):
        for (seed, tip), colour in zip(ways, itertools.cycle(SEED_COLOURS)):
            axes.plot(100 * tip["X"], 100 * tip["Y"], color=colour, linewidth=1.1, label=f"seed {seed.seed}")
        axes.set(xlim=(0, right), ylim=(-half, half), title=f"{name}: {pattern_text(study.runs[name][2])}",
                 xlabel="X [cm]", ylabel="Y [cm]")
        axes.title.set_fontsize(9.5)
    save(figure, path)
    return ("Paths of the crack tip in the undeformed sheet, with the seeds of a run superimposed. Y is exaggerated."
            + (f" Shown: the first {MOST_PATHS} of {len(names)} runs." if len(names) > MOST_PATHS else ""))


def pattern_text(seeds):
    """Patterns over the seeds of a run, with their counts."""
    return ", ".join(f"{pattern} {count}/{len(seeds)}" for pattern, count in patterns_of(seeds).items()) or "not run"


def draw_sweep(study, row, quantities, path, onsets=None):
    """Draws quantities against the abscissa of a row, one panel each, with the power laws that were fitted to them,
    {quantity: "onset" of a row}. @return whether any run was measured"""
    unit, name = entry_axis(row["against"], row["against_unit"])
    points = [(unit * value["against"], study.runs[value["run"]][2]) for value in row["values"] if value["against"] is not None]
    points = [(x, seeds) for x, seeds in points if patterns_of(seeds)]
    if not points:
        return False
    columns = min(3, len(quantities))
    figure, grid = panels(len(quantities), columns, 2.2 if columns == 3 else 2.6)
    for axes, quantity in zip(grid, quantities):
        scale, label = quantity_axis(quantity, study.document["units"][quantity])
        for x, seeds in points:
            marker, colour = PATTERNS[next(iter(patterns_of(seeds)))]
            found = mean_of(seeds, quantity)
            y, error = (scale * found.mean, scale * (found.deviation or 0.0)) if found else (0.0, 0.0)
            axes.errorbar(x, y, yerr=error, marker=marker, color=colour, capsize=3, markersize=6, linestyle="none",
                          markerfacecolor=colour if found else "white")
        if onsets and quantity in onsets:  # the power law above the onset
            fit = onsets[quantity]
            distance = np.linspace(0, max(x for x, _ in points) / unit - fit["onset"]["value"], 200)
            axes.plot(unit * (fit["onset"]["value"] + distance),
                      scale * fit["prefactor"] * distance ** fit["exponent"]["value"], color=GREY, linewidth=1)
        axes.set(xlabel=name, ylabel=label)
        if axes.get_ylim()[0] >= 0:  # the axis begins at 0 unless values are negative
            top = max(axes.get_ylim()[1], 1e-12)
            axes.set_ylim(-0.04 * top, top)
        if is_over_decades([x for x, _ in points]):
            axes.set_xscale("log")
    shown = {next(iter(patterns_of(seeds))) for _, seeds in points}
    handles = [Line2D([], [], linestyle="none", marker=marker, color=colour, label=pattern)
               for pattern, (marker, colour) in PATTERNS.items() if pattern in shown]
    figure.legend(handles=handles, loc="upper left", bbox_to_anchor=(LEFT / WIDTH, 1), ncol=4)
    save(figure, path)
    return True


def draw_speeds(study, path):
    """Draws crack speed over the shear wave speed of the stretched sheet, by pattern. @return whether any was measured"""
    points = [(seed.pattern, seed.values["speed_over_shear"]) for seed in study.seeds
              if seed.pattern and "speed_over_shear" in seed.values]
    if not points:
        return False
    figure, (axes,) = panels(1, 1, 2.8)
    shown = [pattern for pattern in PATTERNS if any(p == pattern for p, _ in points)]
    for place, pattern in enumerate(shown):
        marker, colour = PATTERNS[pattern]
        values = np.array([value for p, value in points if p == pattern])
        aside = np.linspace(-0.25, 0.25, len(values)) if len(values) > 1 else np.zeros(1)
        axes.plot(place + aside, values, marker, color=colour, markersize=5, alpha=0.8)
    axes.axhline(1, color=BLACK, linestyle="--", linewidth=1)
    axes.set(xticks=range(len(shown)), xticklabels=shown, xlim=(-0.6, len(shown) - 0.4),
             ylabel="crack speed /\nshear speed")
    save(figure, path)
    return True
