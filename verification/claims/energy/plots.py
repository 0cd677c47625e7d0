"""Plots of the claim on energy."""
import numpy as np

from latcon.report.claim_tables import Plot, groups, largest_text, off, sorted_by, states
from latcon.report.panels import MARKERS, Grid, colours_of, draw_waves, entry, headroom, logarithmic, note
from latcon.report.pictures import BLACK, GREY


def draw_sinusoidal_energy(tables):
    """Energy of a sheet displaced along a sinusoid over that of the local continuum, and differences from the lattice."""
    grid, drawn = draw_waves(
        tables["sinusoidal_energy"], ("longitudinal waves", "shear waves", "off the lattice's, relative [1]"),
        "energy / local [1]",
        [entry("lattice", "", marker="o"), entry("gradient energy", "--"), entry("filtered", ":"),
         entry("finite elements", "-", marker="x")],
        {"gradient": "--", "filtered": ":", "fem": "-x", "lattice": "o"}, lambda part, side: part[side],
        lambda state: {law: state[law] / state["lattice"] - 1 for law in ("local", "gradient", "filtered")})
    return grid, [f"{name}: " + "; ".join((
        *(f"order of the {law} energy {order}" for law, order in orders.items()),
        f"finite elements off the gradient energy by {largest_text(state['fem'] / state['gradient'] - 1)}"))
        for name, state, orders in drawn]


def draw_travelling_waves(tables):
    """Mean energies in a travelling wave over the theory's, and the finite elements' against the lattice's."""
    table = tables["travelling_waves"]
    colours, angles = colours_of(table["angle [deg]"], "waves along", "°")
    legend = [entry("theory", "--"), entry("lattice", "", marker="o"), entry("finite elements", "-", marker="x"),
              entry("longitudinal", "", GREY, marker=MARKERS["L"]), entry("shear", "", GREY, marker=MARKERS["S"])]
    rows = states(table)
    grid = Grid([name for name, _ in rows], 3, legend + angles, per_line=5)
    metrics = []
    titles = ("elastic energy / theory [1]", "kinetic energy / theory [1]", "elements off lattice, relative [1]")
    for name, state, (*panels, error) in grid.each(rows, titles, "k d [1]"):
        for (wave, angle), part in groups(state, "wave", "angle [deg]"):
            part = sorted_by(part, "k d")
            k, colour = part["k d"], colours[angle]
            for axes, (lattice, fem), style in zip(panels, energies(part).values(), ("-", ":")):
                axes.plot(k, lattice / part["theory [J/m^3]"], MARKERS[wave], color=colour, markerfacecolor="none",
                          markersize=6)
                axes.plot(k, fem / part["theory [J/m^3]"], "-x", color=colour, linewidth=1, markersize=5)
                difference = np.abs(fem / lattice - 1)
                error.plot(k, np.where(difference > 0, difference, np.nan), style, marker=MARKERS[wave], color=colour,
                           markersize=4, linewidth=1)
        for axes in panels:
            axes.axhline(1, linestyle="--", color=BLACK, linewidth=1.2)
        logarithmic(error)
        headroom(error, 1.2)
        note(error, [("solid: elastic, dotted: kinetic", BLACK)])
        metrics.append(f"{name}: " + "; ".join(
            off(f"{what} energy of the finite elements", fem, lattice, "the lattice's")
            for what, (lattice, fem) in energies(state).items()))
    return grid, metrics


def energies(part):
    """Mean energy densities of lattice and finite elements [J/m^3], micro-inertia included."""
    return {"elastic": (part["lattice_elastic [J/m^3]"], part["fem_elastic [J/m^3]"]),
            "kinetic": (part["lattice_kinetic [J/m^3]"],
                        part["fem_kinetic [J/m^3]"] + part["fem_micro_inertia [J/m^3]"])}


PLOTS = (
    Plot("sinusoidal_energy", draw_sinusoidal_energy,
         "Where the deformation varies along a sinusoid, the energies differ by a power of k d (k: wave number, d: "
         "spacing of the lattice).",
         "Energy of a sheet displaced along a sinusoid, over what the local continuum has for it, against k d. "
         "Dashed: with the lattice's gradient energy; dotted: that over 1 + l_d² k², for loads without their "
         "gradient; solid with crosses: finite elements with the gradient energy; circles: lattice. Right: "
         "relative difference from the lattice, triangles longitudinal, circles shear; the order is the slope over "
         "the half of the points with the smallest k d."),
    Plot("travelling_waves", draw_travelling_waves,
         "A travelling wave stores half of its energy as elastic and half as kinetic energy on both sides; with "
         "micro-inertia the finite elements have 1 + l_d² k² times the lattice's.",
         "Mean energies per undeformed volume in a travelling wave, over that of the theory (dashed), against k d; "
         "the kinetic energy of the finite elements includes that of micro-inertia. Triangles longitudinal, "
         "circles shear waves of the lattice; solid with crosses: finite elements. Right: finite elements against "
         "the lattice."),
)
