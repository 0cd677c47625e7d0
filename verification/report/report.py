#!/usr/bin/python3
"""Draws the pictures of latcon's runs and writes report.html.

Exit codes, those of latcon: 0 done and no claim fails; 2 no run there, or a damaged file; 3 a claim fails; 5 a file
cannot be written.
"""
import argparse
import os
import sys
from pathlib import Path

sys.dont_write_bytecode = True  # this folder stays as it is

from claims_text import PLOTS
from crack_path import draw_crack_path
from files import CLAIM_FAILS, DONE, exit_code_of, write_file
from frame import read_last_frame
from near_tip_plots import opening_stress_picture, velocity_picture
from page import page
from pictures import draw_energy, draw_sheet
from runs import find_runs, has_rows
from summary import text_summary


def draw_pictures(run):
    """Pictures of a fracture run, as far as its files go: [(file name, PNG file), ...]."""
    drawn = []
    frame = read_last_frame(run.folder)
    if frame is not None:
        drawn.append("sheet.png")
        draw_sheet(frame, run.input_number("Fracture", "breaking stretch"), run.folder / drawn[-1])
    if has_rows(run.tip, 2):
        drawn.append("crack_path.png")
        draw_crack_path(run, run.folder / drawn[-1])
    if has_rows(run.energy, 2):
        drawn.append("energy.png")
        draw_energy(run.energy, run.folder / drawn[-1])
    means = run.folder / "near_tip_folded.vti"
    if means.exists():
        drawn += ["near_tip_velocity.png", "near_tip_stress.png"]
        velocity_picture(means, run.folder / drawn[-2], crack_speed=(run.crack or {}).get("speed_laboratory"))
        opening_stress_picture(means, run.folder / drawn[-1])
    return [(name, run.folder / name) for name in drawn]


def draw_plots(run):
    """Plots of the claims that a run left tables of: {plot name: (PNG file, error metrics)}."""
    made = {}
    for plot in PLOTS:
        if plot.name in run.tables:
            path = run.folder / f"{plot.name}.png"
            made[plot.name] = (path, plot.draw(run.tables, path))
    return made


def report(directory, quiet):
    """Everything, for the folder as the user gave it. @return exit code"""
    folder = Path(directory)
    runs = find_runs(folder)
    pictures = {run.folder: draw_pictures(run) for run in runs if run.is_fracture}
    plots = {run.folder: draw_plots(run) for run in runs}
    html = page(folder.resolve().name, runs, pictures, plots)
    write_file(folder / "report.html", lambda beside: beside.write_text(html, encoding="utf-8"))
    if not quiet:
        sys.stdout.reconfigure(errors="replace")
        print(text_summary(runs))
        print(f"\n{os.path.join(directory, 'report.html')}")
    return CLAIM_FAILS if any(c.verdict == "fails" for run in runs for c in run.checks) else DONE


def main(words=None):
    """The command line; `words` in place of that of the process. @return exit code"""
    parser = argparse.ArgumentParser(description="Draw the pictures of latcon's runs and write report.html.")
    parser.add_argument("directory", metavar="DIR", help="output directory of a run, or a folder of several")
    parser.add_argument("--quiet", action="store_true", help="print nothing but errors")
    arguments = parser.parse_args(words)
    return exit_code_of(lambda: report(arguments.directory, arguments.quiet))


if __name__ == "__main__":
    sys.exit(main())
