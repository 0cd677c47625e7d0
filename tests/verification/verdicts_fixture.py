#!/usr/bin/python3
"""Checks the claims before a crack, once for all tests of other things, and leaves a folder for them (LATCON_VERDICTS):

latcon/verdicts    verdicts for quick.prm, on the program, and for nearest neighbours alone in a compressed sheet, which are refused
matplotlib         the list of fonts, which takes half a second to make
runs/NAME          results of the runs `accepted` and `refused` that left the verdicts

Usage: verdicts_fixture.py PATH_OF_LATCON FOLDER
"""
import json
import os
import pathlib
import shutil
import subprocess
import sys

# A strip in which a crack does not advance far.
TINY = ["--set", "Sheet/length=2.5 cm", "--set", "Sheet/height=1.5 cm", "--set", "Time/end=0.01 ms"]
# Nearest neighbours alone, which are faster to check, in a sheet that is compressed along x and buckles.
REFUSED = ["--set", "Next-nearest neighbours/present=false", "--set", "Loading/strain x=-0.3"]
RUNS = {"accepted": ([], 0, 2), "refused": (REFUSED, 3, 3)}  # more settings, exit code, files of verdicts after it


def main(program, folder):
    shutil.rmtree(folder, ignore_errors=True)
    environment = dict(os.environ, XDG_CACHE_HOME=str(folder), MPLCONFIGDIR=str(folder / "matplotlib"))
    for name, (settings, code, number) in RUNS.items():
        run = subprocess.run([program, "fracture", "quick", "--no-report", "--output-dir", folder / "runs" / name, *TINY, *settings],
                             text=True, stdout=subprocess.PIPE, env=environment, check=False)
        print(run.stdout)
        if run.returncode != code or "claims: checked now" not in run.stdout:
            sys.exit(f"{name}: exit code {run.returncode}")
        if len(list((folder / "latcon" / "verdicts").iterdir())) != number:
            sys.exit(f"{name}: no verdicts")
        verification = json.loads((folder / "runs" / name / "run.json").read_text(encoding="utf-8"))["verification"]
        if verification["reused"]:
            sys.exit(f"{name}: verdicts that were there before")
    subprocess.run([sys.executable, "-c", "import matplotlib.font_manager"], env=environment, check=True)


if __name__ == "__main__":
    main(sys.argv[1], pathlib.Path(sys.argv[2]))
