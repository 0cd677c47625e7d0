#!/usr/bin/python3
"""Checks the claims before the crack of quick.prm, and leaves the verdicts in a folder for other tests (LATCON_VERDICTS).

Usage: verdicts_fixture.py PATH_OF_LATCON FOLDER
"""
import os
import pathlib
import shutil
import subprocess
import sys
import tempfile

program, folder = sys.argv[1], pathlib.Path(sys.argv[2])
shutil.rmtree(folder, ignore_errors=True)
with tempfile.TemporaryDirectory() as out:
    run = subprocess.run([program, "fracture", "quick", "--no-report", "--output-dir", out], check=True, text=True,
                         stdout=subprocess.PIPE, env=dict(os.environ, XDG_CACHE_HOME=str(folder)))
print(run.stdout)
if "claims: checked now" not in run.stdout or not any((folder / "latcon" / "verdicts").iterdir()):
    sys.exit("no verdicts")
