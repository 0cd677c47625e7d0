"""A study of small strips, for tests of latcon study."""
import copy
import json
import pathlib

import pytest

from program import CASES, latcon

# Strips so small that a crack runs through in a moment, with nearest neighbours alone, which are faster to check.
TINY = json.loads(pathlib.Path(__file__).with_name("tiny.json").read_text()) | {"base": str(CASES / "quick.prm")}


def write_study(folder, change=None):
    """Writes TINY after `change` has changed it. @return path of the file"""
    document = copy.deepcopy(TINY)
    if change:
        change(document)
    path = folder / "tiny.json"
    path.write_text(json.dumps(document))
    return path


def run(*words, expect=0, **keywords):
    """Runs latcon. @return its output"""
    ended = latcon(*words, **keywords, expect=expect)
    return ended.stdout + ended.stderr


def files_in(folder):
    return {str(path.relative_to(folder)): path.read_bytes() for path in folder.rglob("*") if path.is_file()}


def words_of(process):
    """Its command line."""
    try:
        return pathlib.Path(f"/proc/{process}/cmdline").read_text().split("\0")
    except OSError:
        return []


class Studies:
    """Tests of studies, with a folder of their own and an output directory that does not exist yet."""

    @pytest.fixture(autouse=True)
    def set_up(self, tmp_path):
        self.folder, self.out = tmp_path, tmp_path / "out"
