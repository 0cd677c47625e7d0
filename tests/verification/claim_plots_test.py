"""The claims in the report: their sections, plots and error metrics, from tables with known orders and errors."""
import json
import math
import re
import shutil

import numpy as np
import pytest

import made_up_claims
from made_up_claims import write_claims
from made_up_runs import check_row, drawn, expect_texts, pixels, write_verification

from latcon.errors import UnreadableFile
from latcon.files import read_columns
from latcon.report.claim_plots import MODULES, all_plots
from latcon.report.claim_tables import Table, fitted_order, groups, largest_text, range_text

TABLES = [name for plot in all_plots() for name in (plot.name, *plot.others)]
decay_of = MODULES["intrinsic-length"].decay_of
# In the order in which they are checked.
CLAIMS = ("energy", "wave-speeds", "viscoelastic-waves", "relaxation", "intrinsic-length", "nonlocal", "disorder", "prestretch",
          "steady-crack", "running-crack")


def row(claim, number, verdict="holds"):
    """A row of results.json."""
    return check_row(claim, f"{claim} {verdict} {number}", verdict, error={"holds": 1e-3, "fails": 1.0}[verdict], tolerance=1e-2)


def write_run(folder, rows):
    write_verification(folder, rows)
    (folder / "claims.json").write_text(json.dumps({"claims": [
        {"name": claim, "title": f"Title of {claim}", "statement": f"Statement of {claim}."} for claim in CLAIMS]}))


def drawn_html(folder, expect=0):
    drawn(folder, "--quiet", expect=expect)
    return (folder / "report.html").read_text(encoding="utf-8")


def section_of(html, claim):
    """One claim's part of the page."""
    return re.search(rf'<section id="claim-{claim}">.*?</section>', html, re.S)[0]


def test_each_claim_has_its_text_plots_and_error_metrics(runs, monkeypatch):
    monkeypatch.setattr(made_up_claims, "STATES", made_up_claims.STATES[:2])  # both states of one set of shells
    write_run(runs, [row(claim, 0) for claim in CLAIMS])
    write_claims(runs)
    html = drawn_html(runs)
    expect_texts(runs, "claims")
    for claim in MODULES:
        assert section_of(html, claim).count("<img ") == len(MODULES[claim].PLOTS)
    assert {path.stem for path in runs.glob("*.csv")} == set(TABLES)
    for plot in all_plots():
        colours = pixels((runs / f"{plot.name}.png").read_bytes())
        assert (np.ptp(colours[::4, ::4], axis=2) > 60).mean() > 1e-3, f"{plot.name} has no colours"


def test_what_is_missing_is_left_out(tmp_path):
    write_run(tmp_path, [row("energy", 0), row("homemade", 0)])
    write_claims(tmp_path)
    for name in TABLES:
        if name not in ("edge_layer", "dispersion_runs"):
            (tmp_path / f"{name}.csv").unlink()
    html = drawn_html(tmp_path)
    assert re.findall(r'<section id="claim-([^"]*)"', html) == ["energy", "intrinsic-length", "homemade"]
    assert html.count("<img ") == 1
    # Claims that were not checked are not shown.
    assert "At free edges" in section_of(html, "intrinsic-length")
    assert "The speed of waves falls" not in section_of(html, "intrinsic-length")
    assert "No quantity of this claim was checked" in section_of(html, "intrinsic-length")
    assert not (tmp_path / "dispersion.png").exists()


def test_values_that_were_not_computed_leave_gaps(tmp_path, monkeypatch):
    monkeypatch.setattr(made_up_claims, "STATES", made_up_claims.STATES[:1])  # fewer panels of each plot
    monkeypatch.setattr(made_up_claims, "ANGLES", made_up_claims.ANGLES[:1])
    write_run(tmp_path, [])
    write_claims(tmp_path)
    for name in TABLES:
        lines = (tmp_path / f"{name}.csv").read_text().splitlines()
        header = lines[0].split(",")
        kept = {"shells", "law", "wave", "F_xx", "F_yy", "k d", "angle [deg]", "R/d", "length/d", "row", "side", "X/d", "Y/d", "part",
                "w tau", "integrator", "t [s]", "modulus", "sheet", "beta", "driving", "breaking elongation", "exists"}
        rows = [",".join(cell if column in kept else "nan" for column, cell in zip(header, line.split(",")))
                for line in lines[1:]]
        (tmp_path / f"{name}.csv").write_text("\n".join([lines[0], *rows]) + "\n")
    html = drawn_html(tmp_path)
    assert html.count("<img ") == len(all_plots())


