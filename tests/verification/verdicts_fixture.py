#!/usr/bin/python3
"""Checks the claims, once for all tests, and leaves a folder for them (LATCON_VERDICTS):

latcon/verdicts    verdicts for quick.prm, on the program, and for nearest neighbours alone in a compressed sheet, which are refused
matplotlib         the list of fonts, which takes half a second to make
runs/verify        results of `latcon verify --quick`, which leaves the verdicts on the program, with its output in verify.json
runs/NAME          results of the runs `accepted` and `refused` that left the verdicts on a case

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
# Nearest neighbours alone, and without dashpots, which are faster to check, in a sheet that is compressed along x and buckles.
BUCKLED = {"Next-nearest neighbours/present": False, "Nearest neighbours/viscosity": 0, "Loading/strain x": -0.3}
REFUSED = [word for key, value in BUCKLED.items() for word in ("--set", f"{key}={str(value).lower()}")]
RUNS = {"accepted": ([], 0, 2), "refused": (REFUSED, 3, 3)}  # more settings, exit code, files of verdicts after it


def main(program, folder):
    shutil.rmtree(folder, ignore_errors=True)
    environment = dict(os.environ, XDG_CACHE_HOME=str(folder), MPLCONFIGDIR=str(folder / "matplotlib"))
    # Whether these claims hold is for verify_test.py to say: a crack waits for some of them alone.
    verify = subprocess.run([program, "verify", "--quick", "--output-dir", folder / "runs" / "verify"], text=True,
                            capture_output=True, env=environment, check=False)
    kept = [path.name for path in (folder / "latcon" / "verdicts").glob("*.json")]
    (folder / "runs" / "verify.json").write_text(json.dumps(
        {"exit_code": verify.returncode, "output": verify.stdout + verify.stderr, "verdicts": kept}), encoding="utf-8")
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
