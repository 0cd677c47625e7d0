"""Checks that signals end every command soon, with exit code 130, also in run.json."""
import json
import os
import re
import resource
import shutil
import signal
import subprocess
import time

import pytest

from program import CASES, LATCON, catches, children, latcon, on_ranks, read_json, wait_for

QUICK = str(CASES / "quick.prm")
TINY = [QUICK, "--set", "Sheet/length=10 mm", "--set", "Sheet/height=6 mm"]
INTERRUPTED = 130
# Longest time [s] in which a command must end after a signal.
HANGS = 20
# From the keyboard, from a scheduler, and from a limit; all are caught alike.
SOME = ("SIGINT", "SIGUSR1", "SIGXCPU")
ALL = (*SOME, "SIGTERM", "SIGHUP", "SIGUSR2", "SIGALRM")


def started(out, process):
    assert wait_for((out / "run.json").exists, process), "it has not begun"


def ends(process, message="interrupted by SIG"):
    _, errors = process.communicate(timeout=HANGS)
    assert process.returncode == INTERRUPTED, errors
    assert message in errors
    assert "Traceback" not in errors


# Commands and phases without state to save end at once.
def ends_at_once(start, out, *arguments, begun=None, number=signal.SIGINT):
    process = start(*arguments, "--output-dir", out)
    started(out, process)
    if begun:
        assert wait_for(begun, process)
    process.send_signal(number)
    ends(process)
    assert read_json(out / "run.json")["exit_code"] == INTERRUPTED


def test_verify_keeps_the_claims_that_are_done(out, start):
    results = out / "results.json"
    ends_at_once(start, out, "verify", "intrinsic-length", "prestretch", "--quick", begun=results.exists, number=signal.SIGTERM)
    claims = {row["claim"] for row in read_json(results)["claims"]}
    assert claims == {"intrinsic-length"} and (out / "dispersion.csv").exists()
    assert read_json(out / "run.json")["verdict"] is None


@pytest.mark.parametrize("command, begun", [
    (["lattice", QUICK, "--set", "Sheet/length=25 cm", "--set", "Sheet/height=15 cm"], "lattice-0000.vtp"),
    (["continuum", CASES / "hole.prm", "--set", "Continuum/refinements=3"], "continuum.pvd"), (["fracture", QUICK], "run.json")],
    ids=["relaxation", "equilibrium", "claims before a crack"])
def test_what_has_no_state_to_save_ends_at_once(out, start, command, begun):
    ends_at_once(start, out, *command, begun=(out / begun).exists)
    assert not (out / "crack.json").exists()


def test_dry_run(tmp_path, start):
    study = tmp_path / "study.json"
    seeds = list(range(20000))
    study.write_text(json.dumps({"title": "t", "base": QUICK, "runs": {"a": {"seeds": seeds}}, "claims": [
        {"claim": "c", "paper": "s", "rows": [{"run": "a", "quantity": "pattern"}]}]}))
    is_ended_as_it_begins(start, "study", study, "--dry-run")


def interrupt():
    signal.pthread_sigmask(signal.SIG_BLOCK, {signal.SIGINT})
    os.kill(os.getpid(), signal.SIGINT)


@pytest.mark.parametrize("how", [{"preexec_fn": interrupt}, {"env": os.environ | {"LATCON_INTERRUPT": "1"}}],
                         ids=["since before the program", "while MPI ends"])
def test_a_signal_that_comes_before_python_ends_it(tmp_path, start, how):
    ends(start("study", tmp_path / "study.json", **how))


def test_report_ends_with_its_script(start, out):
    latcon("fracture", *TINY, "--set", "Time/end=0.01 ms", "--skip-verification", "--no-report", "--output-dir", out)
    process = start("report", out, start_new_session=True)
    assert wait_for(lambda: children(process.pid), process)
    script = children(process.pid)[0]
    time.sleep(0.5)
    os.killpg(process.pid, signal.SIGINT)  # as the keyboard does
    ends(process)
    assert wait_for(lambda: not os.path.exists(f"/proc/{script}/exe"), process, 5)


# As from the keyboard: the signal is sent to the command and to its child processes.
def is_ended(process):
    os.killpg(process.pid, signal.SIGINT)
    ends(process)


def is_ended_as_it_reads(start, pipe, *arguments):
    """Checks that the command ends while it waits for a file that nobody writes."""
    process = start(*arguments, start_new_session=True)
    writers = []

    def is_read():
        try:
            writers.append(os.open(pipe, os.O_WRONLY | os.O_NONBLOCK))
        except OSError:
            return False  # nobody has opened it
        return True

    assert wait_for(is_read, process)
    time.sleep(0.1)  # a signal just before Python reads would wait for the end of the file
    is_ended(process)
    os.close(writers[0])


