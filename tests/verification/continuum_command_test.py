"""Tests of finite element cases from the command line: closed forms, files, refusals."""
import math
import re

import numpy as np
import pytest

from continuum_run import HOLE, LAYER, MODULUS, SPACING, cells_of, field, last_mesh, points_of, results
from program import CASES, latcon, numbers, read_csv, read_json, settings

TOP_FORCE = "force on the top edge per thickness, x"


def stiffening(ratio):
    """Shear force of a clamped layer over that of the local law, for l = ratio H."""
    return 1. / (1. - 2. * ratio * math.tanh(0.5 / ratio))


# Shear A (1 - cosh(Y/l) / cosh(H/2l)) about the middle, of mean 1, and traction mu A.
def sheared(out, *entries):
    """Length and height of the sheet, results, points and displacement."""
    latcon("continuum", LAYER, "--output-dir", out, "--quiet", *settings(*entries))
    mesh = last_mesh(out)
    points = points_of(mesh)
    # Whole rows of the lattice; the file has seven digits.
    pitch = np.array([0.5 * SPACING, 0.5 * math.sqrt(3.) * SPACING])
    extent = np.round(np.ptp(points, axis=0) / pitch) * pitch
    np.testing.assert_allclose(np.ptp(points, axis=0), extent, rtol=1e-6)
    return *extent, results(out), points, field(mesh, "displacement")


def test_converges_to_the_closed_form(out):
    """theory-continuum.md, eq. (C.35)."""
    l = 4e-3
    errors = []
    for cells in (8, 16):
        length, height, found, points, u = sheared(out, f"Continuum/cells y={cells}")
        A = stiffening(l / height)
        force = MODULUS * A * length
        Y = points[:, 1] - points[:, 1].min() - 0.5 * height
        profile = A * (Y - l * np.sinh(Y / l) / math.cosh(0.5 * height / l))
        difference = u[:, 0] - profile
        errors.append([abs(found[TOP_FORCE] / force - 1.),
                       abs(found["elastic energy per thickness"] / (0.5 * force * height) - 1.),
                       np.ptp(difference) / height])
        assert abs(u[:, 1]).max() < 1e-10 * height
    # Energies of interior penalty elements have the order 2 (p - 1) = 4 and displacements p + 1 = 4. Measured on 16
    # cells: 2.7e-6, 2.7e-6, 7.6e-6 with the orders 3.88, 3.88, 3.77.
    for coarse, fine in zip(*errors):
        assert fine < 1.5e-5
        assert math.log2(coarse / fine) > 3.5


def test_edges_along_a_stretch_are_periodic_or_held(out):
    forces = [sheared(out, "Loading/shear=0", "Loading/strain x=0.2", "Continuum/gradient=none", "Left edge/condition=held",
                      "Right edge/condition=held", *(f"{edge} edge/{entry}" for edge in ("Bottom", "Top")
                                                     for entry in (f"condition={condition}", "normal gradient=free")))[2]
              for condition in ("held", "periodic")]
    held, periodic = (found["force on the right edge per thickness, x"] for found in forces)
    assert periodic == pytest.approx(held, rel=1e-9)


def mean_rod(F, a, b):
    """Mean over directions of energy and first Piola stress [Pa] of rods a (l - l^-2) + b (1 - l^-3)."""
    angle = np.pi * np.arange(64) / 64  # exact to rounding for stretches of 2.3 and 2.8
    N = np.array([np.cos(angle), np.sin(angle)])
    f = F @ N
    l = np.hypot(*f)
    energy = a * (l**2 / 2 + 1 / l - 1.5) + b * (l + 0.5 / l**2 - 1.5)
    force = a * (l - l**-2) + b * (1 - l**-3)
    return energy.mean(), np.einsum("n,in,jn->ij", force / l, f, N) / angle.size


