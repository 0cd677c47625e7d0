"""Tests of `latcon fracture --side continuum`: it is the command of the lattice on another grid."""
import json
import shutil

import pytest

from program import CASES, files, frames, latcon, read, read_csv, read_json

# A crack of seconds, with frames and checkpoints.
SHEET = {"Sheet/spacing": "1 mm", "Sheet/length": "30 mm", "Sheet/height": "16 mm", "Fracture/seed sites": 8, "Time/end": "3 ms",
         "Time/integrator": "runge-kutta-chebyshev", "Fracture/stop position": 0.7, "Output/frame interval": "0.2 ms",
         "Output/energy interval": 20, "Checkpoints/steps": 20}
THE_LATTICE = {"Nonlocal/grid": "triangular", "Nonlocal/refinement": 1, "Nonlocal/half width": "0 rad"}
SCATTERED = {"Nonlocal/scatter": 0.5}
SHORT = {**SCATTERED, "Fracture/stop position": 0.45}
BAD_INPUT = 2


def command(folder, *more, entries=None, side="continuum"):
    sets = [word for key, value in {**SHEET, **(entries or {})}.items() for word in ("--set", f"{key}={value}")]
    return ["fracture", str(CASES / "quick.prm"), "--side", side, "--skip-verification", *sets, "--output-dir", str(folder), *more]


def run_to_end(out, *more, **keywords):
    """@return its folder"""
    latcon(*command(out, *more, **keywords))
    return out


@pytest.fixture(scope="module")
def whole(module_path):
    """Folder of an undisturbed crack, which tests leave as it is."""
    return run_to_end(module_path / "whole", "--no-report", "--threads", "2")


@pytest.fixture(scope="module")
def on_lattice(module_path):
    """The same crack of the lattice."""
    return run_to_end(module_path / "lattice", "--no-report", side="lattice")


@pytest.mark.parametrize("more", [{}, {"Third-nearest neighbours/present": "true", "Third-nearest neighbours/viscosity": "50 Pa s",
                                  "Sheet/orientation": "rows-across-crack"}])
def test_six_directions_at_the_spacing_of_the_lattice_are_the_lattice(out, tmp_path, more):
    expected = files(run_to_end(out, "--no-report", side="lattice", entries=more))
    found = files(run_to_end(tmp_path / "nonlocal", "--no-report", entries=more | THE_LATTICE))
    assert {"crack.csv", "broken_bonds.csv", "energy.csv", "near_tip.json", "lattice-0002.vtp"} <= expected.keys()
    for name in ("crack.json", "results.json", "results.csv", "case.prm"):  # they name the side, or its entries
        expected.pop(name, None), found.pop(name, None)
    assert found == expected


def test_files(whole, out):
    shutil.copytree(whole, out)
    latcon("report", out, "--quiet")
    crack, run = (read_json(out / name) for name in ("crack.json", "run.json"))
    assert crack["side"] == run["side"] == "continuum"
    assert run["half_bonds"] == 30 and run["grid_spacing_m"] == pytest.approx(0.5e-3)
    assert run["entries"]["Nonlocal/grid"] == "square"
    assert float(read_csv(out / "crack.csv")[-1]["X"]) >= 0.7 * 30e-3
    rows = {row["quantity"]: row for row in read_csv(out / "results.csv")}
    assert rows["energy imbalance over energy exchanged"]["verdict"] == "holds"
    speed = rows["Lagrangian crack speed"]
    assert float(speed["continuum"]) == crack["speed_lagrangian"] > 1.0 and not speed["lattice"]
    # The cut breaks what crosses it, and nothing else.
    first = read(frames(out / "lattice.pvd")[0][1])
    assert len(first.Points) == 61 * 33
    assert {"displacement", "velocity", "cauchy_stress", "strain_energy_density", "damage"} <= set(first.PointData.keys())
    assert "strain_gradient_x" not in first.PointData.keys()
    page = (out / "report.html").read_text()
    assert "Crack of the nonlocal continuum" in page
    for picture in ("sheet.png", "crack_path.png", "energy.png", "near_tip_velocity.png"):
        assert (out / picture).exists(), picture


