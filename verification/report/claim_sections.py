"""Sections of the page about claims: statement, plots with their error metrics, rows."""
from html import escape

from claims_text import CLAIMS, PLOTS, explanation, heading
from markup import MARKS, figure, first_sentence, number, plural, row, superscripts, table
from summary import VERDICTS, ratio_text, tally_of

# More rows than these are folded.
MOST_OPEN_ROWS = 8
# Verdicts of a claim by the class that colours them.
WORDS = {"fails": "fails", "holds": "holds", "warns": "holds, not verified", "reported": "reported"}


def claim_sections(runs, plots):
    """A section a claim, those that fail first. `plots`: {folder of a run: {plot name: (PNG file, metrics)}}."""
    entries = shared_rows(runs)
    parts = [claim_section(name, entries.get(name, []), runs, plots) for name in claim_order(entries, plots)]
    return "\n".join(parts) or "<p>Nothing was checked.</p>"


def claim_order(entries, plots):
    """Claims that have rows or plots: those that fail first, then as they are known, then as they came."""
    drawn = [plot.claim for plot in PLOTS if any(plot.name in made for made in plots.values())]
    names = list(dict.fromkeys([*entries, *drawn]))
    known = list(CLAIMS)
    return sorted(names, key=lambda name: (not any(check.verdict == "fails" for check, _ in entries.get(name, [])),
                                           known.index(name) if name in known else len(known)))


def shared_rows(runs):
    """Rows by claim, those that several runs share once: {claim: [(check, names of runs), ...]}, failing ones first."""
    runs_of = {}
    for run in runs:
        for check in run.checks:
            # By text, for nan is not equal to itself.
            runs_of.setdefault(repr(check), (check, []))[1].append(run.name)
    entries = {}
    for check, names in runs_of.values():
        entries.setdefault(check.claim, []).append((check, list(dict.fromkeys(names))))
    return {claim: sorted(rows, key=lambda entry: VERDICTS.index(entry[0].verdict)) for claim, rows in entries.items()}


def claim_section(name, entries, runs, plots):
    """One claim: a line that unfolds; unfolded already if it fails."""
    tally = tally_of(None, name, [check for check, _ in entries])
    opened = " open" if tally.kind == "fails" else ""
    parts = [f'<section id="claim-{escape(name)}"><details class="claim"{opened}>'
             f"<summary>{claim_line(name, tally)}</summary>"]
    text = explanation(name, {plot for made in plots.values() for plot in made})
    if text:
        parts.append(f"<p>{escape(text)}</p>")
    if not entries:
        parts.append('<p class="soft">No quantity of this claim was checked.</p>')
    parts += [plot_figures(plot, runs, plots) for plot in PLOTS if plot.claim == name]
    parts.append(rows_of_claim(name, entries, len(runs) > 1))
    return "\n".join(part for part in parts if part) + "</details></section>"


def claim_line(name, tally):
    """Verdict, heading and counts of a claim."""
    counts = ", ".join(f"{tally.count[v]} {plural(tally.count[v], one, many)}"
                       for v, one, many in (("fails", "fails", "fail"), ("holds", "holds", "hold"),
                                            ("reported", "reported", "reported")) if tally.count[v])
    worst = "" if tally.worst is None else f", worst error / tolerance {ratio_text(tally.worst)}"
    return (f'<span class="tally {tally.kind}">{MARKS[tally.kind]} {WORDS[tally.kind]}</span> <h3>{escape(heading(name))}</h3> '
            f'<span class="soft">{counts}{worst}</span>')


def plot_figures(plot, runs, plots):
    """A plot of the first run that has it; those of other runs, where they differ, are folded below."""
    made = [(run, *plots[run.folder][plot.name]) for run in runs if plot.name in plots.get(run.folder, {})]
    if not made:
        return ""
    first, *others = made
    parts = [plot_figure(plot, *first, len(runs) > 1)]
    for run, png, metrics in others:
        if png.read_bytes() != first[1].read_bytes():
            parts.append(f"<details><summary>The same of the run {escape(run.name)}</summary>"
                         f"{plot_figure(plot, run, png, metrics, True)}</details>")
    return "\n".join(parts)


def plot_figure(plot, run, png, metrics, name_run):
    """One plot with its error metrics."""
    items = "".join(f"<li>{escape(metric)}</li>" for metric in metrics)
    of_run = f" Run {escape(run.name)}." if name_run else ""
    caption = f'<ul class="metrics">{items}</ul>{escape(plot.caption)}{of_run} ({plot.name}.csv)'
    return figure(png, f"{plot.name}, run {run.name}. {first_sentence(plot.caption)}", caption)


def rows_of_claim(name, entries, show_runs):
    """A table of the rows that fail, and one of the others, folded if it is long."""
    head = ["verdict", "quantity", "unit", "#lattice", "#continuum",
            "#published" if name == "fracture" else "#theory", "#error", "#tolerance"]
    head += ["run"] if show_runs else []
    failing = [claim_row(check, names, show_runs) for check, names in entries if check.verdict == "fails"]
    others = [claim_row(check, names, show_runs) for check, names in entries if check.verdict != "fails"]
    parts = [table(head, failing)] if failing else []
    if others:
        opened = " open" if len(others) <= MOST_OPEN_ROWS else ""
        what = f"{len(others)} {plural(len(others), 'row', 'rows')}"
        what += plural(len(others), " that does not fail", " that do not fail") if failing else ""
        parts.append(f"<details{opened}><summary>{what}</summary>{table(head, others)}</details>")
    return "\n".join(parts)


def claim_row(check, shared, show_runs):
    """One checked quantity."""
    cells = [("words", superscripts(check.quantity)), ("short", superscripts(check.unit))]
    cells += [("number", number(value, ".7g")) for value in (check.lattice, check.continuum, check.theory)]
    cells += [("number", number(check.error, ".2e")), ("number", number(check.tolerance, ".3g"))]
    if show_runs:
        cells.append(("short", escape(", ".join(shared))))
    return row(check.kind, cells, check.word)
