"""The path of a crack through the undeformed sheet: its best-fitting sinusoid, and its picture."""
import math

import numpy as np

from ..quantities import number_text
from .pictures import BLUE, COLOUR_MAP, GREY, RED, WIDTH, Page, save
from .runs import has_rows

LEFT, RIGHT, TOP = 1.0, 0.25, 0.45  # margins of the axes [in]


def measured_sinusoid(run):
    """Y(X) [m] of the measured sinusoid of an oscillating crack; None if there is none."""
    crack = run.crack
    names = ("sinusoid_offset", "sinusoid_slope", "amplitude", "wavelength", "sinusoid_phase")
    if crack is None or crack["pattern"] != "oscillating" or any(crack[name] is None for name in names):
        return None
    offset, slope, amplitude, wavelength, phase = (crack[name] for name in names)
    return lambda X: offset + slope * X + amplitude * np.sin(2 * np.pi * X / wavelength + phase)


def measured_window(run):
    """Both ends of the window of the measurement, X [m]; None if there is none."""
    window = [(run.crack or {}).get(f"window_{end}") for end in ("begin", "end")]
    return None if None in window else window


def draw_crack_path(run, path):
    """Draws the path of the tip with the measurement (above) and positions and times of broken bonds (below)."""
    X, Y = 100 * run.tip["X"], 100 * run.tip["Y"]
    broken = run.broken if has_rows(run.broken) else None
    length = run.input_number("Sheet/length")
    X_range = (0.0, 100 * length) if length else (X.min(), max(X.max(), X.min() + 0.1))
    width, upper = WIDTH - LEFT - RIGHT, 2.6
    scale = width / (X_range[1] - X_range[0])  # [in] of picture per cm of sheet

    # The largest integer exaggeration of Y for which the path fits.
    centre, half = (Y.min() + Y.max()) / 2, max(0.6 * (Y.max() - Y.min()), 1e-2 * (X_range[1] - X_range[0]))
    exaggeration = max(1, math.floor(upper / (2 * half * scale)))
    upper = max(upper, min(2 * half * scale, 8.0)) if exaggeration == 1 else upper
    half = upper / (2 * exaggeration * scale)

    lower, half_below = 0.0, 0.0
    if broken is not None:
        half_below = max(1.15 * 100 * np.abs(broken["Y"]).max(), 0.45 / scale)
        lower = min(2 * half_below * scale, 8.0)
    page = Page(TOP + upper + (0.7 + lower + 1.35 if broken is not None else 0.6))

    axes = page.axes(LEFT, TOP, width, upper)
    speed = None if run.crack is None else run.crack["speed_lagrangian"]
    axes.plot(X, Y, color=BLUE, label="tip" if speed is None else
              f"tip, {number_text(speed, run.crack['speed_lagrangian_uncertainty'])} m/s")
    window, curve = measured_window(run), measured_sinusoid(run)
    if window and window[1] > window[0]:
        axes.axvspan(100 * window[0], 100 * window[1], color=GREY, alpha=0.15, linewidth=0, label="measured window")
    if curve is not None:
        text = f"sinusoid, wavelength {in_cm(run.crack, 'wavelength')} cm"
        if run.crack["amplitude"] is not None:
            text += f", amplitude {in_cm(run.crack, 'amplitude')} cm"
        along = np.linspace(*window, 500)
        axes.plot(100 * along, 100 * curve(along), "--", color=RED, label=text)
    larger = f",\n{exaggeration} times the scale of X" if exaggeration > 1 else ""
    axes.set(xlim=X_range, ylim=(centre - half, centre + half), ylabel=f"Y of the tip [cm]{larger}")
    axes.legend(loc="lower left", bbox_to_anchor=(0, 1), ncol=3, borderaxespad=0.2, fontsize=9.5, columnspacing=1.5)
    if broken is None:
        axes.set_xlabel("X in the undeformed sheet [cm]")
    else:
        below = page.axes(LEFT, TOP + upper + 0.7, width, lower)
        dots = below.scatter(100 * broken["X"], 100 * broken["Y"], c=1e3 * broken["t"], cmap=COLOUR_MAP, s=5,
                             linewidths=0)
        below.set(xlim=X_range, ylim=(-half_below, half_below), aspect="equal", ylabel="Y [cm]",
                  xlabel="X in the undeformed sheet [cm]", title="midpoints of broken bonds, equal axes")
        page.colour_bar(dots, LEFT, page.height - 0.68, width, 0.13, "time of breaking [ms]")
    save(page.figure, path)


def in_cm(crack, name):
    """A measured length with its uncertainty [cm]."""
    return number_text(crack[name], crack[f"{name}_uncertainty"], scale=100)
