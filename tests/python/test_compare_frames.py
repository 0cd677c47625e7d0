"""Comparison of frames on made-up sheets: interpolation in the cells, norms, loads, and refusals of sheets that do not belong together.

Commands, files and real frames: tests/verification/compare_command_test.py.
"""
import time

import numpy as np
import pytest
from vtkmodules.vtkCommonDataModel import vtkHigherOrderQuadrilateral

from latcon import UnreadableFile
from latcon.compare_frames import compare_fields, norms, require_same_bounds, require_same_time
from latcon.frames import Frame, write_frame
from latcon.interpolation import interpolate
from latcon.side_frames import FIELDS, FrameFile, find_frame, list_of_times, read_side
from latcon.study.program import InputError

LENGTH, HEIGHT = 0.06, 0.04
LOAD = "load: displacement of held sites on the edges, largest difference"


def stretched(X, Y):
    return 0.1 * X + 0.02 * Y, 0.2 * Y


def grid(nx, ny, width=LENGTH, height=HEIGHT):
    return np.array([(width * i / nx, height * j / ny) for j in range(ny + 1) for i in range(nx + 1)])


def annulus(r, s):
    """A quarter of an annulus, whose cells have curved sides."""
    return (0.01 + 0.02 * r) * np.cos(np.pi / 2 * s), (0.01 + 0.02 * r) * np.sin(np.pi / 2 * s)


def rectangle(width=LENGTH, height=HEIGHT):
    return lambda r, s: (width * r, height * s)


def mesh(degree=3, nx=3, ny=2, shape=rectangle()):
    """Nodes of cells on the mapped unit square, each with its own, and their nodes by rows."""
    node = [(i / degree, j / degree) for j in range(degree + 1) for i in range(degree + 1)]
    r, s = np.array([((cx + i) / nx, (cy + j) / ny) for cy in range(ny) for cx in range(nx) for i, j in node]).T
    return np.column_stack(shape(r, s)), np.arange(len(r)).reshape(nx * ny, -1)


def write(path, points, u, bonds, cells, moves, stress, without, bad, scale, **more):
    n, one = len(points), np.eye(2)
    fields = {"displacement": np.column_stack(u(*points.T)), "deformation_gradient": np.tile(1.1 * one, (n, 1, 1)),
              "first_piola_stress": np.tile(1e5 * stress * one, (n, 1, 1)), "cauchy_stress": np.tile(1e5 * stress * one, (n, 1, 1)),
              "strain_energy_density": np.full(n, 1e4), **more}
    if moves is not None:
        fields["velocity"] = np.tile((2.0 * moves, 0.0), (n, 1))
    if bad:
        fields["first_piola_stress"][0, 1, 1] = np.nan
    fields.pop(without, None)
    write_frame(path, Frame(0.0, scale * points, points, bonds, np.ones(len(bonds)), fields, {}, {}, cells))
    return path


def lattice(path, u=stretched, nx=12, ny=8, width=LENGTH, height=HEIGHT, removed=lambda X, Y: np.zeros_like(X, bool), moves=False, stress=1,
            without="", bad=False, scale=1, when=1.0):
    """A square lattice with diagonals and a held rim."""
    points = grid(nx, ny, width, height)
    i, j = np.tile(np.arange(nx + 1), ny + 1), np.repeat(np.arange(ny + 1), nx + 1)
    bonds = np.array([(one, one + di + (nx + 1) * dj) for one in range(len(points)) for di, dj in ((1, 0), (0, 1), (1, 1), (-1, 1))
                      if 0 <= i[one] + di <= nx and j[one] + dj <= ny])
    kept = ~removed(*points.T)
    bonds = (np.cumsum(kept) - 1)[bonds[kept[bonds].all(axis=1)]]
    held = (i == 0) | (i == nx) | (j == 0) | (j == ny)
    write(path, points[kept], u, bonds, np.empty((0, 0), int), moves, stress, without, bad, scale, held=held[kept].astype(float))
    return read_side(FrameFile(path, when), "lattice")


def continuum(path, u=stretched, degree=3, nx=3, ny=2, shape=rectangle(), moves=None, stress=1, without="", bad=False, scale=1, when=1.0):
    points, rows = mesh(degree, nx, ny, shape)
    order = [vtkHigherOrderQuadrilateral.PointIndexFromIJK(i, j, (degree, degree)) for j in range(degree + 1) for i in range(degree + 1)]
    cells = np.empty_like(rows)
    cells[:, order] = rows
    write(path, points, u, np.empty((0, 2), int), cells, moves, stress, without, bad, scale)
    return read_side(FrameFile(path, when), "continuum")


@pytest.fixture
def paths(tmp_path):
    return tmp_path / "a.vtp", tmp_path / "a.vtu"


