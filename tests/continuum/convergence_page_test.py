#!/usr/bin/python3
"""Tests of the page of convergence orders, with synthetic tables of known orders."""
import pathlib
import sys
import tempfile
import unittest

sys.dont_write_bytecode = True
sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent))

import convergence_page


def write_table(folder, name, orders, steps=(0.25, 0.125, 0.0625)):
    lines = [",".join(map(repr, [h, *(3. * h**order for order in orders)])) for h in steps]
    (folder / f"{name}.csv").write_text("\n".join(["h [m],L2 [m^2],H1 [m],H2 [1]", *lines]) + "\n")


class ConvergencePage(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.tables = pathlib.Path(folder.name) / "tables"
        self.tables.mkdir()
        self.docs = pathlib.Path(folder.name) / "docs"

    def test_orders_are_those_of_the_errors(self):
        write_table(self.tables, "mooney_rivlin_isotropic_uniform_loaded_p3", (3.9, 3.05, 2.2), (0.3, 0.2, 0.05))
        (series,) = convergence_page.read_series(self.tables)
        self.assertEqual((series.local, series.gradient, series.mesh, series.degree),
                         ("mooney_rivlin", "isotropic", "uniform_loaded", 3))
        for norm, order in (("L2", 3.9), ("H1", 3.05), ("H2", 2.2)):
            self.assertEqual(len(series.orders(norm)), 2)
            for observed in series.orders(norm):
                self.assertAlmostEqual(observed, order, delta=1e-12)

    def test_theory_loses_an_order_for_quadratic_elements_with_a_gradient_law(self):
        self.assertEqual(convergence_page.theory("isotropic", 2), {"L2": 2, "H1": 2, "H2": 1})
        self.assertEqual(convergence_page.theory("local", 2), {"L2": 3, "H1": 2, "H2": 1})
        self.assertEqual(convergence_page.theory("lattice", 4), {"L2": 5, "H1": 4, "H2": 3})

    def test_page_shows_every_series(self):
        write_table(self.tables, "network_local_uniform_p2", (3.01, 2.02, 1.03))
        write_table(self.tables, "network_local_hanging_p2", (2.97, 1.96, 0.95))
        write_table(self.tables, "network_lattice_uniform_loaded_p4", (5., 4., 3.))
        self.assertEqual(convergence_page.main(self.tables, self.docs), 0)
        page = (self.docs / "convergence.md").read_text(encoding="utf-8")
        self.assertIn("| without gradient law | 2 | 2 | 3 | 2.97 … 3.01 | 2 | 1.96 … 2.02 | 1 | 0.95 … 1.03 |", page)
        errors = (self.docs / "convergence.csv").read_text(encoding="utf-8")
        self.assertIn("without gradient law,network of fibres (C.11),\"uniform, clamped\",2,1/4,4.62e-02,,", errors)
        self.assertIn("\"uniform, clamped\",2,1/16,7.12e-04,3.01,", errors)
        self.assertNotIn("isotropic.png", page)
        for name in ("local", "lattice"):
            self.assertIn(f"images/convergence-{name}.png", page)
            self.assertEqual((self.docs / "images" / f"convergence-{name}.png").read_bytes()[:4], b"\x89PNG")

    def test_what_is_no_series_is_refused(self):
        with self.assertRaises(convergence_page.BadTable):
            convergence_page.read_series(self.tables)
        for name, text in (("network_local_uniform_p2", "h\n0.1,x,1,1\n0.05,1,1,1\n"), ("other", "h\n1,1,1,1\n2,1,1,1\n"),
                           ("network_local_uniform_p3", "h\n0.1,0,1,1\n0.05,1,1,1\n")):
            path = self.tables / f"{name}.csv"
            path.write_text(text)
            with self.assertRaisesRegex(convergence_page.BadTable, path.name):
                convergence_page.read_series(self.tables)
            path.unlink()


if __name__ == "__main__":
    unittest.main(verbosity=2)
