#!/usr/bin/env pvpython
"""Shows the neighbourhood of the tip of a crack: the sheet in a frame, and the mean fields around the running tip.

Usage: pvpython near_tip.py DIR [--field FIELD] [--unfolded] [--time MS] [--screenshot FILE.png]
DIR is an output directory of `latcon fracture`. Left: bonds around the tip (cross), coloured by their stretch. Right:
means over samples that move with the tip, in the current configuration. FIELD: velocity, its component along the crack
with arrows and an outline of the zone of backward motion ahead of the tip, or opening-stress. Without --screenshot a window opens.
"""
import csv
import json
import sys

sys.dont_write_bytecode = True  # no files are added to this folder

from looks import (BEYOND, TENSOR, View, beside, fail, finish, input_number, parser_of, require, set_scale, size_for,
                   values_of)

VIEW_WIDTH = 760  # [pixels]
NEGATIVE = 0.01  # fraction of the crack speed: faster backward motion is outlined, as counted in near_tip.json
OUTLINE = [0.0, 0.62, 0.45]  # green
LABELS = {"velocity": "velocity along the crack, laboratory [m/s]",
          "opening-stress": "Cauchy stress yy, across the crack [Pa]"}


def arguments():
    parser = parser_of(__doc__, "output directory of latcon fracture")
    parser.add_argument("--field", default="velocity", choices=LABELS)
    parser.add_argument("--unfolded", action="store_true", help="do not mirror samples of a path that descends")
    parser.add_argument("--time", metavar="MS", type=float, help="the frame nearest to this time; default: the last in "
                        "the stretch that was sampled")
    chosen = parser.parse_args()
    chosen.means = "near_tip.vti" if chosen.unfolded else "near_tip_folded.vti"
    needed = (chosen.means, "near_tip.json", "lattice.pvd", "crack.csv", "crack.json")
    require(parser, chosen.directory, needed, "latcon fracture")
    return chosen


def tip_path(directory):
    """[(time [s], undeformed X, current x, y [m])] of the tip."""
    with open(directory / "crack.csv", newline="", encoding="utf-8") as file:
        return [tuple(float(row[name]) for name in ("t", "X", "x", "y")) for row in csv.DictReader(file)]


def frame_time(times, path, chosen):
    """Time of the frame to show [s]."""
    if chosen.time is not None:
        return min(times, key=lambda time: abs(1e3 * time - chosen.time))
    sampled_to = json.loads((chosen.directory / "near_tip.json").read_text(encoding="utf-8")).get("sampled_to")
    measured = [t for t, X, *_ in path if sampled_to is None or X <= sampled_to]
    return max((time for time in times if time <= measured[-1]), default=times[0])


def averaged(chosen):
    """The warped region with material in at least half of the samples, without cells that span the opening."""
    import numpy as np

    image = pv.XMLImageDataReader(FileName=[str(chosen.directory / chosen.means)])
    ahead = pv.Calculator(Input=image, Function="if(coordsX > 0, velocity_X, 0)", ResultArrayName="ahead")
    warped = pv.WarpByVector(Input=ahead, Vectors=["POINTS", "displacement"])
    material = pv.Threshold(Input=warped, Scalars=["POINTS", "occupancy"], LowerThreshold=0.5, UpperThreshold=1.0)
    sized = pv.CellSize(Input=material, ComputeVertexCount=0, ComputeLength=0, ComputeArea=1, ComputeVolume=0)
    sized.UpdatePipeline()
    if sized.GetDataInformation().GetNumberOfCells() == 0:
        fail(f"{chosen.means} holds no material")
    usual = float(np.median(values_of(sized, "Area", on="CELLS")))
    cells = pv.Threshold(Input=sized, Scalars=["CELLS", "Area"], LowerThreshold=0.0, UpperThreshold=3.0 * usual)
    cells.UpdatePipeline()
    return cells


