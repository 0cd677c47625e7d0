#!/usr/bin/python3
"""Draws the plots of a study and writes study.html.

Exit codes, those of latcon: 0 done; 2 no study there, or a damaged file; 5 a file cannot be written.
"""
import argparse
import sys
from pathlib import Path

sys.dont_write_bytecode = True  # this folder stays as it is

from files import DamagedFile, UnwritableFile, write_file
from frame import read_last_frame
from pictures import draw_sheet
from runs import read_run
from study_page import page
from study_plots import draw_paths, draw_speeds, draw_sweep, draw_velocities
from study_runs import read_study

DONE, BAD_INPUT, IO_FAILED = 0, 2, 5


def draw_pictures(study):
    """All pictures, as far as the runs left what they need; see page() for the form."""
    folder = study.folder / "pictures"
    try:
        folder.mkdir(exist_ok=True)
    except OSError as error:
        raise UnwritableFile(folder, error.strerror) from error
    drawn = {"paths": {}, "sweeps": {}, "speeds": None, "velocities": None, "sheets": []}
    for number, claim in enumerate(study.claims):
        names = list(dict.fromkeys(name for row in claim["rows"] for name in row["runs"] if name in study.runs))
        png = folder / f"paths-{number + 1}.png"
        if draw_paths(study, names, png):
            drawn["paths"][number] = png
        drawn["sweeps"][number] = draw_sweeps(study, number, claim, folder)
    shown = [name for name in study.document["pictures"] if name in study.runs]
    if draw_speeds(study, folder / "speeds.png"):
        drawn["speeds"] = folder / "speeds.png"
    if draw_velocities(study, shown, folder / "velocities.png"):
        drawn["velocities"] = folder / "velocities.png"
    for name in shown:
        drawn["sheets"] += draw_first_sheet(study, name, folder)
    return drawn


def draw_sweeps(study, number, claim, folder):
    """One picture for each set of runs along one abscissa: [(caption, PNG), ...]."""
    drawn = {}
    for row in claim["rows"]:
        key = (row["against"], tuple(row["runs"]))
        png = folder / f"sweep-{number + 1}-{len(drawn) + 1}.png"
        if row["against"] and key not in drawn and draw_sweep(study, row, png):
            drawn[key] = (f"Wavelength and amplitude against {row['against']}: mean and standard deviation over the "
                          "seeds. Open symbols at 0: the crack has none.", png)
    return list(drawn.values())


def draw_first_sheet(study, name, folder):
    """The sheet of the first seed that was measured: [(run, seed, PNG)], empty if there is none."""
    for seed in study.runs[name][2]:
        frame = read_last_frame(seed.folder) if seed.state == "measured" else None
        if frame is not None:
            png = folder / f"sheet-{name}.png"
            draw_sheet(frame, read_run(seed.folder).input_number("Fracture", "breaking stretch"), png)
            return [(name, seed.seed, png)]
    return []


def main():
    """The command line. @return exit code"""
    parser = argparse.ArgumentParser(description="Draw the plots of a study and write study.html.")
    parser.add_argument("directory", metavar="DIR", help="output directory of latcon study")
    parser.add_argument("--quiet", action="store_true", help="print nothing but errors")
    arguments = parser.parse_args()
    try:
        study = read_study(Path(arguments.directory))
        html = page(study, draw_pictures(study))
        write_file(study.folder / "study.html", lambda beside: beside.write_text(html, encoding="utf-8"))
    except DamagedFile as error:
        print(f"error: {error}", file=sys.stderr)
        return BAD_INPUT
    except UnwritableFile as error:
        print(f"error: {error}", file=sys.stderr)
        return IO_FAILED
    if not arguments.quiet:
        print(study.folder / "study.html")
    return DONE


if __name__ == "__main__":
    sys.exit(main())
