"""Plots of the checks of a study."""
import numpy as np

from files import read_table
from pictures import BLUE, RED, WIDTH, Page, save

COLOURS = (BLUE, RED)


def draw_steady_crack(folder, path):
    """Draws measured and exact speeds of steady cracks over the driving. @return whether the tables exist"""
    points = read_table(folder / "steady_crack.csv", ("beta", "driving", "breaking elongation", "lattice speed",
                                                      "exact speed"))
    if points is None or not len(points["beta"]):
        return False
    curve = read_table(folder / "steady_crack_curve.csv", ("beta", "speed", "driving"), ("exists",))
    page = Page(4.1)
    axes = page.axes(0.85, 0.2, WIDTH - 1.1, 3.2)
    driving = points["driving"] / points["breaking elongation"]  # with the elongation at which bonds broke, a time step late
    for colour, beta in zip(COLOURS, np.unique(points["beta"])):
        of_series = points["beta"] == beta
        axes.plot(driving[of_series], points["exact speed"][of_series], "o", markersize=11, markerfacecolor="none",
                  color=colour, label=f"exact, β = {beta:g}")
        axes.plot(driving[of_series], points["lattice speed"][of_series], "x", markersize=7, color=colour,
                  label=f"simulator, β = {beta:g}")
        if curve is None:
            continue
        x, y, exists = (curve[name][curve["beta"] == beta] for name in ("driving", "speed", "exists"))
        axes.plot(x, y, ":", color=colour, linewidth=1.2)
        axes.plot(np.where(exists == "yes", x, np.nan), y, "-", color=colour, linewidth=1.2)
    axes.set(xlim=(1.0, 1.1 * driving.max()), ylim=(0, None), xlabel="driving Δ/Δ_G", ylabel="crack speed v/c_S")
    axes.legend(loc="lower right")
    save(page.figure, path)
    return True


# By name of the check: the function that draws its plot from the folder of the study, and the caption.
PLOTS = {
    "steady-crack": (draw_steady_crack,
                     "Speed of a steady crack over the shear wave speed, against the driving over Griffith's "
                     "threshold, for a low and a high viscosity β. Circles: exact solution for the elongation at which the "
                     "simulator's bonds broke; crosses: simulator. Lines (full study only): exact solution, dotted where "
                     "other bonds would break too, or bonds of the crack too early."),
}
