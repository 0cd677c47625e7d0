"""The section of a crack: path, sheet over time, energies, measurements near the tip, still pictures."""
from markupsafe import Markup

from .pages import first_sentence, has_dygraphs
from .live import energy_plot, path_plot
from .near_tip_table import near_tip_rows

CAPTIONS = {
    "animation.gif": "Animation of the crack in uniform slow motion: the deformed sheet, coloured by the speed of the "
                     "material. Filled regions have all their bonds; lines are bonds of sites that have lost some.",
    "sheet.png": "The deformed sheet in its last frame: every intact bond is a line, the crack is the white "
                 "opening; lines across it are intact bonds.",
    "sheet_fields.png": "Fields of the last frame: speed and opening stress in the deformed sheet, damage in the "
                        "undeformed sheet. Stress is force per current length and undeformed thickness. The colour "
                        "scales exclude 1 % of the sites.",
    "crack_path.png": "The crack in the undeformed sheet. Above: its tip, the right-most site that has lost at least a "
                      "quarter of its bonds; the dashed sinusoid has the measured wavelength and amplitude, and phase, "
                      "offset and slope from a least-squares fit. Below: positions of broken bonds, coloured by time.",
    "energy.png": "Energy balance per metre of sheet thickness, since the cut of the seed crack. The dashed line is the "
                  "energy released by the bonds; the areas are the energies that it was converted to; the small axis is "
                  "the difference, over the energy that the crack spent.",
    "near_tip_velocity.png": "Velocity of the material around the tip (cross), mean over samples. Samples where the path "
                             "descends were mirrored first, which keeps the two sides of an oscillating crack "
                             "separate. White: the opening, or points with material in fewer than half of the samples. "
                             "The numbers are in the table below.",
    "near_tip_stress.png": "Opening stress, averaged in the same way. Two off-axis lobes make the contours "
                           "kidney-shaped.",
}

# Pictures of each part of the section; plots and a viewer take the place of the first three.
PARTS = {"path": ("crack_path.png",), "energy": ("energy.png",), "near_tip": ("near_tip_velocity.png", "near_tip_stress.png"),
         "motion": ("animation.gif", "sheet.png", "sheet_fields.png")}
PATH_CAPTION = ("Path of the tip in the undeformed sheet, with Y exaggerated. Shaded: the window of the measurement. Drag "
                "across the plot to zoom in, double-click to reset.")
ENERGY_CAPTION = ("Conversion of the released elastic energy, per metre of thickness, since the cut of the seed crack. "
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
