#!/usr/bin/python3
"""Tests of the rasterisation of a synthetic sheet: filled pixels, openings where bonds break, omitted parts."""
import sys
import unittest
from pathlib import Path

import numpy as np

sys.dont_write_bytecode = True
sys.path.insert(0, str(Path(__file__).resolve().parents[2] / "verification" / "report"))

from frame import Frame
from raster import Mesh, Raster

COLUMNS, ROWS, BREAKS = 10, 9, 2e-3  # sites; time at which the bonds across the middle break [s]


def made_up_frame():
    """A triangular lattice of spacing 1 with the bonds to nearest neighbours."""
    sites = [(column + 0.5 * (row % 2), row * np.sqrt(0.75)) for row in range(ROWS) for column in range(COLUMNS)]
    place = np.array(sites)
    distance = np.linalg.norm(place[:, None] - place[None], axis=2)
    bonds = np.argwhere(np.triu((distance > 0.5) & (distance < 1.1)))
    return Frame(0.0, place, place, bonds, np.ones(len(bonds)), {"site": 100 + np.arange(len(place))})


def broken_bonds(frame):
    """Bonds between rows 4 and 5, by the numbers of their sites, some in reverse order."""
    rows = frame.bonds // COLUMNS
    ends = 100 + frame.bonds[(rows[:, 0] == 4) & (rows[:, 1] == 5)]
    ends[::2] = ends[::2, ::-1]
    return {"t": np.full(len(ends), BREAKS), "site": ends[:, 0].astype(float), "other_site": ends[:, 1].astype(float)}


class Pixels(unittest.TestCase):
    def setUp(self):
        self.frame = made_up_frame()
        self.mesh = Mesh(self.frame, broken_bonds(self.frame))
        self.raster = Raster((-1.0, COLUMNS + 0.5, -1.0, ROWS * np.sqrt(0.75)), 460)
        self.pixel_area = self.raster.pixels_per_unit**-2

    def draw(self, position=None, time=-np.inf, values=None):
        values = self.frame.reference[:, 0] if values is None else values
        return self.raster.draw(self.mesh, self.frame.position if position is None else position, values, time)

    def test_a_whole_sheet_is_filled(self):
        picture = self.draw()
        triangles = 2 * (COLUMNS - 1) * (ROWS - 1)
        self.assertEqual(len(self.mesh.triangles), triangles)
        area = np.count_nonzero(~np.isnan(picture)) * self.pixel_area
        self.assertAlmostEqual(area / (triangles * np.sqrt(3) / 4), 1.0, delta=0.03)

    def test_values_are_where_they_belong(self):
        picture = self.draw(values=self.frame.reference[:, 0] + 100 * self.frame.reference[:, 1])
        rows, columns = np.nonzero(~np.isnan(picture))
        x = -1.0 + (columns + 0.5) / self.raster.pixels_per_unit
        y = -1.0 + (self.raster.height - rows - 0.5) / self.raster.pixels_per_unit
        np.testing.assert_allclose(picture[rows, columns], x + 100 * y, atol=101 / self.raster.pixels_per_unit)

    def test_a_crack_opens_when_its_bonds_break(self):
        opened = self.frame.position + np.where(np.arange(len(self.frame.position)) // COLUMNS > 4, 0.3, 0.0)[:, None]
        before, after = (np.count_nonzero(~np.isnan(self.draw(opened, time))) for time in (0.9 * BREAKS, BREAKS))
        strip = (2 * (COLUMNS - 1) * np.sqrt(3) / 4) / self.pixel_area
        self.assertGreater(before - after, 0.9 * strip)

    def test_what_flew_away_is_left_out(self):
        away = self.frame.position.copy()
        away[0] = (-50.0, 1e6)
        lost = np.count_nonzero(np.isnan(self.draw(away))) - np.count_nonzero(np.isnan(self.draw()))
        # One or two triangles of a site in a corner.
        self.assertGreater(lost, 0.9 * np.sqrt(3) / 4 / self.pixel_area)
        self.assertLess(lost, 1.1 * 2 * np.sqrt(3) / 4 / self.pixel_area)

    def test_bonds_without_triangles_are_lines(self):
        chain = Frame(0.0, self.frame.reference, self.frame.position, np.array([(0, 1), (1, 2)]), np.ones(2), {})
        picture = self.raster.draw(Mesh(chain), chain.position, np.ones(len(chain.position)))
        self.assertAlmostEqual(np.count_nonzero(~np.isnan(picture)), 2 * self.raster.pixels_per_unit, delta=2)


if __name__ == "__main__":
    unittest.main()
