#!/usr/bin/python3
"""Tests of the report with synthetic runs: text, pictures, rejected files and exit codes."""
import base64
import contextlib
import io
import json
import re
import shutil
import subprocess
import sys
import tempfile
import unittest
from html.parser import HTMLParser
from pathlib import Path
from unittest import mock

import numpy as np
from PIL import Image
from vtkmodules.util.numpy_support import numpy_to_vtk
from vtkmodules.vtkCommonCore import vtkPoints
from vtkmodules.vtkCommonDataModel import vtkCellArray, vtkPolyData
from vtkmodules.vtkIOXML import vtkXMLPolyDataWriter

sys.dont_write_bytecode = True
FOLDER = Path(__file__).resolve().parents[2] / "verification" / "report"
sys.path.insert(0, str(FOLDER))

import live
import report

# The crack of the made-up run [m].
WAVELENGTH, AMPLITUDE, PHASE, OFFSET, SLOPE = 0.02, 0.0012, 0.7, 0.0003, 0.004
BEGIN, END = 0.03, 0.09
PICTURES = ("sheet.png", "sheet_fields.png", "crack_path.png", "energy.png")
MOTION_FRAMES = 5
VOID = {"meta", "br", "hr", "img", "link", "input", "source"}


def path_of_tip(X):
    """The sinusoid of the made-up run about the middle of the window."""
    distance = X - (BEGIN + END) / 2
    return OFFSET + SLOPE * distance + AMPLITUDE * np.sin(2 * np.pi * distance / WAVELENGTH + PHASE)


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


def write_fracture(folder, rows):
    """A run with an oscillating crack."""
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
             "amplitude_uncertainty": 1e-4}
    (folder / "crack.json").write_text(json.dumps(crack))
    near_tip = {"samples": 84, "reason": "", "negative_zone_area": 1.4546e-5, "negative_zone_area_uncertainty": 1.88e-6,
                "samples_with_vortex": 0.25, "samples_with_vortex_uncertainty": 0.13,
                "opening_stress_peak_4d": 660930.0, "opening_stress_peak_4d_uncertainty": None, "wedge_angle": None,
                "wedge_angle_uncertainty": None, "units": "SI"}
    (folder / "near_tip.json").write_text(json.dumps(near_tip))
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


class ReportCase(unittest.TestCase):
    def setUp(self):
        temporary = tempfile.TemporaryDirectory()
        self.addCleanup(temporary.cleanup)
        self.folder = Path(temporary.name) / "runs"

    def report(self, *options, expect, folder=None):
        """Runs the script in this process. @return (stdout, stderr)"""
        streams = [io.TextIOWrapper(io.BytesIO(), encoding="utf-8") for _ in range(2)]
        with contextlib.redirect_stdout(streams[0]), contextlib.redirect_stderr(streams[1]):
            exit_code = report.main([str(folder or self.folder), *options])
        texts = []
        for stream in streams:
            stream.seek(0)
            texts.append(stream.read())
        self.assertEqual(exit_code, expect, texts)
        return tuple(texts)

    def page(self, folder=None):
        html = ((folder or self.folder) / "report.html").read_text(encoding="utf-8")
        page = Page(html)
        self.assertEqual(page.open, [])
        return html, page


