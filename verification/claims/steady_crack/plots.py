"""Plot of the claim on steady cracks."""
import numpy as np

from latcon.report.claim_tables import Plot, groups, largest_text
from latcon.report.panels import Grid, colours_of, entry

WORDS = {"exists": ("yes", "no")}


def draw_steady_crack(tables):
    """Measured and exact speeds of steady cracks over the driving."""
    points, curve = tables["steady_crack"], tables.get("steady_crack_curve")
    colours, entries = colours_of(points["beta"], "β =")
    grid = Grid([""], 1, [entry("exact solution", "", marker="o"), entry("simulator", "", marker="x"), *entries])
    axes = grid.axes(0, 0, xlabel="driving Δ/Δ_G [1]", ylabel="crack speed v/c_S [1]")
    metrics = []
    for (beta,), part in groups(points, "beta"):
        # With the elongation at which bonds broke, up to a time step late.
        driving = part["driving"] / part["breaking elongation"]
        axes.plot(driving, part["exact speed"], "o", markersize=9, markerfacecolor="none", color=colours[beta], clip_on=False)
        axes.plot(driving, part["lattice speed"], "x", markersize=6, color=colours[beta], clip_on=False)
        metrics.append(f"β = {beta:g}: speed off the exact solution by "
                       f"{largest_text(part['lattice speed'] / part['exact speed'] - 1)}")
        if curve is not None and np.any(curve["beta"] == beta):
            x, y, exists = (curve[name][curve["beta"] == beta] for name in ("driving", "speed", "exists"))
            axes.plot(x, y, ":", color=colours[beta], linewidth=1.2)
            axes.plot(np.where(exists == "yes", x, np.nan), y, "-", color=colours[beta], linewidth=1.2)
    axes.set(xlim=(1.0, 1.1 * np.nanmax(points["driving"])), ylim=(0, None))
    return grid, metrics


PLOTS = (
    Plot("steady_crack", draw_steady_crack,
         "A steady crack of the simulator has the speed of the exact solution.",
         "Speed of a steady crack over the speed of shear waves, against the driving over Griffith's threshold, for a low "
         "and a high viscosity β. Lines (not in the quick version): exact solution, dotted where other bonds would break "
         "too, or bonds of the crack too early.", others=("steady_crack_curve",)),
)
