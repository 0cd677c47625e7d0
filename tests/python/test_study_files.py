"""Study files, sweeps, shards and pools of processes."""
import json
import os
import pathlib
import sys
import time

import latcon
import pytest

from latcon.study.plan import (PlannedRun, Verification, default_folder, parse_shard, plan_difference, plan_runs, plan_text, runs_of_shard)
from latcon.study.pool import run_processes
from latcon.study.program import Ended, InputError, Program
from latcon.study.study_file import StudyRun, read_study
from latcon.study.sweep import combinations, parse_sweep, sweep_study


@pytest.fixture(scope="module")
def program():
    program = Program({"program": os.fspath(latcon.find_program()), "data": "", "arguments": [], "threads": 1, "yes": False})
    yield program
    program.close()
    with pytest.raises(Ended, match="1, 'a child process was killed by signal 9'"):
        program.ask(memory=[])


@pytest.mark.parametrize("text, values", [
    ("Loading/strain y=1.5:1.9:5", ["1.5", "1.6", "1.7", "1.8", "1.9"]), ("Loading/strain x = -0.1 : 0.2 : 4", ["-0.1", "0", "0.1", "0.2"]),
    ("Sheet/height=1 cm:2cm:3", ["1 cm", "1.5 cm", "2 cm"]), ("Nearest neighbours/a=1e5:+2e5:2", ["100000", "200000"]),
    ("Sheet/orientation=rows-along-crack, rows-across-crack", ["rows-along-crack", "rows-across-crack"])])
def test_sweeps_are_grids_or_lists(program, text, values):
    assert parse_sweep(program, text).values == values


def test_sweeps_give_all_combinations_as_a_study_file(program):
    text = sweep_study(program, ["Loading/strain y=1.5:1.6:2", "Sheet/height=2 cm,3 cm"], "fig1", "base.prm",
                       {"Material/density": "900", "Loading/history times": ""}, 3)
    study = read_study(program, "folder/sweep.json", False, text.encode())
    assert (study.title, study.base) == ("Sweep of Loading/strain y, Sheet/height (fig1)", "folder/base.prm")
    assert [run.name for run in study.runs][:2] == ["strain-y-1.5_height-2cm", "strain-y-1.5_height-3cm"]
    assert study.settings == {"Material/density": "900", "Loading/history times": ""}
    assert study.runs[3].own == {"Loading/strain y": "1.6", "Sheet/height": "3 cm"} and study.runs[3].seeds == [1, 2, 3]


def test_a_plan_resolves_every_case(program, tmp_path):
    (tmp_path / "base.prm").write_text(latcon.Case("quick").text())
    text = sweep_study(program, ["Loading/strain y=1.5:1.6:2"], "quick", "base.prm", {}, 2)
    study = read_study(program, os.fspath(tmp_path / "sweep.json"), False, text.encode())
    program.ask(base=os.fsencode(study.base).hex())
    study.runs[0].own["Fracture/seed sites"] = "5"
    study.override({"Fracture/seed sites": "3"})
    assert study.settings == {"Fracture/seed sites": "3"} and study.runs[0].own == {"Loading/strain y": "1.5"}
    with pytest.raises(InputError, match="--set: Loading/strain y is also an entry of the sweep"):
        study.override({"Loading/strain y": "2"})
    plan = plan_runs(program, study, Verification.NONE)
    assert "Fracture/seed sites=3" in plan[0].changes
    assert [(run.seed, run.value("Loading/strain y")) for run in plan] == [(1, 1.5), (2, 1.5), (1, 1.6), (2, 1.6)]
    # theory.md, eq. (L.5): (eta / a) / (d / sqrt(a / rho)) = 65.625 / 1e5 / (0.625e-3 / sqrt(1e5 / 944))
    assert plan[0].value("zeta") == pytest.approx(10.80695, abs=1e-5)
    assert plan[0].size > 1000 and plan[0].seconds > 0
    assert len({run.case_sha256 for run in plan}) == 4
    study.runs.append(StudyRun("low", own={"Sheet/height": "1 cm"}))
    (added,) = plan_runs(program, study, Verification.NONE, [StudyRun("between", all={"Loading/strain y": "1.55"}, seeds=[3])])
    assert (added.folder, added.value("Loading/strain y"), added.value("Sheet/height")) == ("between-3", 1.55, 0.025)


def test_runs_of_a_sweep_are_limited_and_have_distinct_names(program):
    sweep = parse_sweep(program, "Loading/strain y=1:2:1000")
    assert len(combinations([sweep], 100)) == 1000
    for sweeps, n_seeds in (([sweep], 101), ([sweep, sweep], 1)):
        with pytest.raises(InputError):
            combinations(sweeps, n_seeds)
    long = parse_sweep(program, f"Nearest neighbours/psi=lam^2 + {'1' * 200},lam^2 + {'1' * 200} + lam")
    names = list(combinations([long], 1))
    assert len(set(names)) == 2 and all(len(name) == 150 and name.startswith("psi-lam-21") for name in names)


