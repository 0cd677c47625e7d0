#!/usr/bin/python3
"""Tests of parts of the report: packages that are missing, the fit of a sinusoid, digits of numbers."""
import math
import os
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

import numpy as np

sys.dont_write_bytecode = True
from report_test import AMPLITUDE, BEGIN, END, FOLDER, OFFSET, PHASE, SLOPE, WAVELENGTH, path_of_tip

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
