"""Plots of waves: speeds, attenuation, energies. Each draws into a PNG file and returns its error metrics in words."""
import numpy as np

from claim_tables import fitted_order, groups, largest, largest_text, range_text, sorted_by, states
from panels import (LAW_COLOURS, MARKERS, WAVES, Grid, colours_of, entry, headroom, logarithmic, logarithmic_along_x,
                    note)
from pictures import BLACK, BLUE, GREY, save


def draw_wave_speeds(tables, path):
    """Phase velocities of both waves, less that of long ones, and what the continua's are off the exact ones."""
    table = tables["wave_speeds"]
    colours, angles = colours_of(table["angle [deg]"], "waves along", "°")
    laws = [law for law in ("local", "isotropic", "gradient") if np.isfinite(table[f"{law} [m/s]"]).any()]
    legend = [entry("lattice, exact", "--"), entry("gradient continuum", ":"),
              entry("lattice, run in time", "", marker="o"), entry("finite elements", "-", marker="x")] + angles
    rows = states(table)
    grid = Grid([name for name, _ in rows], 3, legend)
    metrics = []
    for number, (name, state) in enumerate(rows):
        for column, wave in enumerate(WAVES):
            axes = grid.axes(number, column, title=f"{WAVES[wave]} waves", xlabel="k d [1]")
            if column == 0:
                axes.set_ylabel("phase velocity off\nthat of long waves [%]")
            for (_, angle), part in groups(state, "wave", "angle [deg]"):
                if part["wave"][0] == wave:
                    draw_speeds(axes, sorted_by(part, "k d"), colours[angle])
        axes = grid.axes(number, 2, title="off the lattice's, relative [1]", xlabel="k d [1]")
        orders = draw_speed_errors(axes, state, laws)
        headroom(axes, 2.2)
        note(axes, [(f"{law}{f': order {orders[law]}' if orders[law] else ''}", LAW_COLOURS[law]) for law in laws])
        metrics.append(f"{name}: " + "; ".join(filter(None, (
            off("a run of the lattice", state["lattice [m/s]"], state["bloch [m/s]"], "the exact dispersion"),
            off("finite elements", state["fem [m/s]"], state["gradient [m/s]"], "the gradient continuum"),
            *(f"order of the {law} continuum {orders[law]}" for law in laws if orders[law])))))
    save(grid.page.figure, path)
    return metrics


def draw_speeds(axes, part, colour):
    """One wave along one direction, relative to its speed when it is long, in percent."""
    k = part["k d"]
    bloch, gradient, fem, lattice = (100 * (part[f"{side} [m/s]"] / part["local [m/s]"] - 1)
                                     for side in ("bloch", "gradient", "fem", "lattice"))
    axes.plot(k, bloch, "--", color=colour)
    axes.plot(k, gradient, ":", color=colour)
    done = np.isfinite(fem)
    axes.plot(k[done], fem[done], "-x", color=colour, linewidth=1, markersize=5)
    axes.plot(k, lattice, "o", color=colour, markerfacecolor="none", markersize=6)


def draw_speed_errors(axes, state, laws):
    """Errors of the continua against the exact dispersion. @return {law: orders in words, None for none}"""
    orders = {}
    for law in laws:
        found = []
        for (wave, _), part in groups(state, "wave", "angle [deg]"):
            part = sorted_by(part, "k d")
            error = np.abs(part[f"{law} [m/s]"] / part["bloch [m/s]"] - 1)
            axes.plot(part["k d"], np.where(error > 0, error, np.nan), "-", marker=MARKERS[wave], markersize=3,
                      color=LAW_COLOURS[law], linewidth=0.8)
            found.append(fitted_order(part["k d"], error, share=0.5))
        orders[law] = range_text(found)
    logarithmic(axes)
    return orders


def off(what, values, reference, of):
    """The largest relative difference in words."""
    return f"{what} off {of} by {largest_text(values / reference - 1)}"


