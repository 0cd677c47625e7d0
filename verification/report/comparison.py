#!/usr/bin/python3
"""Writes compare.html: two cracks side by side, with one time for both sheets.

Exit codes, as of latcon: 0 success; 2 no comparison, or a damaged file; 5 a file cannot be written.
"""
import argparse
import sys
from html import escape
from pathlib import Path

sys.dont_write_bytecode = True  # no files are added to this folder

import own_settings  # before matplotlib

import numpy as np

from files import DONE, DamagedFile, exit_code_of, read_json, write_page
from live import has_dygraphs, live_plot, rows_of, scripts, styles, thinned, viewer
from markup import plain_row, table, whole_page
from motion import read_motion
from runs import has_rows, read_run
from sheet_data import LARGEST_SHEETS, sheet_data, sheet_of
from study_quantities import SHOWN
from summary import with_uncertainty

SIDES = ("first", "second")
PATHS_CAPTION = ("Paths of both tips in the undeformed sheet, with Y exaggerated. Drag across the plot to zoom in, double-click "
                 "to reset.")


def quantities_table(rows, names):
    """Quantities of both runs, the difference, and the difference over the combined uncertainty."""
    def value(row, scale, key, uncertainty=None):
        return "–" if row[key] is None else with_uncertainty(scale * row[key], scaled(row.get(uncertainty), scale))

    lines = []
    for row in rows:
        scale, unit = SHOWN.get(row["unit"], (1, "" if row["unit"] == "1" else row["unit"]))
        ratio = row["difference_over_uncertainty"]
        lines.append(plain_row([("words", escape(row["name"].replace("_", " "))),
                                *(("number", value(row, scale, side, f"{side}_uncertainty")) for side in SIDES),
                                ("number", value(row, scale, "difference")),
                                ("number", "–" if ratio is None else f"{ratio:+.1f}"), ("short", escape(unit))]))
    return table(["quantity", *(f"#{escape(name)}" for name in names), "#difference", "#/ uncertainty", "unit"], lines, "narrow")


def scaled(value, scale):
    """A value in another unit; None for None."""
    return None if value is None else scale * value


def entries_table(entries, names):
    """Entries in which the cases differ."""
    if not entries:
        return "<p>The cases have the same entries.</p>"
    rows = [plain_row([("words", escape(entry["key"])), ("short", escape(entry["first"])), ("short", escape(entry["second"])),
                       ("short", escape("" if entry["unit"] == "1" else entry["unit"]))]) for entry in entries]
    return table(["entry", *(escape(name) for name in names), "unit"], rows, "narrow")


def paths_plot(runs, names):
    """Both paths over X; None if a run has none."""
    if not all(has_rows(run.tip, 2) for run in runs):
        return None
    tips = [thinned(run.tip) for run in runs]
    X = np.unique(np.concatenate([tip["X"] for tip in tips]))
    curves = {"X [cm]": 100 * X}
    for name, tip in zip(names, tips):  # X of a tip does not decrease
        curves[f"Y of {name} [mm]"] = 1e3 * np.interp(X, tip["X"], tip["Y"], left=np.nan, right=np.nan)
    return {"labels": list(curves), "rows": rows_of(curves), "colours": ["--first", "--second"], "dashed": [False, False],
            "x": "X in the undeformed sheet [cm]", "y": "Y [mm]", "follows": "tip", "window": None}


def with_common_ranges(sheets):
    """The same sheets with colours for the same values; None where there is no sheet."""
    if None in sheets:
        return sheets
    ranges = [sheet.contents["ranges"] for sheet in sheets]
    common = {name: [min(one[name][0] for one in ranges), max(one[name][1] for one in ranges)] for name in ranges[0]}
    return [sheet_of({**sheet.contents, "ranges": common}) for sheet in sheets]


def page(comparison, runs, sheets):
    """The whole page; sheets: data for the viewer of each run (sheet_data.py), or None."""
    names = [run.name if runs[0].name != runs[1].name else comparison[side] for run, side in zip(runs, SIDES)]
    patterns = comparison["pattern"]
    plot = paths_plot(runs, names) if has_dygraphs() else None
    films = "".join(f"<section><h3>{escape(name)}: {escape(patterns[side])}</h3>"
                    f"{viewer(side, run, sheet) if sheet is not None else '<p>The run has no frames of its motion.</p>'}</section>"
                    for name, side, run, sheet in zip(names, SIDES, runs, sheets))
    title = f"{names[0]} compared with {names[1]}"
    body = f"""<h1>{escape(title)}</h1>
{failed_checks(comparison["failed_checks"], names)}
<main>
<div class="pair">{films}</div>
{live_plot("both", "path", plot, PATHS_CAPTION, False) if plot else ""}
{distance_sentence(comparison["paths"])}
<h2>Quantities</h2>
<p>Differences: second run minus first run. Uncertainties are one standard deviation, of one measurement each: scatter over seeds
is measured by a study.</p>
{quantities_table(comparison["quantities"], names)}
<h2>Entries that differ</h2>
{entries_table(comparison["entries"], names)}
</main>"""
    return whole_page(title, body, styles(plot is not None), scripts(any(sheets), plot is not None))


def failed_checks(problems, names):
    """Which run failed its checks, and so measures nothing; empty if none did."""
    notes = "<br>".join(f'<b class="fails">{escape(name)} failed its checks</b>: {escape(problems[side])}'
                        for name, side in zip(names, SIDES) if problems[side])
    return f'<div class="banner fails">{notes}</div>' if notes else ""


def distance_sentence(paths):
    """Distance between the paths."""
    if paths is None:
        return "<p>The paths have no stretch of X in common.</p>"
    return (f"<p>Distance between the paths for X from {100 * paths['X_begin']:.3g} to {100 * paths['X_end']:.3g} cm: root mean "
            f"square {1e3 * paths['rms_distance']:.3g} mm ({paths['rms_distance_over_d']:.3g} d), at most "
            f"{1e3 * paths['largest_distance']:.3g} mm ({paths['largest_distance_over_d']:.3g} d).</p>")


def comparison_page(folder, quiet):
    """Reads both runs and writes the page."""
    comparison = read_json(folder / "compare.json")
    if comparison is None:
        raise DamagedFile(folder, "no comparison of two cracks found (compare.json)")
    wanted = [*(f"{side}_folder" for side in SIDES), *SIDES, "failed_checks", "pattern", "quantities", "entries", "paths"]
    if missing := [name for name in wanted if name not in comparison]:
        raise DamagedFile(folder / "compare.json", f"{', '.join(missing)} missing")
    runs = [read_run(folder / comparison[f"{side}_folder"]) for side in SIDES]
    motions = [read_motion(run) for run in runs]
    sheets = [None if motion is None else sheet_data(run, motion, LARGEST_SHEETS // 2) for run, motion in zip(runs, motions)]
    html = page(comparison, runs, with_common_ranges(sheets))
    write_page(folder / "compare.html", html)
    if not quiet:
        print(folder / "compare.html")
    return DONE


def main(words=None):
    """Runs the command line; `words` replace the arguments of the process. @return exit code"""
    parser = argparse.ArgumentParser(description="Write compare.html of two cracks.")
    parser.add_argument("directory", metavar="DIR", help="output directory of latcon compare")
    parser.add_argument("--quiet", action="store_true", help="print nothing but errors")
    arguments = parser.parse_args(words)
    return exit_code_of(lambda: comparison_page(Path(arguments.directory), arguments.quiet))


if __name__ == "__main__":
    sys.exit(main())
