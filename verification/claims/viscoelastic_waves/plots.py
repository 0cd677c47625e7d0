"""Plots of the claim on waves in lattices with Maxwell branches."""
from functools import partial

from latcon.report.claim_tables import Plot, groups, largest_text, sorted_by, states
from latcon.report.panels import WAVES, Grid, curve, entry, logarithmic_along_x
from latcon.report.pictures import BLUE, GREY

WORDS = {"part": ("one branch", "own branches")}


def draw_waves(tables, name, theory, run, run_name):
    """Frequency and decay of waves against the relaxation time of one branch."""
    rows = [(f"{name}, {WAVES[wave]} waves", part) for name, state in states(tables[name])
            for (kind, wave), part in groups(state, "part", "wave") if kind == "one branch"]
    legend = [entry("complex modulus", "--"), entry(f"{run_name}, run in time", "", marker="o"),
              entry("rubbery and glassy limits", ":", GREY)]
    grid = Grid([name for name, _ in rows], 2, legend)
    metrics = []
    titles = ("frequency over that of the rubbery limit [1]", "decay rate over that frequency [1]")
    for name, part, panels in grid.each(rows, titles, "ω τ [1]"):
        part = sorted_by(part, "w tau")
        unit = part["rubbery [rad/s]"]
        for axes, quantity in zip(panels, ("frequency [rad/s]", "decay [1/s]")):
            curve(axes, part["w tau"], part[f"{theory}_{quantity}"] / unit, "--", BLUE)
            curve(axes, part["w tau"], part[f"{run}_{quantity}"] / unit, "o", BLUE)
        for limit in ("rubbery [rad/s]", "glassy [rad/s]"):
            panels[0].plot(part["w tau"], part[limit] / unit, ":", color=GREY)
        for axes in panels:
            logarithmic_along_x(axes)
        panels[1].set_ylim(bottom=0)
        error = (part[f"{run}_frequency [rad/s]"] - part[f"{theory}_frequency [rad/s]"]) / unit
        metrics.append(f"{name}: frequency of a run off the complex modulus by {largest_text(error)} of the rubbery one")
    return grid, metrics


PLOTS = (
    Plot("viscoelastic_waves",
         partial(draw_waves, name="viscoelastic_waves", theory="theory", run="lattice", run_name="lattice"),
         "Waves are as fast as in the rubbery limit for short relaxation times, as fast as in the glassy limit for long "
         "ones, and decay fastest between them, as predicted by the complex modulus of the lattice.",
         "Frequency and decay rate of free waves at one wavelength against the relaxation time τ of one Maxwell branch "
         "per bond, ω being the frequency of the wave without the branch. Dashed: complex modulus; circles: measured in a "
         "run of the lattice; dotted: frequencies without and with the stiffness of the branch."),
    Plot("viscoelastic_elements",
         partial(draw_waves, name="viscoelastic_elements", theory="continuum", run="fem", run_name="finite elements"),
         "Waves in finite elements with the same branches have the frequencies and decay rates that the complex modulus "
         "of the continuum predicts.",
         "As above, for finite elements with Maxwell branches along the bonds, and the complex modulus of the continuum."),
)