@pytest.fixture(scope="module")
def scattered(module_path):
    """The undisturbed crack between scattered points."""
    return run_to_end(module_path / "scattered", "--no-report", "--threads", "2", entries=SHORT)


def test_frames_and_bonds_are_where_scattered_points_are(scattered):
    points = read(frames(scattered / "lattice.pvd")[0][1]).Points[:, :2]
    for offsets in points.T / 0.5e-3 % 1:  # uniform between grid points
        assert abs(offsets.mean() - 0.5) < 5 * (1 / 12 / len(points)) ** 0.5
        assert (offsets < 0.25).mean() == pytest.approx(0.25, abs=0.05)
    for bond in read_csv(scattered / "broken_bonds.csv"):
        middle = points[[int(bond[name]) for name in ("site", "other_site")]].mean(axis=0)
        assert [float(bond[name]) for name in "XY"] == pytest.approx(middle, abs=1e-8)  # frames are in single precision


def test_checkpoint_of_the_other_side_is_refused(on_lattice, out):
    shutil.copytree(on_lattice, out)
    run = latcon(*command(out, "--resume"), expect=BAD_INPUT)
    assert "fracture --side continuum" in run.stderr


def test_entries_of_the_continuum_do_not_concern_the_lattice(out):
    run_to_end(out, "--dry-run", side="lattice", entries={**THE_LATTICE, "Fracture/right end": "absorbing"})


def test_dry_run(out):
    run = latcon(*command(out, "--dry-run"))
    assert "# nonlocal continuum: 2013 sites" in run.stdout
    assert not out.exists()


def test_ends_without_load_and_a_history(out):
    run_to_end(out, "--no-report", entries={"Fracture/left end": "free", "Time/end": "0.1 ms"})
    strains = {"Loading/history times": "0.05 ms, 0.1 ms", "Loading/history strain y": "1.9, 1.8", "Time/end": "0.2 ms"}
    run_to_end(out, "--no-report", entries=strains)
    assert any(float(row["boundary_work"]) != 0.0 for row in read_csv(out / "energy.csv"))


def test_comparison_with_the_lattice(tmp_path, whole, on_lattice):
    latcon("compare", on_lattice, whole, "--output-dir", tmp_path / "both", "--no-report")
    assert [row["quantity"] for row in read_csv(tmp_path / "both" / "compare.csv")].count("speed_lagrangian") == 1
    compared = read_json(tmp_path / "both" / "compare.json")
    assert compared["side"] == {"first": "lattice", "second": "continuum"}


def test_study_of_both_sides(tmp_path, out):
    entries = {key: value for key, value in SHEET.items() if not key.startswith(("Output/frame", "Checkpoints"))} | {"Time/end": "0.3 ms"}
    document = {"title": "Both sides", "base": str(CASES / "quick.prm"), "set": entries, "side": "continuum",
                "runs": {"rings": {}, "bonds": {"side": "lattice"}},
                "claims": [{"claim": "It runs", "rows": [{"runs": ["rings", "bonds"], "quantity": "energy_imbalance", "below": 1}]}]}
    path = tmp_path / "both.json"

    def study(*more):
        path.write_text(json.dumps(document))
        return latcon("study", path, "--skip-verification", "--no-report", "--output-dir", out, *more).stdout

    def sides():
        cracks = [read_json(out / "runs" / f"{name}-1" / "crack.json") for name in ("rings", "bonds")]
        return [crack.get("side", "lattice") for crack in cracks]
    study()
    assert sides() == ["continuum", "lattice"]
    # A crack of the other side is not the run that is asked for.
    document["runs"]["rings"]["side"] = "lattice"
    assert "1 runs, 1 are finished already" in study("--resume")
    assert sides() == ["lattice", "lattice"]