def rows_of(here, there, tolerances=(), **options):
    """Compares as the command does."""
    require_same_time(here, there)
    require_same_bounds(here, there)
    return {row["quantity"]: row for row in norms(here, there, compare_fields(here, there, **options), dict(tolerances))}


def refused(parts, act, *arguments):
    with pytest.raises((InputError, UnreadableFile)) as caught:
        act(*arguments)
    for part in parts:
        assert part in str(caught.value)


@pytest.mark.parametrize("degree", [1, 2, 3, 4])
def test_finds_polynomials_of_the_degree_of_its_cells(degree):
    nodes, cells = mesh(degree)

    def exact(points):
        x, y = points.T / [[LENGTH], [HEIGHT]]
        return np.column_stack(((x * y)**degree - 2 * x, (y - 0.3)**degree))

    points = grid(36, 24)  # on edges and corners of cells and of the sheet, and between
    values, outside = interpolate(points, nodes, exact(nodes), [cells], 1e-9)
    assert not outside.any()
    np.testing.assert_allclose(values, exact(points), rtol=0, atol=1e-13)


def test_inverts_curved_cells():
    """Isoparametric cells represent linear fields exactly, for any curvature."""
    nodes, cells = mesh(3, 2, 4, annulus)
    points = np.array([annulus(i / 20, j / 40) for j in range(41) for i in range(1, 20)])
    values, outside = interpolate(points, nodes, np.column_stack(stretched(*nodes.T)), [cells[:3], cells[3:]], 1e-9)
    assert not outside.any()
    np.testing.assert_allclose(values, np.column_stack(stretched(*points.T)), rtol=0, atol=1e-16)
    # The middle of a side, beyond all nodes of its cell.
    nodes, cells = mesh(3, 1, 1, lambda r, s: annulus(r, s - 0.5))
    middle = np.array([[-1, 9, 9, -1]]) / 16 @ nodes[cells[0, 3::4]]
    assert middle[0, 0] > nodes[:, 0].max() + 1e-4
    assert not interpolate(middle, nodes, nodes, [cells], 1e-9)[1].any()


def test_has_no_value_outside():
    nodes, cells = mesh(3, 2, 4, annulus)
    # In the hole, beyond the rim, and beyond a straight side by less and by more than the tolerance.
    points = np.array([(0.005, 0.005), (0.0299, 0.0299), (0.02, -0.9e-6), (0.02, -1.1e-6), (1, 1)])
    values, outside = interpolate(points, nodes, np.column_stack(stretched(*nodes.T)), [cells], 1e-6)
    assert outside.tolist() == [True, True, False, True, True]
    assert np.isnan(values[outside]).all()
    assert values[2, 1] == pytest.approx(-0.9e-6 * 0.2, abs=1e-16)  # extrapolated, not constant


def test_takes_the_mean_where_fields_jump():
    nodes, cells = mesh(2, 2, 2)
    values = np.repeat([1.0, 4.0, 1.0, 4.0], 9)[:, None]
    points = np.array([(0.01, 0.01), (0.03, 0.01), (0.03, 0.0), (0.05, 0.02), (0.03, 0.02)])
    np.testing.assert_allclose(interpolate(points, nodes, values, [cells], 1e-9)[0][:, 0], [1, 2.5, 2.5, 4, 2.5], atol=1e-14)


def test_is_quick_on_many_sites():
    nodes, cells = mesh(3, 125, 80)
    begin = time.process_time()
    values, outside = interpolate(grid(399, 249), nodes, np.column_stack(stretched(*nodes.T)), [cells], 1e-9)
    # 1e5 sites among 1e4 cells: 0.8 s; a search over all cells would take minutes.
    assert time.process_time() - begin < 10
    assert not outside.any()
    assert abs(values[:, 1]).max() == pytest.approx(0.2 * HEIGHT, abs=1e-12)


def test_finds_nothing_between_equal_sheets(paths):
    rows = rows_of(lattice(paths[0]), continuum(paths[1]))
    assert (rows["sites"]["lattice"], rows["free sites inside"]["lattice"]) == (13 * 9, 11 * 7)
    assert rows["displacement, largest difference"]["error"] < 1e-14
    assert rows["cauchy_stress, rms difference"]["error"] < 1e-14
    resting = [side(path, u=lambda X, Y: (0 * X, 0 * Y)) for side, path in zip((lattice, continuum), paths)]
    assert rows_of(*resting)["displacement, rms difference"]["error"] == 0


