#!/usr/bin/python3
"""Tests of parts of the report: animation, places where it is read and written, missing packages, the fit of a sinusoid, digits."""
import base64
import functools
import io
import math
import os
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path
from unittest import mock

import numpy as np
from PIL import Image

sys.dont_write_bytecode = True
from report_test import (AMPLITUDE, BEGIN, END, FOLDER, HOLDS, MOTION_FRAMES, OFFSET, PHASE, PICTURES, SLOPE, WAVELENGTH, ReportCase,
                         path_of_tip, write_fracture, write_verification)

import animation
import report
from crack_path import fit_sinusoid
from summary import with_uncertainty


class Packages(unittest.TestCase):
    def refusal(self, error):
        """What the report says where importing Pillow raises this error."""
        with tempfile.TemporaryDirectory() as folder:
            package = Path(folder, "PIL")
            package.mkdir()
            (package / "__init__.py").touch()
            (package / "Image.py").write_text(f"raise {error}")
            done = subprocess.run([sys.executable, FOLDER / "own_settings.py"], env=dict(os.environ, PYTHONPATH=folder),
                                  capture_output=True, text=True, check=False)
        self.assertEqual(done.returncode, 69, done.stderr)
        self.assertIn("(apt-get install python3-pil", done.stderr)
        return done.stderr

    def test_broken_package_is_not_called_absent(self):
        self.assertIn("; PIL.Image: libjpeg.so.62: cannot open", self.refusal("ImportError('libjpeg.so.62: cannot open')"))
        self.assertIn("; PIL.Image: No module named 'olefile'",
                      self.refusal("ModuleNotFoundError(\"No module named 'olefile'\", name='olefile')"))

    def test_absent_package_is_named_alone(self):
        absent = self.refusal("ModuleNotFoundError(\"No module named 'PIL.Image'\", name='PIL.Image')")
        self.assertTrue(absent.endswith("python3-matplotlib)\n"), absent)


