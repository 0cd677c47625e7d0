"""Tests of many processes on one machine: shared folders at the start, leftover files, and use of cores."""
import os
import shutil
import signal
import socket
import subprocess

import pytest

from program import CASES, LATCON, latcon, wait_for

TEST_PROGRAMS = os.environ["LATCON_TEST_PROGRAMS"].split(":")

MOTION = ["lattice", CASES / "quick.prm", "--dry-run", "--set", "Lattice/solution=motion"]
SMALL = ["--set", "Sheet/length=8 mm", "--set", "Sheet/height=6 mm"]
LAUNCHED = ("OMPI_", "PMIX_", "PMI_")


def environment(**variables):
    """Environment of a user without MPI settings, outside mpirun."""
    kept = {name: value for name, value in os.environ.items() if not name.startswith(LAUNCHED)}
    return dict(kept, **variables)


def names_in(folder):
    return sorted(str(path.relative_to(folder)) for path in folder.rglob("*"))


@pytest.fixture
def tmp(tmp_path):
    tmp = tmp_path / "tmp"
    tmp.mkdir()
    return tmp


def block_session_folder(tmp):
    """Creates files where Open MPI would create the session folder shared by a user's processes."""
    host = socket.gethostname()
    for name in {host, host.partition(".")[0]}:
        (tmp / f"ompi.{name}.{os.geteuid()}").write_text("in the way")


def commands(tmp_path):
    quick = str(CASES / "quick.prm")
    yield [LATCON, "--version"]
    yield [LATCON, "lattice", quick, "--dry-run"]
    yield [LATCON, "lattice", quick, *SMALL, "--output-dir", str(tmp_path / "out"), "--quiet"]
    for program in TEST_PROGRAMS:
        yield [program, "--gtest_filter=-*"]


def test_shares_no_folder(tmp, tmp_path):
    block_session_folder(tmp)
    before = names_in(tmp)
    for command in commands(tmp_path):
        run = subprocess.run(command, capture_output=True, text=True, timeout=600, env=environment(TMPDIR=str(tmp)))
        assert run.returncode == 0, run.stderr
        assert "mkdir" not in run.stderr
    assert names_in(tmp) == before


def test_leaves_nothing_when_killed(tmp, tmp_path):
    run = subprocess.Popen([LATCON, "fracture", CASES / "quick.prm", "--skip-verification", "--quiet",
                            "--output-dir", tmp_path / "out"], env=environment(TMPDIR=str(tmp)))
    wait_for((tmp_path / "out" / "energy.csv").exists, run)
    run.kill()
    assert run.wait() == -signal.SIGKILL
    assert names_in(tmp) == []


def test_default_of_threads_and_of_processes_is_what_may_be_used():
    one = str(min(os.sched_getaffinity(0)))
    bound = ["taskset", "-c", one]
    assert "on 1 cores" in latcon("study", "patterns", "--dry-run", launcher=bound).stdout
    assert "1 threads of each rank" in latcon(*MOTION, launcher=bound).stdout


def test_threads_are_those_of_the_environment():
    for threads in ("1", "3"):
        assert f"{threads} threads of each rank" in latcon(*MOTION, env=environment(OMP_NUM_THREADS=threads)).stdout
    run = latcon("lattice", CASES / "quick.prm", "--dry-run", env=environment(OMP_NUM_THREADS="4097"), expect=2)
    assert run.stderr == "latcon: OMP_NUM_THREADS is 4097; allowed: 1 to 4096\n"


def test_threads_that_wait_sleep_unless_they_are_told_otherwise(tmp_path):
    names = ("OMP_WAIT_POLICY", "GOMP_SPINCOUNT", "GLIBC_TUNABLES")
    free = {name: value for name, value in environment().items() if name not in names}
    pages = {"GLIBC_TUNABLES": "glibc.malloc.hugetlb=1"}  # huge ones
    for told, expected in (({}, {"GOMP_SPINCOUNT": "20000", **pages}), ({"OMP_WAIT_POLICY": "active"}, {"OMP_WAIT_POLICY": "active"})):
        run = subprocess.Popen([LATCON, "--quiet", "fracture", CASES / "quick.prm", "--skip-verification",
                                "--output-dir", tmp_path / "out"], env=dict(free, **told))
        wait_for((tmp_path / "out" / "energy.csv").exists, run)
        with open(f"/proc/{run.pid}/environ", "rb") as file:
            variables = dict(item.split(b"=", 1) for item in file.read().split(b"\0") if item)
        with open(f"/proc/{run.pid}/comm", encoding="utf-8") as file:
            assert file.read() == "latcon\n"
        run.kill()
        run.wait()
        assert {name: variables[name.encode()].decode() for name in names if name.encode() in variables} == expected
        shutil.rmtree(tmp_path / "out")
