"""Tests of the report with made-up runs: text, pictures, animation, rejected files and exit codes."""
import functools
import io
import json
import math
import os
import re
import select
import shutil
import signal
import time
from unittest import mock

import numpy as np
import pytest
from PIL import Image

from made_up_runs import (
    BEGIN, END, FAILS, HOLDS, MOTION_FRAMES, PUBLISHED, REPORTED, check_row, drawn, expect_texts, path_of_tip, pixels, read_page, write_fracture, write_verification)

from latcon.quantities import number_text
from latcon.report import animation, pages, report
from latcon.report.crack_path import draw_crack_path, measured_sinusoid
from latcon.report.pictures import energy_shares
from latcon.report.runs import read_run
from latcon.rows import text_table

PICTURES = ("sheet.png", "sheet_fields.png", "crack_path.png", "energy.png")


def test_needs_nothing_beside_it_and_shows_pictures(runs):
    write_fracture(runs, [HOLDS, PUBLISHED])
    drawn(runs, "--quiet")
    html, page = read_page(runs)
    own = ("data:image/png;base64,", "data:image/gif;base64,", "#")
    assert [r[:30] for r in page.references if not r.startswith(own)] == []
    bare = re.sub(r"base64,[^\"]*|^/\*! @license .*?\*/", "", html, flags=re.M)
    assert not re.search(r"https?://|@import|url\(|<script[^>]* src|<link|sourceMappingURL", bare)
    assert "@license https://github.com/danvk/dygraphs" in html  # the MIT licence requires its notice
    assert sorted(page.images) == sorted((runs / name).read_bytes() for name in PICTURES)
    for png in page.images:
        colours = pixels(png)
        assert len(colours) > 500
        assert (np.ptp(colours[:len(colours) // 2:4, ::4], axis=2) > 60).mean() > 2e-3  # colour bars are below
        assert colours.std() > 10
    with mock.patch.object(pages, "DYGRAPHS", runs):  # without the library of the plots
        drawn(runs, "--quiet")
    html, _ = read_page(runs)
    assert "new Dygraph" not in html
    assert 'class="viewer"' in html
    for name in ("The crack in the undeformed sheet", "Energy balance per metre of sheet thickness"):
        assert html.index(f'alt="runs: {name}') < html.index('id="stills-0"')


def verified_and_measured(runs):
    write_verification(runs / "verify", [HOLDS, REPORTED])
    write_fracture(runs / "fig", [HOLDS, PUBLISHED])
    for name, samples in (("rested", 0), ("few", 3)):
        write_fracture(runs / name, [HOLDS], has_sheet=False)
        (runs / name / "near_tip.json").write_text(json.dumps({"samples": samples, "reason": "it <rested>"}))


def failing_and_unreadable(runs):
    write_verification(runs / "verify", [HOLDS, FAILS, check_row("energy", "lost", "fails", error="nan", tolerance=1)])
    write_fracture(runs / "cut", [HOLDS], has_sheet=False, exit_code=None)
    for name in ("results.json", "crack.json"):
        (runs / "cut" / name).unlink()
    for name, energies in (("equilibrium", "load_factor,elastic\n0.5,1.25\n1,5\n"),
                           ("motion", "t,elastic,kinetic,micro_inertia,viscous,boundary_work,imbalance\n"
                                      "0,5,0,0,0,0,0\n0.001,4,1,0,0,0,1e-9\n")):
        write_verification(runs / name, [check_row("continuum", f"energy of the {name}", "reported")])
        (runs / name / "energy.csv").write_text(energies)
    for name in ("damaged", "torn"):
        write_fracture(runs / name, [HOLDS, PUBLISHED], has_sheet=name == "torn")
    (runs / "damaged" / "crack.json").write_text("{")
    (runs / "torn" / "motion-0002.vtp").write_bytes(b"\xff\xfe")


def not_verified_beside_verified(runs):
    write_fracture(runs / "fig", [PUBLISHED], has_sheet=False, skip_verification=True)
    write_verification(runs / "verify", [HOLDS])


@pytest.mark.parametrize("write, expect", [(verified_and_measured, 0), (failing_and_unreadable, 2), (not_verified_beside_verified, 0)])
def test_says_what_was_checked_measured_and_given(runs, write, expect):
    write(runs)
    out, err = drawn(runs, expect=expect)
    assert max(map(len, out.splitlines())) <= 120
    expect_texts(runs, write.__name__, out + err)


def test_a_crack_without_run_json_is_not_shown_as_verified(runs):
    write_fracture(runs, [HOLDS], has_sheet=False)
    (runs / "run.json").unlink()
    (runs / "crack.json").write_text(json.dumps(json.loads((runs / "crack.json").read_text()) | {"skip_verification": True}))
    assert "not verified" in drawn(runs)[0] and "Not verified" in read_page(runs)[1].text


def test_leaves_out_studies_beside_runs(runs):
    write_verification(runs, [FAILS])
    (runs / "study.json").write_text("{}")
    write_verification(runs / "verify", [HOLDS])
    out, _ = drawn(runs)
    assert "energy" in out
    assert "prestretch" not in out
    shutil.rmtree(runs / "verify")
    assert "prestretch" in drawn(runs, expect=3)[0]  # there is nothing else


def test_names_what_is_wrong_near_the_tip(runs):
    write_fracture(runs, [HOLDS], has_sheet=False)
    for damaged in ({"samples": 84}, {"samples": 84, "reason": "", "wedge_angle": "wide"}):
        (runs / "near_tip.json").write_text(json.dumps(damaged))
        assert re.search(r"near_tip.json: (\"reason\" is missing|wedge_angle is 'wide')", drawn(runs, expect=2)[1])
    (runs / "near_tip.json").unlink()
    drawn(runs)
    assert "Near the tip" not in read_page(runs)[1].text


@pytest.mark.parametrize("side", ["lattice", "continuum", "theory", "error", "tolerance"])
def test_a_side_that_is_no_number_fails(runs, side):
    for value in ("nan", "inf", "-inf"):
        row = check_row("energy", "side", "fails", **{"error": 0.0, "tolerance": 1.0, side: value})
        write_verification(runs, [row])
        assert re.search(r"energy: side +inf\n", drawn(runs, expect=3)[0])
        write_verification(runs, [{**row, "verdict": "holds"}])
        assert "row 1 of \"claims\": the verdict 'holds' contradicts its numbers" in drawn(runs, expect=2)[1]


def test_what_cannot_be_shown_or_written_has_its_exit_code(runs):
    runs.mkdir()
    assert "no run found" in drawn(runs, expect=2)[1]
    assert "missing" in drawn(runs / "missing", expect=2)[1]
    write_fracture(runs / "fig", [HOLDS])
    (runs / "file").touch()
    assert "cannot write" in drawn(runs, "--output-dir", str(runs / "file"), expect=5)[1]


def test_names_the_damaged_file(runs):
    write_fracture(runs, [HOLDS])
    intact = {name: (runs / name).read_bytes()
              for name in ("results.json", "crack.json", "near_tip.json", "crack.csv", "energy.csv",
                           "lattice.pvd", "lattice-0000.vtp", "motion.pvd", "motion-0002.vtp")}
    # One file of each kind is no text at all, and all are cut short.
    for name, damaged in [*((name, content[:len(content) * 2 // 3]) for name, content in intact.items()),
                          *((name, b"\xff\xfe") for name in ("crack.json", "crack.csv", "lattice.pvd", "lattice-0000.vtp"))]:
        (runs / name).write_bytes(damaged)
        (runs / "report.html").write_text("stale")
        out, err = drawn(runs, expect=2)
        assert "cannot be read" in out
        assert re.search(rf"\Alatcon: .*{re.escape(name)}: .+\n\Z", err)
        _, page = read_page(runs)
        assert re.search(rf"cannot be read, not shown : .*{re.escape(name)}: ", page.text)
        assert "Holds: all" not in page.text
        (runs / name).write_bytes(intact[name])
    drawn(runs, "--quiet")


def test_a_drawing_that_fails_in_another_process_fails_here():
    with pytest.raises(ZeroDivisionError), report.drawn_meanwhile([lambda: 1 / 0]):
        time.sleep(1)  # so that the other process takes it


def test_drawings_end_with_the_process_that_waits_for_them():
    ended, drawing = os.pipe()
    if (parent := os.fork()) == 0:
        with report.drawn_meanwhile([lambda: (os.write(drawing, b"!"), time.sleep(60))]):
            time.sleep(1)
    os.read(ended, 1)
    os.close(drawing)
    os.kill(parent, signal.SIGKILL)
    os.waitpid(parent, 0)
    assert select.select([ended], [], [], 30)[0]


def test_animation_has_all_frames_and_is_small(runs):
    write_fracture(runs, [HOLDS])
    drawn(runs, "--quiet", "--animation")
    gif, still = ((runs / f"animation.{kind}").read_bytes() for kind in ("gif", "png"))
    html, page = read_page(runs)
    assert "image/gif" not in html  # the viewer shows more in fewer bytes; its last picture is among the still ones
    assert still in page.images
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
    assert np.abs(np.asarray(Image.open(io.BytesIO(still)).convert("RGB"), dtype=float) - pictures[-1]).mean() < 3
    most = len(gif) // 3
    with (mock.patch.object(animation, "draw_animation", functools.partial(animation.draw_animation, largest=most)),
          mock.patch.object(report, "LARGEST_SHEETS", 0)):  # no viewer
        drawn(runs, "--quiet", "--animation")
    html, page = read_page(runs)
    assert 'class="viewer"' not in html
    assert re.search(r'<source media="print, [^"]*" srcset="data:image/png;base64,', html)
    smaller = (runs / "animation.gif").read_bytes()
    assert page.images[0] == smaller and len(smaller) <= most
    with Image.open(io.BytesIO(smaller)) as film:
        assert film.n_frames == MOTION_FRAMES


def test_page_and_pictures_are_written_elsewhere(runs):
    write_fracture(runs / "fig", [HOLDS])
    write_fracture(runs / "other", [HOLDS], has_sheet=False)
    before = {path: path.read_bytes() for path in runs.rglob("*") if path.is_file()}
    elsewhere = runs.parent / "a" / "b"
    out, _ = drawn(runs, "--output-dir", str(elsewhere))
    assert out.splitlines()[-1] == f"{elsewhere}/report.html"
    assert {path: path.read_bytes() for path in runs.rglob("*") if path.is_file()} == before
    assert {str(path.relative_to(elsewhere)) for path in elsewhere.rglob("*") if path.is_file()} == (
        {"report.html", *(f"fig/{name}" for name in PICTURES), *(f"other/{name}" for name in PICTURES[2:])})


def test_a_name_that_is_no_text_is_shown_with_a_question_mark(runs):
    folder = runs.parent / os.fsdecode(b"lat\xe41n")
    write_fracture(folder, [HOLDS], has_sheet=False)
    assert "lat?1n/report.html" in drawn(folder)[0]
    assert "latcon report: lat?1n" in read_page(folder)[1].text


def test_draws_the_sinusoid_that_was_measured(runs):
    write_fracture(runs, [HOLDS], has_sheet=False)
    X = np.linspace(BEGIN, END, 500)
    assert np.array_equal(measured_sinusoid(read_run(runs))(X), path_of_tip(X))
    crack = json.loads((runs / "crack.json").read_text())
    (runs / "crack.json").write_text(json.dumps({**crack, "sinusoid_phase": None}))
    assert measured_sinusoid(read_run(runs)) is None


def test_pictures_show_the_tables(runs):
    write_fracture(runs, [HOLDS], has_sheet=False)
    run = read_run(runs)
    with mock.patch("latcon.report.crack_path.save") as save:
        draw_crack_path(run, "path.png")
    above, below = save.call_args.args[0].axes[:2]
    for shown, table in ((above.lines[0].get_xydata(), run.tip), (below.collections[0].get_offsets(), run.broken)):
        np.testing.assert_allclose(shown, 100 * np.transpose([table["X"], table["Y"]]), rtol=1e-12)  # [cm]
    released, shares = energy_shares({**dict.fromkeys(("kinetic", "contact", "broken"), np.zeros(3)), "viscous": np.array([1, 2, 4]),
                                      "elastic": np.array([9, 8, 6]), "boundary_work": np.array([1, 2, 3])})
    assert (released.tolist(), [(name, values.tolist()) for name, values in shares]) == ([0, 2, 5], [("viscous", [0, 1, 3])])


def test_tables_of_text_wrap_the_second_column_and_cut_nothing_off():
    long = "z" * 150
    assert long in text_table(["a", "b", "c"], [["x", "y", long]], ())
    lines = text_table(["a", "b", "c"], [["x", "words " * 40, "1"]], (2,)).splitlines()
    assert max(map(len, lines)) <= 120 and " ".join(lines).count("words") == 40


def test_gives_the_digits_that_the_uncertainty_leaves():
    assert number_text(20.0576, 0.2328) == "20.06 ± 0.23"
    assert number_text(2.34468, 0.0225) == "2.345 ± 0.022"
    assert number_text(1234.5, 120.0) == "1234 ± 120"
    assert number_text(1.23456e-4, 2e-9) == "1.234560e-04 ± 2.0e-09"
    for unknown in (None, 0.0, math.nan):
        assert number_text(20.0576, unknown) == "20.06"
