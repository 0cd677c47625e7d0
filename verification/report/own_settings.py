"""Ends the script with a message if a Debian package of the report is missing, and imports matplotlib without the `matplotlibrc`
of the current folder, which would otherwise take precedence: the folder of a run may belong to somebody else. Import this module
before any other that imports matplotlib."""
import importlib
import logging
import os
import sys
from pathlib import Path

# Modules that show that a Debian package is installed; the order is that of the imports, matplotlib importing those before it.
PACKAGES = {"numpy.linalg": "python3-numpy", "PIL.Image": "python3-pil", "matplotlib.figure": "python3-matplotlib",
            "vtkmodules.util": "python3-vtk9"}
PACKAGES_MISSING = 69  # exit code, which latcon replaces by its own: EX_UNAVAILABLE of sysexits.h


def require_packages():
    missing, reason = [], ""
    for module, package in PACKAGES.items():
        try:
            importlib.import_module(module)
        except ImportError as error:
            is_absent = isinstance(error, ModuleNotFoundError) and error.name in (module, module.partition(".")[0])
            if not missing and not is_absent:  # installed, but broken; the following may fail for the same reason
                reason = f"; {module}: {error}"
            missing.append(package)
    if missing:
        names = " ".join(missing)
        print(f"error: cannot import the Python modules of the Debian packages {names}; install them "
              f"(apt-get install {names}){reason}", file=sys.stderr)
        sys.exit(PACKAGES_MISSING)


# Without a home, matplotlib keeps its list of fonts in a temporary folder that it removes; its advice would be in the log of every run.
logging.getLogger("matplotlib").setLevel(logging.ERROR)
_here = os.open(".", os.O_PATH)
os.chdir(Path(__file__).resolve().parent)
require_packages()
os.fchdir(_here)
os.close(_here)
