#!/usr/bin/python3
"""Draws the cracks of a study and writes the page gallery.md, with pictures in pictures/ and all rows in gallery-paper.csv.

With --latcon it first performs missing runs: the study, and the cracks of EXTRA_RUNS.
Exit codes, as of latcon: 0 success; 2 no study, or a damaged file; 4 a run failed; 5 a file cannot be written.
"""
import argparse
import csv
import io
import re
import subprocess
import sys
import textwrap
from pathlib import Path

sys.dont_write_bytecode = True  # no files are added to this folder

ROOT = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "python"))

from latcon.errors import UnreadableFile
from latcon.files import if_present, read_text
from latcon.folder import write_file
from latcon.report.animation import draw_animation
from latcon.report.crack_path import draw_crack_path
from latcon.report.pictures import draw_sheet, shrink
from latcon.report.runs import has_rows, read_last_frame, read_motion, read_run
from latcon.report.study import draw_run
from latcon.report.study_plots import asked_quantities, draw_sweep, pattern_text, sweeps_of
from latcon.report.study_runs import mean_of, read_study, value_text

LARGEST_PICTURE, LARGEST_ANIMATION = 250_000, 1_000_000  # [bytes]
TABLE = "gallery-paper.csv"  # all rows of the study
SWEEPS = ("zeta", "Sheet/height")  # abscissas of the plots
SHELLS = "Next-nearest neighbours/present"
ALL_KINDS = ("sheet", "path", "velocity", "stress")
# Cracks shown: heading, pattern, with next-nearest neighbours or without, pictures.
CASES = (("Oscillating", "oscillating", True, ALL_KINDS),
         ("Straight, with next-nearest neighbours", "straight", True, ALL_KINDS),
         ("Without next-nearest neighbours", "straight", False, ALL_KINDS),
         ("Branching", "branching", True, ("sheet", "path")))
# Additional cracks for the gallery, with the entries that differ from the case of Fig. 1.
EXTRA_RUNS = {
    "fig1": [],
    "arrested": ["Sheet/length=8 cm", "Sheet/height=4 cm", "Fracture/breaking stretch=10", "Time/end=3 ms",
                 "Output/frame interval=0", "Output/motion frames=0"],
}
DONE, BAD_INPUT, CLAIM_FAILS, RUN_FAILED, IO_FAILED = 0, 2, 3, 4, 5  # exit codes of latcon
# Pictures of a run in their order, with the numbers that they show: quantity, name, scale, unit.
NUMBERS = {
    "sheet": (("speed_lagrangian", "speed", 1, " m/s"), ("speed_over_shear", "speed over shear wave speed", 1, ""),
              ("bridged_length", "bridged length", 100, " cm"), ("detached_sites", "detached sites", 1, "")),
    "path": (("wavelength", "wavelength", 100, " cm"), ("amplitude", "amplitude", 100, " cm"),
             ("crest_amplitude", "crest amplitude", 100, " cm")),
    "velocity": (("negative_zone_area", "area of the negative-velocity zone", 1e6, " mm²"),
                 ("negative_zone_depth", "most negative velocity ahead of the tip", 1, " m/s"),
                 ("velocity_asymmetry", "asymmetry", 1, ""), ("process_zone_length", "process-zone length", 1e3, " mm")),
    "stress": (("opening_stress_ratio_4d", "peak of the opening stress at 4 d over the value straight ahead", 1, ""),
               ("opening_stress_angle_4d", "angle of this peak", 1, "°"), ("wedge_angle", "wedge angle", 1, "°")),
}


def cases_of(study):
    """[(heading, seed, pictures), ...]: for each entry of CASES the first seed of the first run in `pictures` that shows it.

    Without next-nearest neighbours any pattern is accepted if no run is straight.
    """
    shown = [name for name in study.document["pictures"] if name in study.runs]
    found = []
    for heading, pattern, has_both_shells, kinds in CASES:
        seeds = [seed for name in shown if (study.runs[name][1].get(SHELLS) != "false") == has_both_shells
                 for seed in study.runs[name][2] if seed.is_measured]
        fitting = [seed for seed in seeds if seed.pattern == pattern]
        fitting += [] if has_both_shells else seeds
        found += [(heading, seed, kinds) for seed in fitting[:1]]
    return found


def draw_case(seed, kinds, folder):
    """Draws the pictures of a run for which it has data: {kind of NUMBERS: PNG}."""
    drawn = draw_run(seed, folder, LARGEST_PICTURE, kinds)
    run = read_run(seed.folder)
    if has_rows(run.tip, 2):
        drawn["path"] = folder / f"{seed.run}-path.png"
        draw_crack_path(run, drawn["path"])
        shrink(drawn["path"], LARGEST_PICTURE)
    return drawn


