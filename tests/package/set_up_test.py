"""Checks that cmake/set-up.sh builds in its own clone and is silent if there is nothing to build, and the exit codes of ./run."""
import os
import pathlib
import shutil
import subprocess

import pytest

from folders import SOURCE

SMALL = pathlib.Path(__file__).with_name("small")  # a project


def empty_clone(folder):
    clone = folder.resolve() / "clone"
    (clone / "cmake").mkdir(parents=True)
    (clone / "build" / "paraview").mkdir(parents=True)  # so that it is not downloaded
    for name in ("set-up.sh", "git_commit.cmake"):
        shutil.copy(SOURCE / "cmake" / name, clone / "cmake")
    for name in ("packages.txt", "packages-tests.txt"):
        (clone / "cmake" / name).write_text("# none\n")
    return clone


def run_in(folder, *words):
    environment = {name: value for name, value in os.environ.items() if not name.startswith("CMAKE_")}
    return subprocess.run(words, cwd=folder, capture_output=True, text=True, check=False, env=environment)


@pytest.fixture
def clone(tmp_path):
    return shutil.copytree(SMALL, empty_clone(tmp_path), dirs_exist_ok=True)


def rewrite(clone, name):
    """Makes the program of the project print another name."""
    (clone / "main.c").write_text((SMALL / "main.c").read_text().replace("first", name))


def set_up(tmp_path, clone):
    result = run_in(tmp_path, clone / "cmake" / "set-up.sh", "release", "latcon")
    assert result.returncode == 0, result.stdout + result.stderr
    assert result.stdout == ""
    return result.stderr


def says(tmp_path, clone):
    return run_in(tmp_path, clone / "build" / "release" / "latcon").stdout


def state(folder):
    return {path: path.stat().st_mtime_ns for path in folder.rglob("*") if path.is_file()}


def test_shows_the_steps_of_the_first_build_alone(clone, tmp_path):
    assert "Building" in set_up(tmp_path, clone)
    assert says(tmp_path, clone) == "first\n"
    assert set_up(tmp_path, clone) == ""
    rewrite(clone, "second")
    assert set_up(tmp_path, clone) == ""
    assert says(tmp_path, clone) == "second\n"
    (clone / "main.c").write_text("no program\n")
    failed = run_in(tmp_path, clone / "cmake" / "set-up.sh", "release", "latcon")
    assert failed.returncode != 0
    assert "main.c" in failed.stderr


def test_a_copied_clone_builds_in_its_own_place(clone, tmp_path):
    set_up(tmp_path, clone)
    copy = shutil.copytree(clone, tmp_path / "copy", symlinks=True)
    rewrite(copy, "copy")
    before = state(clone)
    assert "Configuring" in set_up(tmp_path, copy)
    assert says(tmp_path, copy) == "copy\n"
    assert state(clone) == before
    # A second name is no other place.
    (tmp_path / "link").symlink_to(copy)
    assert set_up(tmp_path, tmp_path / "link") == ""


# Exit code 3 of the report may refer to other runs in the folder.
@pytest.mark.parametrize("verify, fracture, report, status", [
    (0, 0, 0, 0), (3, 0, 3, 3), (0, 4, 0, 4), (0, 0, 2, 2), (0, 0, 5, 5), (0, 0, 3, 0), (0, 3, 2, 3)])
def test_run_ends_with_the_status_of_its_runs_and_of_their_report(tmp_path, verify, fracture, report, status):
    runnable = empty_clone(tmp_path)
    shutil.copy(SOURCE / "run", runnable)
    program = runnable / "build" / "release" / "verification" / "latcon"
    program.parent.mkdir(parents=True)
    for path, text in ((runnable / "cmake" / "set-up.sh", ""), (program, 'echo "$1"\neval exit \\${$1:-0}\n')):
        path.write_text("#!/bin/sh\n" + text)
        path.chmod(0o755)
    result = run_in(runnable, "env", f"verify={verify}", f"fracture={fracture}", f"report={report}", "./run")
    assert result.returncode == status, result.stderr
    assert result.stdout.split()[-1] == "report"