def test_measures_a_difference_by_its_norms(paths):
    def moved(X, Y):  # 5 of the 11 free columns
        return stretched(X, Y)[0] + 3e-5 * (X > 0.03), stretched(X, Y)[1] - 4e-5 * (X > 0.03)

    rows = rows_of(lattice(paths[0], moved, stress=1.25), continuum(paths[1], stress=1.25 * 0.8), {"displacement": 1e-3})
    largest, rms = (rows[f"displacement, {name} difference"] for name in ("largest", "rms"))
    assert largest["error"] * max(largest["lattice"], largest["continuum"]) == pytest.approx(5e-5, abs=1e-17)
    assert largest["continuum"] == pytest.approx(np.hypot(*stretched(0.055, 0.035)), abs=1e-15)
    assert rms["error"] * max(rms["lattice"], rms["continuum"]) == pytest.approx(5e-5 * np.sqrt(5 / 11), abs=1e-17)
    assert (rms["tolerance"], largest["tolerance"]) == (1e-3, None)
    stress = rows["first_piola_stress, rms difference"]
    assert (stress["lattice"], stress["error"]) == pytest.approx((1.25e5 * np.sqrt(2), 0.2), rel=1e-13)
    assert rows["deformation_gradient less identity, rms difference"]["lattice"] == pytest.approx(0.1 * np.sqrt(2), abs=1e-14)


def test_finds_other_loads_at_the_held_edges(paths):
    here = lattice(paths[0])
    for more in (0, 1e-5, 1e-3):
        row = rows_of(here, continuum(paths[1], lambda X, Y, more=more: (stretched(X, Y)[0], (1 + more) * 0.2 * Y)))[LOAD]
        # The largest displacement is at the corner.
        assert row["error"] == pytest.approx(more * 0.2 * HEIGHT / np.hypot(*stretched(LENGTH, HEIGHT)), rel=1e-3, abs=1e-14)
    # Inside, sheets of other material may differ.
    inside = continuum(paths[1], lambda X, Y: (stretched(X, Y)[0] + 40 * X * (LENGTH - X) * Y * (HEIGHT - Y), 0.2 * Y), 4)
    assert rows_of(here, inside)[LOAD]["error"] < 1e-14
    # Of a free edge the ends alone are held.
    here.held &= (here.points[:, 1] < HEIGHT) | (abs(here.points[:, 0] - LENGTH / 2) > 0.4 * LENGTH)
    free = continuum(paths[1], lambda X, Y: (stretched(X, Y)[0], 0.2 * Y * (1 + 0.1 * (Y > 0.999 * HEIGHT) * X * (LENGTH - X) / LENGTH**2)))
    assert rows_of(here, free)[LOAD]["error"] < 1e-14


def test_leaves_sites_that_lack_bonds_out_of_stress_and_energy(paths):
    here = lattice(paths[0], removed=lambda X, Y: np.hypot(X - 0.03, Y - 0.02) < 1e-6)  # which takes bonds of eight sites
    comparison = compare_fields(here, continuum(paths[1]))
    assert [int(comparison.compared(field).sum()) for field in FIELDS] == [11 * 7 - 1] * 2 + [11 * 7 - 9] * 4


def test_refuses_other_sheets(paths):
    here = lattice(paths[0])
    refused(["not the same sheet", "a.vtp and ", "a.vtu: ", "0 to 0.06 m by 0 to 0.04 m"], rows_of, here,
            continuum(paths[1], shape=rectangle(LENGTH * (1 + 3e-6))))
    rows_of(here, continuum(paths[1], shape=rectangle(LENGTH * (1 + 1e-7))))  # rounded
    refused(["1000 times as large", "not in metres"], rows_of, here, continuum(paths[1], scale=1000))
    refused(["x and y are exchanged"], rows_of, here, continuum(paths[1], shape=rectangle(HEIGHT, LENGTH)))
    refused(["'first_piola_stress'", "1.02e-06 times", "different units", "Pa"], rows_of, here, continuum(paths[1], stress=1.02e-6))
    square = [lattice(paths[0], nx=8, width=HEIGHT), continuum(paths[1], lambda X, Y: stretched(Y, X)[::-1], shape=rectangle(HEIGHT))]
    assert rows_of(*square)["displacement, rms difference"]["error"] > 0.3


def test_refuses_a_hole_in_one_of_them(paths):
    holed = lattice(paths[0], removed=lambda X, Y: np.hypot(X - 0.03, Y - 0.02) < 0.012)
    refused(["not the same sheet", "the lattice has no site within 0.01 m"], rows_of, holed, continuum(paths[1], nx=4, ny=4))

    def rim(r, s):  # 3 by 3 cells without the middle cell
        k = np.minimum(3, np.floor(4 * s)).astype(int)
        corners = np.array([(0, 0), (1, 0), (1, 1), (0, 1), (0, 0)])
        outer = corners[k] + (4 * s - k)[:, None] * (corners[k + 1] - corners[k])
        return ((0.5 + (outer - 0.5) * (1 - 0.7 * r)[:, None]) * (LENGTH, HEIGHT)).T

    refused(["not the same sheet", "the continuum has no cell at the site"], rows_of, lattice(paths[0], nx=48, ny=32),
            continuum(paths[1], degree=4, nx=1, ny=4, shape=rim))


