"""Tests of the command line: commands, exit codes, output files and their contents as read by independent readers."""
import math
import pathlib
import re
import shutil

import numpy as np
import pytest

from program import CASES, LATCON, claims_where, frames, latcon, numbers, read, read_csv, read_json, settings, unit

# A strip so short that a crack runs through it in a second.
TINY = ["--set", "Sheet/length=2.5 cm", "--set", "Sheet/height=1.5 cm", "--set", "Time/end=1.5 ms"]
BARE = [*TINY, "--no-report"]


@pytest.fixture(scope="module")
def printed(module_path):
    """What the crack that ended well printed."""
    run = latcon("fracture", CASES / "quick.prm", "--output-dir", module_path / "out", *TINY)
    assert "\r" not in run.stderr  # no progress line without a terminal
    return run.stdout


@pytest.fixture
def once(module_path, printed):
    """Its folder."""
    return module_path / "out"


def test_leaves_every_file(once):
    names = {path.name for path in once.iterdir()}
    wanted = {"case.prm", "run.json", "results.json", "results.csv", "crack.csv", "crack.json", "broken_bonds.csv",
              "log.txt", "energy.csv", "lattice.pvd", "motion.pvd", "sheet.png", "sheet_fields.png", "crack_path.png",
              "energy.png", "report.html"}
    assert wanted <= names
    assert not [name for name in names if name.endswith(".part")]


def test_ends_with_its_result(once, printed):
    lines = printed.splitlines()
    assert max(map(len, lines[1:])) <= 120
    first = next(number for number, line in enumerate(lines) if " crack is " in line)
    end = lines[first:]
    assert len(end) <= 12  # all that follows the claims
    crack = read_json(once / "crack.json")
    assert f"is {crack['pattern']}: {crack['reason'][:40]}" in end[0]
    speed = next(line for line in end if "Lagrangian crack speed" in line)
    assert re.search(r"\d ± \d\S* m/s$", speed)
    assert float(speed.split()[3]) == pytest.approx(crack["speed_lagrangian"], abs=crack["speed_lagrangian_uncertainty"])
    rows = read_json(once / "results.json")["claims"]
    for claim in ("energy", "wave-speeds", "intrinsic-length", "prestretch", "fracture"):
        held = sum(row["claim"] == claim and row["verdict"] == "holds" for row in rows)
        assert f"  {claim:<26}{held} check{'s hold' if held > 1 else ' holds'}" in end
    assert re.search(rf"^claims \S+ s, fracture \S+ s, report \S+ s; {once}/report\.html$", end[-1])
    assert "NN+NNN" not in printed  # rows are printed with --verbose alone


def test_verbose_prints_every_row(out):
    run = latcon("fracture", CASES / "quick.prm", "--output-dir", out, *BARE[:4], "--no-report", "--set", "Time/end=0.01 ms", "--verbose")
    rows = read_json(out / "results.json")["claims"]
    lines = run.stdout.splitlines()
    header = next(number for number, line in enumerate(lines) if line.startswith("claim  "))
    at, printed = lines[header].index("quantity"), []
    for line in lines[header + 2:next(number for number, line in enumerate(lines) if " crack is " in line)]:
        if line[0] != " ":
            printed.append([line[at:at + 30].rstrip(), line.split()[-1]])
        else:  # a long quantity goes on
            printed[-1][0] += " " + line.strip()
    assert len(rows) > 100
    assert printed == [[f"{row['quantity']} [{row['unit']}]", row["verdict"]] for row in rows]


def test_claims_of_the_case_are_checked_for_its_own_shells(once):
    rows = read_json(once / "results.json")["claims"]
    assert {row["claim"] for row in rows} == claims_where("before_fracture") | {"fracture"}
    assert all(row["quantity"].startswith("NN+NNN") for row in rows if row["claim"] not in ("steady-crack", "fracture"))


def test_crack_files_tell_one_story(once):
    crack = read_json(once / "crack.json")
    assert crack["pattern"] in ["straight", "oscillating", "branching", "arrested", "undecided"]
    assert "conclusive" not in crack
    for name in ["speed_lagrangian", "speed_laboratory", "wavelength", "amplitude"]:
        assert name in crack
        assert name + "_uncertainty" in crack
    last = read(frames(once / "lattice.pvd")[-1][1])
    fragments = last.PointData["fragment"]
    assert crack["detached_sites"] == (fragments > 0).sum()
    assert crack["detached_fragments"] == fragments.max()
    assert crack["largest_fragment"] == (fragments == 1).sum()
    stretch, toughened = (last.CellData[name][last.GetNumberOfVerts():] for name in ("stretch", "toughened"))
    assert crack["overstretched_bonds"] == (stretch > 3.05).sum()
    # The bond next to break is in the last frame, and no other one is nearer to its limit.
    bond = crack["nearest_to_breaking"]
    nearest = (stretch / np.where(toughened, 3. * 3.05, 3.05)).max()
    assert bond["stretch"] / bond["limit"] == pytest.approx(nearest, abs=1e-12)
    assert round(bond["limit"] / 3.05) in (1, 3)
    assert bond["stretch"] < bond["limit"]
    tip = numbers(once / "crack.csv")
    assert crack["bridged_length"] < tip["X"][-1] - tip["X"][0]
    strips = crack["bridged_length"] / (4. * 0.625e-3)
    assert strips == pytest.approx(round(strips), abs=1e-9)
    assert list(tip) == ["t", "X", "Y", "x", "y", "speed", "bonds_broken"]
    assert (np.diff(tip["X"]) >= 0.).all()
    assert tip["X"][-1] > 2. * tip["X"][0]
    broken = numbers(once / "broken_bonds.csv")
    assert list(broken) == ["t", "site", "other_site", "X", "Y", "stretch"]
    assert len(broken["t"]) == crack["bonds_broken"]
    assert broken["stretch"].min() > 3.05


