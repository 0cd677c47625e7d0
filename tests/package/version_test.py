"""Checks that every file that repeats the version has that of CMakeLists.txt."""
import re

import pytest

from folders import SOURCE, VERSION


@pytest.mark.parametrize("file, pattern", [
    ("CITATION.cff", r"^version: (\S+)"), ("python/latcon/__init__.py", r'^__version__ = "(\S+)"'), ("packaging/conda/meta.yaml", r"^  version: (\S+)"),
    ("packaging/spack/packages/latcon/package.py", r'^    version\("(\S+)"\)')])
def test_version_is_that_of_the_project(file, pattern):
    assert re.findall(pattern, (SOURCE / file).read_text(), re.M) == [VERSION]
