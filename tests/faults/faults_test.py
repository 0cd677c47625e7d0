"""Runs survive kills, full disks and folders that cannot be written.

A run that was stopped is resumed until it ends. After each stop every file is read with VTK, h5py, and Python's readers; at the end
all files are compared with those of the uninterrupted run, byte for byte. LATCON_FAULTS=N stops N times as many.
"""
import os
import random
import shlex
import subprocess

import pytest

import kills
import moments
import victims
import whole
from program import ended

PROGRAM = victims.Program(os.environ["LATCON"], os.environ["LATCON_FILE_FAULTS"])
TIMES = int(os.environ.get("LATCON_FAULTS", 1))
SEED = 1
CRACK = victims.VICTIMS["crack"]


@pytest.mark.parametrize("name", [*victims.VICTIMS, *(["relaxation"] if TIMES == 1 else victims.WITHOUT_CHECKPOINTS)])
def test_run_survives_kills_at_random_moments(name, tmp_path):
    ranks = (1, 1, 2) if name in victims.ON_RANKS else (1,)
    killed, without_checkpoint = kills.kill_at_random(PROGRAM, name, tmp_path / "run", random.Random(f"{SEED} {name}"),
                                                      2 * TIMES if name == "crack" else TIMES, ranks)
    assert name in victims.VICTIMS or killed == without_checkpoint


SOME = {"crack": ("kill", "full"), "sheet in motion": ("full",)}  # files of all are written by the same functions


@pytest.mark.parametrize("name, fault", [(name, fault) for name in victims.VICTIMS
                                         for fault in (SOME.get(name, ()) if TIMES == 1 else ("kill", "full"))])
def test_run_survives_a_fault_at_a_call_that_changes_files(name, fault, module_path):
    pick = random.Random(f"{SEED} {name}")
    assert moments.at_moments(PROGRAM, name, module_path / name, fault,
                              lambda n: pick.sample(range(1, n + 1), min(n, TIMES))) > 30


def crack_on(disk, options, then=""):
    """Runs a crack, which fails by its output, with a file system of its own mounted at `disk`."""
    script = f'mount -t tmpfs -o {options} none {disk} || exit 77; {shlex.join([PROGRAM.latcon, *CRACK])} --output-dir {disk}/out; status=$?; {then} exit $status'
    return ended(subprocess.run(["unshare", "-m", "sh", "-c", script], capture_output=True, text=True, timeout=600), expect=5)


@pytest.mark.usefixtures("needs_mount")
def test_small_disk(tmp_path, whole_run):
    """A real disk becomes full in the middle of a file."""
    complete, expected = whole_run
    disk, kept = tmp_path / "disk", tmp_path / "kept"
    disk.mkdir()
    size = sum(path.stat().st_size for path in complete.rglob("*") if path.is_file())
    run = crack_on(disk, f"size={size // 2048}k", f"cp -r {disk}/out {kept};")
    assert str(disk) in run.stderr
    assert whole.check(kept) > 5
    status, said = PROGRAM.run([*CRACK, "--resume"], kept)
    assert status in victims.DONE, said
    kills.compare("crack", kept, expected)


@pytest.mark.usefixtures("needs_mount")
def test_disk_that_cannot_be_written(tmp_path):
    assert f"{tmp_path}/out" in crack_on(tmp_path, "ro").stderr


def test_folder_of_somebody_else(tmp_path):
    """A folder without write permission; as user nobody if the test runs as root."""
    folder = tmp_path / "locked"
    folder.mkdir(mode=0o555)
    tmp_path.chmod(0o755)
    prefix = ["setpriv", "--reuid=65534", "--regid=65534", "--clear-groups"] if os.geteuid() == 0 else []
    run = subprocess.run([*prefix, PROGRAM.latcon, *CRACK, "--output-dir", folder / "out"], capture_output=True, text=True, timeout=600,
                         env=dict(os.environ, HOME=str(tmp_path), XDG_CACHE_HOME=str(tmp_path)))
    assert run.returncode == 5, run.stderr
    assert "ermission denied" in run.stderr and str(folder / "out") in run.stderr


def test_run_json_is_moved_aside_last(tmp_path):
    """It tells whose the other files are, so they have gone before it, whenever the run that moves them is killed."""
    out, command = tmp_path / "out", victims.VICTIMS["sheet in motion"]
    victims.run_to_end(command, out)
    files = {path.name for path in out.iterdir()}
    for call in range(1, 100):
        status, said = PROGRAM.run(command, out, fault={"LATCON_FAULT": "kill", "LATCON_FAULT_AT": str(call)})
        assert status == -9, said
        moved = {path.name for path in out.glob("earlier-run*/*")}
        if "run.json" in moved:
            break
    assert moved >= {name for name in files if not name.startswith(".") and name != "checkpoints"}


@pytest.fixture(scope="module")
def whole_run(module_path):
    """Folder and results of an undisturbed crack."""
    return module_path / "out", victims.undisturbed(PROGRAM, CRACK, module_path / "out")[0]
