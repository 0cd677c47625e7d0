"""Fixtures of the tests of the Python package: separate caches, scripts in place of the program, and one small crack."""
import csv
import os
import sys
import tempfile

import pytest

import latcon

# The tests do not use the user's caches of verdicts and fonts; pictures do not need a display.
CACHE = tempfile.TemporaryDirectory()
os.environ.update(XDG_CACHE_HOME=CACHE.name, MPLCONFIGDIR=f"{CACHE.name}/matplotlib", MPLBACKEND="Agg")

# A strip so short that a crack runs through it within a second.
TINY = {"Sheet/length": "2.5 cm", "Sheet/height": "1.5 cm", "Time/end": "1.5 ms", "Output/frame interval": "0.5 ms"}


def tiny_case():
    return latcon.Case("quick.prm").set(TINY)


def rows(path):
    """Rows of a table, {column: text}."""
    with open(path, newline="") as file:
        return list(csv.DictReader(file))


@pytest.fixture(scope="session")
def crack(tmp_path_factory):
    """Output directory of a small crack."""
    directory = tmp_path_factory.mktemp("crack") / "out"
    return latcon.fracture(tiny_case(), directory, skip_verification=True, report=False, progress=False)


@pytest.fixture
def stand_in(tmp_path, monkeypatch):
    """Substitutes a Python script for the program that the package runs."""
    def make(body):
        program = tmp_path / "latcon-stand-in"
        program.write_text(f"#!{sys.executable}\nimport pathlib, signal, sys, time\n{body}\n")
        program.chmod(0o755)
        monkeypatch.setenv("LATCON", str(program))
    return make
