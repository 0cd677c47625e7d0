#!/usr/bin/python3
"""Draws the page of an output directory: ``report DIR``, ``study DIR`` or ``compare DIR``.

The program starts this file by its path. Exit codes, those of latcon: 0 success, and no claim fails; 2 nothing to show, or a damaged
file; 3 a claim fails; 5 a file cannot be written; 69 (EX_UNAVAILABLE of sysexits.h, which the program replaces by its own) a package
is missing.
"""
import signal

if __name__ == "__main__":
    signal.signal(signal.SIGINT, signal.SIG_DFL)  # ends the script in silence, while it imports too

import argparse
import importlib
import logging
import os
import sys
from pathlib import Path

sys.dont_write_bytecode = True  # no files are added to this folder

DONE, BAD_INPUT, IO_FAILED, PACKAGES_MISSING = 0, 2, 5, 69
# Modules that show that a Debian package is installed; the order is that of the imports, matplotlib importing those before it.
PACKAGES = {"numpy.linalg": "python3-numpy", "PIL.Image": "python3-pil", "matplotlib.figure": "python3-matplotlib",
            "vtkmodules.util": "python3-vtk9", "jinja2": "python3-jinja2"}


def require_packages():
    """Ends the script with a message if a package is missing."""
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
        print(f"latcon: cannot import the Python modules of the Debian packages {names}; install them "
              f"(apt-get install {names}){reason}", file=sys.stderr)
        sys.exit(PACKAGES_MISSING)


def main(words=None):
    """Runs the command line; `words` replace the arguments of the process. Returns the exit code."""
    parser = argparse.ArgumentParser(prog="latcon.report", description="Draw the pictures and the page of an output directory.")
    parser.add_argument("page", choices=("report", "study", "compare"), help="of runs, of a study, or of two cracks compared")
    parser.add_argument("directory", metavar="DIR", type=Path, help="output directory, for a report also a folder of several")
    parser.add_argument("--output-dir", metavar="OUT", help="folder for page and pictures of a report (default: DIR)")
    parser.add_argument("--animation", action="store_true", help="draw animation.gif of each crack of a report as well")
    parser.add_argument("--dry-run", action="store_true", help="list the runs of a report and draw nothing")
    parser.add_argument("--quiet", action="store_true", help="print nothing but errors")
    given = parser.parse_args(words)
    from latcon.errors import UnreadableFile
    from latcon.report import comparison, report, study
    try:
        if given.page == "report":
            return report.report(given.directory, given.output_dir, given.quiet, given.animation, given.dry_run)
        page = (study.study_page if given.page == "study" else comparison.comparison_page)(given.directory)
        if not given.quiet:
            print(page)
        return DONE
    except UnreadableFile as error:
        print(f"latcon: {error}", file=sys.stderr)
        return BAD_INPUT
    except OSError as error:
        print(f"latcon: cannot write {error.filename or 'standard output'}: {error.strerror}", file=sys.stderr)
        return IO_FAILED


if __name__ == "__main__":
    # Without a home, matplotlib keeps its list of fonts in a temporary folder; its advice would be in the log of every run.
    logging.getLogger("matplotlib").setLevel(logging.ERROR)
    # A `matplotlibrc` of the current folder would take precedence: the folder of a run may belong to somebody else.
    for _name in ("MPLCONFIGDIR", "XDG_CACHE_HOME", "XDG_CONFIG_HOME"):
        if os.environ.get(_name):  # relative to the folder of the user
            os.environ[_name] = os.path.abspath(os.environ[_name])
    _here = os.open(".", os.O_PATH)
    os.chdir(Path(__file__).resolve().parent)
    require_packages()
    os.fchdir(_here)
    os.close(_here)
    sys.path.insert(0, str(Path(__file__).resolve().parents[2]))
    sys.exit(main())
