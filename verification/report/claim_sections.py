"""Sections of the page about claims: statement, plots with their error metrics, rows."""
from html import escape

from claim_plots import PLOTS
from markup import MARKS, figure, first_sentence, number, plural, row, superscripts, table
from summary import VERDICTS, ratio_text, tally_of

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
    entries, texts = shared_rows(runs), claim_texts(runs)
    parts = [claim_section(name, entries.get(name, []), runs, plots, texts)
             for name in claim_order(entries, plots, texts)]
    return "\n".join(parts) or "<p>Nothing was checked.</p>"


def claim_texts(runs):
    """{name: (title, statement)} of the claims that the runs checked, in the order in which they are checked."""
    return {**{name: text for run in runs for name, text in run.claims.items()}, "fracture": FRACTURE}


def claim_order(entries, plots, texts):
    """Claims that have rows or plots: failing claims first, then in the order of `texts`, then in that of the rows."""
    made = {name for drawn in plots.values() for name in drawn}
    drawn = [claim for claim, own in PLOTS.items() if any(plot.name in made for plot in own)]
    names = list(dict.fromkeys([*entries, *drawn]))
    known = list(texts)
    return sorted(names, key=lambda name: (not any(check.verdict == "fails" for check, _ in entries.get(name, [])),
                                           known.index(name) if name in known else len(known)))


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
    """Section of one claim: a line that unfolds, open if the claim fails."""
    tally = tally_of(None, name, [check for check, _ in entries])
    opened = " open" if tally.kind == "fails" else ""
    parts = [f'<section id="claim-{escape(name)}"><details class="claim"{opened}>'
             f"<summary>{claim_line(name, tally, texts)}</summary>"]
    text = explanation(name, {plot for made in plots.values() for plot in made}, texts)
    if text:
        parts.append(f"<p>{escape(text)}</p>")
    if not entries:
        parts.append('<p class="soft">No quantity of this claim was checked.</p>')
    parts += [plot_figures(plot, runs, plots) for plot in PLOTS.get(name, ())]
    parts.append(rows_of_claim(name, entries, len(runs) > 1))
    return "\n".join(part for part in parts if part) + "</details></section>"


def explanation(name, drawn, texts):
    """Statement of a claim, given the names of the plots that were drawn; empty for a claim without texts."""
    parts = [texts[name][1]] if name in texts else []
    return " ".join(parts + [plot.claimed for plot in PLOTS.get(name, ()) if plot.name in drawn])


def heading(name, texts):
    """Heading of a claim's section."""
    return f"{name}: {texts[name][0]}" if name in texts else name


def claim_line(name, tally, texts):
    """Verdict, heading and counts of a claim."""
    counts = ", ".join(f"{tally.count[v]} {plural(tally.count[v], one, many)}"
                       for v, one, many in (("fails", "fails", "fail"), ("holds", "holds", "hold"),
                                            ("reported", "reported", "reported")) if tally.count[v])
    worst = "" if tally.worst is None else f", worst error / tolerance {ratio_text(tally.worst)}"
    return (f'<span class="tally {tally.kind}">{MARKS[tally.kind]} {WORDS[tally.kind]}</span> <h3>{escape(heading(name, texts))}</h3> '
            f'<span class="soft">{counts}{worst}</span>')


def plot_figures(plot, runs, plots):
    """A plot of the first run that has it; different ones of other runs are folded below."""
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
    """A table of the failing rows, and a table of the others, folded if it is long."""
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
