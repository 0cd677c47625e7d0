"""Fixtures of tests of the program and of its report: processes in the background, a folder of runs."""
import pathlib
import subprocess
import tempfile

import pytest


@pytest.fixture
def runs(tmp_path):
    """Folder of runs of a report, which does not exist yet."""
    return tmp_path / "runs"


@pytest.fixture
def start():
    """Starts latcon in the background, by default without standard output; it ends with the test at the latest."""
    from program import LATCON  # starts nothing, but needs the program, which tests of pages do not have
    started = []

    def begin(*arguments, launcher=(), **keywords):
        process = subprocess.Popen([*map(str, (*launcher, LATCON, *arguments))], stdout=subprocess.DEVNULL,
                                   stderr=subprocess.PIPE, text=True, **keywords)
        started.append(process)
        return process

    yield begin
    for process in started:
        if process.poll() is None:
            process.kill()
        process.wait()
        process.stderr.close()


@pytest.fixture(scope="session")
def tiny_study():
    """Output directory of the study TINY, which has run to its end, without its page; beside it what was printed."""
    from studies import run, write_study
    with tempfile.TemporaryDirectory() as folder:
        out = pathlib.Path(folder) / "out"
        (out.parent / "printed").write_text(
            run("study", write_study(pathlib.Path(folder)), "--output-dir", out, "--skip-verification", "--no-report"))
        yield out
