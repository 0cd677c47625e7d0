"""Utilities of the scripts in this folder: command line, colour scales, white views, screenshots."""
import argparse
import json
import pathlib
import sys

TEXT = [0.13, 0.13, 0.13]
BEYOND = [0.835, 0.369, 0.0]  # orange, of bonds beyond the breaking stretch
BAR_HEIGHT = 170  # of the part of a view that title and colour bar take [pixels]
# Indices of a field's components in the files.
VECTOR, TENSOR = {"x": 0, "y": 1}, {"xx": 0, "xy": 1, "yx": 3, "yy": 4}


def parser_of(doc, directory):
    """Command line of all scripts. `doc`: docstring of the script; `directory`: description of DIR."""
    parser = argparse.ArgumentParser(description=doc.split("\n", maxsplit=1)[0])
    parser.add_argument("directory", metavar="DIR", type=pathlib.Path, help=directory)
    parser.add_argument("--screenshot", metavar="FILE", type=pathlib.Path, help="write a picture (PNG) and end")
    return parser


def require(parser, directory, names, of):
    """Ends with exit code 2 unless all files exist. `of`: the command that writes them."""
    for name in names:
        if not (directory / name).is_file():
            parser.error(f"{directory} holds no {name}: is it an output directory of {of}?")


def fail(problem):
    """Prints an error message and ends with exit code 1."""
    sys.exit(f"{pathlib.Path(sys.argv[0]).name}: {problem}")


def input_number(directory, key):
    """Value of an entry of the case of a run, SI unit, as its run.json records it; None if it is missing or no number."""
    try:
        return float(json.loads((directory / "run.json").read_text())["entries"][key])
    except (OSError, ValueError, KeyError):
        return None


def array(source, name, on="POINTS"):
    """Information about a point or cell array of a filter."""
    found = (source.PointData if on == "POINTS" else source.CellData)[name]
    if found is None:
        fail(f"the frames have no field {name!r}")
    return found


def value_range(source, name, component=None):
    """Smallest and largest value of a point array; component None: of a scalar, or of the magnitude."""
    found = array(source, name)
    if found.GetNumberOfComponents() == 1:
        return found.GetRange(0)
    return found.GetRange(-1 if component is None else component)


def values_of(source, name, component=None, on="POINTS"):
    """The values themselves; component None: of a scalar, or of the magnitude."""
    # ParaView's modules are on the path only after it has started.
    import numpy as np
    from paraview import servermanager
    from vtkmodules.util.numpy_support import vtk_to_numpy

    array(source, name, on)
    data = servermanager.Fetch(source)
    found = (data.GetPointData() if on == "POINTS" else data.GetCellData()).GetArray(name)
    values = vtk_to_numpy(found).reshape(found.GetNumberOfTuples(), -1)
    if values.shape[1] == 1:
        return values[:, 0]
    return np.linalg.norm(values, axis=1) if component is None else values[:, component]


def set_scale(lut, limits, preset, component=None):
    """A fixed colour scale; component None: of the magnitude."""
    low, high = limits
    if not high > low:  # a constant field
        low, high = low - 0.5 * (abs(low) or 1.0), high + 0.5 * (abs(high) or 1.0)
    lut.ApplyPreset(preset, True)
    lut.VectorMode = "Magnitude" if component is None else "Component"
    lut.VectorComponent = 0 if component is None else component
    lut.AutomaticRescaleRangeMode = "Never"
    lut.RescaleTransferFunction(low, high)


def symmetric(limits):
    """Limits symmetric about zero."""
    largest = max(abs(limit) for limit in limits)
    return -largest, largest