# The homogeneous sheet of quick.prm in the Mooney-Rivlin law of the network, with its gradient energy.
def test_is_the_mean_of_the_bonds_and_close_to_the_lattice(tmp_path):
    found = {}
    for law, gradient in (("mooney-rivlin-network", "network"), ("cauchy-born", "lattice")):
        out = tmp_path / law
        latcon("continuum", CASES / "quick.prm", "--output-dir", out, "--quiet",
               *settings("Sheet/length=2 cm", "Sheet/height=1.5 cm", f"Continuum/law={law}",
                         f"Continuum/gradient={gradient}", "Continuum/cells x=3", "Continuum/cells y=2"))
        found[law] = results(out)
    extent = np.ptp(points_of(last_mesh(out)), axis=0)
    energy, P = mean_rod(np.diag([2.3, 2.8]), 1e5, 1.5e5)
    weight = 3. * (0.72 + math.sqrt(3.) * 0.81)  # A0 l / V of the six bonds of a site
    network, lattice = found["mooney-rivlin-network"], found["cauchy-born"]
    # Newton stops at 1e-10; the file with the points has seven digits.
    names = ["elastic energy per thickness", "force on the right edge per thickness, x", "force on the top edge per thickness, y"]
    expected = weight * np.array([energy * extent.prod(), P[0, 0] * extent[1], P[1, 1] * extent[0]])
    np.testing.assert_allclose([network[name] for name in names], expected, rtol=2e-6)
    # The sixfold anisotropy that the law neglects (theory-comparison.md, eq. (H.14)).
    np.testing.assert_allclose(network[names[0]], lattice[names[0]], rtol=1e-6)
    np.testing.assert_allclose([network[name] for name in names[1:]], [lattice[name] for name in names[1:]], rtol=1e-4)


@pytest.fixture(scope="module")
def once(module_path):
    """Folder of the sheet with a hole."""
    run = latcon("continuum", HOLE, "--output-dir", module_path / "out", *settings("Continuum/adaptive cycles=6"))
    assert "cycle 6" in run.stdout
    names = {path.name for path in (module_path / "out").iterdir()}
    assert {"case.prm", "run.json", "results.json"} <= names  # the tests read the others
    assert not [name for name in names if name.endswith(".part")]
    return module_path / "out"


def test_reactions_settle_as_the_mesh_grows(once):
    meshes = numbers(once / "meshes.csv")
    assert len(meshes["cells"]) == 7
    assert (np.diff(meshes["cells"]) > 0).all()
    assert (np.diff(meshes["unknowns"]) > 0).all()
    largest = meshes["top_y"]  # equal to the bottom except for sign and round-off
    change = abs(np.diff(largest)) / largest[1:]
    # Once a mesh resolves the rim, the changes decrease by an order of magnitude or more.
    assert change[-1] < 1e-5 and change[-1] < 0.1 * change.max()
    row = read_csv(once / "results.csv")[-1]
    # Newton stops at 1e-10 of the reactions.
    assert float(row["error"]) == pytest.approx(change[-1], abs=1e-9)
    assert row["verdict"] == "holds"
    assert float(row["continuum"]) / largest[-1] == pytest.approx(1., abs=1e-9)


def test_tables_tell_one_story(once):
    meshes, newton = numbers(once / "meshes.csv"), numbers(once / "newton.csv")
    reactions, energy = numbers(once / "reactions.csv"), numbers(once / "energy.csv")
    assert list(energy) == ["load_factor", "elastic"]
    assert (reactions["load_factor"][-1], energy["load_factor"][-1]) == (1., 1.)
    # The row at full load is that of the last mesh.
    assert energy["elastic"][-1] == meshes["elastic"][-1] == results(once)["elastic energy per thickness"]
    assert reactions["top_y"][-1] == meshes["top_y"][-1]
    for axis in "xy":
        sides = [meshes[f"{edge}_{axis}"] for edge in ("bottom", "top")]
        # Newton stops at 1e-10 of the reactions.
        assert abs(sum(sides)).max() < 1e-9 * meshes["top_y"][0]
    ends = np.append(newton["iteration"][1:] == 0, True)
    assert ends.sum() == 7
    assert newton["mesh"][ends].tolist() == list(range(7))
    assert (newton["residual"][ends] <= newton["tolerance"][ends]).all()


