"""Tests of the frames of a crack: reduced frames of its motion, and the default view of the others in ParaView."""
import numpy as np
import pytest
import vtk
from vtk.util.numpy_support import vtk_to_numpy

from program import CASES, frames, latcon, read, read_csv

LENGTH, STOP = 25e-3, 20e-3  # [m]
MOTION_FRAMES = 10
STRIP = ["fracture", CASES / "quick.prm", "--skip-verification", "--no-report", "--quiet",
         "--set", "Sheet/length=2.5 cm", "--set", "Sheet/height=1.5 cm", "--set", "Time/end=1.5 ms",
         "--set", "Output/frame interval=0.4 ms", "--set", "Fracture/stop position=0.8"]


def sheet_of(path):
    return read(vtk.vtkXMLPolyDataReader(), path)


def points_of(sheet, name):
    return vtk_to_numpy(sheet.GetPointData().GetArray(name))


@pytest.fixture(scope="module")
def once(module_path):
    run = latcon(*STRIP, "--set", f"Output/motion frames={MOTION_FRAMES}", "--output-dir", module_path / "out")
    assert run.returncode == 0, run.stderr
    return module_path / "out"


def test_motion_follows_the_tip(once):
    motion = frames(once / "motion.pvd")
    times = [time for time, _ in motion]
    assert times == sorted(set(times))
    assert times[0] == 0.0
    assert times[-1] == frames(once / "lattice.pvd")[-1][0]  # to the last digit
    tip = read_csv(once / "crack.csv")
    reached = [max(float(row["X"]) for row in tip if float(row["t"]) <= time) for time in times]
    assert reached[-1] > STOP  # so it passed all positions
    # One frame each time the tip passes another tenth of its way; a jump may skip some of them.
    pitch = (STOP - reached[0]) / MOTION_FRAMES
    assert len(motion) > 0.7 * MOTION_FRAMES
    assert len(motion) <= MOTION_FRAMES + 2
    tenths = [int((X - reached[0]) / pitch * (1 + 1e-12)) for X in reached[:-1]]
    assert tenths == sorted(set(tenths))


def test_motion_is_that_of_the_sheet_and_light(once):
    motion, lattice = frames(once / "motion.pvd"), frames(once / "lattice.pvd")
    for light_file, whole_file in ((motion[0][1], lattice[0][1]), (motion[-1][1], lattice[-1][1])):
        light, whole = sheet_of(light_file), sheet_of(whole_file)
        assert light.GetNumberOfPoints() == whole.GetNumberOfPoints()
        assert light.GetFieldData().GetArray("TimeValue").GetValue(0) == (whole.GetFieldData().GetArray("TimeValue").GetValue(0))
        places = [vtk_to_numpy(sheet.GetPoints().GetData()) for sheet in (light, whole)]
        np.testing.assert_allclose(*places, atol=1e-7 * LENGTH)
        for name, unit in (("displacement", "m"), ("velocity", "m/s")):
            values = points_of(whole, name)
            np.testing.assert_allclose(points_of(light, name), values, atol=1e-7 * max(np.abs(values).max(), 1e-9))
            array = light.GetPointData().GetArray(name)
            assert array.GetInformation().Get(vtk.vtkDataArray.UNITS_LABEL()) == unit
        assert light_file.stat().st_size < 0.15 * whole_file.stat().st_size


def test_none_are_written_if_none_are_wanted(once):
    out = once.parent / "none"
    run = latcon(*STRIP, "--set", "Output/motion frames=0", "--output-dir", out)
    assert run.returncode == 0, run.stderr
    assert list(out.glob("motion*")) == []


def test_paraview_shows_stretch_and_warps_by_displacement(once):
    sheet = sheet_of(frames(once / "lattice.pvd")[-1][1])
    assert sheet.GetCellData().GetScalars().GetName() == "stretch"
    assert sheet.GetPointData().GetVectors().GetName() == "displacement"
    motion = sheet_of(frames(once / "motion.pvd")[-1][1])
    assert motion.GetPointData().GetScalars().GetName() == "displacement"
    assert motion.GetPointData().GetVectors().GetName() == "displacement"


def test_a_site_has_the_mean_stretch_of_its_bonds(once):
    sheet = sheet_of(frames(once / "lattice.pvd")[-1][1])
    count = sheet.GetNumberOfVerts()
    stretch = vtk_to_numpy(sheet.GetCellData().GetArray("stretch"))
    ends = vtk_to_numpy(sheet.GetLines().GetConnectivityArray()).reshape(-1, 2)
    total, bonds = np.zeros(count), np.zeros(count)
    for side in (0, 1):
        np.add.at(total, ends[:, side], stretch[count:])
        np.add.at(bonds, ends[:, side], 1)
    mean = np.where(bonds > 0, total / np.maximum(bonds, 1), 1.0)
    np.testing.assert_allclose(stretch[:count], mean, rtol=1e-12)