def draw_attenuation(tables, path):
    """Decay rate and frequency of damped waves against k d, and what is off the theory."""
    table = tables["attenuation"]
    sides = {"lattice": "o", "continuum": "+", "fem": "x"}
    words = {"lattice": "lattice, run in time", "continuum": "continuum", "fem": "finite elements"}
    legend = [entry("theory", "--"), *(entry(words[side], "", marker=marker) for side, marker in sides.items())]
    rows = [(f"{name}, {WAVES[wave]} waves", part) for name, state in states(table)
            for (wave,), part in groups(state, "wave")]
    grid = Grid([name for name, _ in rows], 3, legend)
    metrics = []
    for number, (name, state) in enumerate(rows):
        panels = [grid.axes(number, column, title=title, xlabel="k d [1]") for column, title in enumerate(
            ("decay rate [1/s]", "frequency [10³ rad/s]", "off the theory, relative [1]"))]
        for _, part in groups(state, "angle [deg]"):
            part = sorted_by(part, "k d")
            for axes, what, scale in zip(panels, ("decay [1/s]", "frequency [rad/s]"), (1, 1e-3)):
                axes.plot(part["k d"], scale * part[f"theory_{what}"], "--", color=BLUE)
                for side, marker in sides.items():
                    axes.plot(part["k d"], scale * part[f"{side}_{what}"], marker, color=BLUE, markersize=6,
                              markerfacecolor="none")
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
    save(grid.page.figure, path)
    return metrics


def rate_error(part, side):
    """Distance of frequency and decay from the theory's over the latter's size: defined also where one of them is 0."""
    frequency, decay = "frequency [rad/s]", "decay [1/s]"
    distance = np.hypot(part[f"{side}_{frequency}"] - part[f"theory_{frequency}"],
                        part[f"{side}_{decay}"] - part[f"theory_{decay}"])
    return distance / np.hypot(part[f"theory_{frequency}"], part[f"theory_{decay}"])


def draw_travelling_waves(tables, path):
    """Mean energies in a travelling wave over the theory's, and the finite elements' against the lattice's."""
    table = tables["travelling_waves"]
    colours, angles = colours_of(table["angle [deg]"], "waves along", "°")
    legend = [entry("theory", "--"), entry("lattice", "", marker="o"), entry("finite elements", "-", marker="x"),
              entry("longitudinal", "", GREY, marker=MARKERS["L"]), entry("shear", "", GREY, marker=MARKERS["S"])]
    rows = states(table)
    grid = Grid([name for name, _ in rows], 3, legend + angles, per_line=5)
    metrics = []
    for number, (name, state) in enumerate(rows):
        titles = ("elastic energy / theory [1]", "kinetic energy / theory [1]", "elements off lattice, relative [1]")
        elastic, kinetic, error = (grid.axes(number, column, title=title, xlabel="k d [1]")
                                   for column, title in enumerate(titles))
        for (wave, angle), part in groups(state, "wave", "angle [deg]"):
            part = sorted_by(part, "k d")
            k, colour, theory = part["k d"], colours[angle], part["theory [J/m^3]"]
            for axes, lattice, fem in ((elastic, *elastic_energies(part)), (kinetic, *kinetic_energies(part))):
                axes.plot(k, lattice / theory, MARKERS[wave], color=colour, markerfacecolor="none", markersize=6)
                axes.plot(k, fem / theory, "-x", color=colour, linewidth=1, markersize=5)
                difference = np.abs(fem / lattice - 1)
                error.plot(k, np.where(difference > 0, difference, np.nan), "-" if axes is elastic else ":",
                           marker=MARKERS[wave], color=colour, markersize=4, linewidth=1)
        for axes in (elastic, kinetic):
            axes.axhline(1, linestyle="--", color=BLACK, linewidth=1.2)
        logarithmic(error)
        headroom(error, 1.2)
        note(error, [("solid: elastic, dotted: kinetic", BLACK)])
        parts = (("elastic", elastic_energies(state)), ("kinetic", kinetic_energies(state)))
        metrics.append(f"{name}: " + "; ".join(filter(None, (
            off(f"{what} energy of the finite elements", fem, lattice, "the lattice's")
            for what, (lattice, fem) in parts))))
    save(grid.page.figure, path)
    return metrics


def elastic_energies(part):
    """Mean elastic energy density of lattice and finite elements [J/m^3]."""
    return part["lattice_elastic [J/m^3]"], part["fem_elastic [J/m^3]"]


def kinetic_energies(part):
    """Mean kinetic energy density of lattice and finite elements [J/m^3], micro-inertia included."""
    return part["lattice_kinetic [J/m^3]"], part["fem_kinetic [J/m^3]"] + part["fem_micro_inertia [J/m^3]"]
