"""Style of all pictures, and the pictures of the sheet, its fields and its energies. Lengths in cm, times in ms."""
import io
import math

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np
from matplotlib.collections import LineCollection
from PIL import Image

from ..folder import write_file
from .raster import Mesh, Raster

WIDTH = 10.0  # of every picture [in]
PIXELS_PER_INCH = 160
# Okabe and Ito's palette, distinguishable for colour-blind readers and in print.
BLACK, BLUE, SKY, GREEN, RED, GREY = "#222222", "#0072b2", "#56b4e9", "#009e73", "#d55e00", "#8a8a8a"
COLOUR_MAP = "viridis"

plt.rcParams.update({
    "figure.dpi": PIXELS_PER_INCH,
    "font.size": 10,
    "axes.labelsize": 10,
    "axes.titlesize": 11,
    "axes.titlelocation": "left",
    "axes.titley": 1.0,  # the automatic position, whose search takes as long as the rest of the drawing
    "axes.edgecolor": "#555555",
    "axes.linewidth": 0.7,
    "axes.formatter.useoffset": False,
    "axes.grid": True,
    "axes.axisbelow": True,
    "axes.spines.top": False,
    "axes.spines.right": False,
    "grid.color": "#e4e4e4",
    "grid.linewidth": 0.6,
    "legend.frameon": False,
    "legend.fontsize": 10,
    "lines.linewidth": 1.6,
})


def figure_pixels(figure):
    """Draws a figure and closes it. @return its pixels, (rows, columns, 3)"""
    figure.canvas.draw()
    pixels = np.asarray(figure.canvas.buffer_rgba())[..., :3].copy()
    plt.close(figure)
    return pixels


def save(figure, path, few_colours=True):
    """Writes a figure as PNG and closes it."""
    save_png(Image.fromarray(figure_pixels(figure)), path, few_colours)


def save_png(picture, path, few_colours=True):
    """Writes a PIL picture as PNG. With 256 colours the file has a quarter of the size, and colours are within 10 of 255;
    smooth fields then show steps."""
    if few_colours:
        picture = picture.quantize(256, method=Image.Quantize.FASTOCTREE, dither=Image.Dither.NONE)
    data = io.BytesIO()
    picture.save(data, format="PNG")
    write_file(str(path), data.getvalue())


def shrink(path, most):
    """Scales a PNG down until it has at most `most` bytes."""
    with Image.open(path) as picture:
        whole = picture.convert("RGB")
    width = whole.width
    while path.stat().st_size > most and width > 400:
        width = round(0.85 * width)
        save_png(whole.resize((width, round(whole.height * width / whole.width)), Image.Resampling.LANCZOS), path)


class Page:
    """A figure with axes positioned in inches from its left and top edge."""

    def __init__(self, height):
        self.height = height
        self.figure = plt.figure(figsize=(WIDTH, height))

    def axes(self, left, top, width, height, **options):
        """Axes whose upper left corner is at (left, top)."""
        box = (left / WIDTH, (self.height - top - height) / self.height, width / WIDTH, height / self.height)
        return self.figure.add_axes(box, **options)

    def colour_bar(self, shown, left, top, width, height, label, **options):
        """Adds a horizontal colour bar."""
        bar = self.figure.colorbar(shown, cax=self.axes(left, top, width, height), orientation="horizontal", **options)
        bar.set_label(label)
        bar.outline.set_visible(False)


