"""A study of small strips, for tests of latcon study."""
import copy
import json
import pathlib

import pytest

from program import CASES, latcon

# Strips so small that a crack runs through in a moment, with nearest neighbours alone, which are faster to check.
TINY = {
    "title": "A tiny study",
    "base": str(CASES / "quick.prm"),
    "set": {"Sheet/length": "2.5 cm", "Sheet/height": "1.5 cm", "Time/end": "1 ms",
            "Next-nearest neighbours/present": False},
    "quick": {"set": {"Time/end": "0.5 ms"}},
    "runs": {
        "base": {"seeds": [1, 2]},
        "low": {"set": {"Sheet/height": "1 cm"}},
        "thin": {"set": {"Nearest neighbours/viscosity": 40}, "quick": False},
    },
    "claims": [
        {"claim": "The crack runs", "paper": "It does.", "rows": [
            {"run": "base", "quantity": "speed_lagrangian", "above": 1},
            {"runs": ["low", "base"], "quantity": "speed_lagrangian", "against": "Sheet/height"},
            {"run": "base", "quantity": "pattern"}]},
    ],
}


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
    return {path: path.read_bytes() for path in folder.rglob("*") if path.is_file()}


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
