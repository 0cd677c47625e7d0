"""Checks from the command line that every claim holds for the shipped case, in the quick or, with --full, in the full versions,
and that the pages about claims and their files agree with the results.
"""
import os
import pathlib
import re
import shutil

import pytest

import verification_page
from documented import undocumented
from made_up_claims import write_claims
from program import CASES, FULL, claims_where, latcon, read_csv, read_json, settings

quick_only = pytest.mark.skipif(FULL, reason="the quick versions are enough")
PAGE = pathlib.Path(__file__).resolve().parents[2] / "docs" / "verification.csv"
TABLES = ("wave_speeds", "attenuation", "dispersion", "dispersion_runs", "edge_layer", "hole", "notch", "sinusoidal_energy",
          "travelling_waves", "steady_crack")


@pytest.fixture
def verified(out, tmp_path):
    """Output directory of `latcon verify`, and the names of the verdicts that it kept: those of the fixture, or of the full version."""
    if not FULL:
        runs = pathlib.Path(os.environ["LATCON_VERDICTS"]) / "runs"
        run = read_json(runs / "verify.json")
        assert run["exit_code"] == 0, run["output"]
        shutil.copytree(runs / "verify", out)
        return out, set(run["verdicts"])
    # The full versions should take less than ten minutes on two idle cores; the cores may be busy here.
    latcon("verify", "--output-dir", out, env=dict(os.environ, XDG_CACHE_HOME=str(tmp_path)), timeout=1800)
    return out, {path.name for path in tmp_path.glob("latcon/verdicts/*.json")}


def test_every_claim_holds(verified, tmp_path):
    out, kept = verified
    results = read_json(out / "results.json")
    rows = results["claims"]
    assert {row["claim"] for row in rows} == claims_where("default")
    assert read_json(out / "run.json")["laws"] == "all"
    for claim in claims_where("default") - {"steady-crack"}:
        for shells in ("NN+NNN", "NN"):
            assert any(row["claim"] == claim and row["quantity"].startswith((f"{shells}:", f"{shells},")) for row in rows), claim
    # A tolerance without its reason says nothing; a crack waits for all rows that are judged.
    assert [row["quantity"] for row in rows if row["tolerance"] is not None and not row["reason"]] == []
    assert [row["quantity"] for row in rows if row["gate"] != (row["tolerance"] is not None)] == []
    assert {claim["name"] for claim in read_json(out / "claims.json")["claims"]} == claims_where("default")
    for name in TABLES:
        assert len((out / f"{name}.csv").read_text().splitlines()) > 3, name
    # What holds for the program alone is kept as a crack keeps it, which then need not check it again.
    assert len(kept) == (not FULL)
    if not FULL:
        accepted = read_json(pathlib.Path(os.environ["LATCON_VERDICTS"]) / "runs" / "accepted" / "run.json")
        assert kept == {f"{accepted['verification_of_program']['hash']}.json"}
        assert accepted["verification_of_program"]["reused"]
        assert verification_page.differences(PAGE.read_text(encoding="utf-8"), results) == [], (
            "if that is as it should be: cmake --build build/release --target verification_page")
    assert undocumented(out) == []
    # The report draws these columns: claim_plots_test.py.
    (tmp_path / "made-up").mkdir()
    write_claims(tmp_path / "made-up")
    for name in TABLES:
        wanted, written = (set(read_csv(folder / f"{name}.csv")[0]) for folder in (tmp_path / "made-up", out))
        assert wanted - written <= {"fem_isotropic [m/s]"}, name  # of the full versions
    if FULL:
        latcon("report", out, "--quiet")
        page = (out / "report.html").read_text()
        assert page.count("<img ") >= len(TABLES) - 1  # dispersion and its runs share one


# A sheet of nearest neighbours, compressed along x until the speed of shear waves along x vanishes: it buckles.
BUCKLED = settings("Loading/strain x=-0.11", "Loading/strain y=0.75", "Next-nearest neighbours/present=false",
                   "Nearest neighbours/viscosity=0", "Next-nearest neighbours/viscosity=0")


