"""Tests of the frames of a crack: reduced frames of its motion, and the default view of the others in ParaView."""
import numpy as np
import pytest
from vtkmodules.util.numpy_support import vtk_to_numpy

from program import CASES, frames, latcon, read, read_csv, settings, unit

LENGTH, STOP = 25e-3, 20e-3  # [m]
MOTION_FRAMES = 10
STRIP = ["fracture", CASES / "quick.prm", "--skip-verification", "--no-report", "--quiet",
         *settings("Sheet/length=2.5 cm", "Sheet/height=1.5 cm", "Time/end=1.5 ms", "Output/frame interval=0.4 ms", "Fracture/stop position=0.8")]


@pytest.fixture(scope="module")
def once(module_path):
    latcon(*STRIP, "--set", f"Output/motion frames={MOTION_FRAMES}", "--output-dir", module_path / "out")
    return module_path / "out"


def test_motion_follows_the_tip(once):
    motion = frames(once / "motion.pvd")
    times = [time for time, _ in motion]
    assert times == sorted(set(times))
    assert (times[0], times[-1]) == (0.0, frames(once / "lattice.pvd")[-1][0])  # to the last digit
    tip = read_csv(once / "crack.csv")
    reached = [max(float(row["X"]) for row in tip if float(row["t"]) <= time) for time in times]
    assert reached[-1] > STOP  # so it passed all positions
    # One frame each time the tip passes another tenth of its way; a jump may skip some of them.
    pitch = (STOP - reached[0]) / MOTION_FRAMES
    assert 0.7 * MOTION_FRAMES < len(motion) <= MOTION_FRAMES + 2
    tenths = [int((X - reached[0]) / pitch * (1 + 1e-12)) for X in reached[:-1]]
    assert tenths == sorted(set(tenths))


def test_motion_is_that_of_the_sheet_and_light(once):
    motion, lattice = frames(once / "motion.pvd"), frames(once / "lattice.pvd")
    for light_file, whole_file in ((motion[0][1], lattice[0][1]), (motion[-1][1], lattice[-1][1])):
        light, whole = read(light_file), read(whole_file)
        assert light.FieldData["TimeValue"][0] == whole.FieldData["TimeValue"][0]
        np.testing.assert_allclose(light.Points, whole.Points, atol=1e-7 * LENGTH)
        for name, expected in (("displacement", "m"), ("velocity", "m/s")):
            values = whole.PointData[name]
            np.testing.assert_allclose(light.PointData[name], values, atol=1e-7 * max(np.abs(values).max(), 1e-9))
            assert unit(light.PointData[name]) == expected
        assert light_file.stat().st_size < 0.15 * whole_file.stat().st_size


def test_none_are_written_if_none_are_wanted(once):
    out = once.parent / "none"
    latcon(*STRIP, "--set", "Output/motion frames=0", "--output-dir", out)
    assert list(out.glob("motion*")) == []


def test_paraview_shows_stretch_and_warps_by_displacement(once):
    sheet, motion = (read(frames(once / name)[-1][1]) for name in ("lattice.pvd", "motion.pvd"))
    assert sheet.GetCellData().GetScalars().GetName() == "stretch"
    for shown in (sheet.GetPointData().GetVectors(), motion.GetPointData().GetScalars(), motion.GetPointData().GetVectors()):
        assert shown.GetName() == "displacement"


def test_a_site_has_the_mean_stretch_of_its_bonds(once):
    sheet = read(frames(once / "lattice.pvd")[-1][1])
    count = sheet.GetNumberOfVerts()
    stretch = sheet.CellData["stretch"]
    ends = vtk_to_numpy(sheet.GetLines().GetConnectivityArray()).reshape(-1, 2)
    total, bonds = np.zeros(count), np.zeros(count)
    for side in (0, 1):
        np.add.at(total, ends[:, side], stretch[count:])
        np.add.at(bonds, ends[:, side], 1)
    mean = np.where(bonds > 0, total / np.maximum(bonds, 1), 1.0)
    np.testing.assert_allclose(stretch[:count], mean, rtol=1e-12)
