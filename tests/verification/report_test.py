"""Tests of the report with synthetic runs: text, pictures, rejected files and exit codes."""
import base64
import contextlib
import io
import json
import re
import shutil
from html.parser import HTMLParser
from pathlib import Path
from unittest import mock

import numpy as np
import pytest
from PIL import Image
from vtkmodules.util.numpy_support import numpy_to_vtk
from vtkmodules.vtkCommonCore import vtkPoints
from vtkmodules.vtkCommonDataModel import vtkCellArray, vtkPolyData
from vtkmodules.vtkIOXML import vtkXMLPolyDataWriter

FOLDER = Path(__file__).resolve().parents[2] / "python" / "latcon" / "report"

from latcon.report import pages
from latcon.report.__main__ import main

# The crack of the made-up run [m].
WAVELENGTH, AMPLITUDE, PHASE, OFFSET, SLOPE = 0.02, 0.0012, 0.7, 0.0003, 0.004
BEGIN, END = 0.03, 0.09
PICTURES = ("sheet.png", "sheet_fields.png", "crack_path.png", "energy.png")
MOTION_FRAMES = 5
VOID = {"meta", "br", "hr", "img", "link", "input", "source"}


def path_of_tip(X):
    """The sinusoid of the made-up run about the middle of the window."""
    return OFFSET + SLOPE * X + AMPLITUDE * np.sin(2 * np.pi * X / WAVELENGTH + PHASE)


def check_row(claim, quantity, verdict, **numbers):
    """A row of results.json."""
    empty = dict.fromkeys(("lattice", "continuum", "theory", "error", "tolerance"))
    return {"claim": claim, "quantity": quantity, "unit": "m", **empty, **numbers, "verdict": verdict}


HOLDS = check_row("energy", "c^2 <of> a wave", "holds", lattice=1.25, error=2e-3, tolerance=1e-2)
FAILS = check_row("prestretch", "traction", "fails", lattice=3.5, continuum=3.0, error=0.17, tolerance=1e-2)
REPORTED = check_row("energy", "residual", "reported", continuum=0.042, error=0.042)
PUBLISHED = check_row("fracture", "wavelength, undeformed", "holds", lattice=WAVELENGTH, theory=0.021, error=0.048, tolerance=0.2)


def write_verification(folder, rows):
    """A run without a crack."""
    folder.mkdir(parents=True)
    (folder / "results.json").write_text(json.dumps({"claims": rows, "verdict": "holds"}))
    (folder / "run.json").write_text(json.dumps({"version": "1.2.3", "exit_code": 0,
                                                 "entries": {"Fracture/breaking stretch": "3"}}))
    (folder / "case.prm").write_text("subsection Fracture\n  set breaking stretch = 3 # default: auto\nend\n")


def write_table(path, header, columns):
    """A CSV file."""
    np.savetxt(path, np.column_stack(columns), delimiter=",", header=header, comments="", fmt="%.17g")


def write_fracture(folder, rows, has_sheet=True):
    """A run with an oscillating crack; its sheet takes most of the time of a page."""
    write_verification(folder, rows)
    X = np.linspace(0.01, 0.095, 300)
    t = X / 20
    Y = path_of_tip(X)
    write_table(folder / "crack.csv", "t,X,Y,x,y,speed,bonds_broken", (t, X, Y, 2 * X, 3 * Y, 0 * t + 20, 10 * X))
    write_table(folder / "broken_bonds.csv", "t,site,other_site,X,Y,stretch", (t, 0 * t, 0 * t + 1, X, Y, 0 * t + 3))
    write_table(folder / "energy.csv", "t,elastic,kinetic,viscous,broken,boundary_work,contact,imbalance",
                (t, 100 - 1e4 * t, 2e3 * t, 5e3 * t, 3e3 * t, 0 * t, 0 * t, 1e-6 * t))
    crack = {"pattern": "oscillating", "reason": "it winds", "window_begin": BEGIN,
             "window_end": END, "speed_lagrangian": 20.0, "speed_lagrangian_uncertainty": 0.2,
             "wavelength": WAVELENGTH, "wavelength_uncertainty": 1.5e-4, "amplitude": AMPLITUDE,
             "amplitude_uncertainty": 1e-4, "sinusoid_offset": OFFSET, "sinusoid_slope": SLOPE, "sinusoid_phase": PHASE}
    (folder / "crack.json").write_text(json.dumps(crack))
    near_tip = {"samples": 84, "reason": "", "negative_zone_area": 1.4546e-5, "negative_zone_area_uncertainty": 1.88e-6,
                "samples_with_vortex": 0.25, "samples_with_vortex_uncertainty": 0.13,
                "opening_stress_peak_4d": 660930.0, "opening_stress_peak_4d_uncertainty": None, "wedge_angle": None,
                "wedge_angle_uncertainty": None, "units": "SI"}
    (folder / "near_tip.json").write_text(json.dumps(near_tip))
    if has_sheet:
        write_sheet(folder)


