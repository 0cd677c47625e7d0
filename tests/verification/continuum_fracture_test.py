"""Tests of `latcon fracture --side continuum` on a sheet that takes seconds: its files, its ledger of energies, stops and
resumes, input that it refuses, and the comparison with the lattice.
"""
import csv
import json
import os
import shutil
import signal
import subprocess
import time

import pytest
from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkIOXML import vtkXMLPolyDataReader

from program import CASES, LATCON, expect_same, files, frames, latcon, latcon_on_ranks, read, read_csv

# Crosses the sheet in 40 to 80 steps. Frames and checkpoints every few.
SHEET = {"Sheet/spacing": "1 mm", "Sheet/length": "30 mm", "Sheet/height": "16 mm", "Damage/length": "0.5 mm",
         "Damage/cells per length": 1, "Damage/threshold energy": "3.2 MPa", "Nearest neighbours/viscosity": "10 Pa s",
         "Next-nearest neighbours/viscosity": "30 Pa s", "Fracture/seed sites": 8, "Time/end": "3 ms", "Fracture/stop position": 0.8,
         "Output/frame interval": "0.3 ms", "Output/energy interval": 10, "Checkpoints/steps": 5}
BAD_INPUT, SOLVER_FAILED, OUTPUT_FAILED, INTERRUPTED = 2, 4, 5, 130


def command(folder, *more, entries=None, side="continuum"):
    sets = [word for key, value in {**SHEET, **(entries or {})}.items() for word in ("--set", f"{key}={value}")]
    return ["fracture", str(CASES / "quick.prm"), "--side", side, "--skip-verification", *sets, "--output-dir", str(folder), *more]


def run_to_end(out, *more, **keywords):
    run = latcon(*command(out, *more, **keywords))
    assert run.returncode == 0, run.stderr
    return run


@pytest.fixture(scope="module")
def whole(module_path):
    """Folder of an undisturbed crack, which tests leave as it is."""
    run_to_end(module_path / "whole", "--no-report", "--threads", "2")
    return module_path / "whole"


@pytest.fixture(scope="module")
def on_lattice(module_path):
    """The same crack of the lattice."""
    run_to_end(module_path / "lattice", "--no-report", side="lattice")
    return module_path / "lattice"


def test_files(whole, out):
    shutil.copytree(whole, out)
    assert latcon("report", out, "--quiet").returncode == 0
    crack = json.loads((out / "crack.json").read_text())
    assert crack["side"] == "continuum"
    assert crack["skip_verification"]
    assert crack["speed_lagrangian"] > 1.0
    tip = read_csv(out / "crack.csv")
    assert float(tip[-1]["X"]) >= 0.8 * 30e-3
    edges = read_csv(out / "crack_edges.csv")
    assert all(float(row["lower"]) < float(row["upper"]) for row in edges)
    # Every energy is in the table: their sum is that of the start.
    sums = [sum(float(row[name]) for name in ("elastic", "kinetic", "viscous", "broken", "shed", "imbalance"))
            for row in read_csv(out / "energy.csv")]
    for total in sums:
        assert total / sums[0] == pytest.approx(1.0, abs=1e-12)
    # Long steps for so fast a crack; the tolerance is that of its speed (theory-damage.md, eq. (C.83)).
    row = [row for row in read_csv(out / "results.csv") if row["quantity"] == "energy imbalance over energy exchanged"][0]
    assert float(row["error"]) == crack["energy_imbalance"]
    assert row["verdict"] == "holds"
    energy = [{name: float(value) for name, value in row.items()} for row in read_csv(out / "energy.csv")]
    spent = energy[-1]["broken"] + energy[-1]["viscous"] + energy[-1]["shed"]
    assert crack["energy_imbalance"] == pytest.approx(max(abs(row["imbalance"]) for row in energy) / spent, abs=1e-12)
    shown = frames(out / "continuum.pvd")
    assert len(shown) > 3
    for when, path in (shown[0], shown[-1]):
        sheet = read(vtkXMLPolyDataReader(), path)
        assert sheet.GetFieldData().GetArray("TimeValue").GetValue(0) == when
        damage = vtk_to_numpy(sheet.GetPointData().GetArray("damage"))
        assert (damage.min(), damage.max()) == (0.0, 1.0)
        for name in ("displacement", "velocity", "strain_energy_density"):
            assert sheet.GetPointData().GetArray(name) is not None, name
        # Held corners are where the loading of quick.prm puts them.
        corner = vtk_to_numpy(sheet.GetPointData().GetArray("displacement"))[-1]
        assert corner[0] / (1.3 * sheet.GetBounds()[1]) == pytest.approx(1.0, abs=1e-6)
        assert corner[1] / (1.8 * sheet.GetBounds()[3]) == pytest.approx(1.0, abs=1e-6)
    page = (out / "report.html").read_text()
    assert "Crack of the continuum" in page
    for picture in ("damage.png", "crack_edges.png", "crack_path.png", "energy.png"):
        assert (out / picture).exists(), picture


