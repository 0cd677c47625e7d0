"""The section of a crack: path, sheet over time, energies, measurements near the tip, still pictures."""
import numpy as np
from markupsafe import Markup

from ..quantities import number_text
from .crack_path import measured_sinusoid, measured_window
from .pages import first_sentence, has_dygraphs, superscripts
from .pictures import SHARES, energy_shares
from .runs import has_rows

CAPTIONS = {
    "animation.gif": "Animation of the crack in uniform slow motion: the deformed sheet, coloured by the speed of the "
                     "material. Filled regions have all their bonds; lines are bonds of sites that have lost some.",
    "sheet.png": "The deformed sheet in its last frame: every intact bond is a line, the crack is the white "
                 "opening; lines across it are intact bonds.",
    "sheet_fields.png": "Fields of the last frame: speed and opening stress in the deformed sheet, damage in the "
                        "undeformed sheet. Stress is force per current length and undeformed thickness. The colour "
                        "scales exclude 1 % of the sites.",
    "crack_path.png": "The crack in the undeformed sheet. Above: its tip, the right-most site that has lost at least a "
                      "quarter of its bonds; a dashed sinusoid, where one was measured, has its wavelength and amplitude, and "
                      "phase, offset and slope from a least-squares fit. Below: positions of broken bonds, coloured by time.",
    "energy.png": "Energy balance per metre of sheet thickness, since the cut of the seed crack. The dashed line is the "
                  "elastic energy released, with the work of the edges; the areas are the energies that it was converted to; "
                  "the small axis is the difference, the imbalance.",
    "near_tip_velocity.png": "Velocity of the material around the tip (cross), mean over samples. Samples where the path "
                             "descends were mirrored first, which keeps the two sides of an oscillating crack "
                             "separate. White: the opening, or points with material in fewer than half of the samples. "
                             "The numbers are in the table below.",
    "near_tip_stress.png": "Opening stress, averaged in the same way. With two off-axis lobes (ratios above 1 in the "
                           "table) its contours are kidney-shaped.",
}

# Pictures of each part of the section; plots and a viewer take the place of the first three.
PARTS = {"path": ("crack_path.png",), "energy": ("energy.png",), "near_tip": ("near_tip_velocity.png", "near_tip_stress.png"),
         "motion": ("animation.gif", "sheet.png", "sheet_fields.png")}
PATH_CAPTION = ("Path of the tip in the undeformed sheet, with Y exaggerated. Shaded: the window of the measurement. Drag "
                "across the plot to zoom in, double-click to reset.")
ENERGY_CAPTION = ("Conversion of the released elastic energy and the work of the edges, per metre of thickness, since the cut of the seed crack. "
                  "Dotted: time of the sheet above.")


def crack_section(run, position, pictures, sheet, animated):
    """Contents of the section of a crack.

    pictures: {name in CAPTIONS: (picture, still picture for print or None)}; those that a viewer or a plot also shows are
    collapsed. sheet: viewer data (sheet_data.py), or None. animated: whether an animation was asked for.
    """
    plots = {"path": (path_plot(run), PATH_CAPTION), "energy": (energy_plot(run), ENERGY_CAPTION)} if has_dygraphs() else {}
    plots = {name: plot for name, plot in plots.items() if plot[0] is not None}

    def figures(part, still=False):
        found = [(name, pictures[name]) for name in PARTS[part] if name in pictures]
        return [(last if still and last else moving, f"{run.name}: {first_sentence(CAPTIONS[name])}", CAPTIONS[name],
                 None if still else last) for name, (moving, last) in found]

    live = [*plots, *(["motion"] if sheet is not None else [])]
    return {"name": run.name, "position": position, "on_continuum": run.on_continuum, "pattern": pattern_sentence(run.crack),
            "plots": plots, "sheet": sheet, "pictures": {part: figures(part) for part in PARTS}, "near_tip": near_tip_rows(run.near_tip),
            "stills": [figure for part in PARTS if part in live for figure in figures(part, still=True)],
            "missing": [name for name in CAPTIONS if name not in pictures and (animated or name != "animation.gif")]}


def pattern_phrase(crack):
    """Phrase that states the pattern of a crack."""
    form = "the pattern of the crack is <b>{}</b>" if crack["pattern"] == "undecided" else "the crack is <b>{}</b>"
    return Markup(form).format(crack["pattern"])


def pattern_sentence(crack):
    """Sentence, without its full stop, that states the pattern of a crack and the reason."""
    if crack is None:
        return "The run did not reach the measurement of its crack (no crack.json)"
    phrase = pattern_phrase(crack)
    return phrase[:1].upper() + phrase[1:] + (f": {crack['reason']}" if crack.get("reason") else "")


