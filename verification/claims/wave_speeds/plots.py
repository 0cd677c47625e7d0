"""Plots of the claim on wave speeds."""
import numpy as np

from latcon.report.claim_tables import Plot, groups, largest, off, sorted_by, states
from latcon.report.panels import WAVES, Grid, curve, draw_waves, entry, logarithmic, logarithmic_along_x
from latcon.report.pictures import BLUE


def draw_wave_speeds(tables):
    """Phase velocities of both waves relative to that of long waves, and errors of the continua."""
    table = tables["wave_speeds"]
    laws = [law for law in ("local", "isotropic", "gradient") if np.isfinite(table[f"{law} [m/s]"]).any()]
    grid, drawn = draw_waves(
        table, (*(f"{word} waves" for word in WAVES.values()), "off the lattice's, relative [1]"),
        "phase velocity off\nthat of long waves [%]",
        [entry("lattice, exact", "--"), entry("gradient continuum", ":"),
         entry("lattice, run in time", "", marker="o"), entry("finite elements", "-", marker="x")],
        {"bloch": "--", "gradient": ":", "fem": "-x", "lattice": "o"},
        lambda part, side: 100 * (part[f"{side} [m/s]"] / part["local [m/s]"] - 1),
        lambda state: {law: state[f"{law} [m/s]"] / state["bloch [m/s]"] - 1 for law in laws})
    return grid, [f"{name}: " + "; ".join((
        off("a run of the lattice", state["lattice [m/s]"], state["bloch [m/s]"], "the exact dispersion"),
        off("finite elements", state["fem [m/s]"], state["gradient [m/s]"], "the gradient continuum"),
        *(f"order of the {law} continuum {order}" for law, order in orders.items()))) for name, state, orders in drawn]


def draw_attenuation(tables):
    """Decay rate and frequency of damped waves against k d, and differences from the theory."""
    table = tables["attenuation"]
    sides = {"lattice": "o", "continuum": "+", "fem": "x"}
    words = {"lattice": "lattice, run in time", "continuum": "continuum", "fem": "finite elements"}
    legend = [entry("theory", "--"), *(entry(words[side], "", marker=marker) for side, marker in sides.items())]
    rows = [(f"{name}, {WAVES[wave]} waves", part) for name, state in states(table)
            for (wave,), part in groups(state, "wave")]
    grid = Grid([name for name, _ in rows], 3, legend)
    metrics = []
    titles = ("decay rate [1/s]", "frequency [10³ rad/s]", "off the theory, relative [1]")
    for name, state, panels in grid.each(rows, titles, "k d [1]"):
        for _, part in groups(state, "angle [deg]"):
            part = sorted_by(part, "k d")
            for axes, what, scale in zip(panels, ("decay [1/s]", "frequency [rad/s]"), (1, 1e-3)):
                for side, style in {"theory": "--", **sides}.items():
                    curve(axes, part["k d"], scale * part[f"{side}_{what}"], style, BLUE)
            for side, marker in sides.items():
                error = rate_error(part, side)
                panels[2].plot(part["k d"], np.where(error > 0, error, np.nan), "-", marker=marker, markersize=5,
                               color=BLUE, linewidth=0.8, markerfacecolor="none")
        for axes in (panels[0], panels[2]):
            logarithmic(axes)
        logarithmic_along_x(panels[1])
        panels[1].set_ylim(bottom=0)
        worst = {side: largest(rate_error(state, side)) for side in sides}
        metrics.append(f"{name}: " + "; ".join(
            f"{words[side]}: not computed" if value is None else
            f"{words[side]} off the theory by up to {value:.1e} of |ω + iγ|" for side, value in worst.items()))
    return grid, metrics


def rate_error(part, side):
    """Distance of frequency and decay from the theory's over the latter's size: defined also where one of them is 0."""
    frequency, decay = "frequency [rad/s]", "decay [1/s]"
    distance = np.hypot(part[f"{side}_{frequency}"] - part[f"theory_{frequency}"],
                        part[f"{side}_{decay}"] - part[f"theory_{decay}"])
    return distance / np.hypot(part[f"theory_{frequency}"], part[f"theory_{decay}"])


PLOTS = (
    Plot("wave_speeds", draw_wave_speeds,
         "The local continuum has one speed for all wavelengths; with the lattice's gradient energy and "
         "micro-inertia the speed falls with shorter waves as it does in the lattice.",
         "Phase velocity, in percent off that of long waves, against k d, both per undeformed length. Dashed: exact "
         "dispersion of the lattice; dotted: closed formula of the gradient continuum; circles: measured in a run of "
         "the lattice; solid with crosses: finite elements. Right: relative difference from the exact dispersion, "
         "triangles longitudinal, circles shear; the order is the slope over the half of the points with the "
         "smallest k d."),
    Plot("attenuation", draw_attenuation,
         "Dashpots on the bonds and the viscosity of the continuum make waves decay at the same rate.",
         "Decay rate γ and frequency ω of damped waves against k d, a colour for each multiple of the dashpots' "
         "viscosity. Dashed: theory; circles: measured in a run of the lattice; plus signs: continuum; crosses: "
         "finite elements. Right: distance from the theory in the complex plane, |Δω + iΔγ| over |ω + iγ|."),
)
