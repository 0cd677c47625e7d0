"""Pictures of a continuum that broke by damage: its last frame, and the edges of its crack."""
from dataclasses import dataclass

import numpy as np
from ..errors import UnreadableFile
from ..files import if_present, read_columns
from ..frames import read_frame
from .motion import last_frame
from .pictures import BLACK, BLUE, GREY, RED, WIDTH, Page, save

NEEDED = ("displacement", "velocity", "damage", "strain_energy_density")
EDGE = 0.5  # damage at the edge of a crack, as in verification/analysis/damage_contour.h
LEFT, RIGHT, TOP, FOOT, BAR = 0.85, 0.25, 0.4, 0.6, 0.75  # margins of axes, room of their colour bars [in]


@dataclass(frozen=True)
class DamageFrame:
    """Fields at the nodes of a grid at one time, arrays (rows, columns)."""

    time: float  # [s]
    X: np.ndarray  # undeformed [m]
    Y: np.ndarray
    x: np.ndarray  # current [m]
    y: np.ndarray
    speed: np.ndarray  # [m/s]
    damage: np.ndarray  # [1]
    energy: np.ndarray  # [J/m^3]


def read_last_damage_frame(folder):
    """Reads the last existing frame listed in continuum.pvd; None if there is none of a continuum with damage."""
    time, path = last_frame(folder / "continuum.pvd")
    return read_damage_frame(path, time) if path else None


def read_damage_frame(path, time):
    """Reads a frame."""
    frame = read_frame(path, time, NEEDED)
    fields, reference = frame.fields, frame.reference
    if missing := [name for name in NEEDED if name not in fields]:
        raise UnreadableFile(path, f"not a frame of a continuum with damage: array {missing[0]!r} is missing")
    columns = int(np.argmax(reference[:, 1] > reference[0, 1])) or len(reference)
    if len(reference) % columns or not all(np.isfinite(fields[name]).all() for name in NEEDED):
        raise UnreadableFile(path, "its nodes are not those of a grid, or a value is not finite")
    return DamageFrame(time, *(np.asarray(values, float).reshape(-1, columns) for values in (
        *reference.T, *frame.position.T, np.linalg.norm(fields["velocity"], axis=1), fields["damage"], fields["strain_energy_density"])))


def draw_damage(frame, path):
    """Draws the deformed sheet, coloured by speed, without what is broken, and the damage in the undeformed sheet."""
    width = WIDTH - LEFT - RIGHT
    centres = 0.25 * (frame.damage[1:, 1:] + frame.damage[1:, :-1] + frame.damage[:-1, 1:] + frame.damage[:-1, :-1])
    speed = np.where(centres < EDGE, 0.5 * (frame.speed[1:, 1:] + frame.speed[:-1, :-1]), np.nan)
    sound = frame.damage < EDGE
    extent = [(values[sound].min(), values[sound].max()) for values in (frame.x, frame.y)]
    heights = [min(width * np.ptp(extent[1]) / np.ptp(extent[0]), 9.0), width * np.ptp(frame.Y) / np.ptp(frame.X)]
    page = Page(sum(heights) + 2 * (TOP + FOOT + BAR))
    top = np.nanpercentile(speed, 99) if np.isfinite(speed).any() else 1.0
    panels = (("sheet", frame.x, frame.y, speed, "inferno", top or 1.0, "speed of the material [m/s]", "x [cm]", "y [cm]"),
              ("damage, in the undeformed sheet", frame.X, frame.Y, centres, "magma_r", 1.0, "damage [1]",
               "X in the undeformed sheet [cm]", "Y [cm]"))
    above = TOP
    for (title, x, y, values, colours, largest, label, xlabel, ylabel), height in zip(panels, heights):
        axes = page.axes(LEFT, above, width, height)
        shown = axes.pcolormesh(100 * x, 100 * y, values, cmap=colours, vmin=0.0, vmax=largest, rasterized=True)
        axes.set(xlabel=xlabel, ylabel=ylabel, title=f"{title} at {1e3 * frame.time:.2f} ms", aspect="equal")
        axes.set_xlim(*(100 * np.array((x[sound].min(), x[sound].max()))))
        axes.set_ylim(*(100 * np.array((y[sound].min(), y[sound].max()))))
        axes.grid(False)
        page.colour_bar(shown, LEFT, above + height + FOOT, width, 0.13, label, extend="max" if largest == top else "neither")
        above += height + FOOT + BAR + TOP
    save(page.figure, path, few_colours=False)


def read_edges(folder):
    """Table crack_edges.csv of a run of the continuum; None if there is none."""
    return if_present(read_columns, folder / "crack_edges.csv", ("X", "strands", "lower", "upper", "damaged"))


def draw_edges(edges, crack, path):
    """Draws both edges of a crack and its centre line (above) and the damaged width (below), with Y exaggerated."""
    X = 100 * edges["X"]
    page = Page(5.6)
    axes = page.axes(LEFT, TOP, WIDTH - LEFT - RIGHT, 2.7)
    axes.fill_between(X, 1e3 * edges["lower"], 1e3 * edges["upper"], color=GREY, alpha=0.25, linewidth=0)
    for name, values, colour in (("upper edge", edges["upper"], BLUE), ("lower edge", edges["lower"], RED),
                                 ("centre line", 0.5 * (edges["lower"] + edges["upper"]), BLACK)):
        axes.plot(X, 1e3 * values, color=colour, linewidth=1.1, label=name)
    below = page.axes(LEFT, TOP + 3.1, WIDTH - LEFT - RIGHT, 1.4, sharex=axes)
    below.plot(X, 1e3 * edges["damaged"], color=BLUE)
    below.set(xlabel="X in the undeformed sheet [cm]", ylabel="width [mm]", ylim=(0, None))
    axes.set(ylabel="Y [mm]", xlim=(X[0], X[-1]))
    axes.tick_params(labelbottom=False)
    axes.legend(loc="lower left", bbox_to_anchor=(0, 1), ncol=3, borderaxespad=0.2, fontsize=9.5)
    window = [(crack or {}).get(name) for name in ("window_begin", "window_end")]
    if None not in window and window[1] > window[0]:
        for panel in (axes, below):
            panel.axvspan(100 * window[0], 100 * window[1], color=GREY, alpha=0.1, linewidth=0)
    save(page.figure, path)
