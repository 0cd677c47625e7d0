"""Tests of finding, running and stopping the program, and of its exit codes, mostly with a script in place of the program."""
import io
import os
import pathlib
import pickle
import shutil
import signal
import subprocess
import sys
import threading
import time

import pytest

import latcon
import latcon.study.program
from latcon import errors, program

PACKAGE = pathlib.Path(latcon.__file__).parent
FIND = "import latcon; print(latcon.find_program())"


def executable(path):
    path.parent.mkdir(parents=True)
    path.write_text("#!/bin/sh\n")
    path.chmod(0o755)
    return path


def found(package_at, folder, **environment):
    """Program that a copy of the package finds, run in a folder."""
    shutil.copytree(PACKAGE, package_at / "latcon", dirs_exist_ok=True, ignore=shutil.ignore_patterns("__pycache__"))
    ended = subprocess.run([sys.executable, "-B", "-c", FIND], cwd=folder, capture_output=True, text=True, check=False,
                           env={"PATH": "/nowhere", "PYTHONPATH": str(package_at), **environment})
    return ended.stdout.strip() or ended.stderr.strip().splitlines()[-1]


def test_is_found_by_environment_prefix_path_and_build_folder(tmp_path):
    named, on_path = executable(tmp_path / "named/latcon-1"), executable(tmp_path / "path/latcon")
    checkout = tmp_path / "checkout"
    built = executable(checkout / "build/release/verification/latcon")
    below = executable(tmp_path / "prefix/bin/latcon")
    source, site = checkout / "python", tmp_path / "prefix/lib/python3/dist-packages"
    path = str(on_path.parent)
    assert found(source, tmp_path, LATCON=str(named), PATH=path) == str(named)
    assert found(source, tmp_path, PATH=path) == str(on_path)
    assert found(source, tmp_path) == str(built)
    assert found(site, tmp_path, PATH=path) == str(below)
    elsewhere = tmp_path / "elsewhere"
    assert found(elsewhere, checkout / "build") == str(built)
    assert "ProgramNotFound: the program latcon was not found" in found(elsewhere, tmp_path)
    assert "LATCON is '/no/latcon'" in found(elsewhere, tmp_path, LATCON="/no/latcon", PATH=path)


@pytest.mark.parametrize("code, kind", [(1, latcon.InternalError), (2, latcon.BadInput), (3, latcon.ClaimFailed), (4, latcon.DidNotConverge),
                                        (5, latcon.OutputFailed), (130, latcon.Interrupted), (77, latcon.ProgramError)])
def test_exit_codes_are_exceptions_with_the_message(stand_in, tmp_path, code, kind):
    stand_in(f"print('table', flush=True); print('latcon: first\\nsecond', file=sys.stderr); sys.exit({code})")
    with pytest.raises(kind) as caught:
        program.run(["lattice"], tmp_path, False)
    error = caught.value
    assert (type(error), error.exit_code, error.directory) == (kind, code, tmp_path) and str(error) == error.message == "first\nsecond"


def test_exceptions_pass_through_a_pool_of_processes():
    for kind in (kind for module in (errors, latcon.study.program) for kind in vars(module).values()
                 if isinstance(kind, type) and issubclass(kind, BaseException)):
        error = kind(*{errors.UnreadableFile: ("file", "damaged"), latcon.study.program.Ended: (3, "message")}.get(
            kind, ("message", 3, pathlib.Path("out")) if issubclass(kind, errors._EndOfProgram) else ("message",)))
        passed = pickle.loads(pickle.dumps(error))
        assert (type(passed), str(passed), vars(passed)) == (kind, str(error), vars(error))


def test_loops_that_catch_errors_stop_when_interrupted():
    assert not issubclass(latcon.Interrupted, Exception) and issubclass(latcon.Interrupted, KeyboardInterrupt)


def test_a_program_without_message_is_described_by_its_output(stand_in, tmp_path):
    stand_in("print('x fails'); sys.exit(3)")
    with pytest.raises(latcon.ClaimFailed, match="^x fails$"):
        program.run(["verify"], tmp_path, False)
    stand_in("import os; os.kill(os.getpid(), signal.SIGKILL)")
    with pytest.raises(latcon.ProgramError, match="without a message") as caught:
        program.run(["verify"], tmp_path, False)
    assert caught.value.exit_code == -signal.SIGKILL


UPDATE = """
import json, os
def update(text, left):
    os.write(int(os.environ["LATCON_PROGRESS"]), (json.dumps({"text": text, "seconds_left": left}) + "\\n").encode())
"""
PROGRESS = UPDATE + r"""
for left in (9, 4):
    update(f"step {1 if left == 9 else 2}, {left} s left", left); time.sleep(0.2)
sys.stderr.write("\x1b[0m\x1b[31ma remark\x1b[0m\n\n")
"""


def test_progress_lines_are_passed_on_and_messages_are_kept(stand_in, tmp_path, capsys):
    stand_in(PROGRESS)
    lines = []
    program.run(["lattice"], tmp_path, lines.append)
    assert lines == ["step 1, 9 s left", "step 2, 4 s left"]
    assert capsys.readouterr().err == "a remark\n"