def test_fields_open_outside_latcon(once):
    mesh = last_mesh(once)
    assert mesh.FieldData["TimeValue"][0] == 1.
    components = {name: mesh.PointData[name][0].size for name in mesh.PointData.keys()}
    tensors = ["deformation_gradient", "first_piola_stress", "cauchy_stress", "strain_gradient_x",
               "strain_gradient_y", "double_stress_x", "double_stress_y"]
    assert components == {"displacement": 3, "strain_energy_density": 1, **dict.fromkeys(tensors, 9)}
    F, P, sigma, *gradients = (field(mesh, name) for name in tensors)
    # Fields are stored in single precision.
    pushed = np.einsum("piJ,pjJ->pij", P, F) / np.linalg.det(F)[:, None, None]
    assert abs(pushed - sigma).max() < 1e-5 * abs(sigma).max()
    for G in gradients:
        assert abs(G).max() > 0.
        assert abs(G - G.transpose(0, 2, 1)).max() < 1e-5 * abs(G).max()
    assert field(mesh, "strain_energy_density").min() > 0.


def test_cells_are_small_at_the_rim(once):
    mesh = last_mesh(once)
    middle, area = cells_of(mesh)
    points = points_of(mesh)
    distance = np.linalg.norm(middle - 0.5 * (points.min(axis=0) + points.max(axis=0)), axis=1) - 5e-3
    assert distance.min() > 0.
    # Within a radius of the rim, where stress concentrates, cells are at most twice as wide as the smallest of all,
    # which lie there or at the corners, and far from both they are large.
    at_rim = distance < 5e-3
    assert area[at_rim].min() < 4.1 * area.min()
    assert area.max() > 16. * area[at_rim].min()
    assert distance[area > 0.5 * area.max()].min() > 5e-3


def test_small_fraction_refines_one_cell(once):
    out = once.parent / "one"
    latcon("continuum", HOLE, "--output-dir", out, *settings("Continuum/adaptive cycles=1", "Continuum/refined fraction=0.02"), expect=3)
    assert np.diff(numbers(out / "meshes.csv")["cells"]) >= 3


def test_inversion_at_an_edge_leaves_its_iterations(once):
    out = once.parent / "inverted"
    run = latcon("continuum", CASES / "quick.prm", "--output-dir", out, *settings(
        "Loading/strain x=-0.7", "Loading/strain y=0.5", "Loading/shear=3", "Left edge/condition=free", "Right edge/condition=free",
        "Fracture/breaking stretch=auto", "Sheet/length=2 cm", "Sheet/height=1.5 cm", "Continuum/cells x=6", "Continuum/cells y=5",
        "Continuum/degree=2"), expect=4)
    assert re.search("the equilibrium at load factor 0.[45][0-9]* is inverted at an edge: det F", run.stderr)
    assert len(numbers(out / "newton.csv")["residual"]) > 5


def test_reaction_that_does_not_settle_is_3(once):
    out = once.parent / "absurd"
    run = latcon("continuum", HOLE, "--output-dir", out,
                 *settings("Continuum/adaptive cycles=1", "Continuum/reaction tolerance=1e-12", "Continuum/relative tolerance=1e-6"),
                 expect=3)
    assert "fails" in run.stdout
    assert read_json(out / "run.json")["exit_code"] == 3
    # Newton's method stops where the case says, by default at 1e-10.
    given, default = (numbers(folder / "newton.csv")["tolerance"][0] for folder in (out, once))
    assert given / default == pytest.approx(1e4)


# Strains of Fig. 1: the sheet around the hole is stretched by 2.3 and 2.8, its rim compressed across.
FIG1 = ("Loading/strain x=1.3", "Loading/strain y=1.8")


def test_large_strain_is_carried_with_gradient_energy(once):
    for law, gradient in (("cauchy-born", "lattice"), ("mooney-rivlin-network", "network")):
        out = once.parent / law
        latcon("continuum", HOLE, "--output-dir", out,
               *settings(*FIG1, f"Continuum/law={law}", f"Continuum/gradient={gradient}",
                         "Continuum/adaptive cycles=2", "Continuum/reaction tolerance=1e-4"))
        assert results(out)["largest area ratio"] > 6.


def test_loading_that_cannot_be_carried_is_4(once):
    run = latcon("continuum", HOLE, "--output-dir", once.parent / "torn",
                 *settings(*FIG1, "Continuum/law=mooney-rivlin", "Continuum/gradient=none",
                           "Continuum/refinements=1", "Continuum/adaptive cycles=0"), expect=4)
    for part in ["equilibrium was found beyond load factor 0.", "rejected", "converged", "iteration  0  residual"]:
        assert part in run.stdout + run.stderr
    assert "no static equilibrium was found" in run.stderr
