#!/usr/bin/env pvpython
"""Shows the deformed sheet of a lattice, coloured by a field of its bonds or sites.

Usage: pvpython deformed_sheet.py DIR [--field FIELD] [--time MS] [--screenshot FILE.png]
DIR is an output directory of `latcon fracture` or `latcon lattice`. FIELD: stretch of the bonds (default), speed,
opening-stress, damage. Without --screenshot a window opens and plays the frames.
"""
import sys
from dataclasses import dataclass

sys.dont_write_bytecode = True  # no files are added to this folder

from looks import (BEYOND, TENSOR, TEXT, View, beside, fail, finish, input_number, parser_of, require, set_scale,
                   size_for, values_of)

WIDTH = 1100  # [pixels]
MARGIN = 0.02  # around the sheet, of its length


@dataclass(frozen=True)
class Field:
    """Field by which a sheet can be coloured."""

    name: str  # in the files
    on: str
    component: int  # None: of a scalar, or the magnitude
    preset: str
    label: str


FIELDS = {
    "stretch": Field("stretch", "CELLS", None, "Viridis (matplotlib)",
                     "stretch of a bond [1]; orange: beyond the breaking stretch"),
    "speed": Field("velocity", "POINTS", None, "Inferno (matplotlib)", "speed of the material [m/s]"),
    "opening-stress": Field("cauchy_stress", "POINTS", TENSOR["yy"], "Viridis (matplotlib)",
                            "Cauchy stress yy, across the crack [Pa]"),
    "damage": Field("damage", "POINTS", None, "Inferno (matplotlib)", "share of its bonds that a site has lost [1]"),
}


def arguments():
    parser = parser_of(__doc__, "output directory of latcon fracture or latcon lattice")
    parser.add_argument("--field", default="stretch", choices=FIELDS)
    parser.add_argument("--time", metavar="MS", type=float, help="the frame nearest to this time; default: the last")
    chosen = parser.parse_args()
    require(parser, chosen.directory, ("lattice.pvd",), "latcon fracture or latcon lattice")
    return chosen


def limits(sheet, field, directory):
    """Ends of the colour scale, without the extremes of single bonds and of the flanks of the crack."""
    import numpy as np

    if field.name == "damage":
        return 0.0, 1.0
    low, high = np.nanpercentile(values_of(sheet, field.name, field.component, field.on), (1, 99))
    if field.name == "stretch":
        return low, input_number(directory, "Fracture/breaking stretch") or high
    return (0.0 if field.name == "velocity" else low), high


def draw(chosen):
    """The layout, and its size [pixels]."""
    field = FIELDS[chosen.field]
    frames = pv.PVDReader(FileName=str(chosen.directory / "lattice.pvd"))
    times = list(frames.TimestepValues)
    if not times:
        fail("lattice.pvd names no frames")
    sheet = pv.WarpByVector(Input=frames, Vectors=["POINTS", "displacement"])
    scene = pv.GetAnimationScene()
    scene.UpdateAnimationUsingDataTimeSteps()
    # The edges are held at their positions in the first frame; fragments may fly anywhere.
    sheet.UpdatePipeline(times[0])
    low_x, high_x, low_y, high_y = sheet.GetDataInformation().GetBounds()[:4]
    time = times[-1] if chosen.time is None else min(times, key=lambda t: abs(1e3 * t - chosen.time))
    scene.AnimationTime = time
    sheet.UpdatePipeline(time)
    margin = MARGIN * (high_x - low_x)
    bounds = (low_x - margin, high_x + margin, low_y - margin, high_y + margin)

    view = View(pv, f"{chosen.directory.resolve().name}, current configuration")
    display, lut = view.show(sheet, field.name, field.on)
    display.SetRepresentationType("Surface")
    display.LineWidth, display.PointSize = 1.0, 1.5
    set_scale(lut, limits(sheet, field, chosen.directory), field.preset, field.component)
    if field.name == "stretch" and input_number(chosen.directory, "Fracture/breaking stretch"):
        lut.UseAboveRangeColor, lut.AboveRangeColor = 1, BEYOND
    view.show_bar(display, lut, field.label)
    clock = pv.Show(pv.AnnotateTimeFilter(Input=sheet, Scale=1e3, Format="t = {time:.3f} ms"), view.view)
    clock.WindowLocation, clock.FontSize, clock.Color = "Upper Left Corner", 14, TEXT
    size = size_for(bounds, WIDTH)
    view.look_at(bounds, size)
    return beside(pv, (view,), size, "deformed sheet")


if __name__ == "__main__":
    CHOSEN = arguments()
    import paraview.simple as pv  # after parsing the arguments, which does not need ParaView

    pv._DisableFirstRenderCameraReset()
    finish(pv, *draw(CHOSEN), CHOSEN.screenshot)