# Rows of the table: name in near_tip.json, label, unit shown, scale to it, meaning.
QUANTITIES = (
    ("negative_zone_area", "negative velocity, area", "mm^2", 1e6,
             "region ahead of the tip that moves backwards at more than 1 % of the crack speed"),
    ("negative_zone_length", "negative velocity, length", "mm", 1e3, "extent of this region along the crack"),
    ("negative_zone_depth", "negative velocity, largest", "m/s", 1, "fastest backward motion ahead of the tip"),
    ("velocity_asymmetry", "asymmetry", "1", 1,
             "of the mean velocity, with samples of a descending path mirrored: 0 symmetric, 2 antisymmetric"),
    ("samples_with_vortex", "samples with a vortex", "%", 100,
             "share of single samples in which material rotates around a point near the tip"),
    ("process_zone_length", "process zone, length", "mm", 1e3,
             "extent of the material that follows the tip at more than half the speed of relaxed rubber"),
    ("process_zone_share", "process zone, share", "%", 100,
             "share of such material just behind the tip: 3 to 14 d behind it, up to 3 d to either side"),
    ("opening_stress_angle_4d", "opening stress, angle", "degrees", 1,
             "of the peak at 4 d from the tip, from the direction of the crack"),
    ("opening_stress_ratio_4d", "opening stress, ratio", "1", 1,
             "of the peak to the stress straight ahead; above 1 there is a lobe on either side"),
    ("opening_stress_concentration_4d", "opening stress, concentration", "1", 1,
             "peak at 4 d from the tip over the stress of the loaded sheet"),
    ("opening_stress_peak_4d", "opening stress, peak", "MPa", 1e-6, "at 4 d from the tip, Cauchy"),
    ("wedge_angle", "wedge angle", "degrees", 1, "between the flanks, mean over samples"),
    ("speed_over_shear", "speed over shear waves", "1", 1,
             "waves along the crack in the loaded sheet; the paper calls cracks above 1 supersonic"),
    ("speed_over_longitudinal", "speed over longitudinal waves", "1", 1,
             "waves along the crack in the loaded sheet"),
)


def near_tip_rows(near_tip):
    """Samples, reason and rows of near_tip.json; no samples if nothing could be measured; None for None."""
    if near_tip is None:
        return None
    rows = [("", [label, number_text(near_tip[name], near_tip.get(f"{name}_uncertainty"), scale=scale), superscripts(unit), meaning])
            for name, label, unit, scale, meaning in QUANTITIES if name in near_tip]
    return {"samples": near_tip.get("samples") or 0, "reason": near_tip["reason"], "rows": rows}


MOST_ROWS = 2000  # per interactive plot


def path_plot(run):
    """The path of the tip, with the sinusoid of an oscillating crack; None without a path."""
    if not has_rows(run.tip, 2):
        return None
    tip = thinned(run.tip)
    curves = {"X [cm]": 100 * tip["X"], "Y of the tip [mm]": 1e3 * tip["Y"]}
    curve, window = measured_sinusoid(run), measured_window(run)
    if curve is not None:
        inside = (tip["X"] >= window[0]) & (tip["X"] <= window[1])
        curves["measured sinusoid [mm]"] = np.where(inside, 1e3 * curve(tip["X"]), np.nan)
    return plot_over_X(curves, [False, True], [100 * end for end in window] if window and window[1] > window[0] else None)


def plot_over_X(curves, dashed, window=None):
    """Data of a plot of one or two paths."""
    n = len(curves) - 1
    return {"labels": list(curves), "rows": rows_of(curves), "colours": ["--first", "--second"][:n], "dashed": dashed[:n],
            "x": "X in the undeformed sheet [cm]", "y": "Y [mm]", "follows": "tip", "window": window}


def energy_plot(run):
    """Conversion of the elastic energy; None without energies."""
    if not has_rows(run.energy, 2):
        return None
    energy = thinned(run.energy)
    released, shares = energy_shares(energy)
    curves = {"t [ms]": 1e3 * energy["t"], f"released{' and work of the edges' if energy['boundary_work'].any() else ''} [J/m]": released}
    curves.update({f"{SHARES[name][0]} [J/m]": values for name, values in shares})
    return {"labels": list(curves), "rows": rows_of(curves), "colours": ["--text", *(f"--{name}" for name, _ in shares)],
            "dashed": [True] + [False] * len(shares), "stacked": 2, "x": "time [ms]", "y": "energy [J/m]", "follows": "time",
            "window": None}


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
