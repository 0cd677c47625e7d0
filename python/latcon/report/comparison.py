"""compare.html: two cracks side by side, with one time for both sheets."""
import numpy as np

from ..errors import UnreadableFile
from ..files import read_json
from ..quantities import number_text, shown_unit
from .crack_section import rows_of, thinned
from .pages import FAILED, has_dygraphs, write_page
from .runs import has_rows, read_motion, read_run
from .sheet_data import LARGEST_SHEETS, sheet_data, sheet_of

SIDES = ("first", "second")


def quantity_rows(rows):
    """Quantities of both runs, the difference, and the difference over the combined uncertainty."""
    def value(row, scale, key):
        return "–" if row[key] is None else number_text(row[key], row.get(f"{key}_uncertainty"), scale=scale)

    lines = []
    for row in rows:
        scale, unit = shown_unit(row["unit"])
        ratio = row["difference_over_uncertainty"]
        lines.append(("", [("words", row["name"].replace("_", " ")),
                                *(("number", value(row, scale, key)) for key in (*SIDES, "difference")),
                                ("number", "–" if ratio is None else f"{ratio:+.1f}"), ("short", unit)]))
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
    return {"labels": list(curves), "rows": rows_of(curves), "colours": ["--first", "--second"], "dashed": [False, False],
            "x": "X in the undeformed sheet [cm]", "y": "Y [mm]", "follows": "tip", "window": None}


def with_common_ranges(sheets):
    """The same sheets with colours for the same values; None where there is no sheet."""
    if None in sheets:
        return sheets
    ranges = [sheet.contents["ranges"] for sheet in sheets]
    common = {name: [min(one[name][0] for one in ranges), max(one[name][1] for one in ranges)] for name in ranges[0]}
    return [sheet_of({**sheet.contents, "ranges": common}) for sheet in sheets]


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
    sheets = with_common_ranges([None if motion is None else sheet_data(run, motion, LARGEST_SHEETS // 2)
                                 for run, motion in zip(runs, motions)])
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
        entries=[("", [("words", entry["key"]), ("short", entry["first"]), ("short", entry["second"]),
                            ("short", "" if entry["unit"] == "1" else entry["unit"])]) for entry in comparison["entries"]],
        with_viewer=any(sheets), with_plots=plot is not None)
    return folder / "compare.html"