def write_sheet(folder):
    """A frame of 12 by 8 sites with the file that names it and its time, and frames of the motion."""
    columns, rows = np.meshgrid(np.arange(12), np.arange(8))
    reference = np.column_stack((columns.ravel(), rows.ravel(), np.zeros(96))) * 1e-2
    ends = [(i, i + 1) for i in range(96) if i % 12 < 11]
    speed = np.linspace(0, 30, 96)
    fields = {"displacement": 1.3 * reference, "velocity": np.column_stack((speed, 0 * speed, 0 * speed)),
              "cauchy_stress": np.outer(1e4 * speed, np.eye(9)[4]), "damage": speed / 40, "site": np.arange(96)}
    stretch = np.concatenate((np.ones(96), np.linspace(1.5, 4.0, len(ends))))
    write_frame(folder / "lattice-0000.vtp", reference, fields, ends, stretch)
    write_series(folder / "lattice.pvd", {"lattice-0000.vtp": 0.004})
    names = {f"motion-{i:04}.vtp": 1e-3 * i for i in range(MOTION_FRAMES)}
    for name, time in names.items():
        fields = {"displacement": (1.3 + 20 * time) * reference, "velocity": (0.5 + 1e3 * time) * fields["velocity"]}
        write_frame(folder / name, reference, fields)
    write_series(folder / "motion.pvd", names)


def write_frame(path, reference, fields, ends=(), stretch=()):
    """A vtp file of sites, and of bonds with their stretch where there are any."""
    sheet, points, vertices, lines = vtkPolyData(), vtkPoints(), vtkCellArray(), vtkCellArray()
    points.SetData(numpy_to_vtk(reference, deep=True))
    for site in range(len(reference)):
        vertices.InsertNextCell(1, (site,))
    for bond in ends:
        lines.InsertNextCell(2, bond)
    sheet.SetPoints(points)
    sheet.SetVerts(vertices)
    sheet.SetLines(lines)
    for data, arrays in ((sheet.GetPointData(), fields), (sheet.GetCellData(), {"stretch": stretch} if len(ends) else {})):
        for name, values in arrays.items():
            array = numpy_to_vtk(np.ascontiguousarray(values), deep=True)
            array.SetName(name)
            data.AddArray(array)
    writer = vtkXMLPolyDataWriter()
    writer.SetFileName(bytes(path))
    writer.SetInputData(sheet)
    writer.EncodeAppendedDataOff()
    writer.Write()


def write_series(path, times):
    """A .pvd: {file name: time}."""
    frames = "".join(f'<DataSet timestep="{time!r}" file="{name}"/>' for name, time in times.items())
    path.write_text(f'<VTKFile type="Collection"><Collection>{frames}</Collection></VTKFile>')


