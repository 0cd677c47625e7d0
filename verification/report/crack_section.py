"""The section of a crack: path, sheet over time, energies, measurements near the tip, still pictures."""
from html import escape

from live import energy_plot, has_dygraphs, live_plot, path_plot, viewer
from markup import figure, first_sentence
from near_tip_table import near_tip_table

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

# Of a crack of the continuum, instead of those of the same name, or in addition; it has no others.
CONTINUUM_CAPTIONS = {
    "damage.png": "Last frame. Above: the deformed sheet, coloured by the speed of the material; white: damage of 0.5 and "
                  "more. Below: damage in the undeformed sheet.",
    "crack_edges.png": "Both edges of the crack, where the damage is 0.5, and the line midway between the outermost ones, "
                       "in the undeformed sheet with Y exaggerated; below, the width of the damage above 0.5. Shaded: the "
                       "window of the measurement. Edges that move towards and away from each other hide in the path.",
    "crack_path.png": "The tip of the crack in the undeformed sheet, where the damage of 0.5 reaches farthest; the dashed "
                      "sinusoid has the measured wavelength and amplitude.",
    "energy.png": "Energy balance per metre of sheet thickness, since the seed crack. The dashed line is the elastic energy "
                  "released; the areas are the energies that it was converted to. Broken material takes its motion with it. "
                  "The small axis is the difference, over the energy that the crack spent.",
}

NEAR_TIP = ("near_tip_velocity.png", "near_tip_stress.png")
PATH_CAPTION = ("Path of the tip in the undeformed sheet, with Y exaggerated. Shaded: the window of the measurement. Drag "
                "across the plot to zoom in, double-click to reset.")
ENERGY_CAPTION = ("Conversion of the released elastic energy, per metre of thickness, since the cut of the seed crack. "
                  "Dotted: time of the sheet above.")


def crack_section(run, position, pictures, sheet, animated):
    """Pictures and numbers of a crack.

    pictures: {name in CAPTIONS: (picture, still picture for print or None)}; those that a viewer or a plot also shows are
    collapsed. sheet: viewer data (sheet_data.py), or None. animated: whether an animation was asked for.
    """
    plots = {"path": path_plot(run), "energy": energy_plot(run)} if has_dygraphs() else {}
    live = {name: live_plot(position, name, plots[name], caption, sheet is not None)
            for name, caption in (("path", PATH_CAPTION), ("energy", ENERGY_CAPTION)) if plots.get(name) is not None}
    if sheet is not None:
        live["motion"] = viewer(position, run, sheet)
    captions = CONTINUUM_CAPTIONS if run.on_continuum else CAPTIONS
    stills = {"path": ("crack_path.png",),
              "motion": ("animation.gif", "sheet.png", "sheet_fields.png", "damage.png", "crack_edges.png"),
              "energy": ("energy.png",)}
    parts = [f'<h2 id="crack-{position}">Crack{" of the continuum" if run.on_continuum else ""}: {escape(run.name)}</h2>', pattern_sentence(run)]
    for name, names in stills.items():
        parts += ([f'<div id="{name}-{position}">{live[name]}</div>'] if name in live
                  else drawn(run, pictures, names))
    near_tip = drawn(run, pictures, NEAR_TIP) + ([near_tip_table(run.near_tip)] if run.near_tip is not None else [])
    parts += expandable(f"near-tip-{position}", "<b>Near the tip</b>: velocity, opening stress, and measured quantities",
                        near_tip)
    collapsed = [name for name in live for name in stills[name]]
    parts += expandable(f"stills-{position}", "<b>Still pictures</b> of the same",
                        drawn(run, pictures, collapsed, still=True))
    missing = [name for name in captions if name not in pictures and (animated or name != "animation.gif")]
    if missing:
        parts.append(f'<p class="soft">Not drawn, because the run has no data for it: {", ".join(missing)}</p>')
    return "\n".join(parts)


def drawn(run, pictures, names, still=False):
    """Figures of the named pictures, where they exist; still: without animation."""
    found = []
    captions = CONTINUUM_CAPTIONS if run.on_continuum else CAPTIONS
    for name in names:
        if name in pictures:
            moving, last = pictures[name]
            shown, instead = (last, None) if still and last is not None else (moving, last)
            found.append(figure(shown, f"{run.name}: {first_sentence(captions[name])}", captions[name], instead))
    return found


def expandable(name, summary, parts):
    """List with one element that expands below a summary; empty if there are no parts."""
    return [f'<details id="{name}"><summary>{summary}</summary>{"".join(parts)}</details>'] if parts else []


def pattern_phrase(crack):
    """Phrase that states the pattern of a crack."""
    word = escape(crack["pattern"])
    return "the pattern of the crack is <b>undecided</b>" if word == "undecided" else f"the crack is <b>{word}</b>"


def pattern_sentence(run):
    """Sentence that states the pattern of a crack and the reason."""
    if run.crack is None:
        return "<p>The run did not reach the measurement of its crack (no crack.json).</p>"
    phrase = pattern_phrase(run.crack)
    reason = f": {escape(run.crack['reason'])}" if run.crack.get("reason") else ""
    return f"<p>{phrase[:1].upper()}{phrase[1:]}{reason}.</p>"