GOOD = {"title": "t", "base": "b.prm", "seeds": [4, 5], "sweep": ["Sheet/height=2 cm:4 cm:3"], "refine": 6, "runs": {"own": {}},
        "quick": {"seeds": [7], "sweep": ["Sheet/height=2 cm,4 cm"]},
        "claims": [{"claim": "c", "rows": [{"run": "height-3cm", "quantity": "pattern"}]}]}


def test_quick_versions_of_sweeps(program):
    study = read_study(program, "s.json", False, json.dumps(GOOD).encode())
    assert [run.name for run in study.runs] == ["height-2cm", "height-3cm", "height-4cm", "own"] and study.left_out == []
    quick = read_study(program, "s.json", True, json.dumps(GOOD).encode())
    assert [run.seeds for run in quick.runs] == [[7]] * 3 and quick.left_out == ["height-3cm"]


def test_a_sweep_beside_its_case_stays_there(tmp_path):
    assert default_folder(f"{tmp_path}/sweep.json", False) == "output/sweep"
    (tmp_path / "base.json").touch()
    assert default_folder(f"{tmp_path}/sweep.json", False) == str(tmp_path)


def problems():
    lines = [line for line in pathlib.Path(__file__).with_name("study_problems.txt").read_text().splitlines() if line and line[0] != "#"]
    for case, part in zip(lines[::2], lines[1::2], strict=True):
        yield pytest.param(*case.split(" ", 1), part[2:], id=case)
    for text, part in (("[" * 99999, "nested deeper"), ("{}\0", "s.json:1: not a text file"), ("[" * 100 + "]" * 100, "nested deeper than 64"),
                       ('{"runs": {"%s": {}}}' % ("a" * 209), "must consist of at most 208 letters")):
        yield pytest.param("text", text, part, id=part)


@pytest.mark.parametrize("kind, text, part", problems())
def test_problems_name_their_place(program, kind, text, part):
    if kind == "row":
        kind, text = "study", json.dumps({"claims": [{"claim": "c", "rows": [{"run": "own", "quantity": "amplitude", **json.loads(text)}]}]})
    with pytest.raises(InputError) as error:
        if kind == "sweep":
            parse_sweep(program, text)
        else:
            read_study(program, "s.json", False, (json.dumps(GOOD | json.loads(text)) if kind == "study" else text).encode())
    assert part in str(error.value)


def planned(name, seconds):
    return PlannedRun(name, 1, False, [], {}, "digest of " + name, 1e-3, None, 1, 1, seconds, 1)


def test_shards_share_the_runs():
    plan = [planned(name, seconds) for name, seconds in zip("abcde", (1, 5, 3, 5, 2))]
    assert [runs_of_shard(plan, i, 2) for i in (1, 2)] == [[1, 2, 0], [3, 4]]
    assert parse_shard("3/8") == (3, 8)
    for text in ("0/8", "9/8", "1/0", "1/100001", "3", "/", "a/b", "1/2/3", "-1/2", "1.5/2"):
        with pytest.raises(InputError):
            parse_shard(text)


def test_plans_differ_in_words():
    plan = [planned("a", 1), planned("b", 1)]
    stored = plan_text("t", plan, False, 2)
    assert plan_difference(stored, plan_text("t", plan, False, 0)) == ""
    for said, *now in (("another study, 't'", "u", plan, False, 2), ("--skip-verification", "t", plan, True, 2),
                       ("begun with 2 shards", "t", plan, False, 3), ("it has 2 runs, now there are 1", "t", plan[:1], False, 2),
                       ("the case of run c-1 differs", "t", [plan[0], planned("c", 1)], False, 2)):
        assert said in plan_difference(stored, plan_text(*now))
    assert "damaged" in plan_difference("[", plan_text("t", plan, False, 2))


def test_pool_runs_all_jobs_and_keeps_its_limit(tmp_path):
    ended, largest = {}, 0

    def waiting(running):
        nonlocal largest
        largest = max(largest, len(running))
    commands = [["/bin/sh", "-c", text] for text in ("echo one; sleep 0.2", "exit 3", "kill -9 $$", "sleep 0.2")] + [["/nowhere/no"]]
    assert run_processes(5, 2, lambda job: (commands[job], str(tmp_path / f"{job}.txt")), ended.__setitem__, waiting, lambda: False)
    assert ended == {0: 0, 1: 3, 2: 137, 3: 0, 4: 127} and largest == 2
    assert (tmp_path / "0.txt").read_text() == "one\n"


def test_pool_ends_its_children_when_it_is_stopped_or_fails(tmp_path):
    begin, ended = time.monotonic(), []

    def waiting(running):
        if time.monotonic() - begin > 0.3:
            raise ValueError
    command = [sys.executable, "-c", "import time; time.sleep(60)"], str(tmp_path / "log.txt")
    assert not run_processes(2, 1, lambda job: command, lambda job, status: ended.append(job), lambda running: None,
                             lambda: time.monotonic() - begin > 0.3)
    with pytest.raises(ValueError):
        run_processes(2, 1, lambda job: command, lambda job, status: ended.append(job), waiting, lambda: False)
    assert ended == [] and time.monotonic() - begin < 30