class View:
    """A white view with a title, of objects in the plane."""

    def __init__(self, pv, title):
        self.pv = pv
        self.view = pv.CreateView("RenderView")
        self.view.UseColorPaletteForBackground = 0
        self.view.Background = [1.0, 1.0, 1.0]
        self.view.OrientationAxesVisibility = 0
        self.view.InteractionMode = "2D"
        text = pv.Show(pv.Text(Text=title), self.view)
        text.WindowLocation = "Upper Center"
        text.FontSize = 16
        text.Color = TEXT

    def show(self, source, field=None, on="POINTS", colour=None):
        """Shows a source without shading, coloured by a field or in one colour. @return its display, the colour scale"""
        display = self.pv.Show(source, self.view)
        display.Ambient, display.Diffuse, display.Specular = 1.0, 0.0, 0.0  # colours as in the bar
        if field is None:
            display.ColorArrayName = ["POINTS", ""]  # none
            if colour is not None:
                display.AmbientColor = display.DiffuseColor = colour
            return display, None
        self.pv.ColorBy(display, (on, field))
        return display, self.pv.GetColorTransferFunction(field)

    def show_bar(self, display, lut, title):
        """The colour bar below."""
        display.SetScalarBarVisibility(self.view, True)
        bar = self.pv.GetScalarBar(lut, self.view)
        bar.Orientation = "Horizontal"
        bar.WindowLocation, bar.Position = "Any Location", [0.125, 0.03]
        bar.ScalarBarLength = 0.75
        bar.ScalarBarThickness = 14
        bar.Title, bar.ComponentTitle = title, ""
        bar.TitleColor = bar.LabelColor = TEXT
        bar.TitleFontSize = bar.LabelFontSize = 15
        bar.AutomaticLabelFormat = 0
        bar.LabelFormat = bar.RangeLabelFormat = "%-#.3g"
        bar.AddRangeLabels = 1
        bar.UseCustomLabels = 1  # labels at the ends do not overlap
        bar.CustomLabels = []

    def mark(self, x, y):
        """A cross at a position [m], on top of the sheet."""
        mark = self.pv.Show(self.pv.Text(Text="+"), self.view)
        mark.TextPropMode, mark.BillboardPosition = "Billboard 3D Text", [x, y, 1e-3]
        mark.FontSize, mark.Bold, mark.Color, mark.Justification = 26, 1, [0.0, 0.0, 0.0], "Center"
        mark.VerticalJustification = "Center"

    def look_at(self, bounds, size):
        """Shows a box (x from, to, y from, to) [m] above the colour bar of a view with a given size [pixels]."""
        low_x, high_x, low_y, high_y = bounds
        width, height = high_x - low_x, high_y - low_y
        pixel = max(width / (0.9 * size[0]), height / (size[1] - BAR_HEIGHT))
        # Titles are smaller than the colour bars below, so that the box is slightly above the middle.
        centre = [0.5 * (low_x + high_x), 0.5 * (low_y + high_y) - 0.17 * BAR_HEIGHT * pixel]
        self.view.CameraParallelProjection = 1
        self.view.CameraFocalPoint = [*centre, 0.0]
        self.view.CameraPosition = [*centre, 10.0 * max(width, height)]
        self.view.CameraViewUp = [0.0, 1.0, 0.0]
        self.view.CameraParallelScale = 0.5 * size[1] * pixel


def size_for(bounds, width):
    """Size [pixels] of a view of given width that shows a box and a colour bar below."""
    low_x, high_x, low_y, high_y = bounds
    return width, int(min(max(0.9 * width * (high_y - low_y) / (high_x - low_x), 120), 900)) + BAR_HEIGHT


def beside(pv, views, size, name):
    """Views of equal size side by side. @return (layout, its size)"""
    layout = pv.CreateLayout(name)
    layout.AssignView(0, views[0].view)
    place = 0
    for number, view in enumerate(views[1:], start=1):
        place = layout.SplitHorizontal(place, 1.0 / (len(views) + 1 - number))
        layout.AssignView(place + 1, view.view)
        place += 1
    whole = (len(views) * size[0], size[1])
    layout.SetSize(*whole)
    pv.RenderAllViews()
    return layout, whole


def finish(pv, layout, size, screenshot):
    """Writes the picture, or opens a window."""
    if screenshot is None:
        pv.Interact()
        return
    pv.SaveScreenshot(str(screenshot), layout, ImageResolution=size, SeparatorWidth=0)
    if not screenshot.is_file():
        fail(f"cannot write {screenshot}")