def draw_sheet(frame, breaking_stretch, path):
    """Draws the deformed sheet: bonds as lines, coloured by stretch up to the breaking stretch (None: unknown)."""
    low, high = limits(frame.position)
    width = WIDTH - 0.95
    height = min(width * (high - low)[1] / (high - low)[0], 14.0)
    page = Page(height + 1.85)
    axes = page.axes(0.7, 0.4, width, height)

    order = np.argsort(frame.stretch)  # the most stretched on top
    values = frame.stretch[order]
    smallest, largest = np.percentile(values, (1, 99))
    top = breaking_stretch if breaking_stretch and breaking_stretch > smallest else largest
    colours = plt.get_cmap(COLOUR_MAP).with_extremes(over=RED)
    bonds = LineCollection(100 * frame.position[frame.bonds[order]], array=values, cmap=colours, linewidths=0.55,
                           rasterized=True)
    bonds.set_clim(smallest, top if top > smallest else smallest + 1e-3)
    axes.add_collection(bonds)
    alone = np.setdiff1d(np.arange(len(frame.position)), frame.bonds)
    axes.plot(*100 * frame.position[alone].T, ".", markersize=1.5, color=GREY)
    axes.set(xlim=(low[0], high[0]), ylim=(low[1], high[1]), aspect="equal", xlabel="x [cm]", ylabel="y [cm]",
             title=f"sheet at {1e3 * frame.time:.2f} ms")
    axes.grid(False)

    beyond = f"; orange: beyond the breaking stretch {breaking_stretch:.4g} (toughened)" if top == breaking_stretch else ""
    page.colour_bar(bonds, 0.7, height + 1.0, width, 0.16, f"stretch of a bond, current over undeformed length [1]{beyond}",
                    extend="both" if values[-1] > top else "min")
    save(page.figure, path)


def limits(position):
    """Corners of the part to show [cm]: the sheet with a margin, without fragments that flew off."""
    low, high = 100 * np.percentile(position, (0.1, 99.9), axis=0)
    margin = 0.02 * (high - low).max()
    return low - margin, high + margin


# Forms into which elastic energy is converted: {column of energy.csv: (label, colour)}.
SHARES = {"broken": ("in what broke", RED), "viscous": ("viscous heat", SKY), "kinetic": ("kinetic", BLUE),
          "contact": ("contact", GREEN)}


def energy_shares(energy):
    """Released elastic energy including the work of the edges, and its non-zero shares [(column, values), ...]; all relative
    to the first row [J/m]."""
    released = energy["elastic"][0] - energy["elastic"] + energy["boundary_work"] - energy["boundary_work"][0]
    shares = [(name, energy[name] - energy[name][0]) for name in SHARES]
    return released, [(name, values) for name, values in shares if values.any()]


def draw_energy(energy, path):
    """Draws the conversion of the elastic energy: kinetic, viscous and broken, stacked; below, the imbalance."""
    t = 1e3 * energy["t"]
    released, shares = energy_shares(energy)

    page = Page(5.4)
    axes = page.axes(1.0, 0.25, WIDTH - 1.25, 3.3)
    worked = energy["boundary_work"].any()
    axes.plot(t, released, "--", color=BLACK,
              label=f"elastic energy released{' and work of the edges' if worked else ''}, {released[-1]:.4g} J/m")
    if shares:
        axes.stackplot(t, [values for *_, values in shares], colors=[SHARES[name][1] for name, _ in shares], alpha=0.85,
                       linewidth=0, labels=[f"{SHARES[name][0]}, {values[-1]:.4g} J/m" for name, values in shares])
    axes.set(xlim=(t[0], t[-1]), ylabel="energy per sheet thickness\nsince the seed crack [J/m]")
    axes.tick_params(labelbottom=False)
    handles, labels = axes.get_legend_handles_labels()
    axes.legend(handles[:1] + handles[:0:-1], labels[:1] + labels[:0:-1], loc="upper left")

    imbalance = energy["imbalance"]
    exponent = math.floor(math.log10(np.abs(imbalance).max())) if imbalance.any() else 0
    below = page.axes(1.0, 3.85, WIDTH - 1.25, 0.95, sharex=axes)
    below.plot(t, imbalance / 10.0**exponent, color=BLACK, linewidth=1.2)
    below.set(xlabel="time [ms]", ylabel=f"imbalance\n[$10^{{{exponent}}}$ J/m]")
    for panel in (axes, below):
        panel.yaxis.set_label_coords(-0.065, 0.5)
    save(page.figure, path)


LEFT, GAP, TOP, FOOT, BAR = 0.75, 0.85, 0.4, 0.6, 0.75  # of the fields: margins of axes, room of colour bars [in]
PIXELS = 160  # of the fields [1/in]


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
