#!/usr/bin/python3
"""Draws model.png: the sheet with its held edges and seed crack, the bonds of a site, and the law of a bond.

Usage: model.py [FOLDER]     FOLDER of model.png, default: the folder of this script
"""
import pathlib
import sys

import matplotlib
matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np
from matplotlib.patches import Polygon, Rectangle

BLUE, RED, GREY, DARK = "#1f6fb4", "#c8502a", "#b8bec6", "#222222"
ARROW = {"arrowstyle": "<->", "color": DARK, "lw": 1, "shrinkA": 0, "shrinkB": 0}
SHEET = "#dfe9f3"


def dimension(axes, start, end, text, offset, **options):
    """Double arrow from start to end, with its symbol at the offset from the middle."""
    axes.annotate("", start, end, arrowprops=ARROW)
    middle = (np.asarray(start) + end) / 2 + offset
    axes.text(*middle, text, ha="center", va="center", fontsize=12, **options)


def held_edges(axes, x, y, width, height, t=0.9):
    for corner, w, h in (((x - t, y - t), width + 2 * t, t), ((x - t, y + height), width + 2 * t, t), ((x - t, y), t, height),
                         ((x + width, y), t, height)):
        axes.add_patch(Rectangle(corner, w, h, facecolor="white", edgecolor=GREY, hatch="/////", lw=0))
    axes.add_patch(Rectangle((x, y), width, height, facecolor=SHEET, edgecolor=DARK, lw=1))


def draw_sheets(axes):
    length, height = 13.5, 5.
    stretch_x, stretch_y = 2., 2.4
    # Undeformed, with the path of the tip.
    back, seed, tip, amplitude, wavelength = 0.7, 1.6, 10.8, 0.55, 3.6
    x0, y0 = 0., (stretch_y * height - height) / 2
    axes.add_patch(Rectangle((x0, y0), length, height, facecolor=SHEET, edgecolor=DARK, lw=1))
    middle = y0 + height / 2

    def path(x):
        return amplitude * (1 - np.exp(-(x - seed) / 1.2)) * np.sin(2 * np.pi * (x - seed) / wavelength)

    x = np.linspace(seed, tip, 300)
    axes.plot([back, seed], [middle, middle], color=DARK, lw=3)
    axes.plot(x, middle + path(x), color=RED, lw=1.4)
    axes.plot(tip, middle + path(tip), "o", color=RED, ms=4)
    axes.text(0.25, middle - 1.0, "seed", fontsize=10)
    axes.text(tip + 0.4, middle + path(tip), "tip", va="center", fontsize=10, color=RED)
    crest = seed + 5 / 4 * wavelength
    dimension(axes, (crest, middle + 0.95), (crest + wavelength, middle + 0.95), "wavelength $\\Lambda$", (0, 0.62))
    trough = seed + 3 / 4 * wavelength
    axes.plot([trough - 1.2, crest + wavelength], [middle, middle], color=GREY, lw=0.8, ls=":")
    dimension(axes, (trough - 1., middle - amplitude), (trough - 1., middle), "$A$", (-0.6, -0.1))
    axes.plot([trough - 1.2, trough], [middle - amplitude] * 2, color=GREY, lw=0.8, ls=":")
    dimension(axes, (x0 - 0.6, y0), (x0 - 0.6, y0 + height), "$H$", (-0.75, 0))
    dimension(axes, (x0, y0 - 0.6), (length, y0 - 0.6), "$L$", (0, -0.7))
    axes.text(length / 2, y0 + height + 0.8, "undeformed sheet ($X$), path of the tip", ha="center", fontsize=11)

    # Stretched, with all edges held and the crack open.
    x1 = length + 7.
    width, tall = stretch_x * length, stretch_y * height
    held_edges(axes, x1, 0, width, tall)
    centre = tall / 2
    end, start = x1 + stretch_x * tip, x1 + stretch_x * back
    u = start + (end - start) * (1 - np.cos(np.linspace(0, np.pi, 600))) / 2  # dense at both tips
    along = (u - start) / (end - start)
    opening = 1.2 * np.sqrt(1 - along) * np.sqrt(np.tanh(along / 0.04))
    line = np.where(u > x1 + stretch_x * seed, stretch_y * path(np.maximum((u - x1) / stretch_x, seed)), 0)
    upper, lower = centre + line + 1.9 * opening, centre + line - 1.9 * opening
    axes.add_patch(Polygon(np.column_stack([np.r_[u, u[::-1]], np.r_[upper, lower[::-1]]]), facecolor="white", edgecolor=DARK, lw=1))
    axes.plot(end, centre + line[-1], "o", color=RED, ms=4)
    axes.annotate("bonds break at $\\lambda_f$", (end, centre + line[-1]), (end - 0.2, centre + 3.7), fontsize=11, color=RED, ha="center",
                  arrowprops={"arrowstyle": "->", "color": RED})
    delta = 5.2
    dimension(axes, (end - delta, centre - 3.55), (end, centre - 3.55), "$\\delta$: bonds tougher farther back", (0, -0.75))
    axes.plot([end, end], [centre - 3.9, centre + line[-1]], color=GREY, lw=0.8, ls=":")
    axes.text(start + 0.9, centre, "crack", fontsize=10, va="center")
    axes.annotate("", (end + 3.6, centre), (end + 0.6, centre), arrowprops={"arrowstyle": "-|>", "color": RED, "lw": 1.8})
    axes.text(end + 2.2, centre + 0.65, "speed", color=RED, fontsize=10, ha="center")
    axes.text(x1 + width / 2, tall + 1.75, "stretched by $1+\\varepsilon_x$ and $1+\\varepsilon_y$, all edges held ($x$)", ha="center",
              fontsize=11)
    axes.annotate("", (x1 - 1.5, centre), (x0 + length + 1., centre), arrowprops={"arrowstyle": "-|>", "color": DARK, "lw": 1.5})
    axes.text((x1 - 0.5 + length) / 2, centre + 0.7, "$x = F X$", ha="center", fontsize=11)
    axes.set_xlim(-2.6, x1 + width + 1.2)
    axes.set_ylim(-1.2, tall + 2.6)