class Page(HTMLParser):
    """Reads a page: its text, its references, and whether its elements are properly nested."""

    def __init__(self, html):
        super().__init__()
        self.open, self.images, self.references, self.headings, self.text = [], [], [], [], ""
        self.alternatives = []  # of the images
        self.kinds = []  # classes of open elements
        self.feed(html)
        self.close()

    def handle_starttag(self, tag, attributes):
        self.references += [value for name, value in attributes if name in ("src", "href", "srcset", "data")]
        if tag == "img":
            self.images.append(dict(attributes)["src"])
            self.alternatives.append(dict(attributes).get("alt") or "")
        if re.fullmatch("h[1-6]", tag):
            self.headings.append(int(tag[1]))
        if tag in ("table", "pre") and not any("scroll" in (kind or "") for kind in self.kinds):
            raise AssertionError(f"<{tag}> would make the page scroll")
        if tag not in VOID:
            self.open.append(tag)
            self.kinds.append(dict(attributes).get("class"))

    def handle_endtag(self, tag):
        if not self.open or self.open.pop() != tag:
            raise AssertionError(f"</{tag}> closes nothing")
        self.kinds.pop()

    def handle_data(self, data):
        if not {"style", "script"} & set(self.open):
            self.text += data + " "


def drawn(folder, *options, expect):
    """Runs the script in this process. @return (stdout, stderr)"""
    streams = [io.TextIOWrapper(io.BytesIO(), encoding="utf-8") for _ in range(2)]
    with contextlib.redirect_stdout(streams[0]), contextlib.redirect_stderr(streams[1]):
        exit_code = main(["report", str(folder), *options])
    texts = []
    for stream in streams:
        stream.seek(0)
        texts.append(stream.read())
    assert exit_code == expect, texts
    return tuple(texts)


def read_page(folder):
    html = (folder / "report.html").read_text(encoding="utf-8")
    page = Page(html)
    assert page.open == []
    return html, page


# One page with everything, for all these tests.
@pytest.fixture(scope="module")
def whole(module_path):
    whole = module_path / "runs"
    write_fracture(whole, [HOLDS, PUBLISHED])
    assert main(["report", str(whole), "--quiet"]) == 0
    return whole


def test_needs_nothing_beside_it(whole):
    html, page = read_page(whole)
    own = ("data:image/png;base64,", "data:image/gif;base64,", "#")
    assert [r[:30] for r in page.references if not r.startswith(own)] == []
    bare = re.sub(r"base64,[^\"]*|^/\*! @license .*?\*/", "", html, flags=re.M)
    assert not re.search(r"https?://|@import|url\(|<script[^>]* src|<link|sourceMappingURL", bare)
    assert "@license https://github.com/danvk/dygraphs" in html  # the MIT licence requires its notice
    assert len(page.images) == len(PICTURES)


