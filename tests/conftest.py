"""Fixtures of all tests in Python: folders that are removed after the test, and not kept as pytest keeps those of its last runs.

Where LATCON_NO_SKIPS is set, as in hosted CI, a test that cannot run there fails: it is skipped for being long or short alone.
"""
import os
import pathlib
import subprocess
import tempfile

import pytest

CHOSEN = ("in full only", "long", "once is enough", "the quick versions are enough")


@pytest.hookimpl(hookwrapper=True)
def pytest_runtest_makereport(item, call):
    report = (yield).get_result()
    if report.skipped and os.environ.get("LATCON_NO_SKIPS") and not str(report.longrepr[2]).endswith(CHOSEN):
        report.outcome, report.longrepr = "failed", f"{item.nodeid} may not be skipped: {report.longrepr[2]}"


@pytest.fixture
def tmp_path():
    """Empty folder of a test."""
    with tempfile.TemporaryDirectory() as folder:
        yield pathlib.Path(folder)


@pytest.fixture
def out(tmp_path):
    """Output directory of a test, which does not exist yet."""
    return tmp_path / "out"


@pytest.fixture(scope="module")
def module_path():
    """Empty folder of what the tests of a file share."""
    with tempfile.TemporaryDirectory() as folder:
        yield pathlib.Path(folder)


@pytest.fixture(scope="session")
def needs_mount():
    """Skips tests that mount something where that is not allowed."""
    if subprocess.run(["unshare", "-m", "mount", "-t", "tmpfs", "none", "/mnt"], capture_output=True, check=False).returncode:
        pytest.skip("nothing can be mounted here")
