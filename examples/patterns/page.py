#!/usr/bin/python3
"""Makes the record and the pictures of docs/patterns.md.

Usage: page.py record FILE.csv STUDY...     the runs of output directories of `latcon study` in one table
       page.py tables FOLDER                the tables, as CSV
       page.py pictures FOLDER              patterns-map.png, patterns-spectrum.png and patterns-onset.png of the record
"""
import argparse
import csv
import json
import pathlib
import sys

sys.dont_write_bytecode = True
HERE = pathlib.Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parents[1] / "python"))

import numpy as np

from latcon.report.phase_map import Cell, draw_phase_map
from latcon.report.pictures import BLACK, BLUE, GREEN, RED, WIDTH, Page, save

ENTRIES = {"strain_x": "Loading/strain x", "strain_y": "Loading/strain y", "viscosity": "Nearest neighbours/viscosity"}
VALUES = ("speed_lagrangian", "wavelength", "amplitude", "periods", "window_begin")
# zeta = (eta / a) / (d sqrt(rho / a)) over the viscosity of nearest neighbours [1/(Pa s)]: theory.md, eq. (L.5)
ZETA = 1 / (0.1e6 * 0.625e-3 * np.sqrt(944 / 0.1e6))
COLUMNS = ("run", "seed", *ENTRIES, "pattern", *VALUES, "departure")
LEFT = 2 * 0.625e-3  # distance from the centre line that a tip reaches only in an oscillation [m]; a start in noise reaches 1.73 d


def entries(case):
    """Entries of a resolved case: {"Section/Name": text}."""
    section, found = "", {}
    for line in case.read_text(encoding="utf-8").splitlines():
        words = line.split("#")[0].split()
        if words[:1] == ["subsection"]:
            section = " ".join(words[1:])
        elif words[:1] == ["set"]:
            equals = words.index("=")
            found[f"{section}/{' '.join(words[1:equals])}"] = " ".join(words[equals + 1:])
    return found


def departure(path):
    """Advance of the tip until it has left the centre line by more than LEFT [m]; None if it has not."""
    with path.open(encoding="utf-8", newline="") as file:
        tips = [(float(row["X"]), float(row["Y"])) for row in csv.DictReader(file)]
    return next((X - tips[0][0] for X, Y in tips if abs(Y) > LEFT), None)


def record(path, studies):
    """Writes the measured runs of studies, SI units, four digits, sorted by name and seed."""
    lines = {}
    for crack in (crack for study in studies for crack in study.glob("runs/*[0-9]/crack.json")):
        measured = json.loads(crack.read_text(encoding="utf-8"))
        run, seed = crack.parent.name.rsplit("-", 1)
        case = entries(crack.parent / "case.prm")
        lines[run, int(seed)] = [
            run, seed, *(f"{float(case[key]):g}" for key in ENTRIES.values()), measured["pattern"],
            *("" if value is None else f"{value:.4g}"
              for value in (*(measured[name] for name in VALUES), departure(crack.with_name("crack.csv"))))]
    with path.open("w", encoding="utf-8", newline="") as file:
        csv.writer(file, lineterminator="\n").writerows([COLUMNS, *(lines[key] for key in sorted(lines))])


def read(name):
    """The record of a study: [{column: number, text, or None}, ...]."""
    with (HERE / "record" / f"{name}.csv").open(encoding="utf-8", newline="") as file:
        rows = list(csv.DictReader(file))
    for row in rows:
        for column in row:
            if column not in ("run", "pattern"):
                row[column] = float(row[column]) if row[column] else None
    return rows


def cells(rows, refined):
    """Cells of a map: patterns by number of seeds. @param refined whether points beside the grid of the study map are a refinement"""
    points = {}
    for row in rows:
        points.setdefault((row["strain_x"], row["strain_y"]), []).append(row)
    found = []
    for (x, y), seeds in points.items():
        names = [seed["pattern"] for seed in seeds]
        level = 0 if all(abs(steps - round(steps)) < 1e-6 for steps in ((x - 0.25) / 0.15, (y - 1) / 0.08)) or not refined else 1
        found.append(Cell(x, y, {name: names.count(name) for name in names}, level=level))
    return found


