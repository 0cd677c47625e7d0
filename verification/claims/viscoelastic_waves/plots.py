"""Plots of the claim on waves in lattices with Maxwell branches."""
from latcon.report.claim_tables import Plot, groups, largest_text, sorted_by, states
from latcon.report.panels import WAVES, Grid, curve, entry, logarithmic_along_x
from latcon.report.pictures import BLUE, GREY, RED

WORDS = {"part": ("one branch", "own branches")}


def swept(table):
    """The waves with one branch: {name of the state and the wave: rows}."""
    return {f"{name}, {WAVES[wave]} waves": sorted_by(part, "w tau") for name, state in states(table)
            for (kind, wave), part in groups(state, "part", "wave") if kind == "one branch"}


def draw_waves(tables):
    """Frequency and decay of waves against the relaxation time of one branch."""
    waves = swept(tables["viscoelastic_waves"])
    elements = swept(tables["viscoelastic_elements"]) if "viscoelastic_elements" in tables else {}
    legend = [entry("complex modulus", "--"), entry("lattice, run in time", "", marker="o"),
              entry("finite elements, run in time", "", RED, marker="x"), entry("rubbery and glassy limits", ":", GREY)]
    grid = Grid(waves, 2, legend)
    metrics = []
    titles = ("frequency over that of the rubbery limit [1]", "decay rate over that frequency [1]")
    for name, part, panels in grid.each(waves.items(), titles, "ω τ [1]"):
        sides = ((part, "theory", "--", BLUE), (part, "lattice", "o", BLUE), (elements.get(name), "fem", "x", RED))
        for rows, run, style, colour in sides:
            for axes, quantity in zip(panels, ("frequency [rad/s]", "decay [1/s]")):
                if rows is not None:
                    curve(axes, rows["w tau"], rows[f"{run}_{quantity}"] / rows["rubbery [rad/s]"], style, colour)
        unit = part["rubbery [rad/s]"]
        for limit in ("rubbery [rad/s]", "glassy [rad/s]"):
            panels[0].plot(part["w tau"], part[limit] / unit, ":", color=GREY)
        for axes in panels:
            logarithmic_along_x(axes)
        panels[1].set_ylim(bottom=0)
        error = (part["lattice_frequency [rad/s]"] - part["theory_frequency [rad/s]"]) / unit
        metrics.append(f"{name}: frequency of a run off the complex modulus by {largest_text(error)} of the rubbery one")
    return grid, metrics


PLOTS = (
    Plot("viscoelastic_waves", draw_waves,
         "Waves are as fast as in the rubbery limit for short relaxation times, as fast as in the glassy limit for long "
         "ones, and decay fastest between them, as predicted by the complex modulus of the lattice.",
         "Frequency and decay rate of free waves at one wavelength against the relaxation time τ of one Maxwell branch "
         "per bond, ω being the frequency of the wave without the branch. Dashed: complex modulus of the lattice; circles: "
         "measured in a run of the lattice; crosses: in finite elements of its gradient continuum; dotted: frequencies "
         "without and with the stiffness of the branch.",
         others=("viscoelastic_elements",)),
)
