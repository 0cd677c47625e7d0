"""Pictures of the averaged fields around a crack tip, in the current configuration."""
from dataclasses import dataclass

import numpy as np
from matplotlib.colors import TwoSlopeNorm
from matplotlib.ticker import MaxNLocator
from matplotlib.tri import Triangulation

from ..errors import UnreadableFile
from ..frames import read_image
from .pictures import BLACK, COLOUR_MAP, GREEN, WIDTH, Page, save

LEFT, TOP, FOOT, BAR = 0.85, 0.45, 0.62, 1.25  # margins and height of the colour bar [in]
NEGATIVE = 0.01  # fraction of the crack speed: faster backward motion is outlined, as counted in near_tip.json
FIELDS = {"displacement": (2,), "velocity": (2,), "cauchy_stress": (2, 2), "occupancy": ()}


@dataclass(frozen=True)
class NearTip:
    """Mean fields at the points of a grid, arrays (rows along Y, columns along X, components); SI units."""

    X: np.ndarray  # (columns) undeformed, relative to the tip
    Y: np.ndarray  # (rows)
    position: np.ndarray  # (rows, columns, 2) current, relative to the tip
    velocity: np.ndarray  # (rows, columns, 2) of the laboratory
    cauchy_stress: np.ndarray  # (rows, columns, 2, 2)
    occupancy: np.ndarray  # (rows, columns)
    samples: int

    @property
    def holds(self):
        """Points with material in at least half of the samples."""
        return self.occupancy >= 0.5


def read_near_tip(path):
    """Reads near_tip.vti or near_tip_folded.vti."""
    X, Y, fields, _, samples = read_image(path)
    shape = (len(Y), len(X))
    if missing := [name for name, components in FIELDS.items() if getattr(fields.get(name), "shape", None) != shape + components]:
        raise UnreadableFile(path, f"not a VTK image of the fields near a tip: array {missing[0]!r} is missing or of wrong size")
    if samples is None or not np.isfinite(fields["occupancy"]).all():
        raise UnreadableFile(path, "its samples or their occupancy are invalid")
    reference = np.stack(np.meshgrid(X, Y), axis=-1)
    return NearTip(X, Y, reference + fields["displacement"], fields["velocity"], fields["cauchy_stress"], fields["occupancy"], samples)


def velocity_picture(vti_path, out_png, crack_speed=None):
    """Draws velocity arrows on the colours of v_x, and outlines the zone of backward motion ahead of the tip.

    crack_speed: laboratory speed [m/s]; without it the outline is where v_x changes sign
    """
    tip = read_near_tip(vti_path)
    v = tip.velocity[..., 0]
    ahead = np.where(tip.holds & (tip.X > 0), v, np.inf)
    limit = -NEGATIVE * crack_speed if crack_speed else 0.0
    colours = TwoSlopeNorm(0.0, min(v[tip.holds].min(), -1e-3), max(np.percentile(v[tip.holds], 99.5), 1e-3))
    page, axes = axes_around(tip)
    mesh = axes.tripcolor(triangulation(tip), np.nan_to_num(v).ravel(), shading="gouraud", rasterized=True,
                          cmap="RdBu_r", norm=colours)
    goes_back = ahead < limit
    if goes_back.any():
        axes.tricontour(triangulation(tip), np.where(tip.X > 0, np.nan_to_num(v), 0.0).ravel(), levels=[limit],
                        colors=[GREEN], linewidths=1.4, linestyles="solid")
    every = slice(None, None, 2)
    shown = tip.holds[every, every]
    place, arrow = 1e3 * tip.position[every, every][shown], tip.velocity[every, every][shown]
    speed = np.linalg.norm(arrow, axis=1)
    fastest = max(np.percentile(speed, 99), 1e-3)
    arrows = axes.quiver(*place.T, *arrow.T, color=BLACK, angles="xy", width=0.0012, scale=22 * fastest,
                         scale_units="width")
    axes.quiverkey(arrows, 0.86, 1.025, fastest, f"{fastest:.3g} m/s", labelpos="E", fontproperties={"size": 9})
    what = f"green: v_x < {limit:.2g} m/s ahead of the tip" if goes_back.any() else "no backward motion ahead of the tip"
    finish(page, axes, mesh, tip, "velocity", f"v_x [m/s] in the laboratory, along the crack; {what}")
    save(page.figure, out_png)


