"""Runs latcon, a simulator of dynamic fracture of rubber, and reads its results.

Examples
--------
>>> import latcon
>>> case = latcon.Case("quick.prm").set("Sheet/height", "1.5 cm")
>>> run = latcon.fracture(case, "output", threads=2)
>>> run.crack.speed_lagrangian
"""
import sys

from .errors import OUTPUT_FAILED, LatconError, optional_package

if sys.argv[:2] == ["-m", "--parsed"]:  # a command of the program, before __main__.py, which comes after this file
    try:
        for module in ("numpy", "scipy") if sys.argv[2] in ("compare", "study") else ("numpy",):
            optional_package(module, "this command needs", f"{module} (Debian: python3-{module})")
    except LatconError as missing:
        print(f"latcon: {missing}", file=sys.stderr)
        sys.exit(OUTPUT_FAILED)

from .case import Case
from .commands import Job, continuum, fracture, lattice, start, verify
from .errors import (BadInput, ClaimFailed, DidNotConverge, InternalError, Interrupted, OutputFailed, ProgramError, ProgramNotFound,
                     UnknownEntry, UnreadableFile)
from .frames import Frame
from .program import find_program
from .quantities import Quantities, Value
from .results import Run
from .results import open_run as open  # called as latcon.open
from .schema import Entry, Schema, schema
from .studies import Study, open_study, sweep

__version__ = "1.0.0"  # that of CMakeLists.txt, which the tests compare

# Without `open`, which `from latcon import *` would substitute for Python's built-in function.
__all__ = ["BadInput", "Case", "ClaimFailed", "DidNotConverge", "Entry", "Frame", "InternalError", "Interrupted", "Job", "LatconError",
           "OutputFailed", "ProgramError", "ProgramNotFound", "Quantities", "Run", "Schema", "Study", "UnknownEntry",
           "UnreadableFile", "Value", "continuum", "find_program", "fracture", "lattice", "open_study", "schema", "start", "sweep",
           "verify"]