def test_energy_ledger_is_closed(once):
    e = numbers(once / "energy.csv")
    assert list(e) == ["t", "elastic", "kinetic", "viscous", "broken", "boundary_work", "contact", "imbalance"]
    # The bonds of the seed are in `broken` from the start, so the first row contains the total energy.
    initial = e["elastic"][0] + e["broken"][0]
    balance = e["elastic"] + e["kinetic"] + e["viscous"] + e["broken"] + e["contact"] - initial - e["boundary_work"]
    np.testing.assert_allclose(balance, e["imbalance"], rtol=0., atol=1e-12 * initial)
    assert abs(balance).max() < 1e-4 * initial
    assert e["viscous"][-1] > 0.


def test_frames_open_outside_latcon_with_times_and_fields(once):
    series = frames(once / "lattice.pvd")
    times = [time for time, _ in series]
    assert times[0] == 0.
    assert times == sorted(times)
    assert times[-1] == numbers(once / "energy.csv")["t"][-1]  # to the last digit
    broken_before = None
    for time_, path in series:
        sheet = read(path)
        assert sheet.FieldData["TimeValue"][0] == time_
        assert sheet.PointData.keys() == ["displacement", "velocity", "deformation_gradient", "first_piola_stress",
                                          "cauchy_stress", "strain_gradient_x", "strain_gradient_y",
                                          "strain_energy_density", "damage", "held", "site", "fragment"]
        assert sheet.CellData.keys() == ["stretch", "shell", "toughened"]
        assert len(sheet.CellData["stretch"]) == sheet.GetNumberOfCells()
        units = {"displacement": "m", "velocity": "m/s", "cauchy_stress": "Pa", "strain_gradient_x": "1/m", "site": None}
        assert {name: unit(sheet.PointData[name]) for name in units} == units
        lines = sheet.GetNumberOfLines()
        if broken_before is not None:
            assert lines <= broken_before
        broken_before = lines
    # Bonds of the last frame: those of the first minus the broken ones.
    first = read(series[0][1]).GetNumberOfLines()
    assert first - broken_before == len(read_csv(once / "broken_bonds.csv"))


def test_resolved_case_is_the_case(once):
    again = latcon("fracture", once / "case.prm", "--dry-run", "--output-dir", once.parent / "none")
    resolved = (once / "case.prm").read_text()
    assert resolved.strip() in again.stdout
    assert not (once.parent / "none").exists()


def test_size_of_frames(once):
    def dry(*more):
        text = latcon("fracture", CASES / "quick.prm", *TINY, *more, "--dry-run").stdout
        return [float(number) for number in re.search("^# disk: about (.*) bytes for frames, at most (.*) bytes$", text, re.M).groups()]

    said, most = dry()
    assert said < most < 1e4 * said
    assert dry("--set", "Output/frame interval=1e-20")[0] < 1e4 * said  # not more than steps
    size = sum(path.stat().st_size for path in once.glob("*.vtp"))
    assert abs(math.log2(said / size)) < 1., (said, size)


def test_lattice_has_the_hole_and_the_free_sides_of_the_case(out):
    latcon("lattice", CASES / "hole.prm", "--output-dir", out)
    dry = latcon("lattice", CASES / "hole.prm", "--dry-run")
    sheet = read(frames(out / "lattice.pvd")[-1][1])
    removed = 97 * 75 - 37 - sheet.GetNumberOfPoints()  # 75 rows of 97 and 96 sites in turn
    assert f"# lattice: {sheet.GetNumberOfPoints()} sites, " in dry.stdout
    # The area of the hole, to a third of the sites along the rim.
    assert removed * math.sqrt(0.75) == pytest.approx(math.pi * 64, abs=2 * math.pi * 8 / 3)
    held, u, (x, y) = sheet.PointData["held"] == 1, sheet.PointData["displacement"], sheet.Points.T[:2]
    assert held.sum() == 2 * (97 + 96)
    assert abs(y[held]).min() > 0.019
    # The free sides contract, since they are stretched along y, as is the rim of the hole.
    side = (x > x.max() - 1e-6) & (abs(y) < 1e-3)
    assert u[side, 0].max() < -1e-3


