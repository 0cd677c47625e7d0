"""latcon compare: its files against VTK's own interpolation, ranks, choice of frames, refusals.

What is refused of frames: tests/python/test_compare_frames.py.
"""
import types

import numpy as np
import pytest
from vtkmodules.numpy_interface.dataset_adapter import WrapDataObject
from vtkmodules.vtkFiltersCore import vtkProbeFilter

from program import CASES, expect_same, files, frames, latcon, latcon_on_ranks, read, read_csv, read_json, settings

FIELDS = ["displacement", "deformation_gradient", "first_piola_stress", "cauchy_stress", "strain_energy_density"]
SMALL = settings("Sheet/length=2 cm", "Sheet/height=1.5 cm", "Loading/strain y=0.3", "Loading/strain x=0.1")
MOTION = settings("Time/end=0.02 ms", "Output/frame interval=0")


def sites_of(folder):
    return read(folder / "difference_sites.vtp")


def found(folder):
    return {row["quantity"]: row for row in read_csv(folder / "results.csv")}


@pytest.fixture(scope="module")
def once(module_path):
    runs = module_path
    made = types.SimpleNamespace(runs=runs, lattice=runs / "lattice", continuum=runs / "continuum")
    # The continuum has free sides and the lattice has not, which produces a difference.
    for command, out, ranks, entries in [
            ("lattice", made.lattice, 1, []), ("continuum", made.continuum, 1, []),
            ("continuum", runs / "free", 1, ["--set", "Left edge/condition=free", "--set", "Right edge/condition=free"]),
            ("continuum", runs / "pieces", 2, []),
            ("lattice", runs / "lattice-moves", 1, ["--set", "Lattice/solution=motion", *MOTION]),
            ("continuum", runs / "continuum-moves", 1, ["--set", "Continuum/solution=motion", *MOTION])]:
        latcon_on_ranks(ranks, command, CASES / "quick.prm", "--quiet", "--output-dir", out, *SMALL, *entries)
    return made


def compare(out, *arguments, expect=0):
    return latcon("compare", *arguments, "--output-dir", out, expect=expect)


def refused(out, parts, *arguments):
    run = compare(out, *arguments, expect=2)
    for part in parts:
        assert part in run.stderr


# The sites of a periodic lattice stop half a spacing or a whole one short of its ends.
def test_periodic_sheets_are_the_same_sheet(tmp_path, out):
    sheet = [word.replace("x=0.1", "x=0") for word in SMALL] + settings("Left edge/condition=periodic", "Right edge/condition=periodic")
    for command in ("lattice", "continuum"):
        latcon(command, CASES / "quick.prm", "--quiet", "--output-dir", tmp_path / command, *sheet)
    compare(out, tmp_path / "lattice", tmp_path / "continuum", "--tolerance", "displacement=1e-6")
    assert found(out)["sites outside the finite element sheet"]["lattice"] == "0"


def test_equal_sheets_agree(once, out):
    tolerances = [word for name in FIELDS for word in ("--tolerance", f"{name}=1e-6")]
    for continuum in (once.continuum / "continuum_0001.vtu", once.runs / "pieces" / "continuum.pvd"):
        compare(out, once.lattice, continuum, *tolerances)
        assert read_json(out / "results.json")["verdict"] == "holds"
    assert found(out)["sites outside the finite element sheet"]["lattice"] == "0"
    record = read_json(out / "run.json")
    assert record["lattice_frame"] == str(once.lattice / "lattice-0001.vtp")
    assert record["continuum_frame"] == str(once.runs / "pieces" / "continuum_0001.pvtu")
    assert not [path for path in out.iterdir() if path.suffix == ".part"]


def expect_norm(sites, row, field, chosen, reduce):
    """Checks the error of a row by that of the chosen sites, computed independently."""
    difference = (sites.PointData[f"{field}_difference"][chosen].reshape(chosen.sum(), -1)**2).sum(axis=1)
    scale = max(float(row["lattice"]), float(row["continuum"]))
    assert float(row["error"]) > 1e-2
    assert float(row["error"]) == pytest.approx(np.sqrt(reduce(difference)) / scale, abs=1e-12)


def test_difference_is_that_of_another_interpolation(once, out):
    compare(out, once.lattice, once.runs / "free", expect=3)  # free sides are another load
    assert [(time, path.name) for time, path in frames(out / "difference.pvd")] == (
        [(1., "difference_sites.vtp"), (1., "difference_continuum.vtu")])
    cells = read(frames(once.runs / "free" / "continuum.pvd")[-1][1])
    sites = read(once.lattice / "lattice-0001.vtp")
    probe = vtkProbeFilter()
    probe.SetSourceData(cells.VTKObject)
    probe.SetInputData(sites.VTKObject)
    probe.Update()
    probed = WrapDataObject(probe.GetOutput()).PointData
    inside = probed["vtkValidPointMask"] == 1
    assert inside.sum() > 0.9 * len(inside)
    theirs = sites_of(out)
    assert theirs.PointData["outside"].sum() == 0.
    u = sites.PointData["displacement"]
    # The file's positions and fields have 24 bits.
    np.testing.assert_allclose(theirs.PointData["displacement_continuum"][inside],
                               probed["displacement"][inside], rtol=0., atol=5e-7 * abs(u).max())
    for name in FIELDS:
        np.testing.assert_array_equal(theirs.PointData[name], sites.PointData[name])
        lattice, continuum, difference = (theirs.PointData[name + end] for end in ("", "_continuum", "_difference"))
        np.testing.assert_array_equal(difference, lattice - continuum)
    expect_norm(theirs, found(out)["displacement, rms difference"], "displacement", theirs.PointData["held"] == 0, np.mean)
    chosen = (theirs.PointData["held"] == 0) & (theirs.PointData["complete"] == 1)
    expect_norm(theirs, found(out)["cauchy_stress, largest difference"], "cauchy_stress", chosen, np.max)
    # The continuum is unchanged.
    copy = read(out / "difference_continuum.vtu")
    np.testing.assert_array_equal(copy.PointData["displacement"], cells.PointData["displacement"])


