"""Tests of meshes from Gmsh from the command line."""

import re

import numpy as np
import pytest

from continuum_run import HOLE, cells_of, field, last_mesh, results
from program import latcon, read_json, settings

NODES = [(0, 0), (1.7, 0), (3, 0), (0, 1.2), (1.3, 0.8), (3, 0.9), (0, 2), (1.2, 2), (3, 2)]
QUADS = [(1, 2, 5, 4), (2, 3, 6, 5), (4, 5, 8, 7), (5, 6, 9, 8)]
# Physical curve and its nodes: left, right, bottom, top.
LINES = [(0, 1, 4), (0, 4, 7), (1, 3, 6), (1, 6, 9), (2, 1, 2), (2, 2, 3), (3, 7, 8), (3, 8, 9)]


def write_mesh(tmp_path, shift=0, unit=0.01):
    """@param shift offset of the numbers of the curves"""
    nodes = [f"{i} {unit * x!r} {unit * y!r} 0" for i, (x, y) in enumerate(NODES, 1)]
    lines = [f"1 2 {tag + shift} 1 {a} {b}" for tag, a, b in LINES]
    quads = ["3 2 9 1 " + " ".join(map(str, quad)) for quad in QUADS]
    elements = [f"{i} {element}" for i, element in enumerate(lines + quads, 1)]
    path = tmp_path / "four.msh"
    path.write_text("\n".join(["$MeshFormat", "2.2 0 8", "$EndMeshFormat", "$Nodes", str(len(nodes)), *nodes,
                               "$EndNodes", "$Elements", str(len(elements)), *elements, "$EndElements", ""]))
    return settings("Sheet/hole radius=0", f"Continuum/mesh file={path}", "Continuum/adaptive cycles=0",
                    "Continuum/refinements=1", "Loading/strain x=0.2", "Loading/strain y=0.4",
                    "Left edge/condition=held", "Right edge/condition=held")


def test_skewed_quadrilaterals_hold_a_homogeneous_state(out, tmp_path):
    latcon("continuum", HOLE, "--output-dir", out, *write_mesh(tmp_path))
    mesh = last_mesh(out)
    assert mesh.GetNumberOfCells() == 16
    assert cells_of(mesh)[1].sum() == pytest.approx(6e-4, abs=1e-9)
    F, P = field(mesh, "deformation_gradient"), field(mesh, "first_piola_stress")
    assert abs(F - np.diag([1.2, 1.4])).max() < 1e-6
    # Forces on the edges by name, that is by the numbers of the curves; fields in single precision.
    found = results(out)
    for edge, i, force in [("left", 0, -0.02 * P[0, 0, 0]), ("right", 0, 0.02 * P[0, 0, 0]),
                           ("bottom", 1, -0.03 * P[0, 1, 1]), ("top", 1, 0.03 * P[0, 1, 1])]:
        assert found[f"force on the {edge} edge per thickness, {'xy'[i]}"] / force == pytest.approx(1., abs=1e-5)
    density = field(mesh, "strain_energy_density")[0]
    assert found["elastic energy per thickness"] / (6e-4 * density) == pytest.approx(1., abs=1e-5)


def test_curves_of_other_numbers_are_refused(out, tmp_path):
    for shift in (5, 300, -1):
        run = latcon("continuum", HOLE, "--output-dir", out, *write_mesh(tmp_path, shift=shift), expect=2)
        assert "four.msh" in run.stderr
        assert not out.exists()


def test_loads_of_edges_that_the_mesh_does_not_have_are_refused(out, tmp_path):
    case = write_mesh(tmp_path)
    run = latcon("continuum", HOLE, "--output-dir", out, *case, "--set", "Inner edge/traction x=1e3", expect=2)
    assert "four.msh has no Inner edge, which the case loads" in run.stderr
    mesh = settings("Continuum/gradient=lattice", "Left edge/normal gradient=loading")
    latcon("continuum", HOLE, "--output-dir", out, *case, *mesh)
    text = (tmp_path / "four.msh").read_text()
    (tmp_path / "four.msh").write_text(re.sub(r"^1 0\.0 ", "1 0.001 ", text, flags=re.M))  # a corner of the left edge
    run = latcon("continuum", HOLE, "--output-dir", out, *case, *mesh, expect=2)
    assert "the Left edge of the mesh file" in run.stderr and "is not parallel to y" in run.stderr


def test_extent_is_shown_and_must_be_that_of_a_sheet_in_metres(out, tmp_path):
    run = latcon("continuum", HOLE, "--output-dir", out, "--dry-run", *write_mesh(tmp_path))
    assert "# mesh: 0.03 m x 0.02 m\n" in run.stdout
    run = latcon("continuum", HOLE, "--output-dir", out, *write_mesh(tmp_path, unit=10.), expect=2)
    assert "four.msh spans 30 m x 20 m" in run.stderr
    assert not out.exists()


def test_mesh_is_part_of_the_case(tmp_path, out):
    def move(*more, expect=0):
        return latcon("continuum", HOLE, "--output-dir", out, *more, *entries,
                      *settings("Continuum/solution=motion", "Continuum/gradient=none", "Time/end=50 us",
                                "Continuum/time step=10 us", "Checkpoints/steps=2"), expect=expect)
    entries = write_mesh(tmp_path)
    move()
    case_hash = read_json(out / "run.json")["case_hash"]
    mesh = tmp_path / "four.msh"
    text = mesh.read_text()
    mesh.write_text(text.replace(f"5 {0.01 * 1.3!r} 0.008 0", "5 0.014 0.008 0"))
    assert mesh.read_text() != text
    run = move("--resume", expect=2)
    assert "Continuum/mesh sha256" in run.stderr
    assert read_json(out / "run.json")["case_hash"] == case_hash
    write_mesh(tmp_path)
    move("--resume")
