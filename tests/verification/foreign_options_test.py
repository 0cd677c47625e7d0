"""Libraries read no options from the current folder, from the home folder, or from the environment."""
import os
import subprocess

import pytest

from program import CASES, LATCON

TINY = [CASES / "quick.prm", "--set", "Sheet/length=10 mm", "--set", "Sheet/height=6 mm", "--set", "Time/end=0.01 ms"]


@pytest.mark.parametrize("command", [["lattice", *TINY], ["fracture", *TINY, "--skip-verification"], ["continuum", CASES / "shear_layer.prm"]],
                         ids=["lattice", "crack with its page", "finite elements"])
def test_options_that_others_left_are_not_read(tmp_path, command):
    here, home, marker, program = (tmp_path / name for name in ("here", "home", "started", "gdb"))
    program.write_text(f"#!/bin/sh\ntouch {marker}\n")
    program.chmod(0o755)
    # PETSc options that start a debugger and write files, all within a second.
    options = (f"-debug_terminal {program}\n-start_in_debugger gdb\n-debugger_pause 1\n"
               f"-info {tmp_path}/info\n-log_view :{tmp_path}/log\n")
    for folder in (here, home):
        folder.mkdir()
        for name in (".petscrc", "petscrc", ".slepcrc", "slepcrc"):
            (folder / name).write_text(options)
    (here / "matplotlibrc").write_text("no.such.key: 1\nbackend: module://planted\n")
    (here / "planted.py").write_text(f"open({str(marker)!r}, 'w')\n")
    before, outside = sorted(os.listdir(here)), sorted([*os.listdir(tmp_path), "out"])
    run = subprocess.run([LATCON, *command, "--quiet", "--output-dir", tmp_path / "out"], capture_output=True, text=True, timeout=300, cwd=here,
                         env=dict(os.environ, HOME=str(home), PETSC_OPTIONS=" ".join(options.split())), check=False)
    assert (run.returncode, run.stderr) == (0, "")
    assert sorted(os.listdir(here)) == before
    assert sorted(os.listdir(tmp_path)) == outside


def test_closed_standard_output_is_no_matter_of_libraries(tmp_path):
    run = subprocess.run(["/bin/sh", "-c", 'exec "$@" >&-', "sh", LATCON, "lattice", *TINY, "--quiet", "--output-dir", tmp_path / "out"],
                         stderr=subprocess.PIPE, text=True, timeout=600, check=False)
    assert run.stderr == ""
