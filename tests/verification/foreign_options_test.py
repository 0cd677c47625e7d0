"""Checks that libraries do not read options from the current folder, from the home folder, or from latcon's arguments."""
import os
import subprocess
import types

import pytest

from program import CASES, LATCON

TINY = [str(CASES / "quick.prm"), "--set", "Sheet/length=10 mm", "--set", "Sheet/height=6 mm", "--set", "Time/end=0.01 ms"]
COMMANDS = {"version": ["--version"], "lattice": ["lattice", *TINY, "--quiet"],
            "crack with its page": ["fracture", *TINY, "--skip-verification", "--quiet"],
            "finite elements": ["continuum", str(CASES / "shear_layer.prm"), "--quiet"]}


@pytest.fixture
def made(tmp_path):
    made = types.SimpleNamespace()
    made.marker = tmp_path / "started"
    made.program = tmp_path / "gdb"
    made.program.write_text(f"#!/bin/sh\ntouch {made.marker}\n")
    made.program.chmod(0o755)
    # PETSc options that start a debugger and write files, all within a second.
    made.options = (f"-debug_terminal {made.program}\n-start_in_debugger gdb\n-debugger_pause 1\n"
                    f"-info {tmp_path}/info\n-log_view :{tmp_path}/log\n")
    return made


def run_all(tmp_path, made, cwd, *more, **variables):
    """@param more options of the crack"""
    for name, command in COMMANDS.items():
        command = [*command, *more] if "fracture" in command else command
        out = tmp_path / f"out-{name}"
        before = {path.name for path in tmp_path.iterdir()} | {out.name}
        arguments = command if name == "version" else [*command, "--output-dir", str(out)]
        run = subprocess.run([LATCON, *arguments], capture_output=True, text=True, timeout=300, cwd=cwd,
                             env=dict(os.environ, **variables))
        assert (run.returncode, run.stderr) == (0, "")
        assert not made.marker.exists()
        assert {path.name for path in tmp_path.iterdir()} <= before


def test_in_the_current_folder(tmp_path, made):
    here = tmp_path / "here"
    here.mkdir()
    for name in (".petscrc", "petscrc", ".slepcrc", "slepcrc"):
        (here / name).write_text(made.options)
    (here / "matplotlibrc").write_text("no.such.key: 1\nbackend: module://planted\n")
    (here / "planted.py").write_text(f"open({str(made.marker)!r}, 'w')\n")
    before = sorted(os.listdir(here))
    run_all(tmp_path, made, here)
    assert sorted(os.listdir(here)) == before


def test_in_the_home_folder(tmp_path, made):
    home = tmp_path / "home"
    home.mkdir()
    for name in (".petscrc", ".slepcrc"):
        (home / name).write_text(made.options)
    run_all(tmp_path, made, tmp_path, "--no-report", HOME=str(home))


def test_in_the_environment(tmp_path, made):
    run_all(tmp_path, made, tmp_path, "--no-report", PETSC_OPTIONS=" ".join(made.options.split()))


def test_closed_standard_output_is_no_matter_of_libraries(tmp_path):
    run = subprocess.run(["/bin/sh", "-c", 'exec "$@" >&-', "sh", LATCON, "lattice", *TINY, "--quiet", "--output-dir",
                          str(tmp_path / "out")], stderr=subprocess.PIPE, text=True, timeout=600)
    assert run.stderr == ""
