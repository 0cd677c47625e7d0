#!/usr/bin/env pvpython
"""Shows the output of `latcon compare`: the lattice, the continuum, and their difference at the sites.

Usage: pvpython side_by_side.py DIR [--field NAME] [--component C] [--undeformed] [--screenshot FILE.png]
DIR contains difference.pvd of `latcon compare`. The first two views share a colour scale, and all three share a camera.
Without --screenshot a window opens.
"""
import sys

sys.dont_write_bytecode = True  # no files are added to this folder

from looks import (TENSOR, VECTOR, View, array, beside, finish, parser_of, require, set_scale, size_for, symmetric,
                   value_range)

# Fields that the lattice computes from the bonds of a site: coloured at sites with all their bonds, grey elsewhere.
FROM_BONDS = ("deformation_gradient", "first_piola_stress", "cauchy_stress", "strain_energy_density")
FIELDS = {"displacement": (VECTOR, "m"), "velocity": (VECTOR, "m/s"), "deformation_gradient": (TENSOR, "1"),
          "first_piola_stress": (TENSOR, "Pa"), "cauchy_stress": (TENSOR, "Pa"), "strain_energy_density": ({}, "J/m^3")}
OUTSIDE = [0.75, 0.75, 0.75]  # sites outside the continuum, and those whose field is not shown
VIEW_WIDTH = 640  # [pixels]
FILES = ("difference_sites.vtp", "difference_continuum.vtu")


def arguments():
    parser = parser_of(__doc__, "output directory of latcon compare")
    parser.add_argument("--field", default="displacement", choices=FIELDS)
    parser.add_argument("--component", metavar="C", help="x, y of a vector, xx ... yy of a tensor; default: magnitude")
    parser.add_argument("--undeformed", action="store_true", help="do not warp by the displacement")
    chosen = parser.parse_args()
    components = FIELDS[chosen.field][0]
    if chosen.component is not None and chosen.component not in components:
        parser.error(f"{chosen.field} has no component {chosen.component!r}: " +
                     (", ".join(components) if components else "it is a scalar"))
    require(parser, chosen.directory, FILES, "latcon compare")
    return chosen


def as_lattice(display):
    """Draws sites as points and bonds as lines."""
    display.SetRepresentationType("Surface")
    display.LineWidth = 2.5
    display.PointSize = 4.0


def draw(chosen):
    """The layout of the three views, and its size [pixels]."""
    components, unit = FIELDS[chosen.field]
    component = components.get(chosen.component)
    difference = f"{chosen.field}_difference"
    shown = f"{chosen.field}{f' {chosen.component}' if chosen.component else ''} [{unit}]"
    size_of = "" if chosen.component or not components else "size of "

    sites = pv.XMLPolyDataReader(FileName=[str(chosen.directory / FILES[0])])
    cells = pv.XMLUnstructuredGridReader(FileName=[str(chosen.directory / FILES[1])])
    for source in (sites, cells):
        source.TimeArray = "None"
        source.UpdatePipeline()
        array(source, chosen.field)
    all_sites, grey = sites, ""
    if chosen.field in FROM_BONDS:
        sites = pv.Threshold(Input=sites, Scalars=["POINTS", "complete"], LowerThreshold=1.0, UpperThreshold=1.0)
        sites.UpdatePipeline()
        grey = " (grey: sites that lack bonds)"
    # Extremes of the continuum between the sites, for instance in a corner, do not determine the scale.
    ranges = [value_range(sites, name, component) for name in (chosen.field, f"{chosen.field}_continuum")]
    off = value_range(sites, difference, component)
    if not chosen.undeformed:
        all_sites, sites, cells = (pv.WarpByVector(Input=source, Vectors=["POINTS", "displacement"])
                                   for source in (all_sites, sites, cells))
    left, middle, right = (View(pv, title) for title in (f"lattice{grey}", "continuum", f"lattice less continuum{grey}"))
    for view in (left, right) if grey else ():
        as_lattice(view.show(all_sites, colour=OUTSIDE)[0])
    lattice, lut = left.show(sites, chosen.field)
    continuum, _ = middle.show(cells, chosen.field)
    differs, off_lut = right.show(sites, difference)

    set_scale(lut, (min(r[0] for r in ranges), max(r[1] for r in ranges)), "Viridis (matplotlib)", component)
    if size_of:
        set_scale(off_lut, (0.0, off[1]), "Inferno (matplotlib)")
    else:
        set_scale(off_lut, symmetric(off), "Cool to Warm", component)
    lut.NanColor = off_lut.NanColor = OUTSIDE
    for display in (lattice, differs):
        as_lattice(display)
    continuum.NonlinearSubdivisionLevel = 3
    left.show_bar(lattice, lut, size_of + shown)
    middle.show_bar(continuum, lut, size_of + shown)
    right.show_bar(differs, off_lut, f"{size_of}difference of {shown}")

    bounds = cells.GetDataInformation().GetBounds()[:4]
    size = size_for(bounds, VIEW_WIDTH)
    for view in (left, middle, right):
        view.look_at(bounds, size)
    pv.AddCameraLink(left.view, middle.view, "lattice and continuum")
    pv.AddCameraLink(middle.view, right.view, "continuum and difference")
    return beside(pv, (left, middle, right), size, "lattice, continuum, difference")


if __name__ == "__main__":
    CHOSEN = arguments()
    import paraview.simple as pv  # after parsing the arguments, which does not need ParaView

    pv._DisableFirstRenderCameraReset()
    finish(pv, *draw(CHOSEN), CHOSEN.screenshot)