def draw_lattice(axes):
    h = np.sqrt(3) / 2
    sites = np.array([(i + 0.5 * (j % 2), j * h) for j in range(-3, 4) for i in range(-3, 4)])
    sites = sites[(abs(sites[:, 0]) < 2.6) & (abs(sites[:, 1]) < 2.3)]
    for p in sites:
        for q in sites:
            if 0 < np.hypot(*(p - q)) < 1.01:
                axes.plot(*zip(p, q), color=GREY, lw=0.6, zorder=1)
    for p in sites:
        distance = np.hypot(*p)
        for length, color in ((1., BLUE), (np.sqrt(3), RED)):
            if abs(distance - length) < 1e-6:
                axes.plot([0, p[0]], [0, p[1]], color=color, lw=2.2, zorder=2)
    axes.plot(*sites.T, "o", color=DARK, ms=5, zorder=3)
    axes.plot(0, 0, "o", color="white", mec=DARK, ms=8, zorder=4)
    dimension(axes, (-2, -2 * h - 0.33), (-1, -2 * h - 0.33), "$d$", (0, -0.24))
    axes.text(2.75, 0.85, "nearest neighbours, NN\n6 bonds of length $d$", color=BLUE, fontsize=11, va="center")
    axes.text(2.75, -0.15, "next-nearest, NNN\n6 bonds of length $\\sqrt{3}\\,d$", color=RED, fontsize=11, va="center")
    axes.text(2.75, -1.15, "mass of a site\n$\\rho\\,(\\sqrt{3}/2)\\,d^2$ per thickness $h$", fontsize=11, va="center")
    axes.set_xlim(-2.7, 6.2)
    axes.set_ylim(-2.4, 2.05)