def test_pictures_show_something(whole):
    _, page = read_page(whole)
    for name in PICTURES:
        png = (whole / name).read_bytes()
        assert png in [base64.b64decode(source.partition(",")[2]) for source in page.images]
        pixels = np.asarray(Image.open(io.BytesIO(png)).convert("RGB"), dtype=float)
        assert pixels.shape[1] == 1600
        assert pixels.shape[0] > 500
        coloured = np.ptp(pixels[:len(pixels) // 2:4, ::4], axis=2) > 60  # colour bars are below
        assert coloured.mean() > 2e-3, f"{name} has no colours"
        assert pixels.std() > 10, f"{name} is blank"


def test_says_what_was_checked_measured_and_given(runs):
    write_verification(runs / "verify", [HOLDS, REPORTED])
    write_fracture(runs / "fig", [HOLDS, PUBLISHED])
    out, err = drawn(runs, expect=0)
    assert err == ""
    _, page = read_page(runs)
    assert re.search(r"· measured Lagrangian crack speed 20.00 ± 0.20 – m/s –", " ".join(page.text.split()))
    for words in ("c² <of> a wave", "1.25", "✓ holds", "2.00e-03", "0.01", "· reported", "0.042", "oscillating",
                  "it winds", "2.1", "2.000 ± 0.015", "-4.8 %", "breaking stretch", "1.2.3", "verify, fig",
                  "Holds: all 3 checks"):
        assert words in page.text
    assert "fails" not in page.text.replace("#fails", "").replace("holds fails reported", "")
    lines = out.splitlines()
    assert max(map(len, lines)) <= 120
    assert lines[-1] == f"{runs}/report.html"
    assert re.search(r"verify +energy +1 +0 +1 +0\.2\n", out)
    assert re.search(r"fig +wavelength, undeformed +cm +2\.1 +2\.000 \+- 0\.015 +-4\.8 % +holds", out)


def test_leaves_out_studies_beside_runs(runs):
    write_verification(runs, [FAILS])
    (runs / "study.json").write_text("{}")
    write_verification(runs / "verify", [HOLDS])
    out, _ = drawn(runs, expect=0)
    assert "energy" in out
    assert "prestretch" not in out
    (runs / "verify" / "results.json").unlink()
    (runs / "verify" / "run.json").unlink()
    out, _ = drawn(runs, expect=3)  # there is nothing else
    assert "prestretch" in out


def test_shows_what_was_measured_near_the_tip(runs):
    write_fracture(runs, [HOLDS], has_sheet=False)
    drawn(runs, expect=0)
    text = " ".join(read_page(runs)[1].text.split())
    assert "Near the tip, from 84 samples" in text
    for row in ("negative velocity, area 14.5 ± 1.9 mm²", "samples with a vortex 25 ± 13 %",
                "opening stress, peak 0.6609 MPa", "wedge angle – degrees"):
        assert row in text
    assert "asymmetry 0" not in text  # not in the file
    for samples, words in ((0, "Nothing was measured: it <rested>."),
                           (3, "Not all quantities could be measured: it <rested>.")):
        (runs / "near_tip.json").write_text(json.dumps({"samples": samples, "reason": "it <rested>"}))
        drawn(runs, expect=0)
        assert words in read_page(runs)[1].text
    for damaged in ({"samples": 84}, {"samples": 84, "reason": "", "wedge_angle": "wide"}):
        (runs / "near_tip.json").write_text(json.dumps(damaged))
        assert re.search(r"near_tip.json: (\"reason\" is missing|wedge_angle is 'wide')", drawn(runs, expect=2)[1])
    (runs / "near_tip.json").unlink()
    drawn(runs, expect=0)
    assert "Near the tip" not in read_page(runs)[1].text


def test_a_failing_row_is_first_and_exits_3(runs):
    write_verification(runs, [HOLDS, FAILS, check_row("energy", "lost", "fails", error="nan", tolerance=1)])
    out, _ = drawn(runs, expect=3)
    html, page = read_page(runs)
    assert "Fails: 2 of 3 checks fail" in page.text
    assert html.rindex("lost") < html.index("c² &lt;of&gt; a wave")
    assert re.search(r"prestretch: traction +17\n", out)
    assert re.search(r"energy: lost +inf\n", out)


def test_a_side_that_is_no_number_fails(runs):
    for side in ("lattice", "continuum", "theory", "error", "tolerance"):
        for value in ("nan", "inf", "-inf"):
            row = check_row("energy", "side", "fails", **{"error": 0.0, "tolerance": 1.0, side: value})
            write_verification(runs, [row])
            assert re.search(r"energy: side +inf\n", drawn(runs, expect=3)[0])
            (runs / "results.json").write_text(json.dumps({"claims": [{**row, "verdict": "holds"}]}))
            assert "contradicts its numbers" in drawn(runs, expect=2)[1]
            shutil.rmtree(runs)


def test_without_the_library_of_the_plots_pictures_take_their_place(runs):
    write_fracture(runs, [HOLDS])
    with mock.patch.object(pages, "DYGRAPHS", runs):
        drawn(runs, "--quiet", expect=0)
    html, _ = read_page(runs)
    assert "new Dygraph" not in html
    assert 'class="viewer"' in html
    stills = html.index('id="stills-0"')
    for name in ("The crack in the undeformed sheet", "Energy balance per metre of sheet thickness"):
        assert html.index(f'alt="runs: {name}') < stills


def test_an_interrupted_run_is_shown_as_far_as_it_went(runs):
    write_fracture(runs / "cut", [HOLDS])
    for name in ("results.json", "crack.json", "lattice-0000.vtp"):
        (runs / "cut" / name).unlink()
    (runs / "cut" / "run.json").write_text(json.dumps({"version": "1.2.3", "exit_code": None}))
    assert "unfinished" in drawn(runs, expect=0)[0]
    _, page = read_page(runs)
    assert "Not complete" in page.text
    assert "no crack.json" in page.text
    assert "has no data for it: sheet.png, sheet_fields.png" in page.text
    assert len(page.images) == 2


def test_a_skipped_verification_is_said(runs):
    write_fracture(runs, [PUBLISHED], has_sheet=False)
    (runs / "run.json").write_text(json.dumps({"exit_code": 0, "skip_verification": True}))
    out, _ = drawn(runs, expect=0)
    html, page = read_page(runs)
    assert "without verification of its material and pre-stretch" in page.text
    assert "Not verified: all checks made hold" in page.text
    assert 'class="banner warns"' in html
    assert "holds, not verified" in page.text
    assert not re.search(r'class="[^"]*\bholds\b', html)  # nothing is green
    assert "not verified" in out
    # Together with a verified run as well.
    write_verification(runs.parent / "both" / "verify", [HOLDS])
    write_fracture(runs.parent / "both" / "fig", [PUBLISHED], has_sheet=False)
    (runs.parent / "both" / "fig" / "run.json").write_text(json.dumps({"exit_code": 0, "skip_verification": True}))
    drawn(runs.parent / "both", "--quiet", expect=0)
    assert 'class="banner holds"' not in read_page(runs.parent / "both")[0]


def test_refuses_a_folder_without_a_run(runs):
    runs.mkdir()
    assert "no run found" in drawn(runs, expect=2)[1]
    assert "missing" in drawn(runs / "missing", expect=2)[1]


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
        assert re.search(rf"\Aerror: .*{re.escape(name)}: .+\n\Z", err)
        _, page = read_page(runs)
        assert re.search(rf"cannot be read, not shown : .*{re.escape(name)}: ", page.text)
        assert "Holds: all" not in page.text
        (runs / name).write_bytes(intact[name])
    drawn(runs, "--quiet", expect=0)


def test_one_unreadable_run_does_not_cost_the_others(runs):
    write_verification(runs / "verify", [HOLDS, FAILS])
    write_fracture(runs / "fig", [HOLDS, PUBLISHED])
    write_fracture(runs / "damaged", [HOLDS])
    (runs / "damaged" / "crack.json").write_text("{")
    write_fracture(runs / "torn", [HOLDS])
    (runs / "torn" / "motion-0002.vtp").write_bytes(b"\xff\xfe")
    out, err = drawn(runs, expect=2)
    assert re.search(r"\Aerror: .*damaged/crack.json: .*\nerror: .*torn/motion-0002.vtp: .*\n\Z", err)
    assert re.search(r"fig +wavelength, undeformed +cm +2\.1 +2\.000 \+- 0\.015 +-4\.8 % +holds", out)
    assert re.search(r"damaged +cannot be read\ntorn +cannot be read\n", out)
    _, page = read_page(runs)
    for words in ("Fails: 1 of 4 checks", "damaged: cannot be read", "torn: cannot be read", "Crack: fig"):
        assert words in page.text


def test_shows_runs_of_the_continuum(runs):
    for name, energies in (("equilibrium", "load_factor,elastic\n0.5,1.25\n1,5\n"),
                           ("motion", "t,elastic,kinetic,micro_inertia,viscous,boundary_work,imbalance\n"
                                      "0,5,0,0,0,0,0\n0.001,4,1,0,0,0,1e-9\n")):
        write_verification(runs / name, [check_row("continuum", f"energy of the {name}", "reported")])
        (runs / name / "energy.csv").write_text(energies)
    write_fracture(runs / "fig", [HOLDS, PUBLISHED])
    out, err = drawn(runs, expect=0)
    assert err == ""
    assert "fig" in out
    for name in ("equilibrium", "motion"):
        assert f"energy of the {name}" in read_page(runs)[1].text


def test_does_not_believe_a_verdict_against_its_numbers(runs):
    write_verification(runs, [{**FAILS, "verdict": "holds"}])
    assert re.search("results.json: row 1 .* verdict 'holds' contradicts", drawn(runs, expect=2)[1])


def test_a_file_that_cannot_be_written_exits_5(runs):
    write_verification(runs, [HOLDS])
    (runs / "report.html").mkdir()
    assert "report.html" in drawn(runs, expect=5)[1]
