#!/usr/bin/env pvpython
"""Shows what `latcon compare` wrote: the lattice, the continuum, and their difference at the sites.

Usage: pvpython side_by_side.py DIR [--field NAME] [--component C] [--undeformed] [--screenshot FILE.png]
DIR holds the difference.pvd of `latcon compare`. The first two views have one colour scale, and all three one camera.
Without --screenshot a window opens.
"""
import argparse
import pathlib
import sys

# Where a field's components are in the files, and its unit.
VECTOR, TENSOR = {"x": 0, "y": 1}, {"xx": 0, "xy": 1, "yx": 3, "yy": 4}
# Fields that on the lattice come from the bonds of a site: shown where it has all of them.
FROM_BONDS = ("deformation_gradient", "first_piola_stress", "cauchy_stress", "strain_energy_density")
FIELDS = {"displacement": (VECTOR, "m"), "velocity": (VECTOR, "m/s"), "deformation_gradient": (TENSOR, "1"),
          "first_piola_stress": (TENSOR, "Pa"), "cauchy_stress": (TENSOR, "Pa"), "strain_energy_density": ({}, "J/m^3")}
TEXT = [0.13, 0.13, 0.13]
OUTSIDE = [0.75, 0.75, 0.75]  # sites outside the continuum
VIEW_WIDTH, BAR_HEIGHT = 640, 170  # of a view, and of the part of it that titles and colour bars take [pixels]


def arguments():
    parser = argparse.ArgumentParser(description=__doc__.split("\n", maxsplit=1)[0])
    parser.add_argument("directory", metavar="DIR", type=pathlib.Path, help="output directory of latcon compare")
    parser.add_argument("--field", default="displacement", choices=FIELDS)
    parser.add_argument("--component", metavar="C", help="x or y of a vector, xx ... yy of a tensor; default: magnitude")
    parser.add_argument("--undeformed", action="store_true", help="do not warp by the displacement")
    parser.add_argument("--screenshot", metavar="FILE", type=pathlib.Path, help="write a picture and end")
    chosen = parser.parse_args()
    components = FIELDS[chosen.field][0]
    if chosen.component is not None and chosen.component not in components:
        parser.error(f"{chosen.field} has no component {chosen.component!r}: " +
                     (", ".join(components) if components else "it is a scalar"))
    for name in ("difference_sites.vtp", "difference_continuum.vtu"):
        if not (chosen.directory / name).is_file():
            parser.error(f"{chosen.directory} holds no {name}: is it an output directory of latcon compare?")
    return chosen


def array(source, name):
    found = source.PointData[name]
    if found is None:
        sys.exit(f"side_by_side.py: the frames have no field {name!r}")
    return found


def value_range(source, name, component):
    """Smallest and largest value; component None: of the magnitude."""
    values = array(source, name)
    if values.GetNumberOfComponents() == 1:
        return values.GetRange(0)
    return values.GetRange(-1 if component is None else component)


def set_scale(lut, limits, component, preset):
    low, high = limits
    if not high > low:  # a constant field
        low, high = low - 0.5 * (abs(low) or 1.0), high + 0.5 * (abs(high) or 1.0)
    lut.ApplyPreset(preset, True)
    lut.VectorMode = "Magnitude" if component is None else "Component"
    lut.VectorComponent = 0 if component is None else component
    lut.AutomaticRescaleRangeMode = "Never"
    lut.RescaleTransferFunction(low, high)
    lut.NanColor = OUTSIDE


class View:
    """One of the three."""

    def __init__(self, source, field, title, warped):
        self.view = pv.CreateView("RenderView")
        self.view.UseColorPaletteForBackground = 0
        self.view.Background = [1.0, 1.0, 1.0]
        self.view.OrientationAxesVisibility = 0
        self.view.InteractionMode = "2D"
        self.shown = pv.WarpByVector(Input=source, Vectors=["POINTS", "displacement"]) if warped else source
        self.display = pv.Show(self.shown, self.view)
        self.display.Ambient, self.display.Diffuse = 1.0, 0.0  # colours as in the bar, without shading
        pv.ColorBy(self.display, ("POINTS", field))
        self.lut = pv.GetColorTransferFunction(field)
        text = pv.Show(pv.Text(Text=title), self.view)
        text.WindowLocation = "Upper Center"
        text.FontSize = 16
        text.Color = TEXT

    def show_bar(self, title):
        self.display.SetScalarBarVisibility(self.view, True)
        bar = pv.GetScalarBar(self.lut, self.view)
        bar.Orientation = "Horizontal"
        bar.WindowLocation = "Lower Center"
        bar.ScalarBarLength = 0.75
        bar.ScalarBarThickness = 14
        bar.Title, bar.ComponentTitle = title, ""
        bar.TitleColor = bar.LabelColor = TEXT
        bar.TitleFontSize = bar.LabelFontSize = 15
        bar.AutomaticLabelFormat = 0
        bar.LabelFormat = bar.RangeLabelFormat = "%-#.3g"
        bar.AddRangeLabels = 1
        bar.UseCustomLabels = 1  # the ends are enough, and do not overlap
        bar.CustomLabels = []


