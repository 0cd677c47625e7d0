"""latcon compare of two cracks: differences in units of their uncertainty, entries that differ, distance of the paths."""
import json
import math
import os
import re
import shutil

import numpy as np
import pytest

from program import latcon, read_csv, read_json, refused, settings

from latcon import UnreadableFile
from latcon.compare import _read_crack as read_crack
from latcon.quantities import number_text
from latcon.study.program import InputError

RUN = ["fracture", "quick", "--skip-verification", "--no-report", "--quiet", *settings("Sheet/length=3 cm", "Sheet/height=1.5 cm")]


@pytest.fixture(scope="module")
def pair(module_path):
    """Folders of two cracks."""
    for name, *entries in (("one",), ("other", "Loading/strain y=1.9", "Lattice/noise seed=3")):
        latcon(*RUN, "--output-dir", module_path / name, *settings(*entries))
    return module_path / "one", module_path / "other"


def compare(out, *arguments):
    run = latcon("compare", *arguments, "--no-report", "--output-dir", out)
    return run.stdout, read_json(out / "compare.json")


@pytest.fixture(scope="module")
def compared(module_path, pair):
    """What was printed of the two, and compare.json."""
    return compare(module_path / "compared", *pair)


def test_quantities_are_those_of_the_runs(module_path, pair, compared):
    text, found = compared
    rows = {row["name"]: row for row in found["quantities"]}
    table = {row["quantity"]: row for row in read_csv(module_path / "compared" / "compare.csv")}
    assert list(rows) == list(table)
    for file, names in [("crack.json", ["speed_lagrangian", "speed_laboratory", "bonds_broken"]), ("near_tip.json", ["wedge_angle"])]:
        first, second = (read_json(run / file) for run in pair)
        for name in names:
            row = rows[name]
            assert (row["first"], row["second"]) == (first[name], second[name])
            assert row["difference"] == second[name] - first[name]
            assert float(table[name]["difference"]) == row["difference"]
            if name == "bonds_broken":
                assert (row["difference_over_uncertainty"], table[name]["difference_over_uncertainty"]) == (None, "")
                continue
            combined = math.hypot(first[name + "_uncertainty"], second[name + "_uncertainty"])
            assert row["difference_over_uncertainty"] == pytest.approx(row["difference"] / combined, abs=1e-12)
    assert rows["zeta"]["first"] == pytest.approx(10.80695, abs=1e-5)  # theory.md, eq. (L.5)
    assert re.search(r"(?m)^speed_lagrangian  +\S+ ± \S+ m/s  +\S+ ± \S+ m/s  +\S+ m/s  +[+-]\d+\.\d$", text)
    assert re.search(r"(?m)^pattern ", text)


def test_entries_that_differ_are_listed(compared):
    text, found = compared
    assert found["entries"] == [{"key": "Lattice/noise seed", "unit": "", "first": "1", "second": "3"},
                      {"key": "Loading/strain y", "unit": "1", "first": "1.8", "second": "1.9"}]
    assert re.search(r"(?m)^Loading/strain y +1\.8 +1\.9$", text)


def test_distance_of_the_paths_is_numpys(pair, compared):
    _, found = compared
    paths = [np.genfromtxt(run / "crack.csv", delimiter=",", names=True) for run in pair]
    begin, end = max(path["X"][0] for path in paths), min(path["X"][-1] for path in paths)
    assert (found["paths"]["X_begin"], found["paths"]["X_end"]) == (begin, end)
    X = np.linspace(begin, end, 200001)
    apart = np.interp(X, paths[1]["X"], paths[1]["Y"]) - np.interp(X, paths[0]["X"], paths[0]["Y"])
    assert abs(apart).max() > 1e-4
    assert found["paths"]["rms_distance"] == pytest.approx(np.sqrt((apart**2).mean()), abs=1e-4 * abs(apart).max())
    assert found["paths"]["largest_distance"] == pytest.approx(abs(apart).max(), abs=1e-3 * abs(apart).max())
    assert found["paths"]["largest_distance_over_d"] == pytest.approx(found["paths"]["largest_distance"] / 0.625e-3, abs=5e-8)


def test_a_run_does_not_differ_from_itself(pair, out):
    text, found = compare(out, pair[0], pair[0])
    assert {row["difference"] for row in found["quantities"]} == {0.}
    assert (found["entries"], found["paths"]["rms_distance"], found["paths"]["largest_distance"]) == ([], 0., 0.)
    assert "The cases have the same entries." in text
    assert read_json(out / "run.json")["exit_code"] == 0


def test_the_page_shows_both_runs_and_which_failed_its_checks(tmp_path, pair, out):
    failed = shutil.copytree(pair[0], tmp_path / os.fsdecode(b"failed\xff"))  # not UTF-8
    info = read_json(failed / "run.json")
    del info["entries"]["Time/end"]
    info |= {"exit_code": 3, "failed_rows": {"fracture: energy imbalance over energy exchanged": "ledger"}}
    (failed / "run.json").write_text(json.dumps(info))
    run = latcon("compare", failed, pair[1], "--output-dir", out)
    assert run.stderr == ""
    assert f"{out}/compare.json, compare.csv, compare.html" in run.stdout
    found = read_json(out / "compare.json")
    for side, folder in (("first", failed), ("second", pair[1])):
        assert (out / found[f"{side}_folder"]).resolve() == folder.resolve()
    assert ("Time/end", "", "0.003") in [(entry["key"], entry["first"], entry["second"]) for entry in found["entries"]]
    html = (out / "compare.html").read_text(encoding="utf-8")
    assert html.count('class="viewer"') == 2
    speed = next(row for row in found["quantities"] if row["name"] == "speed_lagrangian")
    for words in ("Loading/strain y", found["pattern"]["first"], "speed lagrangian", number_text(speed["first"], speed["first_uncertainty"])):
        assert words in html
    assert re.search(r'failed its checks</b>: [^<]*energy imbalance over energy exchanged \(ledger\)', html)
    assert html.count("failed its checks") == 1
    compare(out, *pair)
    assert not (out / "compare.html").exists()


def test_what_is_no_pair_of_cracks_is_refused(tmp_path, pair):
    empty = tmp_path / "empty"
    empty.mkdir()
    for folders in [(pair[0], empty), (empty, pair[0])]:
        assert re.search(f"{empty} holds no crack.json.*give two output directories of cracks, or a lattice", refused("compare", *folders))
    assert "are for frames" in refused("compare", *pair, "--overlap")
    assert "is one of the runs" in refused("compare", *pair, "--output-dir", pair[1])
    damaged = shutil.copytree(pair[0], tmp_path / "damaged")
    (damaged / "crack.csv").write_text("t,X,Y\n0,1,2\n0,1\n")
    assert "damaged/crack.csv: line 3 has 2 fields, the header has 3" in refused("compare", pair[0], damaged)
    info = read_json(damaged / "run.json")
    del info["entries"]
    for file, text, message in (
            ("crack.csv", "t,X,Y\n0,1,2\n0,0.5,2\n", "damaged/crack.csv: line 3: damaged: X decreases"),
            ("run.json", json.dumps(info), "damaged/run.json: does not hold the entries of the case"),
            ("crack.json", "{}", "damaged: its crack was not measured"), ("crack.json", "{", "damaged/crack.json: not JSON")):
        (damaged / file).write_text(text)
        with pytest.raises((InputError, UnreadableFile), match=message):
            read_crack(None, str(damaged))
    (damaged / "run.json").unlink()
    with pytest.raises(UnreadableFile, match="damaged/run.json: No such file"):
        read_crack(None, str(damaged))