def numbers_text(seed, seeds, kinds):
    """Numbers of one seed, and their means over all seeds of the run if there are several."""
    words = []
    for quantity, name, scale, unit in (number for kind in kinds for number in NUMBERS[kind]):
        value, mean = seed.values.get(quantity), mean_of(seeds, quantity)
        here = "none" if value is None else f"{scale * value:.4g}{unit}"
        if mean is not None:
            over = f" ({value_text(mean, scale).rpartition(' (')[0]}{unit})" if mean.n > 1 else ""
            words.append(f"{name} {here}{over}")
    return "; ".join(words)


def case_section(study, heading, seed, drawn):
    """Section of a crack: description, numbers, pictures."""
    about, changed, seeds = study.runs[seed.run]
    changes = ", ".join(f"{entry} = {value}" for entry, value in changed.items())
    kinds = [kind for kind in NUMBERS if kind in drawn]
    found = numbers_text(seed, seeds, kinds)
    return [f"## {heading}: `{seed.run}`", "", f"{about[:1].upper()}{about[1:]}{'. ' if about else ''}"
            f"{'Changed: ' + changes + '. ' if changes else ''}Patterns over its seeds: {pattern_text(seeds)}. "
            f"Pictures of seed {seed.seed}: {seed.pattern}.{f' Measured: {found}.' if found else ''}", "",
            *[f"![{kind} of {seed.run}](pictures/{drawn[kind].name})" for kind in kinds]]


def sweep_sections(study, folder):
    """Sections of sweeps, one for each set of runs along one abscissa: [(lines, PNG), ...]."""
    sections, known = [], set()
    for claim in study.claims:
        for rows in sweeps_of([row for row in claim["rows"] if row["against"] in SWEEPS]):
            key = (rows[0]["against"], tuple(rows[0]["runs"]))
            png = folder / f"sweep-{len(sections) + 1}.png"
            if key in known or not draw_sweep(study, rows[0], asked_quantities(rows), png):
                continue
            known.add(key)
            sections.append(([f"## {claim['claim']}", "", f"![sweep](pictures/{png.name})"], png))
    return sections


def brief(measured):
    """What was measured, without the list of runs or abscissas that follows a summary or is all there is."""
    return re.split(r"; (?=[\w.+-]+: )", measured)[0]


def deciding(rows):
    """The row that decides a claim: the first that fails, or is judged, or is reported; a number rather than a pattern."""
    judged = [row for row in rows if row["verdict"] != "reported"]
    chosen = [row for row in judged if row["verdict"] != "holds"] or judged or rows
    return next((row for row in chosen if row["quantity"] != "pattern"), chosen[0])


def claims_section(study, table):
    """Table of the statements of the source, each with the row that decides; `table` is the name of the file with all rows."""
    lines = ["## What the paper says, and what latcon measures", "",
             f"One row that decides for each statement; all rows are in [{table}]({table}), the words of the paper and notes in "
             "`verification/studies/paper.json`.", "", "| statement | verdict | decided by |", "| --- | --- | --- |"]
    for claim in study.claims:
        row = deciding(claim["rows"])
        runs = row["runs"][0] + (" …" if len(row["runs"]) > 1 else "")
        lines.append(f"| {claim['claim']} | {claim['verdict']} | {runs}, `{row['quantity']}`: {brief(row['measured'])}"
                     f"{' [' + row['expected'] + ']' if row['expected'] else ''} |")
    return lines


def rows_text(study):
    """All rows of the study as CSV."""
    out = io.StringIO()
    table = csv.writer(out, lineterminator="\n")
    table.writerow(["statement", "verdict", "runs", "quantity", "measured", "expected"])
    for claim in study.claims:
        for row in claim["rows"]:
            table.writerow([claim["claim"], row["verdict"], ", ".join(row["runs"]), row["quantity"], row["measured"], row["expected"] or ""])
    return out.getvalue()


def film_section(run, folder):
    """Animation of the crack of Fig. 1: ([line, ...], [picture, ...]), empty if there is no such run."""
    gif = folder / "fig1.gif"
    motion = read_motion(run)
    if motion is None:
        return [], []
    draw_animation(motion, gif, largest=LARGEST_ANIMATION)
    return ["", "## Animation of Fig. 1", "", "![the sheet of Fig. 1, torn from left to right](pictures/fig1.gif)", "",
            "The deformed sheet, coloured by the speed of the material, in uniform slow motion: waves run ahead of the "
            "crack, and its flanks snap back behind it. Made from the frames in `motion.pvd` of `./run fracture "
            "verification/cases/fig1.prm`; `latcon report --animation` draws one of any crack."], [gif]


def arrested_section(run, folder):
    """Section of an arrested crack: ([line, ...], [picture, ...]), empty if there is no such run."""
    frame = read_last_frame(run.folder)
    if run.crack is None or frame is None:
        return [], []
    png = folder / "arrested-sheet.png"
    breaking_stretch = run.input_number("Fracture/breaking stretch")
    draw_sheet(frame, breaking_stretch, png)
    shrink(png, LARGEST_PICTURE)
    changes = ", ".join(entry.replace("=", " = ") for entry in EXTRA_RUNS["arrested"] if not entry.startswith("Output"))
    return ["", f"## {run.crack['pattern'].capitalize()}: `arrested`", "",
            f"Bonds too tough for the loading. Changed with respect to Fig. 1: {changes}. "
            f"Measured: {run.crack['pattern']}, {run.crack['reason']}.", "",
            f"![sheet of arrested](pictures/{png.name})"], [png]


