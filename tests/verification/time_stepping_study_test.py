#!/usr/bin/python3
"""Runs the quick study `time-stepping`: both integrators give the same crack in a small strip of Fig. 1, the long steps with at
most a third of the force evaluations.

Usage: time_stepping_study_test.py PATH_OF_LATCON
"""
import json
import os
import pathlib
import subprocess
import sys
import tempfile

LATCON = sys.argv[1]


def study(*options):
    return subprocess.run([LATCON, "study", "time-stepping", "--quick", "--skip-verification", *options], check=False,
                          capture_output=True, text=True)


def main():
    planned = {line.split()[0]: int(line.split()[2]) for line in study("--dry-run").stdout.splitlines()
               if line.startswith(("verlet-", "chebyshev-"))}
    print("force evaluations:", planned)
    if not 3 * planned["chebyshev-1"] < planned["verlet-1"]:
        sys.exit("the long steps do not save two thirds of the force evaluations")
    with tempfile.TemporaryDirectory() as folder:
        run = study("--quiet", "--output-dir", folder)
        document = json.loads((pathlib.Path(folder) / "study.json").read_text(encoding="utf-8"))
    verdicts = {(row["quantity"], row["verdict"]) for claim in document["claims"] for row in claim["rows"]}
    for claim in document["claims"]:
        print([(row["quantity"], row["measured"], row["verdict"]) for row in claim["rows"]])
    for quantity in ("speed_lagrangian", "energy_imbalance"):
        if (quantity, "holds") not in verdicts:
            sys.exit(f"{quantity} was not found to be the same")
    if run.returncode != 0:
        sys.exit(f"exit code {run.returncode}: {run.stderr}")


if __name__ == "__main__":
    os.environ.setdefault("OMP_NUM_THREADS", "1")
    main()