def show_means(view, chosen):
    """Shows the mean fields. @return their bounds [m]"""
    import numpy as np

    cells = averaged(chosen)
    view.mark(0.0, 0.0)
    if chosen.field == "opening-stress":
        display, lut = view.show(cells, "cauchy_stress")
        low, high = np.nanpercentile(values_of(cells, "cauchy_stress", TENSOR["yy"]), (2, 99.5))
        set_scale(lut, (min(low, 0.0), high), "Viridis (matplotlib)", TENSOR["yy"])
    else:
        display, lut = view.show(cells, "velocity")
        low, high = np.nanpercentile(values_of(cells, "velocity", 0), (0.5, 99.5))
        # White is rest.
        set_scale(lut, (-max(abs(low), high), max(abs(low), high)), "Cool to Warm", 0)
        fastest = float(np.nanpercentile(values_of(cells, "velocity"), 99))
        low_x, high_x = cells.GetDataInformation().GetBounds()[:2]
        glyphs = pv.Glyph(Input=cells, GlyphType="2D Glyph", OrientationArray=["POINTS", "velocity"],
                          ScaleArray=["POINTS", "velocity"], ScaleFactor=0.05 * (high_x - low_x) / fastest,
                          GlyphMode="Every Nth Point", Stride=7)
        arrows, _ = view.show(glyphs)
        arrows.AmbientColor = arrows.DiffuseColor = [0.1, 0.1, 0.1]
        speed = json.loads((chosen.directory / "crack.json").read_text(encoding="utf-8")).get("speed_laboratory")
        if speed:
            limit = pv.Contour(Input=cells, ContourBy=["POINTS", "ahead"], Isosurfaces=[-NEGATIVE * speed])
            outline, _ = view.show(limit)
            outline.AmbientColor = outline.DiffuseColor = OUTLINE
            outline.LineWidth = 3.0
    view.show_bar(display, lut, LABELS[chosen.field])
    return cells.GetDataInformation().GetBounds()[:4]


def show_sheet(view, sheet, bounds, chosen):
    """Shows the bonds in a box, coloured by stretch."""
    import numpy as np

    low_x, high_x, low_y, high_y = bounds
    part = pv.Clip(Input=sheet, ClipType="Box", Invert=1, Exact=0)
    part.ClipType.Position, part.ClipType.Length = [low_x, low_y, -1.0], [high_x - low_x, high_y - low_y, 2.0]
    part.UpdatePipeline()
    display, lut = view.show(part, "stretch", "CELLS")
    display.SetRepresentationType("Surface")
    display.LineWidth, display.PointSize = 1.6, 2.5
    low, high = np.percentile(values_of(part, "stretch", on="CELLS"), (1, 99))
    breaking = input_number(chosen.directory, "Fracture/breaking stretch")
    set_scale(lut, (low, breaking or high), "Viridis (matplotlib)")
    if breaking:
        lut.UseAboveRangeColor, lut.AboveRangeColor = 1, BEYOND
    view.show_bar(display, lut, "stretch of a bond [1]" + ("; orange: beyond the breaking stretch" if breaking else ""))


def draw(chosen):
    """The layout of the two views, and its size [pixels]."""
    path = tip_path(chosen.directory)
    frames = pv.PVDReader(FileName=str(chosen.directory / "lattice.pvd"))
    times = [time for time in frames.TimestepValues if path and time >= path[0][0]]
    if not times:
        fail("there is no frame with a crack tip")
    time = frame_time(times, path, chosen)
    *_, tip_x, tip_y = max((record for record in path if record[0] <= time), key=lambda record: record[0])
    pv.GetAnimationScene().UpdateAnimationUsingDataTimeSteps()
    pv.GetAnimationScene().AnimationTime = time
    sheet = pv.WarpByVector(Input=frames, Vectors=["POINTS", "displacement"])
    sheet.UpdatePipeline(time)

    left = View(pv, f"{chosen.directory.resolve().name} at {1e3 * time:.3f} ms")
    right = View(pv, "mean over samples, moving with the tip" + ("" if chosen.unfolded else ", folded"))
    bounds = show_means(right, chosen)
    around_tip = (bounds[0] + tip_x, bounds[1] + tip_x, bounds[2] + tip_y, bounds[3] + tip_y)
    show_sheet(left, sheet, around_tip, chosen)
    left.mark(tip_x, tip_y)
    size = size_for(bounds, VIEW_WIDTH)
    right.look_at(bounds, size)
    left.look_at(around_tip, size)
    return beside(pv, (left, right), size, "near the tip")


if __name__ == "__main__":
    CHOSEN = arguments()
    import paraview.simple as pv  # after parsing the arguments, which does not need ParaView

    pv._DisableFirstRenderCameraReset()
    finish(pv, *draw(CHOSEN), CHOSEN.screenshot)
