"""Fields of a frame: speed and opening stress in the deformed sheet, damage in the undeformed sheet."""
import numpy as np

from .pictures import COLOUR_MAP, WIDTH, Page, limits, save
from .raster import Mesh, Raster

LEFT, GAP, TOP, FOOT, BAR = 0.75, 0.85, 0.4, 0.6, 0.75  # margins of axes, room of their colour bars [in]
PIXELS = 160  # of the fields [1/in]


def has_fields(frame):
    """Returns whether a frame has the fields that draw_fields() needs."""
    return {"velocity", "cauchy_stress", "damage"} <= set(frame.fields)


def draw_fields(frame, path):
    """Draws the three fields of a frame."""
    mesh = Mesh(frame)
    speed = np.linalg.norm(frame.fields["velocity"], axis=1)
    stress = 1e-6 * frame.fields["cauchy_stress"][:, 1, 1]
    damage = frame.fields["damage"]
    half = (WIDTH - LEFT - GAP - 0.2) / 2
    low, high = limits(frame.position)
    below_low, below_high = limits(frame.reference)
    height = half * (high - low)[1] / (high - low)[0]
    # The part of the undeformed sheet around the crack.
    torn = np.abs(frame.reference[damage > 0, 1])
    reach = min(below_high[1], 100 * 1.5 * (np.percentile(torn, 99) if len(torn) else 1.0))
    below_low, below_high = np.array((below_low[0], -reach)), np.array((below_high[0], reach))
    below = (WIDTH - LEFT - 0.2) * (below_high - below_low)[1] / (below_high - below_low)[0]
    page = Page(TOP + height + FOOT + BAR + TOP + below + FOOT + BAR)

    panel(page, (LEFT, TOP, half, height), mesh, frame.position, speed, (low, high), "inferno",
          (0.0, np.percentile(speed, 99) or 1.0), "speed", "speed of the material [m/s]", "x [cm]", "y [cm]")
    ends = np.percentile(stress, (1, 99))
    panel(page, (LEFT + half + GAP, TOP, half, height), mesh, frame.position, stress, (low, high), COLOUR_MAP,
          (ends[0], max(ends[1], ends[0] + 1e-9)), "opening stress", "Cauchy stress across the crack [MPa]", "x [cm]",
          "")
    panel(page, (LEFT, TOP + height + FOOT + BAR + TOP, WIDTH - LEFT - 0.2, below), mesh, frame.reference, damage,
          (below_low, below_high), "magma_r", (0.0, 1.0), "damage, in the undeformed sheet",
          "fraction of its bonds that a site has lost [1]", "X in the undeformed sheet [cm]", "Y [cm]")
    save(page.figure, path, few_colours=False)


def panel(page, box, mesh, position, values, corners, colours, ends, title, label, xlabel, ylabel):
    """Draws one field with its colour bar. box: left, top, width, height [in]; corners [cm]"""
    left, top, width, height = box
    low, high = corners
    axes = page.axes(*box)
    extent = (low[0], high[0], low[1], high[1])
    picture = Raster(extent, round(PIXELS * width)).draw(mesh, 100 * position, values)
    shown = axes.imshow(picture, extent=extent, cmap=colours, vmin=ends[0], vmax=ends[1], interpolation="nearest",
                        aspect="auto")
    axes.set(xlabel=xlabel, ylabel=ylabel, title=title)
    axes.grid(False)
    slack = 1e-3 * (ends[1] - ends[0])
    beyond = (values.min() < ends[0] - slack, values.max() > ends[1] + slack)
    extend = {(False, False): "neither", (True, False): "min", (False, True): "max", (True, True): "both"}[beyond]
    page.colour_bar(shown, left, top + height + FOOT, width, 0.13, label, extend=extend)
