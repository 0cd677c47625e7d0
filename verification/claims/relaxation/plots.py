"""Plots of the claim on relaxation."""
import numpy as np

from latcon.report.claim_tables import Plot, groups, largest_text, sorted_by
from latcon.report.panels import Grid, entry
from latcon.report.pictures import BLUE, GREEN, RED

WORDS = {"integrator": ("velocity Verlet", "Runge-Kutta-Chebyshev")}


def draw_relaxation(tables):
    """Overstress and energies of a held sheet against time."""
    rows = [(f"{shells}, {integrator}", sorted_by(part, "t [s]"))
            for (shells, integrator), part in groups(tables["relaxation"], "shells", "integrator")]
    legend = [entry("closed form", "--"), entry("lattice, run in time", "", marker="o"), entry("overstress", "-", BLUE),
              entry("stored", "-", GREEN), entry("dissipated", "-", RED)]
    grid = Grid([name for name, _ in rows], 2, legend, per_line=5)
    metrics = []
    titles = ("overstress over that at the start [1]", "energy over that at the start [1]")
    for name, part, panels in grid.each(rows, titles, "time [ms]"):
        worst = []
        for axes, quantity, first, colour in ((panels[0], "overstress [Pa]", "overstress [Pa]", BLUE),
                                              (panels[1], "stored [J/m]", "stored [J/m]", GREEN),
                                              (panels[1], "dissipated [J/m]", "stored [J/m]", RED)):
            unit = part[f"theory_{first}"][0]
            axes.plot(1e3 * part["t [s]"], part[f"theory_{quantity}"] / unit, "--", color=colour)
            axes.plot(1e3 * part["t [s]"], part[f"lattice_{quantity}"] / unit, "o", color=colour,
                      markerfacecolor="none", markersize=5)
            worst.append((part[f"lattice_{quantity}"] - part[f"theory_{quantity}"]) / unit)
        for axes in panels:
            axes.set_ylim(bottom=0)
        metrics.append(f"{name}: off the closed form by {largest_text(np.concatenate(worst))} of the value at the start")
    return grid, metrics


PLOTS = (
    Plot("relaxation", draw_relaxation,
         "Stress and energies of a sheet that is strained suddenly and then held are sums of exponentials.",
         "Overstress, energy stored in all branches and energy that they dissipated, over the overstress and the energy at "
         "the start. Dashed: closed form, circles: run of the lattice."),
)