def mean_text(values, scale, digits):
    """Mean and standard deviation of the values that exist; a dash if there are none."""
    found = scale * np.array([value for value in values if value is not None])
    if not len(found):
        return "–"
    scatter = f" ± {found.std(ddof=1):.{digits}f}" if len(found) > 1 else ""
    return f"{found.mean():.{digits}f}{scatter}" + (f" ({len(found)} of {len(values)})" if len(found) < len(values) else "")


def table(rows, start, head, abscissa):
    """Table as CSV of the runs whose name begins with `start`, by abscissa(row): patterns and means over the seeds."""
    groups = {}
    for row in rows:
        if row["run"].startswith(start):
            groups.setdefault(abscissa(row), []).append(row)
    lines = [f"{head},pattern,amplitude [mm],wavelength [cm],speed [m/s]"]
    for value, seeds in sorted(groups.items()):
        names = [seed["pattern"] for seed in seeds]
        patterns = "; ".join(f"{name} {names.count(name)}/{len(names)}" for name in sorted(set(names)))
        means = [mean_text([seed[name] for seed in seeds], scale, 2) for name, scale in
                 (("amplitude", 1e3), ("wavelength", 1e2), ("speed_lagrangian", 1))]
        lines.append(f"{value:g},{patterns},{','.join(means)}")
    return "\n".join(lines) + "\n"


def tables():
    """The tables of the page by the names of their files: over the strain, and over zeta."""
    rows = read("onset")
    return {"patterns-strain.csv": table(rows, "y-", "strain y", lambda row: row["strain_y"]),
            "patterns-zeta.csv": table(rows, "eta-", "ζ", lambda row: round(row["viscosity"] * ZETA, 2))}


def draw_onset(rows, path):
    """Squared amplitude, wavelength and pattern of every crack over the strain, by the noise."""
    page = Page(4.1)
    columns = (("(amplitude / 0.1 cm)²", lambda row: (1000 * row["amplitude"]) ** 2), ("wavelength [cm]", lambda row: 100 * row["wavelength"]))
    for number, (label, value) in enumerate(columns):
        axes = page.axes(0.8 + number * 4.8, 0.5, 4.1, 2.9)
        for start, colour, marker, words in (("y-", BLUE, "o", "noise of 0.05 d"), ("quiet-", RED, "^", "noise of 0.0001 d"),
                                             ("loud-", GREEN, "v", "noise of 0.12 d")):
            seeds = [row for row in rows if row["run"].startswith(start)]
            wavy = [row for row in seeds if row["amplitude"] is not None]
            calm = [row for row in seeds if row["pattern"] == "straight"]
            axes.plot([row["strain_y"] for row in wavy], [value(row) for row in wavy], marker, color=colour, markersize=5, label=words)
            axes.plot([row["strain_y"] for row in calm], [0] * len(calm), marker, color=colour, markerfacecolor="white", markersize=5)
        axes.set(xlabel="strain y, across the crack", ylabel=label)
        axes.set_ylim(bottom=-0.04 * axes.get_ylim()[1])
        if number == 0:
            axes.axhline((0.75 * 0.625) ** 2, color=BLACK, linestyle="--", linewidth=1)
            page.figure.legend(loc="upper left", bbox_to_anchor=(0.8 / WIDTH, 1), ncol=3)
    save(page.figure, path)


def draw(folder):
    """Draws all pictures whose record exists."""
    for name in ("map", "spectrum"):
        draw_phase_map(cells(read(name), name == "map"), "strain x, along the crack", "strain y, across the crack", folder / f"patterns-{name}.png",
                       height=4.2)
    draw_onset(read("onset"), folder / "patterns-onset.png")


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    commands = parser.add_subparsers(dest="command", required=True)
    for name, words in (("record", ("file", "studies")), ("tables", ("folder",)), ("pictures", ("folder",))):
        command = commands.add_parser(name)
        for word in words:
            command.add_argument(word, type=pathlib.Path, **({"nargs": "+"} if word == "studies" else {}))
    given = parser.parse_args()
    if given.command == "record":
        record(given.file, given.studies)
    elif given.command == "tables":
        for name, text in tables().items():
            (given.folder / name).write_text(text, encoding="utf-8")
    else:
        draw(given.folder)


if __name__ == "__main__":
    main()
