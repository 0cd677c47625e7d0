"""compare.html: two cracks side by side, with one time for both sheets."""
import numpy as np

from ..errors import UnreadableFile
from ..files import read_json
from ..quantities import number_text, shown_unit
from .crack_section import plot_over_X, thinned
from .pages import FAILED, has_dygraphs, number, write_page
from .runs import has_rows, read_motion, read_run
from .sheet_data import LARGEST_SHEETS, Sheet, sheet_data

SIDES = ("first", "second")


def quantity_rows(rows):
    """Quantities of both runs, the difference, and the difference over the combined uncertainty."""
    lines = []
    for row in rows:
        scale, unit = shown_unit(row["unit"])
        values = [number_text(row[key], row.get(f"{key}_uncertainty"), scale=scale) for key in (*SIDES, "difference")]
        lines.append(("", [row["name"].replace("_", " "), *values, number(row["difference_over_uncertainty"], "+.1f"), unit]))
    return lines


def paths_plot(runs, names):
    """Both paths over X; None if a run has none."""
    if not all(has_rows(run.tip, 2) for run in runs):
        return None
    tips = [thinned(run.tip) for run in runs]
    X = np.unique(np.concatenate([tip["X"] for tip in tips]))
    curves = {"X [cm]": 100 * X}
    for name, tip in zip(names, tips):  # X of a tip does not decrease
        curves[f"Y of {name} [mm]"] = 1e3 * np.interp(X, tip["X"], tip["Y"], left=np.nan, right=np.nan)
    return plot_over_X(curves, [False, False])


def distance_sentence(paths):
    """Distance between the paths."""
    if paths is None:
        return "The paths have no stretch of X in common."
    return (f"Distance between the paths for X from {100 * paths['X_begin']:.3g} to {100 * paths['X_end']:.3g} cm: root mean "
            f"square {1e3 * paths['rms_distance']:.3g} mm ({paths['rms_distance_over_d']:.3g} d), at most "
            f"{1e3 * paths['largest_distance']:.3g} mm ({paths['largest_distance_over_d']:.3g} d).")


def comparison_page(folder):
    """Reads both runs and writes the page. Returns its path."""
    comparison = read_json(folder / "compare.json")
    wanted = [*(f"{side}_folder" for side in SIDES), *SIDES, "failed_checks", "pattern", "quantities", "entries", "paths"]
    if missing := [name for name in wanted if name not in comparison]:
        raise UnreadableFile(folder / "compare.json", f"{', '.join(missing)} missing")
    runs = [read_run(folder / comparison[f"{side}_folder"]) for side in SIDES]
    motions = [read_motion(run) for run in runs]
    sheets = [None if motion is None else sheet_data(run, motion, LARGEST_SHEETS // 2) for run, motion in zip(runs, motions)]
    if None not in sheets:  # colours for the same values
        both = [sheet.contents["ranges"] for sheet in sheets]
        ranges = {name: [min(one[name][0] for one in both), max(one[name][1] for one in both)] for name in both[0]}
        sheets = [Sheet({**sheet.contents, "ranges": ranges}) for sheet in sheets]
    names = [run.name if runs[0].name != runs[1].name else comparison[side] for run, side in zip(runs, SIDES)]
    plot = paths_plot(runs, names) if has_dygraphs() else None
    problems = comparison["failed_checks"]
    write_page(
        folder / "compare.html", "compare.html", title=f"{names[0]} compared with {names[1]}", names=names, plot=plot,
        heads=[f"#{name}" for name in names], distance=distance_sentence(comparison["paths"]),
        failed=[FAILED.format(f"{name} failed its checks", f": {problems[side]}") for name, side in zip(names, SIDES) if problems[side]],
        films=[{"name": name, "side": side, "pattern": comparison["pattern"][side], "run": run.name, "sheet": sheet}
               for name, side, run, sheet in zip(names, SIDES, runs, sheets)],
        quantities=quantity_rows(comparison["quantities"]),
        entries=[("", [entry["key"], entry["first"], entry["second"], "" if entry["unit"] == "1" else entry["unit"]])
                 for entry in comparison["entries"]],
        with_viewer=any(sheets), with_plots=plot is not None)
    return folder / "compare.html"