def test_refuses_other_times(paths):
    here = lattice(paths[0], moves=True, when=2e-4)
    there = continuum(paths[1], moves=True, when=2e-4 * (1 + 5e-9))
    refused(["the times differ", "of the lattice", "of the continuum", "--lattice-time"], rows_of, here, there)
    here.file = there.file = FrameFile(paths[0], is_chosen=True)
    require_same_time(here, there)
    rows = rows_of(lattice(paths[0], moves=True, when=2e-4), continuum(paths[1], moves=True, when=2e-4 * (1 + 2e-10)))
    assert rows["velocity, rms difference"]["lattice"] == 2
    for moving in (True, False):
        here, there = lattice(paths[0], moves=moving), continuum(paths[1], moves=None if moving else True)
        sides = ("lattice", "continuum") if moving else ("continuum", "lattice")
        refused(["the {} is in motion and the {} in equilibrium".format(*sides)], rows_of, here, there)
    rows_of(lattice(paths[0], when=0.0), continuum(paths[1], moves=True, when=0.0))  # the start of a motion or an equilibrium


def test_names_what_a_file_lacks(paths):
    for field in FIELDS:
        if field.name != "velocity":
            refused(["a.vtu", f"'{field.name}'"], lambda: continuum(paths[1], without=field.name))
        refused(["a.vtp", f"'{field.name}'"], lambda: lattice(paths[0], without=field.name))
    refused(["a.vtp: 'first_piola_stress' is not finite at 1 of 117 points"], lambda: lattice(paths[0], bad=True))
    refused(["a.vtu: 'first_piola_stress' is not finite at 1 of 96 points"], lambda: continuum(paths[1], bad=True))
    refused(["'velocity' is not in", "a.vtu"], rows_of, lattice(paths[0]), continuum(paths[1]), {"velocity": 1e-3})
    refused(["'TimeValue'"], read_side, FrameFile(paths[0]), "lattice")


@pytest.mark.parametrize("make, side", [(lattice, "lattice"), (continuum, "continuum")])
def test_refuses_damaged_files(tmp_path, make, side):
    path = tmp_path / ("a.vtp" if side == "lattice" else "a.vtu")
    make(path)
    content = path.read_bytes()
    for kept in (0, 60, len(content) // 4, len(content) - 400):
        path.write_bytes(content[:kept])
        refused([path.name, "corrupt: " if kept > 60 else "not a VTK file"], read_side, FrameFile(path, 1.0), side)
    path.write_bytes(content.replace(b'NumberOfComponents="9"', b'NumberOfComponents="-9"', 1))  # for which VTK throws
    refused([path.name, "corrupt: "], read_side, FrameFile(path, 1.0), side)


def test_chooses_the_frame_of_a_series(tmp_path):
    for name in "012":
        lattice(tmp_path / f"{name}.vtp")
    series = tmp_path / "lattice.pvd"
    series.write_text("<VTKFile><Collection>" + "".join(f'<DataSet timestep="{when}" file="{name}.vtp"/>' for when, name in (
        (0.5, "1"), (0, "0"), (1, "2"), (2, "gone"))) + "</Collection></VTKFile>")
    assert find_frame(series, "lattice", 0.5).path.name == "1.vtp"
    assert find_frame(tmp_path, "lattice", 1 + 1e-10).path.name == "2.vtp"
    assert find_frame(tmp_path, "lattice", 0.0).times == [0, 0.5, 1, 2]
    refused(["no frame at 0.7", "0, 0.5, 1"], find_frame, series, "lattice", 0.7)
    refused(["gone.vtp", "does not exist"], find_frame, series, "lattice")
    for name in (series, tmp_path / "0.vtp"):
        refused(["a lattice frame where a continuum frame is expected"], find_frame, name, "continuum", 0.5)
    refused(["no continuum.pvd", "give the lattice first"], find_frame, tmp_path, "continuum")
    refused(["none.vtp", "no such file"], find_frame, tmp_path / "none.vtp", "lattice")
    series.write_text("<VTKFile><Coll")
    refused(["lattice.pvd", "not XML"], find_frame, series, "lattice")
    assert list_of_times([0, 0.5, 1]) == "0, 0.5, 1"
    assert list_of_times(range(10)) == "0, 1, 2, 3, ..., 6, 7, 8, 9"
