"""Table and plot of the claim on damage."""
import numpy as np

from latcon.report.claim_tables import Plot, groups, largest_text, sorted_by
from latcon.report.panels import Grid, colours_of, entry

LAWS = {"local": "local law", "gradient": "with gradient energy"}

TABLES = {
    "damaged_bar": ({"shells": None, "law": tuple(LAWS)}, ("h/xi", "X/xi", "damage", "theory")),
}


def draw_damaged_bar(tables):
    """Damage along broken bars, on several meshes, and the closed form."""
    table = tables["damaged_bar"]
    colours, meshes = colours_of(table["h/xi"][np.isfinite(table["h/xi"])], "h / ξ =")
    shells = [name for (name,), _ in groups(table, "shells")]
    grid = Grid(shells, len(LAWS), [entry("closed form", "--"), entry("finite elements", "", marker="o"), *meshes])
    metrics = []
    for row, name in enumerate(shells):
        for column, (law, title) in enumerate(LAWS.items()):
            axes = grid.axes(row, column, title=title, xlabel="X from the crack [ξ]",
                             ylabel="damage [1]" if column == 0 else "")
            own = (table["shells"] == name) & (table["law"] == law) & np.isfinite(table["h/xi"])
            for (size,), part in groups({key: values[own] for key, values in table.items()}, "h/xi"):
                part = sorted_by(part, "X/xi")
                axes.plot(part["X/xi"], part["theory"], "--", color=colours[size])
                axes.plot(part["X/xi"], part["damage"], "o", color=colours[size], markersize=4, markerfacecolor="none")
                metrics.append(f"{name}, {title}, h = {size:.4g} ξ: damage off the closed form by "
                               f"{largest_text(part['damage'] - part['theory'])}")
    return grid, metrics


PLOTS = (
    Plot("damaged_bar", draw_damaged_bar,
         "A broken bar is damaged to a distance of 2 ξ from the crack, d = (1 − |X|/2ξ)², whatever its law.",
         "Damage at the nodes along broken bars. Dashed: closed form beside a column of elements that is open; "
         "circles: finite elements."),
)
