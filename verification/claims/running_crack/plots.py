"""Plot of the claim on a running crack."""
import numpy as np
from matplotlib.colors import TwoSlopeNorm

from latcon.report.claim_tables import Plot, groups
from latcon.report.panels import Grid, entry
from latcon.report.pictures import BLACK

SIDES = {"lattice": "lattice", "local": "local continuum", "local-flank": "with cut flank",
         "gradient": "with gradients", "viscous-gradient": "and their viscosity"}

CONTINUA = ("local", "gradient", "viscous-gradient", "local-flank", "gradient-flank")
WORDS = {"side": ("lattice", *CONTINUA, *(f"bonds-{name}" for name in CONTINUA))}


def draw_running_crack(tables):
    """Velocity along the crack and opening stress around the tip: lattice and network continua."""
    table = tables["running_crack"]
    shells = [name for (name,), _ in groups(table, "shells")]
    quantities = (("v_x [m/s]", "velocity along the crack [m/s]"), ("opening_stress [Pa]", "opening stress [MPa]"))
    names = [f"{name}: {title}" for name in shells for _, title in quantities]
    grid = Grid(names, len(SIDES) + 1, [entry("tip", "", BLACK, "+")], gap=0.5)  # the last one for bars of colours
    metrics = []
    for number, (name, (column, _)) in enumerate((name, quantity) for name in shells for quantity in quantities):
        part = table.where(table["shells"] == name)
        unit = 1e-6 if "Pa" in column else 1.0
        shown = part[column] * unit
        known = shown[np.isfinite(shown)]
        low, high = np.percentile(known, (0.5, 99.5)) if len(known) else (0.0, 1.0)
        low, high = min(low, -1e-3 * abs(high) - 1e-9), max(high, 1e-3 * abs(low) + 1e-9)
        for place, (side, title) in enumerate(SIDES.items()):
            axes = grid.axes(number, place, title=title, xlabel="X from the tip [d]",
                             ylabel="Y [d]" if place == 0 else "", aspect="equal")
            axes.grid(False)
            own = part["side"] == side
            if not own.any():
                axes.set(xlim=(-1, 1), ylim=(-1, 1), xticks=[], yticks=[])
                axes.text(0, 0, "not computed", ha="center", va="center")
                continue
            x, y, values = field(part["X/d"][own], part["Y/d"][own], shown[own])
            mesh = axes.pcolormesh(x, y, values, cmap="RdBu_r", norm=TwoSlopeNorm(0.0, low, high), shading="nearest",
                                   rasterized=True)
            axes.plot(0, 0, "+", color=BLACK, markersize=9)
        place = grid.axes(number, len(SIDES))
        place.axis("off")
        bar = grid.page.figure.colorbar(mesh, cax=place.inset_axes([0.0, 0.1, 0.08, 0.8]))
        bar.outline.set_visible(False)
    for name in shells:
        deepest = []
        for side, title in SIDES.items():
            own = (table["shells"] == name) & (table["side"] == side) & (table["X/d"] > 0)
            if own.any():
                deepest.append(f"{title} {np.min(table['v_x [m/s]'][own]):.2f}")
        metrics.append(f"{name}: most negative velocity ahead of the tip [m/s]: {', '.join(deepest)}")
    return grid, metrics


def field(X, Y, values):
    """Values on the grid of their points, mirrored below the crack: (x, y, values), masked where there is none."""
    x, column = np.unique(np.round(X, 6), return_inverse=True)
    y, row = np.unique(np.round(Y, 6), return_inverse=True)
    upper = np.full((len(y), len(x)), np.nan)
    upper[row, column] = values
    return x, np.concatenate((-y[::-1], y)), np.ma.masked_invalid(np.concatenate((upper[::-1], upper)))


PLOTS = (
    Plot("running_crack", draw_running_crack,
         "The pictures show the fields near the tip in the lattice and in the network continua: local, without "
         "the bonds that the crack has cut, with gradient energy, and with gradient viscosity as well.",
         "Fields around the tip of a driven crack in the reference configuration, mean of four samples: lattice, network "
         "continuum, the same without the bonds and dashpots that the crack has cut, and with gradient energy and "
         "micro-inertia, without and with gradient viscosity, with one scale of colours for each row. Blue ahead of the "
         "tip: material that moves against the crack.", few_colours=False),
)
