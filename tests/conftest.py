"""Fixtures of all tests in Python: folders that are removed after the test, and not kept as pytest keeps those of its last runs."""
import pathlib
import tempfile

import pytest


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
