"""Imports matplotlib without a `matplotlibrc` of the current folder, which it would take before any other: the folder of
a run may be somebody else's. To be imported before all that imports matplotlib."""
import os
from pathlib import Path

_here = os.open(".", os.O_PATH)
os.chdir(Path(__file__).resolve().parent)
import matplotlib  # noqa: F401

os.fchdir(_here)
os.close(_here)
