"""Tests of the scripts of verification/paraview/, drawn by ParaView on a virtual display: a crack, and both sides of a comparison."""
import json
import os
import pathlib
import shutil
import subprocess

import numpy as np
import pytest
from PIL import Image

from made_up_runs import opening, write_series, write_sites
from near_tip_plots_test import write_field

from latcon.frames import Frame, write_frame

SCRIPTS = pathlib.Path(__file__).resolve().parents[2] / "verification" / "paraview"
MODULES = pathlib.Path(os.environ["LATCON_PARAVIEW"])
pytestmark = pytest.mark.skipif(not (MODULES / "paraview").is_dir() or shutil.which("Xvfb") is None, reason="no ParaView or no Xvfb")

BREAKING = 3.0
RED, GREEN = (213, 94, 0), (0, 158, 115)  # bonds beyond the breaking stretch; outline of the zone of backward motion
YELLOW = (253, 231, 37)  # the upper end of the scale


def near(pixels, colour):
    """Number of pixels with a colour."""
    return np.count_nonzero(np.abs(pixels - colour).max(axis=2) < 12)


def write_run(folder):
    """A sheet of 40 by 30 sites, stretched 2 by 1.5 times, its bonds ever more stretched to the right, and at the last
    time torn between two rows; fields around a tip."""
    columns, rows = np.meshgrid(np.arange(40), np.arange(30))
    reference = np.column_stack((columns.ravel(), rows.ravel() - 14.5)) * 1e-3
    along, across = grid_bonds(40, 30)
    for name, torn in (("lattice-0000.vtp", 0), ("lattice-0001.vtp", 30)):
        holds = ~((across[:, 0] // 40 == 14) & (across[:, 0] % 40 < torn))
        bonds = np.concatenate((along, across[holds]))
        speed = np.linspace(0, 40, 1200)
        fields = {"displacement": reference * (1.0, 0.5), "velocity": np.column_stack((speed, 0 * speed)),
                  "cauchy_stress": opening(1e4 * speed), "damage": speed / 40}
        write_sites(folder / name, reference, fields, bonds, 1.0 + 2.4 * reference[bonds[:, 0], 0] / 0.04)  # up to 3.34
    write_series(folder / "lattice.pvd", {"lattice-0000.vtp": 0.0, "lattice-0001.vtp": 2e-3})
    (folder / "run.json").write_text(json.dumps({"entries": {"Fracture/breaking stretch": str(BREAKING)}}))
    (folder / "crack.csv").write_text("t,X,Y,x,y\n0,0.001,0,0.002,0\n0.001,0.03,0,0.06,0\n")
    (folder / "crack.json").write_text('{"pattern": "straight", "speed_laboratory": 50.0}')
    (folder / "near_tip.json").write_text('{"samples": 7, "sampled_to": 0.031}')
    write_field(folder / "near_tip_folded.vti")


def grid_bonds(columns, rows):
    """Bonds along x and along y of a square grid of sites."""
    number = np.arange(columns * rows).reshape(rows, columns)
    return [np.column_stack((a.ravel(), b.ravel())) for a, b in ((number[:, :-1], number[:, 1:]), (number[:-1], number[1:]))]


WIDTH, HEIGHT = 0.06, 0.03  # of the sheet [m]
SPACING = 0.5e-3  # [m]


def write_difference(folder):
    """Displacement along x that increases with x, equal on both sides except in the upper right quarter."""
    def vectors(x):
        return np.column_stack((x, 0 * x))
    nx, ny = round(WIDTH / SPACING) + 1, round(HEIGHT / SPACING) + 1
    x, y = np.meshgrid(SPACING * np.arange(nx), SPACING * np.arange(ny))
    position = np.column_stack((x.ravel(), y.ravel()))
    off = np.where((position[:, 0] > 0.5 * WIDTH) & (position[:, 1] > 0.5 * HEIGHT), 1e-4, 0.0)
    u = 0.1 * position[:, 0]
    # The stress of sites that lack bonds is meaningless.
    complete = (position[:, 1] > 0.25 * HEIGHT) & (position[:, 1] < 0.75 * HEIGHT)
    stress = 1e5 + position[:, 0]
    bonds = np.concatenate(grid_bonds(nx, ny))
    write_sites(folder / "difference_sites.vtp", position, {
        "displacement": vectors(u + off), "displacement_continuum": vectors(u), "displacement_difference": vectors(off),
        "cauchy_stress": opening(np.where(complete, stress, -1e9)), "cauchy_stress_continuum": opening(np.where(complete, stress, 0.0)),
        "cauchy_stress_difference": opening(0.0 * stress), "complete": complete.astype(float)}, bonds, np.ones(len(bonds)))
    corners = np.array([(0, 0), (WIDTH, 0), (WIDTH, HEIGHT), (0, HEIGHT)], dtype=float)
    write_frame(folder / "difference_continuum.vtu", Frame(
        0.0, corners, corners, np.empty((0, 2), int), np.empty(0),
        {"displacement": vectors(0.1 * corners[:, 0]), "cauchy_stress": opening(1e5 + corners[:, 0])}, {}, {}, np.array([[0, 1, 2, 3]])))


@pytest.fixture(scope="module")
def folder(module_path):
    """Folder of a crack and of the files of a comparison."""
    write_run(module_path)
    write_difference(module_path)
    return module_path


@pytest.fixture(scope="module")
def script(module_path):
    """Runs a script with ParaView's modules, like pvpython, with the interpreter for which ParaView was built."""
    read_end, write_end = os.pipe()
    # -displayfd: writes the number once connections are accepted; -noreset: continues after the last one closes.
    display = subprocess.Popen(["Xvfb", "-displayfd", str(write_end), "-noreset", "-nolisten", "tcp", "-screen", "0", "1280x1024x24"],
                               pass_fds=[write_end], stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    os.close(write_end)
    with os.fdopen(read_end) as answer:
        number = answer.readline().strip()
    environment = dict(os.environ, DISPLAY=f":{number}", PYTHONPATH=str(MODULES), PYTHONDONTWRITEBYTECODE="1",
                       OMPI_ALLOW_RUN_AS_ROOT="1", OMPI_ALLOW_RUN_AS_ROOT_CONFIRM="1")
    yield lambda name, *arguments: subprocess.run(["/usr/bin/python3", str(SCRIPTS / name), *map(str, arguments)], capture_output=True,
                                                  text=True, timeout=300, env=environment, check=False)
    display.terminate()
    display.wait()


@pytest.fixture
def picture(script, folder, tmp_path):
    """Colours of a screenshot of a script."""
    def draw(name, *arguments):
        run = script(name, folder, "--screenshot", tmp_path / "picture.png", *arguments)
        assert run.returncode == 0, run.stderr
        return np.asarray(Image.open(tmp_path / "picture.png").convert("RGB")).astype(int)
    return draw


def test_sheet_shows_bonds_beyond_the_breaking_stretch_and_the_crack(picture):
    torn, whole = (picture("deformed_sheet.py", "--time", time) for time in ("2", "0"))
    for pixels in (torn, whole):
        assert near(pixels, RED) > 300
        # The sheet is 78 by 43.5 mm as deformed, with bonds of 2 mm along x.
        shown = np.abs(pixels[40:-100] - 255).max(axis=2) > 60
        rows, columns = np.flatnonzero(shown.mean(axis=1) > 0.3), np.flatnonzero(shown.mean(axis=0) > 0.2)
        assert np.ptp(columns) / np.ptp(rows) == pytest.approx(78 / 43.5, abs=0.05)
    # A quarter of the bonds between two rows in the middle remain.
    shown = [np.count_nonzero(np.abs(pixels - 255).max(axis=2) > 60, axis=1) for pixels in (torn, whole)]
    middle = int(np.argmax(shown[1] - shown[0]))
    assert shown[0][middle] < 0.5 * shown[1][middle]


def test_sheet_shows_other_fields(picture):
    pictures = [picture("deformed_sheet.py", "--field", field)
                for field in ("speed", "opening-stress", "damage")]
    for pixels in pictures:
        assert near(pixels, RED) == 0
        assert pixels.std() > 10
    assert np.abs(pictures[0] - pictures[1]).max(axis=2).astype(bool).mean() > 0.05


def test_near_the_tip_what_moves_back_is_outlined(picture):
    pixels = picture("near_tip.py")
    left, right = np.split(pixels, 2, axis=1)
    assert near(right, GREEN) > 200
    assert near(left, GREEN) == 0
    assert near(left, RED) > 100


def test_near_the_tip_stress_is_highest_there(picture):
    right = np.split(picture("near_tip.py", "--field", "opening-stress"), 2, axis=1)[1]
    rows, columns = np.nonzero(np.abs(right[:-180] - YELLOW).max(axis=2) < 25)
    assert len(rows) > 20
    # The tip is 20 of 36 pitches from the left end of the sheet, which fills nine tenths of the view.
    assert np.median(columns) / right.shape[1] == pytest.approx(0.05 + 0.9 * 20 / 36, abs=0.06)


def sheet(view):
    """The part of a view between its title and its bar that is not white."""
    filled = np.abs(view - 255).max(axis=2) > 40
    rows = np.flatnonzero(filled.mean(axis=1) > 0.8)  # text and colour bars are shorter
    columns = np.flatnonzero(filled[rows].mean(axis=0) > 0.7)
    return view[rows[0]:rows[-1] + 1, columns[0]:columns[-1] + 1]


def at(sheet, x, y):
    """Mean colour about a place, as shares of the width and, from the bottom, of the height."""
    row, column = round((1 - y) * len(sheet)), round(x * sheet.shape[1])
    return sheet[row - 5:row + 6, column - 5:column + 6].reshape(-1, 3).mean(axis=0)


def test_shows_both_sides_alike_and_their_difference(picture):
    left, middle, right = map(sheet, np.split(picture("side_by_side.py"), 3, axis=1))
    # 0.066 by 0.03 m as deformed.
    assert middle.shape[1] / middle.shape[0] == pytest.approx(2.2, abs=0.03)
    for x, y in ((0.1, 0.5), (0.4, 0.3), (0.9, 0.2)):
        assert abs(at(left, x, y) - at(middle, x, y)).max() < 30, (x, y)
    assert abs(at(middle, 0.1, 0.5) - at(middle, 0.9, 0.5)).max() > 100
    for x, y in ((0.25, 0.25), (0.25, 0.75), (0.75, 0.25)):  # black is none
        assert at(right, x, y).max() < 30, (x, y)
    assert at(right, 0.75, 0.75).min() > 100


def test_shows_sites_that_lack_bonds_in_grey(picture):
    views = np.split(picture("side_by_side.py", "--field", "cauchy_stress", "--component", "yy", "--undeformed"), 3, axis=1)
    left, middle, right = map(sheet, views)
    assert len(left) / len(middle) == pytest.approx(1, abs=0.03)  # none is left out
    assert len(right) / len(middle) == pytest.approx(1, abs=0.03)
    for view in (left, right):
        for y in (0.1, 0.9):
            assert np.ptp(at(view, 0.5, y)) < 6
            assert at(view, 0.5, y).mean() == pytest.approx(0.75 * 255, abs=6)
    ends = [at(left, x, 0.5) for x in (0.05, 0.95)]
    assert abs(ends[0] - ends[1]).max() > 100  # the scale is that of the sites that are coloured
    titles = [np.count_nonzero(view[:40].min(axis=2) < 128) for view in views]
    assert min(titles[0], titles[2]) > 2 * titles[1]  # and the title states it


@pytest.mark.parametrize("name, place, arguments, status, part", [
    ("deformed_sheet.py", "none", [], 2, "lattice.pvd"), ("deformed_sheet.py", "", ["--field", "colour"], 2, "opening-stress"),
    ("near_tip.py", "none", [], 2, "near_tip_folded.vti"), ("near_tip.py", "", ["--unfolded"], 2, "near_tip.vti"),
    ("side_by_side.py", "none", [], 2, "difference_sites.vtp"), ("side_by_side.py", "", ["--component", "z"], 2, "x, y"),
    ("side_by_side.py", "", ["--field", "speed"], 2, "displacement"),
    ("side_by_side.py", "", ["--field", "velocity", "--screenshot", "/dev/null"], 1, "velocity")])
def test_what_cannot_be_shown_is_refused(script, folder, name, place, arguments, status, part):
    run = script(name, folder / place, *arguments)
    assert run.returncode == status
    assert part in run.stderr
