"""Sections of the page about claims: statement, plots with their error metrics, rows."""
from .claim_plots import PLOTS
from .pages import MARKS, first_sentence, number, plural, row, superscripts
from .summary import VERDICTS, ratio_text, tally_of

# More rows than these are folded.
MOST_OPEN_ROWS = 8
# Verdicts of a claim by the class that colours them.
WORDS = {"fails": "fails", "holds": "holds", "warns": "holds, not verified", "reported": "reported"}

# Title and statement of the rows that compare a crack with published values. No claim of the program computes them.
FRACTURE = (
    "the crack beside the published one",
    "The crack of the lattice is measured and compared with the published values. No continuum is involved, and no "
    "agreement between lattice and continuum is claimed beyond the onset of fracture. Pictures of the crack are in the "
    "section of its run.")


def claim_sections(runs, plots):
    """A section per claim, failing claims first. `plots`: {folder of a run: {plot name: (PNG file, metrics)}}."""
    entries = shared_rows(runs)
    # {name: (title, statement)} of the claims that the runs checked, in the order in which they are checked
    texts = {**{name: text for run in runs for name, text in run.claims.items()}, "fracture": FRACTURE}
    made = {name for drawn in plots.values() for name in drawn}
    drawn = [claim for claim, own in PLOTS.items() if any(plot.name in made for plot in own)]
    # Claims that have rows or plots: failing claims first, then in the order of `texts`, then in that of the rows.
    names = [name for name in [*texts, *entries, *drawn] if name in entries or name in drawn]
    names = sorted(dict.fromkeys(names), key=lambda name: all(check.verdict != "fails" for check, _ in entries.get(name, [])))
    return [claim_section(name, entries.get(name, []), runs, plots, texts) for name in names]


def shared_rows(runs):
    """Rows per claim, {claim: [(check, names of runs), ...]}, failing rows first; a row of several runs is listed once."""
    runs_of = {}
    for run in runs:
        for check in run.checks:
            # Compared as text, because nan is not equal to itself.
            runs_of.setdefault(repr(check), (check, []))[1].append(run.name)
    entries = {}
    for check, names in runs_of.values():
        entries.setdefault(check.claim, []).append((check, list(dict.fromkeys(names))))
    return {claim: sorted(rows, key=lambda entry: VERDICTS.index(entry[0].verdict)) for claim, rows in entries.items()}


def claim_section(name, entries, runs, plots, texts):
    """Contents of the section of one claim: a line that unfolds, open if the claim fails; plots; failing rows, and the others,
    which are folded if there are many."""
    tally = tally_of(name, [check for check, _ in entries])
    counts = ", ".join(f"{count} {plural(count, one, many)}" for one, many, count in (
        ("fails", "fail", tally.count["fails"]), ("holds", "hold", tally.count["holds"]),
        ("reported", "reported", tally.count["reported"])) if count)
    show_runs = len(runs) > 1
    rows = {fails: [claim_row(check, names, show_runs) for check, names in entries if (check.verdict == "fails") == fails]
            for fails in (True, False)}
    folded = f"{len(rows[False])} {plural(len(rows[False]), 'row', 'rows')}"
    drawn = {plot for made in plots.values() for plot in made}
    return {
        "name": name, "kind": tally.kind, "verdict": f"{MARKS[tally.kind]} {WORDS[tally.kind]}",
        "heading": f"{name}: {texts[name][0]}" if name in texts else name,
        "counts": counts + ("" if tally.worst is None else f", worst error / tolerance {ratio_text(tally.worst)}"),
        "explanation": " ".join([*(texts[name][1:] if name in texts else ()),
                                 *(plot.claimed for plot in PLOTS.get(name, ()) if plot.name in drawn)]),
        "plots": [figure for plot in PLOTS.get(name, ()) for figure in plot_figures(plot, runs, plots)],
        "head": ["verdict", "~quantity", "unit", "#lattice", "#continuum", "#published" if name == "fracture" else "#theory",
                 "#error", "#tolerance", *["run"] * show_runs],
        "failing": rows[True], "others": rows[False], "is_short": len(rows[False]) <= MOST_OPEN_ROWS,
        "summary": folded + (plural(len(rows[False]), " that does not fail", " that do not fail") if rows[True] else ""),
    }


def plot_figures(plot, runs, plots):
    """A plot with its error metrics of the first run that has it, and different ones of other runs, which are folded."""
    made = [(run, *plots[run.folder][plot.name]) for run in runs if plot.name in plots.get(run.folder, {})]
    return [{"png": png, "metrics": metrics, "of_run": run.name if number else None,
             "alt": f"{plot.name}, run {run.name}. {first_sentence(plot.caption)}",
             "caption": f"{plot.caption}{f' Run {run.name}.' if number or len(runs) > 1 else ''} ({plot.name}.csv)"}
            for number, (run, png, metrics) in enumerate(made) if not number or png.read_bytes() != made[0][1].read_bytes()]


def claim_row(check, shared, show_runs):
    """One checked quantity."""
    return row(check.kind, [
        superscripts(check.quantity), superscripts(check.unit),
        *(number(value, ".7g") for value in (check.lattice, check.continuum, check.theory)),
        number(check.error, ".2e"), number(check.tolerance, ".3g"), *[", ".join(shared)] * show_runs], check.word)