@quick_only
def test_waves_that_never_ran_fail(out):
    """Checks the case of quick.prm with other settings. Rows with NaN must not hold. The claim on energies: gate_test.py."""
    result = latcon("verify", "wave-speeds", "--quick", "--case", CASES / "quick.prm", *BUCKLED, "--output-dir", out, expect=3)
    rows = read_json(out / "results.json")["claims"]
    for row in rows:
        if row["verdict"] == "holds":
            assert not {"nan", "inf", "-inf"} & {str(value) for value in row.values()}, row
    failing = [row["quantity"] for row in rows if row["verdict"] == "fails"]
    assert any("it buckles in waves of kd" in quantity for quantity in failing), failing
    assert re.search("1 of .*\n  wave-speeds: NN: stability of the loaded lattice, .*; it buckles in waves of kd = ", result.stdout)


def judged(out, *options, expect=0):
    run = latcon("verify", "intrinsic-length", "--quick", "--output-dir", out, *options, expect=expect)
    document = read_json(out / "run.json")
    rows = read_json(out / "results.json")["claims"]
    return sum(row["verdict"] == "holds" for row in rows), document["laws"], "--laws all judges every law" in run.stdout


@quick_only
def test_only_a_case_or_an_option_chooses_the_laws_that_are_judged(out):
    case = ("--case", CASES / "fig1.prm")
    every, laws, is_said = judged(out, *case, "--laws", "all")
    assert (laws, is_said) == ("all", False)
    fewer, laws, is_said = judged(out, *case)
    assert fewer < every
    assert (laws, is_said) == ("case", True)
    assert judged(out, "--set", "Lattice/noise seed=1", "--laws", "case") == (fewer, "case", True)


@quick_only
@pytest.mark.parametrize("claim, entries, fails", [
    ("intrinsic-length", ["Next-nearest neighbours/area factor=0.07"], None),  # layers of an edge that decay fast
    ("energy", ["Contact/viscosity=10"], None),  # overdamped contact
    ("nonlocal", ["Sheet/orientation=rows-across-crack", "Next-nearest neighbours/present=false", "Nonlocal/refinement=1.5", "Loading/strain x=-0.17",
                  "Loading/strain y=1.3", "Nearest neighbours/a=3e4", "Nearest neighbours/b=8e5", "Fracture/breaking stretch=auto"],
     "NN: square grid, m = 1.5: not computed: a wave does not oscillate")])
def test_valid_cases_hold_and_a_stencil_that_buckles_does_not(out, claim, entries, fails):
    latcon("verify", claim, "--quick", "--quiet", "--case", CASES / "quick.prm", "--output-dir", out, *settings(*entries), expect=3 if fails else 0)
    assert fails is None or any(row["quantity"].startswith(fails) for row in read_csv(out / "results.csv") if row["verdict"] == "fails")


@quick_only
def test_a_claim_that_is_named_judges_something_or_fails(out):
    run = latcon("verify", "running-crack", "--quick", "--set", "Loading/strain y=0", "--output-dir", out, expect=3)
    assert "running-crack: rows that are judged: not computed: this case has none" in run.stdout


@pytest.mark.skipif(not FULL, reason="long")
def test_frames_of_the_running_crack_can_be_compared(out, tmp_path):
    """Frames of both sides have the same time and coordinates: the velocities differ most at the tip."""
    latcon("verify", "running-crack", "--quick", "--output-dir", out)
    lattice, *continua = read_csv(out / "running_crack_frames.csv")
    d, X, Y = 0.625e-3, float(lattice["X_tip [m]"]), float(lattice["Y_tip [m]"])
    for side in continua:
        differences = []
        for centre in (X, X - 8 * d):
            latcon("compare", out / lattice["file"], out / side["file"], "--overlap", "--exclude", f"{centre},{Y},{5 * d}",
                   "--output-dir", tmp_path / "compared")
            rows = {row["quantity"]: row for row in read_csv(tmp_path / "compared" / "results.csv")}
            differences.append(float(rows["velocity, largest difference"]["error"]))
        assert differences[0] < 0.5 * differences[1], side