def test_sites_in_excluded_circles_are_not_compared(once, out):
    compare(out, once.lattice, once.runs / "free", "--exclude", "1 cm,2 mm,3 mm", "--exclude", "0.002,-0.004,0.0015", expect=3)
    theirs = sites_of(out)
    X = theirs.Points.astype(float)
    circles = (np.hypot(X[:, 0] - 0.01, X[:, 1] - 0.002) < 0.003) | (np.hypot(X[:, 0] - 0.002, X[:, 1] + 0.004) < 0.0015)
    np.testing.assert_array_equal(theirs.PointData["excluded"] == 1, circles)
    rows = found(out)
    assert int(rows["sites in excluded circles"]["lattice"]) == circles.sum()
    chosen = (theirs.PointData["held"] == 0) & ~circles
    assert int(rows["free sites inside"]["lattice"]) == chosen.sum()
    expect_norm(theirs, rows["displacement, rms difference"], "displacement", chosen, np.mean)


# One homogeneous deformation, also in the left half of the sheet.
def test_a_part_of_the_sheet_is_compared_where_both_are(tmp_path, once, out):
    half = tmp_path / "half"
    latcon("continuum", CASES / "quick.prm", "--quiet", "--output-dir", half, *(word.replace("=2 cm", "=1 cm") for word in SMALL))
    refused(out, ["not the same sheet"], once.lattice, half)
    compare(out, once.lattice, half, "--overlap", "--tolerance", "displacement=1e-6", "--tolerance", "first_piola_stress=1e-6")
    theirs = sites_of(out)
    X = theirs.Points.astype(float)
    np.testing.assert_array_equal(theirs.PointData["outside"] == 1, X[:, 0] > 0.01 + 1e-8)
    assert np.isnan(theirs.PointData["displacement_difference"][X[:, 0] > 0.011, :2]).all()


def test_ranks_leave_no_trace(once, tmp_path, out):
    compare(out, once.lattice, once.continuum)
    assert {"difference.pvd", "difference_sites.vtp", "difference_continuum.vtu", "results.json", "results.csv"} <= files(out).keys()
    latcon_on_ranks(2, "compare", once.lattice, once.continuum, "--output-dir", tmp_path / "ranks")
    expect_same(tmp_path / "ranks", files(out))


def test_motions_end_at_the_same_time(once, out):
    lattice, continuum = once.runs / "lattice-moves", once.runs / "continuum-moves"
    compare(out, lattice, continuum, "--time", "0.02 ms")
    assert frames(out / "difference.pvd")[0][0] / 2e-5 == pytest.approx(1., abs=1e-9)
    assert "velocity, rms difference" in found(out)
    compare(out, lattice, continuum, "--lattice-time", "0", "--continuum-time", "2e-5")
    row = found(out)["time"]
    assert (row["lattice"], float(row["continuum"])) == ("0", 2e-5)


def test_a_study_in_the_folder_is_kept(once, out):
    out.mkdir()
    (out / "run.json").write_text('{"study": "of another command"}')
    (out / ".latcon-files").write_text("run.json\n")
    latcon("compare", once.lattice, once.continuum, "--output-dir", out, "--resume")
    assert "another" in (out / "earlier-run" / "run.json").read_text()


def test_bad_input_touches_nothing(once, out):
    out.mkdir()
    (out / "results.json").write_text("of another comparison")
    # Each option names all that is wrong with it.
    refused(out, ["--tolerance speed=1", "displacement", "larger than 0"], once.lattice, once.continuum, "--tolerance", "speed=1",
            "--tolerance", "displacement=0")
    refused(out, ["--exclude 1,2: X,Y,R is wanted", "--exclude 0,0,0: the radius", "furlong"], once.lattice, once.continuum,
            "--exclude", "1,2", "--exclude", "0,0,0", "--exclude", "0,1 furlong,1")
    refused(out, ["furlong"], once.lattice, once.continuum, "--time", "1 furlong")
    refused(out, ["--time is for both"], once.lattice, once.continuum, "--time", "1", "--lattice-time", "1")
    refused(out, ["cannot be compared"], once.lattice, once.continuum, "--exclude", "0,0,1 m")
    refused(once.lattice, ["whose run.json and results.json would be lost"], once.lattice, once.continuum)
    refused(out, ["--set"], once.lattice, once.continuum, "--set", "Sheet/length=1")
    (once.runs / "pieces" / "continuum_0000.1.vtu").unlink()
    refused(out, ["continuum_0000"], once.lattice, once.runs / "pieces", "--time", "0")
    assert [(path.name, path.read_text()) for path in out.iterdir()] == [("results.json", "of another comparison")]
