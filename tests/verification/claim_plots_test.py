#!/usr/bin/python3
"""The claims in the report: their sections, plots and error metrics, from tables with known orders and errors."""
import contextlib
import io
import json
import math
import re
import sys
import tempfile
import unittest
from pathlib import Path
from unittest import mock

import numpy as np
from PIL import Image

sys.dont_write_bytecode = True
sys.path.insert(0, str(Path(__file__).resolve().parents[2] / "verification" / "report"))

import made_up_claims
import pictures
import report
from claim_plots import MODULES, TABLES, all_plots
from claim_tables import fitted_order, groups, largest_text, range_text
from files import DamagedFile, read_table
from made_up_claims import DECAY, FIRST_ROW, RUN_ERROR, write_claims


decay_of = MODULES["intrinsic-length"].decay_of
# In the order in which they are checked.
CLAIMS = ("energy", "wave-speeds", "viscoelastic-waves", "relaxation", "intrinsic-length", "disorder", "prestretch",
          "steady-crack", "running-crack", "damage")
FULL = "--full" in sys.argv  # also the layout of the plots


def check_row(claim, number, verdict="holds"):
    """A row of results.json."""
    empty = dict.fromkeys(("lattice", "continuum", "theory"))
    error = {"holds": 1e-3, "fails": 1.0}[verdict]
    return {"claim": claim, "quantity": f"{claim} {verdict} {number}", "unit": "1", **empty, "error": error,
            "tolerance": 1e-2, "verdict": verdict}


