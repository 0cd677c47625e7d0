"""Tests of output directories that several processes use, that are removed, or that contain files of others."""
import json
import os
import pathlib
import shutil
import signal
import subprocess
import time

import pytest

from program import CASES, LATCON, frames, latcon, latcon_on_ranks, on_ranks, settings, wait_for
from studies import files_in
from verdicts_fixture import REFUSED

from latcon.report.runs import find_runs

QUICK = str(CASES / "quick.prm")
TINY = [QUICK, "--set", "Sheet/length=10 mm", "--set", "Sheet/height=6 mm", "--set", "Time/end=0.01 ms"]
# Starts at once and runs until it is killed.
LONG = ["fracture", QUICK, "--skip-verification", "--no-report", "--quiet", "--threads", "1",
        "--set", "Output/frame interval=0.02 ms", "--set", "Checkpoints/steps=64"]
ENDLESS = [*LONG, "--set", "Sheet/length=30 cm"]
LOCK = ".latcon.lock"


@pytest.fixture(scope="module")
def study(module_path):
    study = module_path / "study.json"
    study.write_text(json.dumps({"title": "t", "base": QUICK, "runs": {"a": {}}, "claims": [
        {"claim": "c", "paper": "s", "rows": [{"run": "a", "quantity": "pattern"}]}]}))
    return study


def stop(process):
    process.send_signal(signal.SIGSTOP)
    tasks = pathlib.Path(f"/proc/{process.pid}/task")  # a thread that writes stops after the call
    assert wait_for(lambda: all(") T " in (task / "stat").read_text() for task in tasks.iterdir()), process)


@pytest.fixture(scope="module", autouse=True)
def refused_study(study, module_path):
    """A study of which a stopped process holds a run, started at first, as it waits for 10 s; the folder of that run."""
    part = module_path / "out" / "runs" / "a-1.part"
    part.mkdir(parents=True)
    owner = subprocess.Popen([LATCON, *ENDLESS, "--output-dir", part], stdout=subprocess.DEVNULL)
    assert wait_for((part / "lattice-0000.vtp").exists, owner)
    stop(owner)
    before = files_in(part)
    refused = subprocess.Popen([LATCON, "study", study, "--skip-verification", "--output-dir", module_path / "out"],
                               stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True)
    yield part, owner, before, refused
    for process in (owner, refused):
        process.kill()
        process.wait()


def commands(study, out):
    yield ["lattice", *TINY, "--output-dir", out]
    yield ["continuum", CASES / "shear_layer.prm", "--output-dir", out]
    yield ["fracture", *TINY, "--skip-verification", "--output-dir", out]
    yield ["verify", "energy", "--quick", "--output-dir", out]
    yield ["report", out]
    yield ["study", study, "--skip-verification", "--output-dir", out]
    yield ["batch", study, "--slurm", "--skip-verification", "--output-dir", out]


def test_second_command_is_refused_and_writes_nothing(start, out, tmp_path, study):
    owner = start(*ENDLESS, "--output-dir", out)
    assert wait_for((out / "lattice-0000.vtp").exists, owner)
    stop(owner)
    before = files_in(out)
    for refused in [start(*command) for command in commands(study, out)]:  # each waits for a second
        _, said = refused.communicate(timeout=600)
        assert refused.returncode == 2, said
        assert f"{out} is in use by process {owner.pid} on " in said
        assert "--output-dir" in said
    latcon("lattice", *TINY, "--dry-run", "--output-dir", out)
    elsewhere = tmp_path / "elsewhere"
    assert latcon("report", out, "--dry-run", "--output-dir", elsewhere).stdout == f"{out}\n" and not elsewhere.exists()
    latcon("report", out, "--animation", "--output-dir", elsewhere, "--quiet")
    assert "has not ended" in (elsewhere / "report.html").read_text()
    assert files_in(out) == before
    owner.kill()
    owner.communicate()
    latcon("lattice", *TINY, "--output-dir", out)


def test_ranks_hold_it_and_respect_it(start, out):
    ranks = start(*ENDLESS, "--output-dir", out, launcher=on_ranks(2))
    assert wait_for((out / "lattice-0000.vtp").exists, ranks)
    run = latcon_on_ranks(2, "lattice", *TINY, "--set", "Lattice/solution=motion", "--output-dir", out, expect=2)
    assert "is in use by process" in run.stderr
    ranks.terminate()
    ranks.communicate()


VICTIMS = {
    "crack": LONG,
    "lattice": ["lattice", QUICK, "--quiet", *settings(
        "Lattice/solution=motion", "Time/end=10 ms", "Output/frame interval=0.02 ms", "Checkpoints/steps=32")],
    "continuum": ["continuum", CASES / "shear_layer.prm", "--quiet", *settings(
        "Continuum/solution=motion", "Continuum/time step=5 us", "Time/end=10 ms", "Checkpoints/steps=3", "Output/frame interval=0.02 ms")]}


def remove(out, process):
    assert wait_for((out / "run.json").exists, process)
    time.sleep(0.2)
    while out.exists():  # the run writes meanwhile
        shutil.rmtree(out, ignore_errors=True)