def opening_stress_picture(vti_path, out_png):
    """Draws filled contours of the Cauchy stress sigma_yy."""
    tip = read_near_tip(vti_path)
    stress = 1e-6 * tip.cauchy_stress[..., 1, 1]
    low, high = np.percentile(stress[tip.holds & (tip.X > 0)], (1, 99.9))  # without the extremes at the flanks
    levels = MaxNLocator(18).tick_values(min(low, 0.0), max(high, low + 1e-6))
    page, axes = axes_around(tip)
    cells = triangulation(tip)
    mesh = axes.tricontourf(cells, np.nan_to_num(stress).ravel(), levels=levels, cmap=COLOUR_MAP, extend="both")
    axes.tricontour(cells, np.nan_to_num(stress).ravel(), levels=levels, colors="white", linewidths=0.35)
    finish(page, axes, mesh, tip, "opening stress", "Cauchy stress across the crack [MPa], force per current length and "
           "undeformed thickness")
    save(page.figure, out_png)


def triangulation(tip):
    """Two triangles for each cell of the grid that contains material, in the current configuration [mm].

    Cells with more than three times the median area ahead of the tip are omitted. They span the opening, because of fibrils
    or of flanks whose position varies between samples.
    """
    rows, columns = tip.holds.shape
    number = np.arange(rows * columns).reshape(rows, columns)
    corners = np.stack((number[:-1, :-1], number[:-1, 1:], number[1:, 1:], number[1:, :-1]))
    x, y = position = 1e3 * np.nan_to_num(tip.position).reshape(-1, 2).T  # points without material are in no triangle
    (ax, ay), (bx, by) = (position[:, corners[i + 2]] - position[:, corners[i]] for i in (0, 1))
    area = 0.5 * np.abs(ax * by - ay * bx)
    whole = tip.holds.ravel()[corners].all(axis=0)
    ahead = whole & (tip.X[None, :-1] > 0)
    a, b, c, d = corners[:, whole & (area < 3 * np.median(area[ahead if ahead.any() else whole]))]
    return Triangulation(x, y, np.concatenate((np.column_stack((a, b, c)), np.column_stack((a, c, d)))))


def axes_around(tip):
    """A page with axes of equal scales for the neighbourhood of the tip."""
    x, y = 1e3 * tip.position[tip.holds].T
    # Excludes single outlying points of a flank, and the uniform regions far above and below the tip.
    left, right = np.percentile(x, (0.2, 100))
    half_height = min(np.percentile(np.abs(y), 99.9), 0.38 * (right - left))
    bottom, top = -half_height, half_height
    width = WIDTH - LEFT - 0.25
    height = width * (top - bottom) / (right - left)
    page = Page(TOP + height + FOOT + BAR - 0.55)
    axes = page.axes(LEFT, TOP, width, height)
    axes.set(xlim=(left, right), ylim=(bottom, top), aspect="equal", xlabel="x from the tip [mm]",
             ylabel="y from the tip [mm]")
    axes.grid(False)
    return page, axes


def finish(page, axes, mesh, tip, title, label):
    """Adds tip, title and colour bar."""
    axes.plot(0, 0, "+", color=BLACK, markersize=11, markeredgewidth=1.6)
    axes.set_title(f"{title} around the tip: mean of {tip.samples} samples, current configuration")
    page.colour_bar(mesh, LEFT, page.height - 0.62, WIDTH - LEFT - 0.25, 0.14, label)