class ClaimSections(unittest.TestCase):
    def setUp(self):
        temporary = tempfile.TemporaryDirectory()
        self.addCleanup(temporary.cleanup)
        self.folder = Path(temporary.name) / "runs"

    def write_run(self, folder, rows):
        folder.mkdir(parents=True)
        (folder / "results.json").write_text(json.dumps({"claims": rows}))
        (folder / "claims.json").write_text(json.dumps({"claims": [
            {"name": claim, "title": f"Title of {claim}", "statement": f"Statement of {claim}."} for claim in CLAIMS]}))
        (folder / "run.json").write_text(json.dumps({"version": "1.2.3", "exit_code": 0}))
        (folder / "case.prm").write_text("subsection Sheet\nend\n")

    def report(self, expect=0):
        """Runs the script. Returns the page and its messages on stderr."""
        errors = io.StringIO()
        with contextlib.redirect_stderr(errors):
            self.assertEqual(report.main([str(self.folder), "--quiet"]), expect, errors.getvalue())
        page = self.folder / "report.html"
        return page.read_text(encoding="utf-8") if page.exists() else "", errors.getvalue()

    def section(self, html, claim):
        """One claim's part of the page."""
        return re.search(rf'<section id="claim-{claim}">.*?</section>', html, re.S)[0]

    @unittest.skipUnless(FULL, "in full only")
    def test_nothing_is_cut_off_at_the_edges_of_a_plot(self):
        self.write_run(self.folder, [check_row(claim, 0) for claim in CLAIMS])
        with mock.patch.object(made_up_claims, "K", 0.3 * made_up_claims.K):  # numbers beside the axes get long
            write_claims(self.folder)
        beyond = []

        def measured(figure):
            figure.canvas.draw()
            box = figure.get_tightbbox(figure.canvas.get_renderer())  # [in]
            width, height = figure.get_size_inches()
            beyond.append(max(-box.x0, -box.y0, box.x1 - width, box.y1 - height))
            return drawn(figure)

        drawn = pictures.figure_pixels
        with mock.patch.object(pictures, "figure_pixels", measured):
            self.report()
        self.assertEqual(len(beyond), len(all_plots()))
        self.assertLess(max(beyond), 0)

    def test_each_claim_has_its_text_plots_and_error_metrics(self):
        self.write_run(self.folder, [check_row(claim, 0) for claim in CLAIMS])
        write_claims(self.folder)
        html, _ = self.report()
        metrics = {
            "energy": ("order of the local energy 2.0", "order of the filtered energy 4.00",
                       "elastic energy of the finite elements off the lattice&#x27;s by up to 1.0e-03",
                       "kinetic energy of the finite elements off the lattice&#x27;s by up to 1.0e-03",
                       "finite elements off the gradient energy by up to 2.0e-06"),
            "wave-speeds": ("order of the local continuum 2.0", "order of the gradient continuum 4.00",
                            f"a run of the lattice off the exact dispersion by up to {RUN_ERROR:.1e}",
                            "finite elements off the gradient continuum by up to 1.0e-05",
                            "continuum off the theory by up to 1.0e-04"),
            "viscoelastic-waves": ("NN, F = I, shear waves: frequency of a run off the complex modulus by up to 1.2e-04",),
            "relaxation": ("NN+NNN, velocity Verlet: off the closed form by up to 0.0e+00",),
            "intrinsic-length": (f"{DECAY:+.4f} (theory {DECAY:+.4f})", f"(theory {FIRST_ROW:+.3e})",
                                 "NN: no layer, every row within 3.0e-16", "off the exact one by up to 1.0e-02"),
            "disorder": ("NN, bulk modulus: mean off the effective medium by up to", "reduction by disorder 6.70e-03"),
            "prestretch": ("local: order of displacement 1.00, stress 1.00, energy 1.00, reaction 1.00, shape 1.00",
                           "gradient: order of displacement 2.00, stress 2.00, energy 2.00, reaction 2.00<"),
            "running-crack": ("NN+NNN: most negative velocity ahead of the tip [m/s]: lattice -1.00, local continuum "
                              "-0.50, gradient continuum -0.50",
                              "NN: most negative velocity ahead of the tip [m/s]: lattice -1.00, local continuum -0.50<"),
            "steady-crack": ("β = 0.5: speed off the exact solution by up to 1.0e-04",),
            "damage": ("NN+NNN, local law, h = 0.5 ξ: damage off the closed form by up to 1.0e-03",
                       "NN, with gradient energy, h = 0.25 ξ: damage off the closed form by up to 1.0e-03"),
        }
        for claim, expected in metrics.items():
            section = self.section(html, claim)
            self.assertIn(f"{claim}: Title of {claim}", section)
            self.assertIn(f"Statement of {claim}.", section)
            plots = MODULES[claim].PLOTS
            self.assertEqual(section.count("<img "), len(plots))
            for text in expected:
                self.assertIn(text, section)
            for plot in plots:
                self.assertIn(f"({plot.name}.csv)", section)
                self.assertIn(plot.claimed, section.replace("&#x27;", "'"))
        self.assertEqual({plot.name for plot in all_plots()} | {"dispersion_runs", "steady_crack_curve"}, set(TABLES))
        for plot in all_plots():
            pixels = np.asarray(Image.open(self.folder / f"{plot.name}.png").convert("RGB"), dtype=float)
            self.assertEqual(pixels.shape[1], 1600)
            self.assertGreater((np.ptp(pixels, axis=2) > 60).mean(), 1e-3, f"{plot.name} has no colours")

    def test_what_is_missing_is_left_out(self):
        self.write_run(self.folder, [check_row("energy", 0), check_row("homemade", 0)])
        write_claims(self.folder)
        for name in TABLES:
            if name not in ("edge_layer", "dispersion_runs"):
                (self.folder / f"{name}.csv").unlink()
        html, _ = self.report()
        self.assertEqual(re.findall(r'<section id="claim-([^"]*)"', html), ["energy", "intrinsic-length", "homemade"])
        self.assertEqual(html.count("<img "), 1)
        # Claims that were not checked are not shown.
        self.assertIn("At free edges", self.section(html, "intrinsic-length"))
        self.assertNotIn("The speed of waves falls", self.section(html, "intrinsic-length"))
        self.assertIn("No quantity of this claim was checked", self.section(html, "intrinsic-length"))
        self.assertFalse((self.folder / "dispersion.png").exists())

    def test_values_that_were_not_computed_leave_gaps(self):
        self.write_run(self.folder, [])
        write_claims(self.folder)
        for name, (_, numbers) in TABLES.items():
            lines = (self.folder / f"{name}.csv").read_text().splitlines()
            header = lines[0].split(",")
            kept = {"shells", "law", "wave", "F_xx", "F_yy", "k d", "angle [deg]", "R/d", "length/d", "row", "side", "X/d", "Y/d", "part",
                    "w tau", "integrator", "t [s]", "modulus", "sheet", "beta", "driving", "breaking elongation", "exists"}
            rows = [",".join(cell if column in kept else "nan" for column, cell in zip(header, line.split(",")))
                    for line in lines[1:]]
            (self.folder / f"{name}.csv").write_text("\n".join([lines[0], *rows]) + "\n")
        html, _ = self.report()
        self.assertEqual(html.count("<img "), len(all_plots()))

    def test_damaged_table_is_named(self):
        self.write_run(self.folder, [])
        write_claims(self.folder)
        for name in TABLES:
            path = self.folder / f"{name}.csv"
            whole = path.read_text()
            header, first = whole.splitlines()[:2]
            damaged = [whole.replace(header.split(",")[-1] + "\n", "other\n", 1), whole[:whole.rindex(",")],
                       header + "\n" + first.rpartition(",")[0] + ",many\n"]
            if name == "wave_speeds":
                damaged[0] = whole.replace("bloch [m/s]", "bloch", 1)  # its last column is optional
                damaged[2] = whole.replace(",L,", ",P,", 1)
            for text in damaged:
                path.write_text(text)
                self.assertRegex(self.report(expect=2)[1], rf"\Aerror: .*{name}\.csv: .+\n\Z")
            path.write_text(whole)

    def test_failing_rows_are_never_folded(self):
        rows = [check_row("energy", number) for number in range(30)] + [check_row("wave-speeds", 0, "fails")]
        rows += [check_row("wave-speeds", number) for number in range(1, 30)]
        self.write_run(self.folder, rows)
        html, _ = self.report(expect=3)
        section = self.section(html, "wave-speeds")
        self.assertLess(html.index("claim-wave-speeds\">"), html.index("claim-energy\">"))
        self.assertLess(html.index('<section id="claim-wave-speeds"'), html.index('<section id="claim-energy"'))
        self.assertLess(section.index("wave-speeds fails 0"), section.index("<details>"))
        self.assertGreater(section.index("wave-speeds holds 1"), section.index("<details>"))
        self.assertIn("29 rows that do not fail", section)
        self.assertNotIn("<details open", self.section(html, "energy"))

    def test_plots_of_several_runs(self):
        for name in ("first", "same", "third"):
            self.write_run(self.folder / name, [check_row("intrinsic-length", 0)])
            write_claims(self.folder / name)
            for table in TABLES:
                if table != "edge_layer":
                    (self.folder / name / f"{table}.csv").unlink()
        path = self.folder / "third" / "edge_layer.csv"
        path.write_text("".join(line for line in path.read_text().splitlines(True) if not line.startswith("NN,")))
        section = self.section(self.report()[0], "intrinsic-length")
        self.assertEqual(section.count("<img "), 2)
        self.assertIn("Run first.", section)
        self.assertRegex(section, r"<details><summary>The same of the run third</summary>")


