"""Tests of the rasterisation of a synthetic sheet: filled pixels, openings where bonds break, omitted parts."""
import numpy as np
import pytest

from latcon.frames import Frame
from latcon.report.raster import Mesh, Raster

COLUMNS, ROWS, BREAKS = 10, 9, 2e-3  # sites; time at which the bonds across the middle break [s]


def made_up_frame():
    """A triangular lattice of spacing 1 with the bonds to nearest neighbours."""
    sites = [(column + 0.5 * (row % 2), row * np.sqrt(0.75)) for row in range(ROWS) for column in range(COLUMNS)]
    place = np.array(sites)
    distance = np.linalg.norm(place[:, None] - place[None], axis=2)
    bonds = np.argwhere(np.triu((distance > 0.5) & (distance < 1.1)))
    return Frame(0.0, place, place, bonds, np.ones(len(bonds)), {"site": 100 + np.arange(len(place))}, {}, {})


def broken_bonds(frame):
    """Bonds between rows 4 and 5, by the numbers of their sites, some in reverse order."""
    rows = frame.bonds // COLUMNS
    ends = 100 + frame.bonds[(rows[:, 0] == 4) & (rows[:, 1] == 5)]
    ends[::2] = ends[::2, ::-1]
    return {"t": np.full(len(ends), BREAKS), "site": ends[:, 0].astype(float), "other_site": ends[:, 1].astype(float)}


FRAME = made_up_frame()
MESH = Mesh(FRAME, broken_bonds(FRAME))
RASTER = Raster((-1.0, COLUMNS + 0.5, -1.0, ROWS * np.sqrt(0.75)), 460)
PIXEL_AREA = RASTER.pixels_per_unit**-2


def draw(position=FRAME.position, time=-np.inf, values=FRAME.reference[:, 0]):
    return RASTER.draw(MESH, position, values, time)


def test_a_whole_sheet_is_filled():
    picture = draw()
    triangles = 2 * (COLUMNS - 1) * (ROWS - 1)
    assert len(MESH.triangles) == triangles
    area = np.count_nonzero(~np.isnan(picture)) * PIXEL_AREA
    assert area / (triangles * np.sqrt(3) / 4) == pytest.approx(1.0, abs=0.03)


def test_values_are_where_they_belong():
    picture = draw(values=FRAME.reference[:, 0] + 100 * FRAME.reference[:, 1])
    rows, columns = np.nonzero(~np.isnan(picture))
    x = -1.0 + (columns + 0.5) / RASTER.pixels_per_unit
    y = -1.0 + (RASTER.height - rows - 0.5) / RASTER.pixels_per_unit
    np.testing.assert_allclose(picture[rows, columns], x + 100 * y, atol=101 / RASTER.pixels_per_unit)


def test_a_crack_opens_when_its_bonds_break():
    opened = FRAME.position + np.where(np.arange(len(FRAME.position)) // COLUMNS > 4, 0.3, 0.0)[:, None]
    before, after = (np.count_nonzero(~np.isnan(draw(opened, time))) for time in (0.9 * BREAKS, BREAKS))
    strip = (2 * (COLUMNS - 1) * np.sqrt(3) / 4) / PIXEL_AREA
    assert before - after > 0.9 * strip


def test_what_flew_away_is_left_out():
    away = FRAME.position.copy()
    away[0] = (-50.0, 1e6)
    lost = np.count_nonzero(np.isnan(draw(away))) - np.count_nonzero(np.isnan(draw()))
    # One or two triangles of a site in a corner.
    assert 0.9 < lost / (np.sqrt(3) / 4 / PIXEL_AREA) < 1.1 * 2


def test_bonds_without_triangles_are_lines():
    chain = Frame(0.0, FRAME.reference, FRAME.position, np.array([(0, 1), (1, 2)]), np.ones(2), {}, {}, {})
    picture = RASTER.draw(Mesh(chain), chain.position, np.ones(len(chain.position)))
    assert np.count_nonzero(~np.isnan(picture)) == pytest.approx(2 * RASTER.pixels_per_unit, abs=2)