def draw(chosen):
    """The layout of the three views, and the size that fits it [pixels]."""
    components, unit = FIELDS[chosen.field]
    component = components.get(chosen.component)
    difference = f"{chosen.field}_difference"
    shown = f"{chosen.field}{f' {chosen.component}' if chosen.component else ''} [{unit}]"
    size = "" if chosen.component or not components else "size of "

    sites = pv.XMLPolyDataReader(FileName=[str(chosen.directory / "difference_sites.vtp")])
    cells = pv.XMLUnstructuredGridReader(FileName=[str(chosen.directory / "difference_continuum.vtu")])
    for source in (sites, cells):
        source.TimeArray = "None"
        source.UpdatePipeline()
        array(source, chosen.field)
    if chosen.field in FROM_BONDS:
        sites = pv.Threshold(Input=sites, Scalars=["POINTS", "complete"], LowerThreshold=1.0, UpperThreshold=1.0)
        sites.UpdatePipeline()
    # What the continuum does between the sites, in a corner for instance, does not wash out the rest.
    ranges = [value_range(sites, name, component) for name in (chosen.field, f"{chosen.field}_continuum")]
    off = value_range(sites, difference, component)
    warped = not chosen.undeformed
    left = View(sites, chosen.field, "lattice", warped)
    middle = View(cells, chosen.field, "continuum", warped)
    right = View(sites, difference, "lattice less continuum", warped)

    set_scale(left.lut, (min(r[0] for r in ranges), max(r[1] for r in ranges)), component, "Viridis (matplotlib)")
    if size:
        set_scale(right.lut, (0.0, off[1]), component, "Inferno (matplotlib)")
    else:
        largest = max(abs(off[0]), abs(off[1]))
        set_scale(right.lut, (-largest, largest), component, "Cool to Warm")
    for view in (left, right):  # a lattice is shown as one
        view.display.SetRepresentationType("Surface")
        view.display.LineWidth = 2.5
        view.display.PointSize = 4.0
    middle.display.NonlinearSubdivisionLevel = 3
    for view in (left, middle):
        view.show_bar(size + shown)
    right.show_bar(f"{size}difference of {shown}")

    layout = pv.CreateLayout("lattice, continuum, difference")
    layout.AssignView(0, left.view)
    place = layout.SplitHorizontal(0, 1.0 / 3.0)
    layout.AssignView(place + 1, middle.view)
    place = layout.SplitHorizontal(place + 1, 0.5)
    layout.AssignView(place + 1, right.view)

    low_x, high_x, low_y, high_y = middle.shown.GetDataInformation().GetBounds()[:4]
    width, height = high_x - low_x, high_y - low_y
    view_height = int(min(max(0.9 * VIEW_WIDTH * height / width, 120), 900)) + BAR_HEIGHT
    layout.SetSize(3 * VIEW_WIDTH, view_height)
    pixel = max(width / (0.9 * VIEW_WIDTH), height / (view_height - BAR_HEIGHT))
    for view in (left.view, middle.view, right.view):
        # Titles take less than the colour bars below: the sheet is a little above the middle.
        centre = [0.5 * (low_x + high_x), 0.5 * (low_y + high_y) - 0.17 * BAR_HEIGHT * pixel]
        view.CameraParallelProjection = 1
        view.CameraFocalPoint = [*centre, 0.0]
        view.CameraPosition = [*centre, 10.0 * max(width, height)]
        view.CameraViewUp = [0.0, 1.0, 0.0]
        view.CameraParallelScale = 0.5 * view_height * pixel
    pv.AddCameraLink(left.view, middle.view, "lattice and continuum")
    pv.AddCameraLink(middle.view, right.view, "continuum and difference")
    pv.RenderAllViews()
    return layout, (3 * VIEW_WIDTH, view_height)


if __name__ == "__main__":
    CHOSEN = arguments()
    import paraview.simple as pv  # after the arguments, whose errors need no ParaView

    pv._DisableFirstRenderCameraReset()
    LAYOUT, SIZE = draw(CHOSEN)
    if CHOSEN.screenshot:
        pv.SaveScreenshot(str(CHOSEN.screenshot), LAYOUT, ImageResolution=SIZE, SeparatorWidth=0)
        if not CHOSEN.screenshot.is_file():
            sys.exit(f"side_by_side.py: cannot write {CHOSEN.screenshot}")
    else:
        pv.Interact()
