"""Checks that the exit code of the program agrees with that in run.json, whatever fails last."""
import os
import subprocess
import sys

import numpy as np
import pytest

from program import CASES, LATCON, latcon, latcon_on_ranks, read_json, settings

SHEET = ["fracture", CASES / "quick.prm", "--skip-verification", *settings("Sheet/length=10 mm", "Sheet/height=6 mm")]
TINY = [*SHEET, "--set", "Time/end=0.01 ms"]
BAD_INPUT, OUTPUT_FAILED = 2, 5


def test_page_that_cannot_be_written(out):
    (out / "report.html").mkdir(parents=True)
    latcon(*TINY, "--output-dir", out, expect=OUTPUT_FAILED)
    assert read_json(out / "run.json")["exit_code"] == OUTPUT_FAILED


def test_script_that_fails(out):
    run = latcon(*TINY, "--output-dir", out, env=dict(os.environ, MPLCONFIGDIR="/proc"), expect=OUTPUT_FAILED)
    assert "report.html: the report script failed" in run.stderr
    assert read_json(out / "run.json")["exit_code"] == OUTPUT_FAILED


@pytest.mark.parametrize("ranks, frame", [(1, "lattice-0000.vtp"), (2, "motion-0000.vtp")])
def test_frame_that_cannot_be_written_ends_a_run_that_takes_hours(out, ranks, frame):
    (out / frame).mkdir(parents=True)
    arguments = [*SHEET, *settings("Time/end=10 s", "Fracture/breaking stretch=1000", "Output/frame interval=0"),
                 "--no-report", "--output-dir", out]
    run = latcon_on_ranks(ranks, *arguments, expect=OUTPUT_FAILED)
    assert f"cannot write {out}/{frame}: it is a folder" in run.stderr
    assert read_json(out / "run.json")["exit_code"] == OUTPUT_FAILED


def test_standard_output_that_is_full(out):
    for command in ([*TINY, "--no-report", "--output-dir", out], [*TINY, "--dry-run"], ["--version"], ["report", out]):
        with open("/dev/full", "w") as full:
            run = subprocess.run([LATCON, *map(str, command)], stdout=full, stderr=subprocess.PIPE, text=True)
        assert run.returncode == OUTPUT_FAILED, command
        assert "cannot write standard output" in run.stderr
    assert read_json(out / "run.json")["exit_code"] == OUTPUT_FAILED


def test_streams_that_are_closed():
    for closed in (">&-", "<&- >&- 2>&-"):
        ended = subprocess.run(["bash", "-c", f'"$0" --version {closed}', LATCON], stderr=subprocess.DEVNULL, check=False)
        assert ended.returncode == OUTPUT_FAILED, closed


def test_instruction_set_that_there_is_not(out):
    for command in (TINY, ["verify", "energy", "--quick"]):
        run = latcon(*command, "--output-dir", out, env=dict(os.environ, LATCON_INSTRUCTION_SET="MMX"), expect=BAD_INPUT)
        assert "environment variable LATCON_INSTRUCTION_SET: `MMX` is none of the instruction sets" in run.stderr
        assert not out.exists()


def test_report_does_not_depend_on_settings_of_python(out, tmp_path):
    latcon(*TINY, "--no-report", "--output-dir", out)
    (tmp_path / "modules").mkdir()
    (tmp_path / "modules" / "numpy.py").write_text("raise ImportError('another numpy')")
    settings = {"MPLBACKEND": "nonsense", "PYTHONSAFEPATH": "1", "PYTHONWARNINGS": "error",
                "PYTHONPATH": str(tmp_path / "modules"), "MPLCONFIGDIR": "fonts"}
    latcon("report", out, env=dict(os.environ, **settings), cwd=tmp_path)
    assert (out / "report.html").exists() and (tmp_path / "fonts").exists()


def test_commands_in_python_say_that_numpy_is_missing(tmp_path):
    (python := tmp_path / "python").write_text(f'#!/bin/sh\nexec {sys.executable} -S "$@"\n')
    python.chmod(0o755)
    for command in (["init", tmp_path / "new"], ["entries"], ["report", tmp_path], ["compare", "a", "b"], ["study", "paper"], ["batch", "paper", "--slurm"]):
        run = latcon(*command, env=os.environ | {"LATCON_PYTHON": str(python)}, expect=OUTPUT_FAILED)
        assert run.stderr == "latcon: this command needs the Python package numpy (Debian: python3-numpy): No module named 'numpy'\n"
    (tmp_path / "modules").mkdir()
    (tmp_path / "modules" / "numpy").symlink_to(os.path.dirname(np.__file__))
    python.write_text(f'#!/bin/sh\nPYTHONPATH=$PYTHONPATH:{tmp_path}/modules exec {sys.executable} -S "$@"\n')
    for command in (["compare", "a", "b"], ["study", "patterns", "--dry-run"]):
        run = latcon(*command, env=os.environ | {"LATCON_PYTHON": str(python)}, expect=OUTPUT_FAILED)
        assert "this command needs the Python package scipy (Debian: python3-scipy): " in run.stderr