def test_program_copied_without_its_data_is_5(tmp_path):
    copy = pathlib.Path(shutil.copy(LATCON, tmp_path / "latcon"))
    (tmp_path / "run").mkdir()
    run = latcon("report", tmp_path / "run", program=copy, expect=5)
    assert "share/latcon" in run.stderr


def test_step_four_times_too_long_fails_by_its_ledger(out):
    chebyshev = ["--skip-verification", *BARE, "--set", "Time/integrator=runge-kutta-chebyshev"]
    for step, code in (("auto", 0), (4 * 3.7e-6, 3)):
        latcon("fracture", CASES / "quick.prm", "--output-dir", out, *chebyshev, "--set", f"Time/step={step}", expect=code)
        energy = numbers(out / "energy.csv")
        spent = energy["broken"][-1] + energy["viscous"][-1] - energy["broken"][0]
        crack = read_json(out / "crack.json")
        assert crack["energy_imbalance"] == pytest.approx(abs(energy["imbalance"]).max() / spent, abs=1e-12)


@pytest.mark.parametrize("integrator, step, end, code", [
    ("velocity-verlet", "auto", "0.2 ms", 0), ("runge-kutta-chebyshev", "auto", "1 ms", 0),
    ("runge-kutta-chebyshev", 4 * 3.7e-6, "1 ms", 3)])
def test_motion_conserves_energy_unless_its_steps_are_too_long(out, integrator, step, end, code):
    """Automatic steps of Runge-Kutta-Chebyshev miss the energy of about two of them (theory.md, eq. (L.40))."""
    latcon("lattice", CASES / "quick.prm", "--output-dir", out, *settings(
        "Lattice/solution=motion", "Output/energy interval=16", f"Time/integrator={integrator}", f"Time/end={end}", f"Time/step={step}"),
        expect=code)
    assert len(numbers(out / "energy.csv")["t"]) > 3
    row, = (row for row in read_csv(out / "results.csv") if row["quantity"] == "energy imbalance over energy exchanged")
    assert row["verdict"] == ("fails" if code else "holds")
    assert (float(row["error"]) < float(row["tolerance"])) == (code == 0)
    assert float(row["error"]) > 0
    assert row["reason"] != ""


def ledger_of(out, command, *entries):
    latcon(command, CASES / "quick.prm", "--output-dir", out, "--quiet", *settings(*(f"{side}/solution=motion" for side in ("Lattice", "Continuum")), *entries))
    row, = (row for row in read_csv(out / "results.csv") if row["quantity"] == "energy imbalance over energy exchanged")
    return float(row["error"]), float(row["tolerance"])


def test_noise_without_dashpots_has_the_ledger_of_its_shortest_waves(out):
    """The bound (L.44), which steps of half the length do not change: the imbalance is of second order."""
    undamped = *(f"{shell} neighbours/viscosity=0" for shell in ("Nearest", "Next-nearest")), "Time/end=0.5 ms"
    error, tolerance = ledger_of(out, "lattice", *undamped)
    assert 0.7 * tolerance < error
    assert ledger_of(out, "lattice", *undamped, "Time/step=5.8e-7") == (pytest.approx(error / 4, rel=0.3), tolerance)


def test_sheet_at_rest_balances_and_can_be_pulled(out):
    rest = "Loading/strain x=0", "Loading/strain y=0", "Lattice/noise amplitude=0", "Time/end=0.2 ms"
    assert ledger_of(out, "continuum", *rest)[0] == ledger_of(out, "lattice", *rest)[0] == 0
    pulled = "Loading/history times=0.1 ms, 0.2 ms", "Loading/history strain y=0, 0.5"
    assert 0 < ledger_of(out, "lattice", *rest, *pulled)[0] < 1e-4


def test_slit_runs_between_ends_that_absorb(out):
    latcon("fracture", CASES / "quick.prm", "--output-dir", out, *BARE, "--skip-verification", *settings(
        "Fracture/left end=free", "Fracture/right end=absorbing", "Fracture/seed shape=slit", "Fracture/seed length=4 mm", "Fracture/seed height=2 mm"))
    crack = read_json(out / "crack.json")
    assert crack["energy_imbalance"] < 1e-5
    assert crack["skip_verification"] and read_json(out / "run.json")["skip_verification"]
    assert {row["claim"] for row in read_csv(out / "results.csv")} == {"fracture"}
    assert numbers(out / "energy.csv")["boundary_work"][-1] != 0.
    assert read(out / "lattice-0000.vtp").PointData["held"].sum() == 2 * (41 + 40)  # two rows below and two above


def test_claim_that_fails_is_3(out):
    run = latcon("fracture", CASES / "quick.prm", "--output-dir", out, *BARE, "--skip-verification", "--set",
                 "Reference/speed=1 m/s", expect=3)
    assert re.search(r"1 of 2 checks fails:\n  fracture: Lagrangian crack speed: error .*, tolerance 0.2\n"
                                 r"fracture \S+ s; .*\n\Z", run.stdout)
    assert (out / "crack.json").exists()