def draw_bond(axes):
    a, b, breaking = 0.1, 0.15, 3.05  # MPa; those of Fig. 1

    def stress(s):
        return a * (s - s**-2) + b * (1 - s**-3)

    stretch = np.linspace(0.88, breaking, 200)
    axes.plot(stretch, stress(stretch), color=BLUE, lw=2)
    tougher = np.linspace(breaking, 4.2, 80)
    axes.plot(tougher, stress(tougher), color=BLUE, lw=2, ls=":")
    axes.plot([breaking, breaking], [0, stress(breaking)], color=RED, lw=1.6)
    axes.plot(breaking, stress(breaking), "o", color=RED, ms=6)
    axes.text(breaking, -0.055, "$\\lambda_f$", color=RED, ha="center", fontsize=13)
    axes.text(1, -0.055, "1", ha="center", fontsize=11)
    axes.text(3.2, 0.16, "behind the tip\n$\\lambda_f$ is raised", fontsize=10, color=DARK)
    axes.axhline(0, color=DARK, lw=0.8)
    axes.text(4.35, -0.055, "stretch $\\lambda$", ha="right", fontsize=11)
    axes.text(0.74, 0.475, "stress of a bond, $\\psi'(\\lambda)$:\nMooney-Rivlin, $a$ and $b$", fontsize=11, va="top", color=BLUE)
    # Spring and dashpot in parallel, between two sites.
    left, right, y, dy = 1.3, 2.78, -0.25, 0.05
    for x in (left, right):
        axes.plot([x, x], [y - dy, y + dy], color=DARK, lw=1.2)
        end = x - 0.25 if x == left else x + 0.25
        axes.plot([x, end], [y, y], color=DARK, lw=1.2)
        axes.plot(end, y, "o", color=DARK, ms=6)
    zigzag = np.linspace(left + 0.3, right - 0.3, 13)
    axes.plot([left, *zigzag, right], [y + dy, *(y + dy + 0.025 * np.array([0, *[1, -1] * 5, 1, 0])), y + dy], color=BLUE, lw=1.3)
    middle = (left + right) / 2
    axes.plot([left, middle - 0.05], [y - dy, y - dy], color=DARK, lw=1.2)
    axes.plot([middle - 0.05] * 2, [y - dy - 0.022, y - dy + 0.022], color=DARK, lw=1.6)
    axes.plot([middle - 0.2, middle + 0.15, middle + 0.15, middle - 0.2], y - dy + np.array([0.03, 0.03, -0.03, -0.03]), color=DARK, lw=1.2)
    axes.plot([middle + 0.15, right], [y - dy, y - dy], color=DARK, lw=1.2)
    axes.text(right + 0.45, y + dy, "$\\psi$: spring", fontsize=11, va="center", color=BLUE)
    axes.text(right + 0.45, y - dy, "$\\eta$: dashpot", fontsize=11, va="center")
    axes.set_xlim(0.65, 4.5)
    axes.set_ylim(-0.36, 0.5)


def main(folder):
    plt.rcParams["font.family"] = "DejaVu Sans"
    figure = plt.figure(figsize=(10.5, 7.))
    for box, draw, equal in (((0.005, 0.48, 0.99, 0.52), draw_sheets, True), ((0.0, 0.0, 0.56, 0.47), draw_lattice, True),
                             ((0.56, 0.0, 0.43, 0.47), draw_bond, False)):
        axes = figure.add_axes(box)
        draw(axes)
        axes.axis("off")
        if equal:
            axes.set_aspect("equal")
    figure.savefig(folder / "model.png", dpi=100, metadata={"Software": None})


if __name__ == "__main__":
    main(pathlib.Path(sys.argv[1]) if len(sys.argv) > 1 else pathlib.Path(__file__).resolve().parent)