def test_results_are_found_after_a_change_of_folder(stand_in, tmp_path, monkeypatch):
    stand_in("""folder = pathlib.Path(sys.argv[sys.argv.index("--output-dir") + 1]); folder.mkdir()
(folder / "run.json").write_text("{}")""")
    case = tmp_path / "a.prm"
    case.write_text("")
    monkeypatch.chdir(tmp_path)
    run = latcon.commands._run("lattice", case, "out", None, False, False, False)
    monkeypatch.chdir("/")
    assert run.directory == latcon.results.Run(tmp_path / "out").directory == tmp_path / "out"
    monkeypatch.setenv("HOME", str(tmp_path))
    assert latcon.open("~/out").directory == tmp_path / "out"


def test_progress_is_shown_in_place_in_a_terminal_and_sparsely_in_a_log(stand_in, tmp_path, monkeypatch):
    stand_in(PROGRESS)
    monkeypatch.setattr(program.importlib.util, "find_spec", lambda name: None)  # as if without tqdm
    for is_terminal, shown in ((True, "\rstep 1, 9 s left\rstep 2, 4 s left\r"), (False, "a remark\n")):
        stream = io.StringIO()
        stream.isatty = lambda answer=is_terminal: answer
        monkeypatch.setattr(sys, "stderr", stream)
        program.run(["lattice"], tmp_path, True)
        assert stream.getvalue().startswith(shown)


STOPPABLE = """
def stop(number, frame):
    with open({count!r}, "a") as file: file.write("x")
    time.sleep(0.3)
    print("latcon: saved", file=sys.stderr)
    sys.exit(130)
signal.signal(signal.SIGINT, stop)
import os
if os.getsid(0) != os.getpid(): sys.exit("a terminal would signal this program as well")
pathlib.Path({ready!r}).touch()
time.sleep(60)
"""


def interrupt_when(path, times=1):
    """Ctrl-C to this process once a file exists."""
    def wait():
        while not path.exists():
            time.sleep(0.01)
        for _ in range(times):
            os.kill(os.getpid(), signal.SIGINT)
            time.sleep(0.5)
    thread = threading.Thread(target=wait, daemon=True)
    thread.start()
    return thread


def test_ctrl_c_stops_the_program_and_waits_for_its_end(stand_in, tmp_path):
    count, ready = tmp_path / "count", tmp_path / "ready"
    stand_in(STOPPABLE.format(count=str(count), ready=str(ready)))
    thread = interrupt_when(ready)
    with pytest.raises(latcon.Interrupted) as caught:
        program.run(["fracture"], tmp_path, False)
    thread.join()
    assert (caught.value.exit_code, caught.value.message) == (130, "saved")
    assert count.read_text() == "x"  # one signal


def test_a_run_in_the_background_is_stopped_or_waited_for(stand_in, tmp_path):
    count, ready, out = tmp_path / "count", tmp_path / "ready", tmp_path / "out"
    out.mkdir()
    (out / "run.json").write_text("{}")
    case = tmp_path / "a.prm"
    case.touch()
    stand_in(PROGRESS + STOPPABLE.format(count=str(count), ready=str(ready)))
    job = latcon.start(case, out)
    while not ready.exists():
        time.sleep(0.01)
    with pytest.raises(TimeoutError, match="out"):
        job.wait(0.1)
    assert job.progress == "step 2, 4 s left" and job.is_running
    assert job.stop().directory == job.directory == out and not job.is_running and count.read_text() == "x"
    with pytest.raises(latcon.Interrupted, match="saved"):
        job.wait()
    stand_in("sys.exit(4)")
    job = latcon.start(case, out)
    for end in (job.wait, job.stop):
        with pytest.raises(latcon.DidNotConverge):
            end()


def test_a_second_ctrl_c_kills_a_program_that_does_not_end(stand_in, tmp_path):
    ready = tmp_path / "ready"
    stand_in(f"signal.signal(signal.SIGINT, signal.SIG_IGN); pathlib.Path({str(ready)!r}).touch(); time.sleep(60)")
    thread = interrupt_when(ready, times=2)
    begin = time.monotonic()
    with pytest.raises(latcon.Interrupted) as caught:
        program.run(["fracture"], tmp_path, False)
    thread.join()
    assert caught.value.exit_code == -signal.SIGKILL and time.monotonic() - begin < 50


def test_an_exception_of_the_progress_function_stops_the_program(stand_in, tmp_path):
    count, ready = tmp_path / "count", tmp_path / "ready"
    stand_in(UPDATE + STOPPABLE.format(count=str(count), ready=str(ready)).replace(
        "time.sleep(60)", "update('step 1', None); time.sleep(60)"))
    def fail(line):
        raise ZeroDivisionError(line)
    with pytest.raises(ZeroDivisionError, match="step 1"):
        program.run(["fracture"], tmp_path, fail)
    assert count.read_text() == "x"
