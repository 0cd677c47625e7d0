"""Draws the pictures of runs and writes report.html."""
import os
import sys
from pathlib import Path

from ..errors import UnreadableFile
from .claim_plots import all_plots
from .crack_path import draw_crack_path
from .field_pictures import draw_fields, has_fields
from .pages import write_page
from .motion import read_last_frame, read_motion
from .near_tip_plots import opening_stress_picture, velocity_picture
from .page import contents
from .pictures import draw_energy, draw_sheet
from .runs import Unreadable, find_runs, has_rows
from .sheet_data import LARGEST_SHEETS, sheet_data
from .summary import text_summary


def draw_pictures(run, motion, folder):
    """Draws the pictures of a fracture run for which it has files: {name: (picture, still picture for print or None)}.

    motion: frames of the run to animate, or None. folder: where the pictures are written.
    """
    drawn = {}

    def place(name, still=None):
        drawn[name] = (folder / name, still)
        return folder / name

    if motion is not None:
        from .animation import draw_animation
        still = folder / "animation.png"
        draw_animation(motion, place("animation.gif", still), still)
    frame = read_last_frame(run.folder)
    if frame is not None:
        draw_sheet(frame, run.input_number("Fracture/breaking stretch"), place("sheet.png"))
        if has_fields(frame):
            draw_fields(frame, place("sheet_fields.png"))
    if has_rows(run.tip, 2):
        draw_crack_path(run, place("crack_path.png"))
    if has_rows(run.energy, 2):
        draw_energy(run.energy, place("energy.png"))
    means = run.folder / "near_tip_folded.vti"
    if means.exists():
        velocity_picture(means, place("near_tip_velocity.png"), crack_speed=(run.crack or {}).get("speed_laboratory"))
        opening_stress_picture(means, place("near_tip_stress.png"))
    return drawn


def draw_plots(run, folder):
    """Plots in a folder of the tables that claims wrote in a run: {plot name: (PNG file, error metrics)}."""
    made = {}
    for plot in all_plots():
        if plot.name in run.tables:
            path = folder / f"{plot.name}.png"
            made[plot.name] = (path, plot.write(run.tables, path))
    return made


def place_for(run, folder, output):
    """Folder for the pictures of a run in `folder`: its place in `output`."""
    place = output / run.folder.relative_to(folder)
    place.mkdir(parents=True, exist_ok=True)
    return place


def report(folder, output_dir=None, quiet=False, animated=False):
    """Draws and writes the report of a folder.

    output_dir: folder for the page and the pictures, those of each run in the same sub-folder as the run; None: the folder itself
    @return exit code: 0; 3 if a claim fails; 2 if a run cannot be read, which is listed with its error, while the others are shown
    """
    output = Path(output_dir or folder)
    found, unreadable = find_runs(folder)
    runs, pictures, plots, sheets = [], {}, {}, {}
    most = LARGEST_SHEETS // max(1, sum(run.is_fracture for run in found))
    for run in found:
        try:  # frames and fields are read here
            motion = read_motion(run) if run.is_fracture else None
            place = place_for(run, folder, output)
            pictures[run.folder] = draw_pictures(run, motion if animated else None, place) if run.is_fracture else {}
            sheets[run.folder] = None if motion is None else sheet_data(run, motion, most)
            plots[run.folder] = draw_plots(run, place)
            runs.append(run)
        except UnreadableFile as error:
            unreadable.append(Unreadable(run.name, run.folder, str(error)))
    write_page(output / "report.html", "report.html",
               **contents(folder.resolve().name, runs, pictures, plots, sheets, unreadable, animated))
    for one in unreadable:
        print(f"error: {one.problem}", file=sys.stderr)
    if not quiet:
        sys.stdout.reconfigure(errors="replace")
        print(text_summary(runs, unreadable))
        print(f"\n{os.path.join(output_dir or folder, 'report.html')}")
    if unreadable:
        return 2
    return 3 if any(c.verdict == "fails" for run in runs for c in run.checks) else 0