def run_missing(latcon, folder):
    """Runs the study and the cracks of EXTRA_RUNS unless they exist. @return whether all runs succeeded"""
    wanted = [] if (folder / "study.json").exists() else [["study", "paper", "--output-dir", folder]]
    case = ROOT / "verification" / "cases" / "fig1.prm"
    for name, changes in EXTRA_RUNS.items():
        out = folder / "gallery" / name
        if not (out / "crack.json").exists():
            settings = [word for change in changes for word in ("--set", change)]
            wanted.append(["fracture", case, "--no-report", "--quiet", "--output-dir", out, *settings])
    for words in wanted:
        print("Running latcon", *words[:2], "into", words[words.index("--output-dir") + 1], flush=True)
        if subprocess.run([latcon, *words], check=False).returncode not in (DONE, CLAIM_FAILS):
            return False
    return True


def gallery(study, docs):
    """Draws all pictures and writes the page."""
    folder = docs / "pictures"
    folder.mkdir(parents=True, exist_ok=True)
    document = study.document
    lines = ["# Gallery", "", "Made by `cmake --build build/release --target gallery` from the study "
             f"\"{document['title']}\" (latcon {document['version']}, commit {document['git_commit'][:12]}, "
             f"{len(study.seeds)} runs{', quick version' if document['quick'] else ''}); do not edit. The numbers are "
             "from its `study.json`: values of the seed shown, and mean ± standard deviation over all seeds. A test runs the cracks "
             "shown again: pattern, speed and detached sites have to be those on the page, to the last digit.", "",
             "Pictures, as far as a crack has them: the deformed sheet in its last frame; above, path of the tip in the undeformed "
             "sheet, below, where bonds broke, coloured by time; velocity of the material around the tip (cross), mean over "
             "samples, mirrored where the path descends, blue: motion against the direction of the crack; opening stress, "
             "averaged in the same way. Plots of sweeps have means and standard deviations over the seeds; open symbols at 0: "
             "not defined for this crack."]
    pictures = set()
    extra = {name: read_run(study.folder / "gallery" / name) for name in EXTRA_RUNS}
    section, drawn = film_section(extra["fig1"], folder)
    lines += section
    pictures |= set(drawn)
    for heading, seed, kinds in cases_of(study):
        drawn = draw_case(seed, kinds, folder)
        pictures |= set(drawn.values())
        lines += ["", *case_section(study, heading, seed, drawn)]
    section, drawn = arrested_section(extra["arrested"], folder)
    lines += section
    pictures |= set(drawn)
    for section, png in sweep_sections(study, folder):
        pictures.add(png)
        lines += ["", *section]
    lines += ["", *claims_section(study, TABLE)]
    write_file(str(docs / TABLE), rows_text(study))
    before = set(re.findall(r"\]\(pictures/([^)]*)\)", if_present(read_text, docs / "gallery.md") or ""))
    write_file(str(docs / "gallery.md"), wrapped(lines))
    for name in before - {picture.name for picture in pictures}:
        (folder / name).unlink(missing_ok=True)  # of another study
    print(docs / "gallery.md")
    return DONE


def wrapped(lines):
    """Text of the lines, wrapped to 120 columns."""
    return "".join(line + "\n" if line.startswith(("!", "#", "|")) else textwrap.fill(
        line, 120, subsequent_indent="  " if line.startswith("- ") else "", break_long_words=False,
        break_on_hyphens=False) + "\n" for line in lines)


def main(words=None):
    """Runs the command line; `words` replace the arguments of the process. @return exit code"""
    parser = argparse.ArgumentParser(description="Draw the cracks of a study and write gallery.md.")
    parser.add_argument("directory", metavar="STUDY", help="output directory of latcon study")
    parser.add_argument("docs", metavar="DOCS", help="where to write gallery.md and pictures/")
    parser.add_argument("--latcon", metavar="PROGRAM", help="program with which to perform missing runs")
    arguments = parser.parse_args(words)
    folder = Path(arguments.directory)
    if arguments.latcon and not run_missing(arguments.latcon, folder):
        print("error: latcon failed, see above", file=sys.stderr)
        return RUN_FAILED
    try:
        return gallery(read_study(folder), Path(arguments.docs))
    except UnreadableFile as error:
        print(f"error: {error}; `latcon study paper` makes one", file=sys.stderr)
        return BAD_INPUT
    except OSError as error:
        print(f"error: cannot write {error.filename}: {error.strerror}", file=sys.stderr)
        return IO_FAILED


if __name__ == "__main__":
    sys.exit(main())
