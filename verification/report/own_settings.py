"""Imports matplotlib without the `matplotlibrc` of the current folder, which would otherwise take precedence: the folder of
a run may belong to somebody else. Import this module before any other that imports matplotlib."""
import os
from pathlib import Path

_here = os.open(".", os.O_PATH)
os.chdir(Path(__file__).resolve().parent)
import matplotlib  # noqa: F401

os.fchdir(_here)
os.close(_here)
