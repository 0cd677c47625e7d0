"""Tests of pictures of synthetic fields around a tip: their contents for a known field, and rejected files."""
import numpy as np
import pytest
from vtkmodules.util.numpy_support import numpy_to_vtk
from vtkmodules.vtkCommonDataModel import vtkImageData
from vtkmodules.vtkIOXML import vtkXMLImageDataWriter

from made_up_runs import pixels

from latcon.errors import UnreadableFile
from latcon.report.near_tip_plots import opening_stress_picture, read_near_tip, triangulation, velocity_picture

PITCH, BEHIND, AHEAD, HALF = 1e-3, 20, 16, 18
STRETCH = 2.0  # of the made-up sheet along x and y
GREEN = np.array((0x00, 0x9E, 0x73))


def write_field(path, backward=3.0, without=()):
    """A crack that is open behind the tip, and a disc of 5 mm ahead of it that moves backwards."""
    columns, rows = BEHIND + 1 + AHEAD, 2 * HALF + 1
    X, Y = np.meshgrid(PITCH * np.arange(-BEHIND, AHEAD + 1), PITCH * np.arange(-HALF, HALF + 1))
    zero = np.zeros_like(X)
    disc = np.hypot(X - 8e-3, Y) < 5e-3
    fields = {
        "displacement": np.stack(((STRETCH - 1) * X, (STRETCH - 1) * Y, zero), axis=-1),
        "velocity": np.stack((np.where(disc, -backward, np.where(X < -2e-3, 10.0, 0.0)), 10 * np.sign(Y), zero), axis=-1),
        "cauchy_stress": np.stack([*[zero] * 4, 1e5 * (1 + np.exp(-(X**2 + Y**2) / 1e-5)), *[zero] * 4], axis=-1)}
    occupancy = np.where((X < 0) & (np.abs(Y) < 2.5e-3), 0.2, 1.0)
    for values in fields.values():
        values[occupancy == 0.2] = np.nan
    image = vtkImageData()
    image.SetDimensions(columns, rows, 1)
    image.SetSpacing(PITCH, PITCH, 1.0)
    image.SetOrigin(-BEHIND * PITCH, -HALF * PITCH, 0.0)
    for name, values in {**fields, "occupancy": occupancy[..., None]}.items():
        if name in without:
            continue
        array = numpy_to_vtk(values.reshape(rows * columns, -1), deep=True)
        array.SetName(name)
        image.GetPointData().AddArray(array)
    samples = numpy_to_vtk(np.array([7.0]), deep=True)
    samples.SetName("Samples")
    image.GetFieldData().AddArray(samples)
    writer = vtkXMLImageDataWriter()
    writer.SetFileName(str(path))
    writer.SetInputData(image)
    writer.EncodeAppendedDataOff()
    writer.Write()


@pytest.fixture
def vti(tmp_path):
    write_field(tmp_path / "near_tip.vti")
    return tmp_path / "near_tip.vti"


def colours(draw, vti, **options):
    """Pixels of a picture of a field."""
    draw(vti, vti.with_suffix(".png"), **options)
    return pixels(vti.with_suffix(".png").read_bytes())


def test_reads_places_and_components(vti):
    tip = read_near_tip(vti)
    assert tip.samples == 7
    row, column = HALF + 4, BEHIND + 3
    np.testing.assert_allclose(tip.position[row, column], (3e-3 * STRETCH, 4e-3 * STRETCH), rtol=1e-12)
    np.testing.assert_allclose(tip.velocity[row, column + 4], (-3.0, 10.0))
    np.testing.assert_allclose(tip.cauchy_stress[HALF, BEHIND], ((0, 0), (0, 2e5)))
    assert not tip.holds[HALF, BEHIND - 1]
    # The opening is in no triangle: 20 columns of cells by the five rows of points in it and one more on each side.
    cells = (BEHIND + AHEAD) * 2 * HALF - BEHIND * 6
    shown = triangulation(tip)
    assert len(shown.triangles) == 2 * cells
    assert np.ptp(shown.x) == pytest.approx(STRETCH * (BEHIND + AHEAD))  # [mm], as is the pitch


def test_outlines_what_moves_back(vti):
    def green():
        """Number of pixels in the colour of the outline."""
        return np.count_nonzero(np.abs(colours(velocity_picture, vti, crack_speed=50.0) - GREEN).max(axis=2) < 30)
    outlined = green()
    assert outlined > 500  # a circle with a radius of about 300 pixels
    write_field(vti, backward=0.4)  # slower than 1 % of the crack
    assert green() < outlined / 20


def test_shows_the_stress_where_it_is(vti):
    picture = colours(opening_stress_picture, vti)
    # The peak is at the tip in yellow, the far field is another colour.
    yellow = (picture[..., 0] > 200) & (picture[..., 1] > 200) & (picture[..., 2] < 120)
    rows, columns = np.nonzero(yellow[:int(0.75 * len(picture))])
    assert len(rows) > 100
    width = (10 - 0.85 - 0.25) * 160
    tip_column = 0.85 * 160 + width * BEHIND / (BEHIND + AHEAD)
    assert np.median(columns) == pytest.approx(tip_column, abs=0.06 * width)


def test_names_what_is_wrong(vti):
    vti.write_bytes(b"nothing of the kind")
    with pytest.raises(UnreadableFile):
        read_near_tip(vti)
    write_field(vti, without=("velocity",))
    with pytest.raises(UnreadableFile, match="velocity"):
        read_near_tip(vti)