@pytest.mark.parametrize("name", VICTIMS)
def test_run_whose_folder_is_removed_says_so(start, out, name):
    process = start(*VICTIMS[name], "--output-dir", out)
    remove(out, process)
    _, said = process.communicate(timeout=600)
    assert process.returncode == 5, said
    assert str(out) in said
    assert not out.exists()


def test_run_whose_folder_is_replaced_leaves_the_other_alone(start, out):
    process = start(*LONG, "--output-dir", out)
    assert wait_for((out / "run.json").exists, process)
    stop(process)
    shutil.rmtree(out)
    out.mkdir()
    (out / LOCK).write_text("of another run")
    process.send_signal(signal.SIGCONT)
    _, said = process.communicate(timeout=600)
    assert process.returncode == 5, said
    assert str(out) in said
    assert os.listdir(out) == [LOCK]


def test_links_are_not_followed(out, tmp_path):
    crack = ["fracture", *TINY, "--skip-verification", "--quiet", "--set", "Checkpoints/steps=16"]
    latcon(*crack, "--no-report", "--output-dir", out)
    names = {*files_in(out), "report.html", "sheet.png", "energy.png"}
    assert any(name.endswith(".h5") for name in names)
    shutil.rmtree(out)
    victim = tmp_path / "victim"
    victim.write_text("mine")
    for name in names:
        if name != LOCK:
            for place in (out / name, out / f"{name}.part"):
                place.parent.mkdir(parents=True, exist_ok=True)
                place.symlink_to(victim)
    latcon(*crack, "--output-dir", out)
    assert victim.read_text() == "mine"
    assert names <= files_in(out).keys()
    assert not [name for name in names if (out / name).is_symlink()]


def test_link_in_place_of_the_lock_is_refused(tmp_path, out):
    out.mkdir()
    victim = tmp_path / "victim"
    victim.write_text("mine")
    (out / LOCK).symlink_to(victim)
    run = latcon("lattice", *TINY, "--output-dir", out, expect=5)
    assert str(out / LOCK) in run.stderr
    assert (victim.read_text(), os.listdir(out)) == ("mine", [LOCK])


def test_what_killed_runs_left_is_removed(out):
    (out / "checkpoints").mkdir(parents=True)
    stale = [out / "case.prm.0123456789abcdef.part", out / "checkpoints" / "checkpoint-000000000016.h5.00000000deadbeef.part"]
    own = out / "notes.part"
    for path in (*stale, own):
        path.write_text("half")
    latcon("lattice", *TINY, "--output-dir", out)
    assert not [path for path in stale if path.exists()]
    assert own.read_text() == "half"


def test_files_of_the_run_before_are_moved_aside(out):
    crack = ["fracture", *TINY, "--output-dir", out, "--no-report"]

    def run(*words, expect=0):
        return latcon(*crack, *words, expect=expect).stdout

    assert "earlier-run" not in run("--skip-verification", "--set", "Output/frame interval=1 us")
    (out / "notes.txt").write_text("mine")
    before, first = sorted(path.name for path in out.glob("lattice-*.vtp")), (out / "crack.csv").read_bytes()
    assert f"now in {out}/earlier-run\n" in run("--skip-verification", "--set", "Output/frame interval=0")
    named = sorted(path.name for _, path in frames(out / "lattice.pvd"))
    assert sorted(path.name for path in out.glob("lattice-*.vtp")) == named
    assert len(named) < len(before)
    assert sorted(path.name for path in (out / "earlier-run").glob("lattice-*.vtp")) == before
    assert (out / "earlier-run" / "crack.csv").read_bytes() == first
    assert (out / "notes.txt").exists()
    assert f"now in {out}/earlier-run-2\n" in run("--skip-verification", "--resume")  # there is no checkpoint
    # A refused crack leaves no files of the previous run among its own, and a report shows one run.
    run(*REFUSED, expect=3)
    assert [found.folder for found in find_runs(out)[0]] == [out]
    assert not any((out / name).exists() for name in ("crack.json", "crack.csv", "crack_path.png"))


def test_files_of_others_are_moved_aside(out):
    out.mkdir()
    names = ("lattice-0000.vtp", "results.csv", "report.html")
    for name in names:
        (out / name).write_text("mine")
    run = latcon("lattice", *TINY, "--output-dir", out)
    assert run.stderr.count("that latcon did not write are now in") == 2
    assert "that latcon did not write are now in" in latcon("report", out).stderr  # written by Python
    for name, aside in zip(names, ("earlier-run", "earlier-run-2", "earlier-run-3")):
        assert (out / aside / name).read_text() == "mine" and (out / name).read_bytes() != b"mine"


def test_case_in_its_own_folder_is_not_overwritten(out):
    out.mkdir()
    own = (CASES / "quick.prm").read_text()
    (out / "case.prm").write_text(own)
    refused = latcon("lattice", out / "case.prm", "--output-dir", out, expect=2)
    assert "overwrite its own case" in refused.stderr
    assert [path.read_text() for path in out.iterdir()] == [own]
    latcon("lattice", *TINY, "--output-dir", out)
    latcon("lattice", out / "case.prm", "--output-dir", out, "--set", "Loading/strain x=0.1")


def test_runs_of_a_study_hold_theirs(refused_study):
    part, owner, before, refused = refused_study
    assert f"{part} is in use by process {owner.pid} on " in refused.communicate(timeout=600)[1]
    assert refused.returncode == 2
    assert files_in(part) == before