class WholePage(ReportCase):
    """One page with everything, for all these tests."""

    @classmethod
    def setUpClass(cls):
        temporary = tempfile.TemporaryDirectory()
        cls.addClassCleanup(temporary.cleanup)
        cls.whole = Path(temporary.name) / "runs"
        write_fracture(cls.whole, [HOLDS, PUBLISHED])
        assert report.main([str(cls.whole), "--quiet"]) == 0

    def setUp(self):
        self.folder = self.whole

    def test_needs_nothing_beside_it(self):
        html, page = self.page()
        own = ("data:image/png;base64,", "data:image/gif;base64,", "#")
        self.assertEqual([r[:30] for r in page.references if not r.startswith(own)], [])
        bare = re.sub(r"base64,[^\"]*|^/\*! @license .*?\*/", "", html, flags=re.M)
        self.assertNotRegex(bare, r"https?://|@import|url\(|<script[^>]* src|<link|sourceMappingURL")
        self.assertIn("@license https://github.com/danvk/dygraphs", html)  # the MIT licence requires its notice
        self.assertEqual(len(page.images), len(PICTURES))

    def test_can_be_read_without_seeing_it(self):
        _, page = self.page()
        for words in page.alternatives:
            self.assertRegex(words, r"\w+ \w+ \w+")
        self.assertEqual(len(set(page.alternatives)), len(page.images))
        self.assertEqual(page.headings[0], 1)
        self.assertEqual(page.headings.count(1), 1)
        for before, after in zip(page.headings, page.headings[1:]):
            self.assertLessEqual(after, before + 1)

    def test_begins_with_what_was_found(self):
        html, _ = self.page()
        order = [html.index(words) for words in ("Holds: all", 'class="key"', 'data-plot="path', 'class="viewer"',
                                                 'data-plot="energy', 'id="claims"', "(case.prm")]
        self.assertEqual(order, sorted(order))

    def test_pictures_show_something(self):
        _, page = self.page()
        for name in PICTURES:
            png = (self.folder / name).read_bytes()
            self.assertIn(png, [base64.b64decode(source.partition(",")[2]) for source in page.images])
            pixels = np.asarray(Image.open(io.BytesIO(png)).convert("RGB"), dtype=float)
            self.assertEqual(pixels.shape[1], 1600)
            self.assertGreater(pixels.shape[0], 500)
            coloured = np.ptp(pixels[:len(pixels) // 2], axis=2) > 60  # colour bars are below
            self.assertGreater(coloured.mean(), 2e-3, f"{name} has no colours")
            self.assertGreater(pixels.std(), 10, f"{name} is blank")


class ReportTest(ReportCase):
    def test_says_what_was_checked_measured_and_given(self):
        write_verification(self.folder / "verify", [HOLDS, REPORTED])
        write_fracture(self.folder / "fig", [HOLDS, PUBLISHED])
        out, err = self.report(expect=0)
        self.assertEqual(err, "")
        _, page = self.page()
        self.assertRegex(" ".join(page.text.split()), r"· measured Lagrangian crack speed 20.00 ± 0.20 – m/s –")
        for words in ("c² <of> a wave", "1.25", "✓ holds", "2.00e-03", "0.01", "· reported", "0.042", "oscillating",
                      "it winds", "2.1", "2.000 ± 0.015", "-4.8 %", "breaking stretch", "1.2.3", "verify, fig",
                      "Holds: all 3 checks"):
            self.assertIn(words, page.text)
        self.assertNotIn("fails", page.text.replace("#fails", "").replace("holds fails reported", ""))
        lines = out.splitlines()
        self.assertLessEqual(max(map(len, lines)), 120)
        self.assertEqual(lines[-1], f"{self.folder}/report.html")
        self.assertRegex(out, r"verify +energy +1 +0 +1 +0\.2\n")
        self.assertRegex(out, r"fig +wavelength, undeformed +cm +2\.1 +2\.000 \+- 0\.015 +-4\.8 % +holds")

    def test_leaves_out_studies_beside_runs(self):
        write_verification(self.folder, [FAILS])
        (self.folder / "study.json").write_text("{}")
        write_verification(self.folder / "verify", [HOLDS])
        out, _ = self.report(expect=0)
        self.assertIn("energy", out)
        self.assertNotIn("prestretch", out)
        (self.folder / "verify" / "results.json").unlink()
        (self.folder / "verify" / "run.json").unlink()
        out, _ = self.report(expect=3)  # there is nothing else
        self.assertIn("prestretch", out)

    def test_shows_what_was_measured_near_the_tip(self):
        write_fracture(self.folder, [HOLDS])
        self.report(expect=0)
        text = " ".join(self.page()[1].text.split())
        self.assertIn("Near the tip, from 84 samples", text)
        for row in ("negative velocity, area 14.5 ± 1.9 mm²", "samples with a vortex 25 ± 13 %",
                    "opening stress, peak 0.6609 MPa", "wedge angle – degrees"):
            self.assertIn(row, text)
        self.assertNotIn("asymmetry 0", text)  # not in the file
        for samples, words in ((0, "Nothing was measured: it <rested>."),
                               (3, "Not all quantities could be measured: it <rested>.")):
            (self.folder / "near_tip.json").write_text(json.dumps({"samples": samples, "reason": "it <rested>"}))
            self.report(expect=0)
            self.assertIn(words, self.page()[1].text)
        for damaged in ({"samples": 84}, {"samples": 84, "reason": "", "wedge_angle": "wide"}):
            (self.folder / "near_tip.json").write_text(json.dumps(damaged))
            self.assertRegex(self.report(expect=2)[1], r"near_tip.json: (\"reason\" is missing|wedge_angle is 'wide')")
        (self.folder / "near_tip.json").unlink()
        self.report(expect=0)
        self.assertNotIn("Near the tip", self.page()[1].text)

    def test_a_failing_row_is_first_and_exits_3(self):
        write_verification(self.folder, [HOLDS, FAILS, check_row("energy", "lost", "fails", error="nan", tolerance=1)])
        out, _ = self.report(expect=3)
        html, page = self.page()
        self.assertIn("Fails: 2 of 3 checks fail", page.text)
        self.assertLess(html.rindex("lost"), html.index("c² &lt;of&gt; a wave"))
        self.assertRegex(out, r"prestretch: traction +17\n")
        self.assertRegex(out, r"energy: lost +inf\n")

    def test_a_side_that_is_no_number_fails(self):
        for side in ("lattice", "continuum", "theory", "error", "tolerance"):
            for value in ("nan", "inf", "-inf"):
                row = check_row("energy", "side", "fails", **{"error": 0.0, "tolerance": 1.0, side: value})
                write_verification(self.folder, [row])
                self.assertRegex(self.report(expect=3)[0], r"energy: side +inf\n")
                (self.folder / "results.json").write_text(json.dumps({"claims": [{**row, "verdict": "holds"}]}))
                self.assertIn("contradicts its numbers", self.report(expect=2)[1])
                shutil.rmtree(self.folder)

    def test_without_the_library_of_the_plots_pictures_take_their_place(self):
        write_fracture(self.folder, [HOLDS])
        with mock.patch.object(live, "DYGRAPHS", self.folder):
            self.report("--quiet", expect=0)
        html, _ = self.page()
        self.assertNotIn("new Dygraph", html)
        self.assertIn('class="viewer"', html)
        stills = html.index('id="stills-0"')
        for name in ("The crack in the undeformed sheet", "Energy balance per metre of sheet thickness"):
            self.assertLess(html.index(f'alt="runs: {name}'), stills)

    def test_runs_as_a_script(self):
        write_verification(self.folder, [FAILS])
        command = ["/usr/bin/python3", str(FOLDER / "report.py"), str(self.folder)]
        loud = subprocess.run(command, capture_output=True, text=True, check=False)
        quiet = subprocess.run(command + ["--quiet"], capture_output=True, text=True, check=False)
        self.assertEqual((loud.returncode, quiet.returncode), (3, 3))
        self.assertTrue(loud.stdout.endswith(f"\n{self.folder}/report.html\n"), loud.stdout)
        self.assertEqual((loud.stderr, quiet.stdout, quiet.stderr), ("", "", ""))

    def test_an_interrupted_run_is_shown_as_far_as_it_went(self):
        write_fracture(self.folder / "cut", [HOLDS])
        for name in ("results.json", "crack.json", "lattice-0000.vtp"):
            (self.folder / "cut" / name).unlink()
        (self.folder / "cut" / "run.json").write_text(json.dumps({"version": "1.2.3", "exit_code": None}))
        self.assertIn("unfinished", self.report(expect=0)[0])
        _, page = self.page()
        self.assertIn("Not complete", page.text)
        self.assertIn("no crack.json", page.text)
        self.assertIn("has no data for it: sheet.png, sheet_fields.png", page.text)
        self.assertEqual(len(page.images), 2)

    def test_a_skipped_verification_is_said(self):
        write_fracture(self.folder, [PUBLISHED])
        (self.folder / "run.json").write_text(json.dumps({"exit_code": 0, "skip_verification": True}))
        out, _ = self.report(expect=0)
        html, page = self.page()
        self.assertIn("without verification of its material and pre-stretch", page.text)
        self.assertIn("Not verified: all checks made hold", page.text)
        self.assertIn('class="banner warns"', html)
        self.assertIn("holds, not verified", page.text)
        self.assertNotRegex(html, r'class="[^"]*\bholds\b')  # nothing is green
        self.assertIn("not verified", out)
        # Together with a verified run as well.
        write_verification(self.folder.parent / "both" / "verify", [HOLDS])
        write_fracture(self.folder.parent / "both" / "fig", [PUBLISHED])
        (self.folder.parent / "both" / "fig" / "run.json").write_text(
            json.dumps({"exit_code": 0, "skip_verification": True}))
        self.report("--quiet", expect=0, folder=self.folder.parent / "both")
        self.assertNotIn('class="banner holds"', self.page(self.folder.parent / "both")[0])

    def test_reused_verdicts_are_said(self):
        write_fracture(self.folder, [HOLDS, PUBLISHED])
        verification = {"hash": "abc", "reused": True, "checked_at": "2026-01-02T03:04:05Z"}
        (self.folder / "run.json").write_text(json.dumps({"exit_code": 0, "verification": verification}))
        self.report("--quiet", expect=0)
        self.assertIn("cached verdicts of 2026-01-02T03:04:05Z", self.page()[1].text)

    def test_refuses_a_folder_without_a_run(self):
        self.folder.mkdir()
        self.assertIn("no run found", self.report(expect=2)[1])
        self.assertIn("missing", self.report(expect=2, folder=self.folder / "missing")[1])

    def test_names_the_damaged_file(self):
        write_fracture(self.folder, [HOLDS])
        intact = {name: (self.folder / name).read_bytes()
                  for name in ("results.json", "crack.json", "near_tip.json", "crack.csv", "energy.csv",
                               "lattice.pvd", "lattice-0000.vtp", "motion.pvd", "motion-0002.vtp")}
        for name, content in intact.items():
            for damaged in (content[:len(content) * 2 // 3], b"\xff\xfe"):
                with self.subTest(name=name, length=len(damaged)):
                    (self.folder / name).write_bytes(damaged)
                    (self.folder / "report.html").write_text("stale")
                    out, err = self.report(expect=2)
                    self.assertIn("cannot be read", out)
                    self.assertRegex(err, rf"\Aerror: .*{re.escape(name)}: .+\n\Z")
                    _, page = self.page()
                    self.assertRegex(page.text, rf"cannot be read, not shown : .*{re.escape(name)}: ")
                    self.assertNotIn("Holds: all", page.text)
            (self.folder / name).write_bytes(content)
        self.report("--quiet", expect=0)

    def test_one_unreadable_run_does_not_cost_the_others(self):
        write_verification(self.folder / "verify", [HOLDS, FAILS])
        write_fracture(self.folder / "fig", [HOLDS, PUBLISHED])
        write_fracture(self.folder / "damaged", [HOLDS])
        (self.folder / "damaged" / "crack.json").write_text("{")
        write_fracture(self.folder / "torn", [HOLDS])
        (self.folder / "torn" / "motion-0002.vtp").write_bytes(b"\xff\xfe")
        out, err = self.report(expect=2)
        self.assertRegex(err, r"\Aerror: .*damaged/crack.json: .*\nerror: .*torn/motion-0002.vtp: .*\n\Z")
        self.assertRegex(out, r"fig +wavelength, undeformed +cm +2\.1 +2\.000 \+- 0\.015 +-4\.8 % +holds")
        self.assertRegex(out, r"damaged +cannot be read\ntorn +cannot be read\n")
        _, page = self.page()
        for words in ("Fails: 1 of 4 checks", "damaged: cannot be read", "torn: cannot be read", "Crack: fig"):
            self.assertIn(words, page.text)

    def test_shows_runs_of_the_continuum(self):
        for name, energies in (("equilibrium", "load_factor,elastic\n0.5,1.25\n1,5\n"),
                               ("motion", "t,elastic,kinetic,micro_inertia,viscous,boundary_work,imbalance\n"
                                          "0,5,0,0,0,0,0\n0.001,4,1,0,0,0,1e-9\n")):
            write_verification(self.folder / name, [check_row("continuum", f"energy of the {name}", "reported")])
            (self.folder / name / "energy.csv").write_text(energies)
        write_fracture(self.folder / "fig", [HOLDS, PUBLISHED])
        out, err = self.report(expect=0)
        self.assertEqual(err, "")
        self.assertIn("fig", out)
        for name in ("equilibrium", "motion"):
            self.assertIn(f"energy of the {name}", self.page()[1].text)

    def test_does_not_believe_a_verdict_against_its_numbers(self):
        write_verification(self.folder, [{**FAILS, "verdict": "holds"}])
        self.assertRegex(self.report(expect=2)[1], "results.json: row 1 .* verdict 'holds' contradicts")

    def test_a_file_that_cannot_be_written_exits_5(self):
        write_verification(self.folder, [HOLDS])
        (self.folder / "report.html").mkdir()
        self.assertIn("report.html", self.report(expect=5)[1])


if __name__ == "__main__":
    unittest.main()