class Animation(ReportCase):
    def test_is_drawn_on_request_alone(self):
        write_fracture(self.folder, [HOLDS])
        self.report("--quiet", expect=0)
        self.assertEqual(list(self.folder.glob("animation.*")), [])
        self.assertNotIn("nimation", self.page()[1].text)

    def test_has_all_frames_and_is_small(self):
        write_fracture(self.folder, [HOLDS])
        self.report("--quiet", "--animation", expect=0)
        gif, still = ((self.folder / f"animation.{kind}").read_bytes() for kind in ("gif", "png"))
        html, page = self.page()
        self.assertNotIn("image/gif", html)  # the viewer shows more in fewer bytes; its last picture is among the still ones
        self.assertIn(still, [base64.b64decode(image.partition(",")[2]) for image in page.images])
        with mock.patch.object(report, "LARGEST_SHEETS", 0):  # no viewer
            self.report("--quiet", "--animation", expect=0)
        html, page = self.page()
        self.assertNotIn('class="viewer"', html)
        self.assertEqual(gif, base64.b64decode(page.images[0].partition(",")[2]))
        self.assertRegex(html, r'<source media="print, [^"]*" srcset="data:image/png;base64,')
        with Image.open(io.BytesIO(gif)) as film:
            self.assertEqual((film.n_frames, film.info["loop"]), (MOTION_FRAMES, 0))  # repeated for ever
            pictures, shown = [], []
            for number in range(film.n_frames):
                film.seek(number)
                pictures.append(np.asarray(film.convert("RGB"), dtype=float))
                shown.append(film.info["duration"])
        self.assertEqual(shown, [1250] * (MOTION_FRAMES - 1) + [2000])
        for before, after in zip(pictures, pictures[1:]):
            self.assertGreater(np.count_nonzero(np.abs(before - after).max(axis=2) > 60), 500)
        with Image.open(self.folder / "animation.png") as still:
            self.assertLess(np.abs(np.asarray(still.convert("RGB"), dtype=float) - pictures[-1]).mean(), 3)
        for most in (len(gif) - 1, len(gif) // 3):
            with mock.patch.object(animation, "draw_animation", functools.partial(animation.draw_animation, largest=most)):
                self.report("--quiet", "--animation", expect=0)
            self.assertLessEqual((self.folder / "animation.gif").stat().st_size, most)
            with Image.open(self.folder / "animation.gif") as film:
                self.assertEqual(film.n_frames, MOTION_FRAMES)

    def test_needs_a_motion(self):
        write_fracture(self.folder, [HOLDS])
        (self.folder / "motion.pvd").unlink()
        self.report("--quiet", "--animation", expect=0)
        self.assertFalse((self.folder / "animation.gif").exists())
        self.assertIn("has no data for it: animation.gif", self.page()[1].text)


class Places(ReportCase):
    """Folders of other users, and without the usual places."""

    def test_page_and_pictures_are_written_elsewhere(self):
        write_fracture(self.folder / "fig", [HOLDS])
        write_fracture(self.folder / "other", [HOLDS])
        before = {path: path.read_bytes() for path in self.folder.rglob("*") if path.is_file()}
        elsewhere = self.folder.parent / "a" / "b"
        out, _ = self.report("--output-dir", str(elsewhere), expect=0)
        self.assertEqual(out.splitlines()[-1], f"{elsewhere}/report.html")
        self.assertEqual({path: path.read_bytes() for path in self.folder.rglob("*") if path.is_file()}, before)
        self.assertEqual({str(path.relative_to(elsewhere)) for path in elsewhere.rglob("*") if path.is_file()},
                         {"report.html", *(f"{run}/{name}" for run in ("fig", "other") for name in PICTURES)})
        self.report("--quiet", expect=0)
        self.assertEqual(self.page()[0], self.page(elsewhere)[0])

    def test_a_folder_for_pictures_that_cannot_be_made_exits_5(self):
        write_fracture(self.folder / "fig", [HOLDS])
        (self.folder.parent / "file").touch()
        self.assertIn("cannot write", self.report("--output-dir", str(self.folder.parent / "file"), expect=5)[1])

    def test_a_name_that_is_no_text_is_shown_with_a_question_mark(self):
        folder = self.folder.parent / os.fsdecode(b"lat\xe41n")
        write_fracture(folder, [HOLDS])
        out, _ = self.report(expect=0, folder=folder)
        self.assertIn("lat?1n/report.html", out)
        self.assertIn("latcon report: lat?1n", self.page(folder)[1].text)

    def test_a_user_without_a_home_gets_no_advice(self):
        write_verification(self.folder, [HOLDS])
        environment = {name: value for name, value in os.environ.items() if name not in ("MPLCONFIGDIR", "XDG_CACHE_HOME", "XDG_CONFIG_HOME")}
        done = subprocess.run([sys.executable, FOLDER / "report.py", self.folder, "--quiet"], env=dict(environment, HOME="/dev/null"),
                              capture_output=True, text=True, check=False)
        self.assertEqual((done.returncode, done.stderr), (0, ""))


class FitSinusoid(unittest.TestCase):
    def test_recovers_the_sinusoid(self):
        X = np.linspace(0.0, 0.12, 500)
        Y = np.where((X < BEGIN) | (X > END), 1.0, path_of_tip(X))  # points outside must not count
        fit = fit_sinusoid(X, Y, WAVELENGTH, BEGIN, END)
        for value, truth in ((fit.amplitude, AMPLITUDE), (fit.phase, PHASE), (fit.offset, OFFSET), (fit.slope, SLOPE)):
            self.assertAlmostEqual(value / truth, 1, places=9)
        self.assertLess(np.abs(fit(X) - path_of_tip(X)).max(), 1e-12)

    def test_needs_more_points_than_coefficients(self):
        X = np.linspace(BEGIN, END, 4)
        self.assertIsNone(fit_sinusoid(X, X, WAVELENGTH, BEGIN, END))


class WithUncertainty(unittest.TestCase):
    def test_gives_the_digits_that_the_uncertainty_leaves(self):
        self.assertEqual(with_uncertainty(20.0576, 0.2328), "20.06 ± 0.23")
        self.assertEqual(with_uncertainty(2.34468, 0.0225), "2.345 ± 0.022")
        self.assertEqual(with_uncertainty(1234.5, 120.0), "1234 ± 120")
        for unknown in (None, 0.0, math.nan):
            self.assertEqual(with_uncertainty(20.0576, unknown), "20.06")


if __name__ == "__main__":
    unittest.main()