def test_stop_and_resume(whole, out):
    expected = files(whole)
    with subprocess.Popen([LATCON, *command(out, "--no-report")], stdout=subprocess.DEVNULL,
                          stderr=subprocess.DEVNULL) as run:
        while not list(out.glob("checkpoints/*.h5")):
            assert run.poll() is None, "it ended too soon"
            time.sleep(0.002)
        os.kill(run.pid, signal.SIGTERM)
        assert run.wait(timeout=600) == INTERRUPTED
    assert files(out)["crack.csv"] != expected["crack.csv"]
    assert "step" in run_to_end(out, "--no-report", "--resume", "--threads", "1").stdout
    expect_same(out, expected)


def test_checkpoint_of_the_other_side_is_refused(on_lattice, out):
    shutil.copytree(on_lattice, out)
    run = latcon(*command(out, "--resume"))
    assert run.returncode == BAD_INPUT
    assert "fracture --side continuum" in run.stderr


def test_resume_without_a_checkpoint_keeps_no_files_of_the_other_side(on_lattice, out):
    shutil.copytree(on_lattice, out)
    shutil.rmtree(out / "checkpoints")
    run_to_end(out, "--no-report", "--resume", entries={"Time/end": "0.1 ms"})
    assert not (out / "lattice.pvd").exists()
    assert (out / "earlier-run" / "lattice.pvd").exists()


@pytest.mark.parametrize("entries, message", [
    ({"Continuum/law": "mooney-rivlin"}, "Continuum/law"),
    ({"Continuum/gradient": "network"}, "Continuum/gradient"),
    ({"Fracture/left end": "free"}, "Fracture/left end"),
    ({"Disorder/strength": "uniform"}, "Disorder/strength"),
    ({"Nearest neighbours/branch moduli": "0.1 MPa",
      "Nearest neighbours/relaxation times": "1 s"}, "Nearest neighbours/branch moduli"),
    ({"Third-nearest neighbours/present": "true",
      "Third-nearest neighbours/branch moduli": "0.1 MPa",
      "Third-nearest neighbours/relaxation times": "1 s"}, "Third-nearest neighbours/branch moduli"),
    ({"Third-nearest neighbours/present": "true", "Third-nearest neighbours/law": "expression",
      "Third-nearest neighbours/psi": "a*(lam-1)^2"}, "Third-nearest neighbours/law"),
    ({"Body force/force y": "1"}, "Body force/force y"),
    ({"Initial state/velocity x": "1"}, "Initial state/velocity x"),
    ({"Initial state/base": "undeformed"}, "Initial state/base"),
    ({"Continuum/time step": "1 s"}, "Continuum/time step"),
    ({"Continuum/gradient": "lattice", "Continuum/inertia length": "100 m"}, "Continuum/inertia length"),
    ({"Damage/threshold energy": "1 MPa"}, "would be damaged everywhere"),
    ({"Damage/length": "3 mm"}, "Damage/length"),
    ({"Damage/cells per length": 0}, "Damage/cells per length"),
    ({"Sheet/hole radius": "2 mm"}, "Sheet/hole radius"),
    ({"Fracture/breaking stretch": "auto"}, "Fracture/breaking stretch")])
def test_bad_input(entries, message, out):
    run = latcon(*command(out, entries=entries))
    assert run.returncode == BAD_INPUT, run.stderr
    assert message in run.stderr
    assert not out.exists()


def test_there_are_two_sides(out):
    assert latcon(*command(out, side="both")).returncode == BAD_INPUT


def test_threshold_is_compared_with_the_energy_of_the_law(out):
    # A lattice of nearest neighbours alone stores more at these strains than its network, 0.717 MPa.
    nearest = {"Next-nearest neighbours/present": "false", "Loading/strain x": 0.2, "Loading/strain y": 2.2,
               "Damage/threshold energy": "0.7205 MPa"}
    for law, code in (("cauchy-born", BAD_INPUT), ("mooney-rivlin-network", 0)):
        run = latcon(*command(out, "--dry-run", entries={**nearest, "Continuum/law": law}))
        assert run.returncode == code, run.stderr


def test_three_ranks_leave_the_files_of_one(out, tmp_path):
    entries = {"Continuum/gradient": "lattice", "Fracture/stop position": 0.5}
    run_to_end(out, "--no-report", entries=entries)
    expected = files(out)
    out = tmp_path / "ranks"
    run = latcon_on_ranks(3, *command(out, "--no-report", "--threads", "1", entries=entries))
    assert run.returncode == 0, run.stderr
    expect_same(out, expected)
    # From the older of the two checkpoints, on another number of ranks.
    max((out / "checkpoints").iterdir()).unlink()
    run = latcon_on_ranks(2, *command(out, "--no-report", "--threads", "1", "--resume", entries=entries))
    assert run.returncode == 0, run.stderr
    assert "checkpoint" in run.stdout
    expect_same(out, expected)


