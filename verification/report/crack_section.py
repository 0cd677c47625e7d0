"""The section of a crack: its path, the sheet over time, its energies, what was measured near its tip, still pictures."""
from html import escape

from live import energy_plot, has_dygraphs, live_plot, path_plot, viewer
from markup import figure, first_sentence
from near_tip_table import near_tip_table

CAPTIONS = {
    "animation.gif": "The crack as it runs, in slow motion of one pace: the sheet as it is, coloured by the speed of "
                     "the material. What is filled has all its bonds; lines are bonds of sites that have lost some.",
    "sheet.png": "The sheet in its last frame, as it is: every unbroken bond is a line, the crack is the white "
                 "opening; lines across it are bonds that still hold.",
    "sheet_fields.png": "Fields of the last frame: speed and opening stress in the sheet as it is, damage where it was "
                        "before the loading. Stress is force per current length and undeformed thickness. Scales end "
                        "where 1 % of the sites are beyond.",
    "crack_path.png": "The crack in the undeformed sheet. Above: its tip, the right-most site that has lost enough "
                      "bonds; the dashed sinusoid has the measured wavelength and amplitude, its phase, offset and "
                      "slope are least squares. Below: where bonds broke, coloured by time.",
    "energy.png": "Where the elastic energy went, per metre of sheet thickness, from the cut of the seed crack on. The "
                  "dashed line is what the bonds gave; the areas are what was found elsewhere; the small axis is the "
                  "difference, over the energy given to the sheet.",
    "near_tip_velocity.png": "Velocity of the material around the tip (cross), mean over samples; where the path "
                             "descends, samples were mirrored first, so that the two sides of an oscillating crack "
                             "stay apart. White: the opening, or fewer than half the samples had material there. "
                             "Numbers are in the table below.",
    "near_tip_stress.png": "Stress across the crack, in the same mean. Two lobes off the axis are what is called "
                           "kidney shaped.",
}

NEAR_TIP = ("near_tip_velocity.png", "near_tip_stress.png")
PATH_CAPTION = ("Path of the tip in the undeformed sheet, Y drawn larger than X. Shaded: the window of the measurement. Drag "
                "across the plot to enlarge it, double-click to reset.")
ENERGY_CAPTION = ("Where the released elastic energy went, per metre of sheet thickness, since the cut of the seed crack. "
                  "Dotted: the time of the sheet above.")


def crack_section(run, position, pictures, sheet):
    """A crack: what it did, as pictures and numbers.

    pictures: {name in CAPTIONS: (picture, still picture for print or None)}; those that a viewer or a plot shows as well are
    folded. sheet: data of the viewer (sheet_data.py); None: there is none.
    """
    plots = {"path": path_plot(run), "energy": energy_plot(run)} if has_dygraphs() else {}
    live = {name: live_plot(position, name, plots[name], caption, sheet is not None)
            for name, caption in (("path", PATH_CAPTION), ("energy", ENERGY_CAPTION)) if plots.get(name) is not None}
    if sheet is not None:
        live["motion"] = viewer(position, run, sheet)
    stills = {"path": ("crack_path.png",), "motion": ("animation.gif", "sheet.png", "sheet_fields.png"),
              "energy": ("energy.png",)}
    parts = [f'<h2 id="crack-{position}">Crack: {escape(run.name)}</h2>', pattern_sentence(run)]
    for name, names in stills.items():
        parts += ([f'<div id="{name}-{position}">{live[name]}</div>'] if name in live
                  else drawn(run, pictures, names))
    near_tip = drawn(run, pictures, NEAR_TIP) + ([near_tip_table(run.near_tip)] if run.near_tip is not None else [])
    parts += details(f"near-tip-{position}", "<b>Near the tip</b>: velocity, opening stress, and what was measured of them",
                     near_tip)
    folded = [name for name in live for name in stills[name]]
    parts += details(f"stills-{position}", "<b>Still pictures</b> of the same", drawn(run, pictures, folded, still=True))
    missing = [name for name in CAPTIONS if name not in pictures]
    if missing:
        parts.append(f'<p class="soft">Not drawn, for the run left nothing to draw: {", ".join(missing)}</p>')
    return "\n".join(parts)


def drawn(run, pictures, names, still=False):
    """The figures of those of some pictures that were drawn; still: without motion."""
    found = []
    for name in names:
        if name in pictures:
            moving, last = pictures[name]
            shown, instead = (last, None) if still and last is not None else (moving, last)
            found.append(figure(shown, f"{run.name}: {first_sentence(CAPTIONS[name])}", CAPTIONS[name], instead))
    return found


def details(name, summary, parts):
    """What unfolds below a line, in a list; an empty list if it is nothing."""
    return [f'<details id="{name}"><summary>{summary}</summary>{"".join(parts)}</details>'] if parts else []


def pattern_phrase(crack):
    """The pattern of a crack in words."""
    word = escape(crack["pattern"])
    return "the pattern of the crack is <b>undecided</b>" if word == "undecided" else f"the crack is <b>{word}</b>"


def pattern_sentence(run):
    """What the crack did, and why it is called that."""
    if run.crack is None:
        return "<p>The run did not get to the measurement of its crack (no crack.json).</p>"
    phrase = pattern_phrase(run.crack)
    reason = f": {escape(run.crack['reason'])}" if run.crack.get("reason") else ""
    return f"<p>{phrase[:1].upper()}{phrase[1:]}{reason}.</p>"