@pytest.mark.parametrize("plot", all_plots(), ids=lambda plot: plot.name)
def test_damaged_table_is_named(tmp_path, plot):
    made, folder = tmp_path / "made", tmp_path / "run"
    made.mkdir()
    write_claims(made)
    write_run(folder, [])
    for name in (plot.name, *plot.others):  # no other plot is drawn
        shutil.copy(made / f"{name}.csv", folder)
    for name in (plot.name, *plot.others):
        path = folder / f"{name}.csv"
        whole = path.read_text()
        header, first = whole.splitlines()[:2]
        damaged = [whole.replace(header.split(",")[-1] + "\n", "other\n", 1), whole[:whole.rindex(",")],
                   header + "\n" + first.rpartition(",")[0] + ",many\n"]
        plotted = {"wave_speeds": "bloch [m/s]", "disorder": "reuss [1]", "running_crack": "v_x [m/s]"}
        if name in plotted:
            damaged[0] = whole.replace(plotted[name], "other", 1)  # the last column is not drawn
        if name == "wave_speeds":
            damaged[2] = whole.replace(",L,", ",P,", 1)
        for text in damaged:
            path.write_text(text)
            assert re.search(rf"\Alatcon: .*{name}\.csv: .+\n\Z", drawn(folder, "--quiet", expect=2)[1])
        path.write_text(whole)


def test_failing_rows_are_never_folded(tmp_path):
    rows = [row("energy", number) for number in range(30)] + [row("wave-speeds", 0, "fails")]
    rows += [row("wave-speeds", number) for number in range(1, 30)]
    write_run(tmp_path, rows)
    html = drawn_html(tmp_path, expect=3)
    section = section_of(html, "wave-speeds")
    assert html.index("claim-wave-speeds\">") < html.index("claim-energy\">")
    assert html.index('<section id="claim-wave-speeds"') < html.index('<section id="claim-energy"')
    assert section.index("wave-speeds fails 0") < section.index("<details>")
    assert section.index("wave-speeds holds 1") > section.index("<details>")
    assert "29 rows that do not fail" in section
    assert "<details open" not in section_of(html, "energy")


def test_order_is_that_of_the_smallest_points():
    x = np.array([0.8, 0.1, 0.2, 0.4])
    assert fitted_order(x, 3 * x**4) == pytest.approx(4, abs=5e-13)
    error = np.where(x < 0.5, x**2, 1.0)
    assert fitted_order(x, error, share=0.5) == pytest.approx(2, abs=5e-13)
    assert fitted_order(x, error) != pytest.approx(2, abs=5e-2)


def test_order_needs_three_errors_above_round_off():
    x = np.array([0.1, 0.2, 0.4, 0.8])
    assert fitted_order(x, 1e-16 * x) is None
    assert fitted_order(x, np.array([np.nan, np.nan, 1e-3, 1e-2])) is None


def test_decay_has_the_sign_of_what_alternates():
    assert decay_of(0.3 * (-0.2) ** np.arange(20)) == pytest.approx(-0.2, abs=5e-13)
    assert decay_of(0.3 * 0.5 ** np.arange(5)) == pytest.approx(0.5, abs=5e-13)
    assert np.isnan(decay_of(np.zeros(4)))


def test_says_how_much_was_not_computed():
    assert largest_text(np.array([-1e-7, 1e-8])) == "up to 1.0e-07"
    assert largest_text(np.array([np.nan, 1e-7, 1e-8])) == "up to 1.0e-07 (1 of 3 not computed)"
    assert largest_text(np.array([np.nan, np.inf])) == "an amount that could not be computed (2 of 2 not computed)"
    for place in range(3):
        values = [1.98, 2.0, 2.03]
        values.insert(place, math.nan)
        assert range_text(values) == "1.98 to 2.03 (1 of 4 not computed)"
    assert range_text([None, math.nan]) is None


def test_table_of_words_and_numbers(tmp_path):
    path = tmp_path / "t.csv"
    path.write_text('law,"x, y [m]",z\n"a, b",1,nan\nc,2,3\n')
    table = Table(path, read_columns(path, None, texts=("law", "wave"), finite=False))
    assert read_columns(path, ("x, y [m]", "z"), texts=("law",), finite=False).keys() == table.keys()
    assert list(table["law"]) == ["a, b", "c"]
    assert list(table["x, y [m]"]) == [1.0, 2.0]
    assert [key for key, _ in groups(table, "law")] == [("a, b",), ("c",)]
    with pytest.raises(UnreadableFile, match="line 2 holds a number that is not finite"):
        read_columns(path, ("z",), texts=("law",))
    with pytest.raises(UnreadableFile, match="has no column 'wave'"):
        read_columns(path, ("z",), texts=("wave",))