def is_ended_as_it_begins(start, *arguments):
    process = start(*arguments, start_new_session=True)
    assert wait_for(lambda: catches(process, signal.SIGINT), process)
    is_ended(process)


def test_ends_while_it_reads(out, tmp_path, start):
    latcon("fracture", *TINY, "--set", "Time/end=0.01 ms", "--skip-verification", "--no-report", "--output-dir", out)
    film = out / "motion-0001.vtp"
    film.unlink()
    case, study = tmp_path / "case.prm", tmp_path / "study.json"
    for pipe in (case, study, film):
        os.mkfifo(pipe)
    commands = {"verify": (case, "energy", "--quick", "--case", case), "lattice": (case, case),
                "continuum": (case, case), "fracture": (case, case), "study": (study, study),
                "batch": (study, study, "--slurm"), "report": (film, out), "schema": (case, case)}
    immediate = {"entries", "help", "init"}  # read shipped files alone
    listed = latcon("--help").stdout.partition("Subcommands:")[2].partition("Exit codes")[0]
    assert set(re.findall(r"^  (\w+) ", listed, re.MULTILINE)) == {*commands, *immediate, "compare"}
    for name, (pipe, *arguments) in commands.items():
        is_ended_as_it_reads(start, pipe, name, *arguments)


def test_comparison(out, tmp_path, start):
    """Frames cannot be pipes: the signal is sent before they are read."""
    sheets = {"lattice": tmp_path / "lattice", "continuum": tmp_path / "continuum"}
    for side, folder in sheets.items():
        latcon(side, *TINY, "--output-dir", folder)
    is_ended_as_it_begins(start, "compare", *sheets.values(), "--output-dir", out)


# Motions write a checkpoint, their last frame and tables.
def motion(out, *more, length="30 cm", end="1"):
    return ["fracture", QUICK, "--skip-verification", "--set", f"Time/end={end}", "--set", f"Sheet/length={length}",
            "--threads", "1", *more, "--output-dir", out]


def is_saved(out, process):
    message = f"interrupted; --resume continues from what is in {out}"
    ends(process, message)
    assert (out / "log.txt").read_text().endswith(f"latcon: {message}\n")
    assert read_json(out / "run.json")["exit_code"] == INTERRUPTED
    assert list((out / "checkpoints").glob("*.h5"))
    assert (out / "crack.csv").exists()


def test_every_signal_saves_and_draws_no_report(start, out):
    for name in SOME:
        process = start(*motion(out))
        assert wait_for((out / "lattice.pvd").exists, process)
        assert [other for other in ALL if not catches(process, getattr(signal, other))] == []
        process.send_signal(getattr(signal, name))
        is_saved(out, process)
        assert not (out / "report.html").exists()
        shutil.rmtree(out)


def test_a_signal_to_one_of_two_ranks(start, out):
    process = start(*motion(out, "--set", "Fracture/stop position=0.99", length="10 cm"), launcher=on_ranks(2))
    assert wait_for((out / "lattice.pvd").exists, process)
    os.kill(max(children(process.pid)), signal.SIGTERM)
    is_saved(out, process)


def test_a_signal_to_one_of_two_ranks_before_the_motion(start, out):
    process = start("fracture", QUICK, "--output-dir", out, launcher=on_ranks(2))
    started(out, process)
    os.kill(max(children(process.pid)), signal.SIGTERM)
    ends(process)
    assert read_json(out / "run.json")["exit_code"] == INTERRUPTED


def test_ignored_hangup_stays_ignored(start, out):
    process = start(*motion(out, "--no-report", length="4 cm", end="0.2 ms"), launcher=["nohup"])
    assert wait_for((out / "lattice.pvd").exists, process)
    process.send_signal(signal.SIGHUP)
    process.communicate(timeout=600)
    assert process.returncode == 0


def test_a_reader_that_leaves_ends_nothing(out):
    command = [LATCON, *map(str, motion(out, "--no-report", length="4 cm", end="0.02 ms"))]
    process = subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.PIPE)
    process.stdout.close()
    process.stderr.read()
    assert process.wait(600) == 0
    process.stderr.close()
    assert read_json(out / "run.json")["exit_code"] == 0


def test_the_limit_of_the_size_of_files_is_5(start, out):
    process = start(*motion(out), preexec_fn=lambda: resource.setrlimit(resource.RLIMIT_FSIZE, (10000, 10000)))
    _, errors = process.communicate(timeout=HANGS)
    assert process.returncode == 5, errors
    assert "File too large" in errors