def test_crack_that_fails_leaves_its_last_valid_state(out, tmp_path):
    entries = {"Nearest neighbours/viscosity": "1 Pa s", "Next-nearest neighbours/viscosity": "1 Pa s"}
    run = latcon(*command(out, "--no-report", entries=entries))
    assert run.returncode == SOLVER_FAILED, run.stderr
    assert "a cell that is not broken is inverted" in run.stderr
    shown = frames(out / "continuum.pvd")
    assert shown[-1][0] > 0.0
    assert shown[-1][0] == json.loads((out / "crack.json").read_text())["end_time"]
    assert json.loads((out / "run.json").read_text())["exit_code"] == SOLVER_FAILED
    expected, message = files(out), run.stderr.split("latcon: ")[-1]
    out = tmp_path / "ranks"
    run = latcon_on_ranks(2, *command(out, "--no-report", "--threads", "1", entries=entries))
    assert run.returncode == SOLVER_FAILED, run.stderr
    assert message.strip() in run.stderr
    expect_same(out, expected)


def test_table_that_cannot_be_written(out):
    (out / "crack_edges.csv").mkdir(parents=True)
    assert latcon(*command(out, "--no-report")).returncode == OUTPUT_FAILED


def test_dry_run(out):
    run = latcon(*command(out, "--dry-run"))
    assert run.returncode == 0, run.stderr
    assert "# damage: length 0.0005 m, threshold 3.2e+06 J/m^3" in run.stdout
    assert not out.exists()


def test_comparison_with_the_lattice(tmp_path, whole, on_lattice):
    run = latcon("compare", on_lattice, whole, "--output-dir", tmp_path / "both", "--no-report")
    assert run.returncode == 0, run.stderr
    with open(tmp_path / "both" / "compare.csv", newline="") as table:
        speeds = [row for row in csv.reader(table) if row and row[0] == "speed_lagrangian"]
    assert len(speeds) == 1
    compared = json.loads((tmp_path / "both" / "compare.json").read_text())
    assert compared["side"] == {"first": "lattice", "second": "continuum"}
    sheets = (whole / "continuum.pvd", on_lattice / "lattice.pvd")
    for both in (sheets, sheets[::-1]):
        frame = latcon("compare", *both, "--output-dir", tmp_path / "frames")
        assert frame.returncode == BAD_INPUT
        assert "cannot be compared site by site" in frame.stderr


def test_step_four_times_too_long_fails_by_its_ledger(tmp_path):
    steps = {}
    for times in (4, 1):
        folder = tmp_path / str(times)
        entries = {"Sheet/length": "3 cm", "Sheet/height": "1.5 cm", "Time/end": "0.5 ms", "Continuum/time step": 1.26936e-6 * times,
                   "Output/energy interval": 5}
        run = latcon("fracture", CASES / "quick.prm", "--side", "continuum", "--skip-verification", "--no-report", "--output-dir", folder,
                     *[word for key, value in entries.items() for word in ("--set", f"{key}={value}")])
        assert run.returncode == (3 if times == 4 else 0), run.stderr
        steps[times] = [float(row["tolerance"]) for row in read_csv(folder / "results.csv") if "imbalance" in row["quantity"]]
    assert steps[4][0] / steps[1][0] == pytest.approx(1.0, abs=0.05)  # is that of the automatic step


def test_study_of_both_sides(tmp_path, out):
    entries = {key: value for key, value in SHEET.items() if not key.startswith(("Output/frame", "Checkpoints"))} | {"Time/end": "0.3 ms"}
    document = {"title": "Both sides", "base": str(CASES / "quick.prm"), "set": entries, "side": "continuum",
                "runs": {"damage": {}, "bonds": {"side": "lattice"}},
                "claims": [{"claim": "It runs", "rows": [{"runs": ["damage", "bonds"], "quantity": "energy_imbalance", "below": 1}]}]}
    path = tmp_path / "both.json"

    def study(*more):
        path.write_text(json.dumps(document))
        run = latcon("study", path, "--skip-verification", "--output-dir", out, *more)
        assert run.returncode == 0, run.stdout + run.stderr
        return run.stdout

    def sides():
        cracks = [json.loads((out / "runs" / f"{name}-1" / "crack.json").read_text()) for name in ("damage", "bonds")]
        return [crack.get("side", "lattice") for crack in cracks]
    study()
    assert sides() == ["continuum", "lattice"]
    assert "0 runs, 2 are finished already" in study("--resume")
    # A crack of the other side is not the run that is asked for.
    document["runs"]["damage"]["side"] = "lattice"
    assert "1 runs, 1 are finished already" in study("--resume")
    assert sides() == ["lattice", "lattice"]