class Numbers(unittest.TestCase):
    def test_order_is_that_of_the_smallest_points(self):
        x = np.array([0.8, 0.1, 0.2, 0.4])
        self.assertAlmostEqual(fitted_order(x, 3 * x**4), 4, places=12)
        error = np.where(x < 0.5, x**2, 1.0)
        self.assertAlmostEqual(fitted_order(x, error, share=0.5), 2, places=12)
        self.assertNotAlmostEqual(fitted_order(x, error), 2, places=1)

    def test_order_needs_three_errors_above_round_off(self):
        x = np.array([0.1, 0.2, 0.4, 0.8])
        self.assertIsNone(fitted_order(x, 1e-16 * x))
        self.assertIsNone(fitted_order(x, np.array([np.nan, np.nan, 1e-3, 1e-2])))

    def test_decay_has_the_sign_of_what_alternates(self):
        self.assertAlmostEqual(decay_of(0.3 * (-0.2) ** np.arange(20)), -0.2, places=12)
        self.assertAlmostEqual(decay_of(0.3 * 0.5 ** np.arange(5)), 0.5, places=12)
        self.assertTrue(np.isnan(decay_of(np.zeros(4))))

    def test_says_how_much_was_not_computed(self):
        self.assertEqual(largest_text(np.array([-1e-7, 1e-8])), "up to 1.0e-07")
        self.assertEqual(largest_text(np.array([np.nan, 1e-7, 1e-8])), "up to 1.0e-07 (1 of 3 not computed)")
        self.assertEqual(largest_text(np.array([np.nan, np.inf])), "an amount that could not be computed (2 of 2 not computed)")
        for place in range(3):
            values = [1.98, 2.0, 2.03]
            values.insert(place, math.nan)
            self.assertEqual(range_text(values), "1.98 to 2.03 (1 of 4 not computed)")
        self.assertIsNone(range_text([None, math.nan]))

    def test_table_of_words_and_numbers(self):
        with tempfile.TemporaryDirectory() as folder:
            path = Path(folder) / "t.csv"
            path.write_text('law,"x, y [m]",z\n"a, b",1,nan\nc,2,3\n')
            table = read_table(path, ("x, y [m]", "z"), texts=("law",), finite=False)
            self.assertEqual(list(table["law"]), ["a, b", "c"])
            self.assertEqual(list(table["x, y [m]"]), [1.0, 2.0])
            self.assertEqual([key for key, _ in groups(table, "law")], [("a, b",), ("c",)])
            with self.assertRaisesRegex(DamagedFile, "line 2 holds a number that is not finite"):
                read_table(path, ("z",), texts=("law",))
            with self.assertRaisesRegex(DamagedFile, "has no column 'wave'"):
                read_table(path, ("z",), texts=("wave",))


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
