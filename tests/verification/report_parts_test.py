"""Tests of parts of the report: animation, places where it is read and written, missing packages, the curve of a path, digits."""
import base64
import functools
import io
import json
import math
import os
import re
import subprocess
import sys
import tempfile
from pathlib import Path
from unittest import mock

import numpy as np
import pytest
from PIL import Image

from report_test import (
    BEGIN, END, FOLDER, HOLDS, MOTION_FRAMES, PICTURES, drawn, path_of_tip, read_page, write_fracture)

from latcon.quantities import number_text
from latcon.report import animation, report
from latcon.report.crack_path import measured_sinusoid
from latcon.report.runs import read_run
from latcon.rows import text_table


def refusal(error):
    """What the report says where importing Pillow raises this error."""
    with tempfile.TemporaryDirectory() as folder:
        package = Path(folder, "PIL")
        package.mkdir()
        (package / "__init__.py").touch()
        (package / "Image.py").write_text(f"raise {error}")
        done = subprocess.run([sys.executable, FOLDER / "__main__.py"], env=dict(os.environ, PYTHONPATH=folder),
                              capture_output=True, text=True, check=False)
    assert done.returncode == 69, done.stderr
    assert "(apt-get install python3-pil" in done.stderr
    return done.stderr


def test_absent_package_is_named_alone():
    absent = refusal("ModuleNotFoundError(\"No module named 'PIL.Image'\", name='PIL.Image')")
    assert absent.endswith("python3-matplotlib)\n"), absent


def test_has_all_frames_and_is_small(runs):
    write_fracture(runs, [HOLDS])
    drawn(runs, "--quiet", "--animation", expect=0)
    gif, still = ((runs / f"animation.{kind}").read_bytes() for kind in ("gif", "png"))
    html, page = read_page(runs)
    assert "image/gif" not in html  # the viewer shows more in fewer bytes; its last picture is among the still ones
    assert still in [base64.b64decode(image.partition(",")[2]) for image in page.images]
    with mock.patch.object(report, "LARGEST_SHEETS", 0):  # no viewer
        drawn(runs, "--quiet", "--animation", expect=0)
    html, page = read_page(runs)
    assert 'class="viewer"' not in html
    assert gif == base64.b64decode(page.images[0].partition(",")[2])
    assert re.search(r'<source media="print, [^"]*" srcset="data:image/png;base64,', html)
    with Image.open(io.BytesIO(gif)) as film:
        assert (film.n_frames, film.info["loop"]) == (MOTION_FRAMES, 0)  # repeated for ever
        pictures, shown = [], []
        for number in range(film.n_frames):
            film.seek(number)
            pictures.append(np.asarray(film.convert("RGB"), dtype=float))
            shown.append(film.info["duration"])
    assert shown == [1250] * (MOTION_FRAMES - 1) + [2000]
    for before, after in zip(pictures, pictures[1:]):
        assert np.count_nonzero(np.abs(before - after).max(axis=2) > 60) > 500
    with Image.open(runs / "animation.png") as still:
        assert np.abs(np.asarray(still.convert("RGB"), dtype=float) - pictures[-1]).mean() < 3
    most = len(gif) // 3
    with mock.patch.object(animation, "draw_animation", functools.partial(animation.draw_animation, largest=most)):
        drawn(runs, "--quiet", "--animation", expect=0)
    assert (runs / "animation.gif").stat().st_size <= most
    with Image.open(runs / "animation.gif") as film:
        assert film.n_frames == MOTION_FRAMES


# Folders of other users, and without the usual places.
def test_page_and_pictures_are_written_elsewhere(runs):
    write_fracture(runs / "fig", [HOLDS])
    write_fracture(runs / "other", [HOLDS])
    before = {path: path.read_bytes() for path in runs.rglob("*") if path.is_file()}
    elsewhere = runs.parent / "a" / "b"
    out, _ = drawn(runs, "--output-dir", str(elsewhere), expect=0)
    assert out.splitlines()[-1] == f"{elsewhere}/report.html"
    assert {path: path.read_bytes() for path in runs.rglob("*") if path.is_file()} == before
    assert {str(path.relative_to(elsewhere)) for path in elsewhere.rglob("*") if path.is_file()} == (
        {"report.html", *(f"{run}/{name}" for run in ("fig", "other") for name in PICTURES)})
    drawn(runs, "--quiet", expect=0)
    assert read_page(runs)[0] == read_page(elsewhere)[0]


def test_a_folder_for_pictures_that_cannot_be_made_exits_5(runs):
    write_fracture(runs / "fig", [HOLDS])
    (runs.parent / "file").touch()
    assert "cannot write" in drawn(runs, "--output-dir", str(runs.parent / "file"), expect=5)[1]


def test_a_name_that_is_no_text_is_shown_with_a_question_mark(runs):
    folder = runs.parent / os.fsdecode(b"lat\xe41n")
    write_fracture(folder, [HOLDS])
    out, _ = drawn(folder, expect=0)
    assert "lat?1n/report.html" in out
    assert "latcon report: lat?1n" in read_page(folder)[1].text


def test_draws_the_sinusoid_that_was_measured(tmp_path):
    run = tmp_path / "run"
    write_fracture(run, [HOLDS], has_sheet=False)
    X = np.linspace(BEGIN, END, 500)
    assert np.array_equal(measured_sinusoid(read_run(run))(X), path_of_tip(X))
    crack = json.loads((run / "crack.json").read_text())
    (run / "crack.json").write_text(json.dumps({**crack, "sinusoid_phase": None}))
    assert measured_sinusoid(read_run(run)) is None


def test_tables_of_text_wrap_the_second_column_and_cut_nothing_off():
    long = "z" * 150
    assert long in text_table(["a", "b", "c"], [["x", "y", long]], ())
    lines = text_table(["a", "b", "c"], [["x", "words " * 40, "1"]], (2,)).splitlines()
    assert max(map(len, lines)) <= 120 and " ".join(lines).count("words") == 40


def test_gives_the_digits_that_the_uncertainty_leaves():
    assert number_text(20.0576, 0.2328) == "20.06 ± 0.23"
    assert number_text(2.34468, 0.0225) == "2.345 ± 0.022"
    assert number_text(1234.5, 120.0) == "1234 ± 120"
    for unknown in (None, 0.0, math.nan):
        assert number_text(20.0576, unknown) == "20.06"
