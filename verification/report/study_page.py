"""The page of a study: the table of its claims, their plots, its runs. One HTML file that needs nothing beside it."""
from html import escape
from pathlib import Path

from markup import figure, row, table, verb
from study_plots import pattern_text
from study_runs import mean_of, value_text

KINDS = {"holds": "holds", "does not hold": "fails", "reported": "reported", "not measured": "reported"}


def page(study, pictures):
    """The whole page.

    pictures: {"paths": {claim number: PNG}, "sweeps": {claim number: [(caption, PNG), ...]}, "speeds": PNG or None,
    "velocities": PNG or None, "sheets": [(run, seed, PNG), ...]}
    """
    document = study.document
    style = (Path(__file__).parent / "style.css").read_text(encoding="utf-8")
    title = escape(document["title"])
    sections = [claim_section(number, claim, pictures) for number, claim in enumerate(study.claims)]
    return f"""<!DOCTYPE html>
<html lang="en">
<head>
<meta charset="utf-8">
<meta name="viewport" content="width=device-width, initial-scale=1">
<title>latcon: {title}</title>
<style>
{style}</style>
</head>
<body>
<h1>{title}</h1>
<p class="soft">{escape(facts(study))}</p>
{banner(study)}
<h2 id="summary">Claims</h2>
{overview(study)}
{"".join(sections)}
{common_pictures(pictures)}
<h2 id="runs">Runs</h2>
{runs_table(study)}
{settings(document)}
</body>
</html>
"""


def facts(study):
    """Version, size and cost in one line."""
    document = study.document
    commit, _, changed = document["git_commit"].partition("-")
    hours = sum(seed.wall_time for seed in study.seeds) / 3600
    return " · ".join([f"latcon {document['version']}, commit {commit[:12]}{' and changes' if changed else ''}",
                       f"{len(study.runs)} cases, {len(study.seeds)} runs, {hours:.3g} core hours",
                       *(["quick version"] if document["quick"] else []),
                       f"verified: {document['verification']}"])


def rows_of(study, verdict):
    """How many rows have a verdict."""
    return sum(r["verdict"] == verdict for claim in study.claims for r in claim["rows"])


def banner(study):
    """What all rows amount to, and what a reader must know first."""
    count = {verdict: rows_of(study, verdict) for verdict in KINDS}
    judged = count["holds"] + count["does not hold"]
    broken = [seed for seed in study.seeds if seed.state != "measured"]
    if count["does not hold"]:
        kind = "fails"
        head = f"✗ {count['does not hold']} of {judged} rows {verb(count['does not hold'], 'does', 'do')} not hold"
    elif count["not measured"] or broken:
        kind, head = "warns", f"! {count['holds']} rows hold, but not everything was measured"
    else:
        kind, head = "holds", f"✓ All {judged} rows hold"
    notes = [f'<b class="fails">{escape(seed.run)}, seed {seed.seed}: {escape(seed.state)}</b> {escape(seed.problem)}'
             for seed in broken]
    if count["not measured"]:
        notes.append(f"{count['not measured']} {verb(count['not measured'], 'row was', 'rows were')} not measured")
    if count["reported"]:
        notes.append(f"{count['reported']} {verb(count['reported'], 'row has', 'rows have')} no rule, for information")
    notes.append(f"verified: {escape(study.document['verification'])}")
    return f'<div class="banner {kind}"><strong>{head}</strong><ul>{"".join(f"<li>{n}</li>" for n in notes)}</ul></div>'


def overview(study):
    """A line for each claim."""
    lines = []
    for number, claim in enumerate(study.claims):
        count = {verdict: sum(r["verdict"] == verdict for r in claim["rows"]) for verdict in KINDS}
        lines.append(row(KINDS[claim["verdict"]], [
            ("words", f'<a href="#claim-{number}">{escape(claim["claim"])}</a>'),
            *(("number", str(count[verdict])) for verdict in KINDS)], claim["verdict"]))
    return table(["verdict", "claim", "#hold", "#do not", "#reported", "#not measured"], lines, "narrow")


def claim_section(number, claim, pictures):
    """A claim: what the source says, the rows, the paths, the sweeps."""
    lines = [row(KINDS[r["verdict"]], [
        ("short", "<br>".join(escape(name) for name in r["runs"])), ("short", escape(r["quantity"])),
        ("words", escape(r["expected"]) or "–"), ("words", broken(r["measured"])), ("words", broken(r["note"]))],
        r["verdict"]) for r in claim["rows"]]
    parts = [f'<section id="claim-{number}"><h2>{escape(claim["claim"])}</h2>',
             f'<p><b>Paper:</b> {escape(claim["paper"])}</p>',
             table(["verdict", "runs", "quantity", "expected", "latcon", "missing"], lines)]
    if claim["note"]:
        parts.append(f'<p>{escape(claim["note"])}</p>')
    for caption, png in pictures["sweeps"].get(number, []):
        parts.append(figure(png, f"sweep of claim {number + 1}", escape(caption)))
    if number in pictures["paths"]:
        parts.append(figure(pictures["paths"][number], f"paths of claim {number + 1}",
                            "Paths of the crack tip in the undeformed sheet, the seeds of a run on top of each other. "
                            "Y is drawn larger than X."))
    return "".join(parts) + "</section>"


def broken(text):
    """A list in words, an entry a line."""
    return escape(text).replace("; ", "<br>")


def common_pictures(pictures):
    """What belongs to no single claim."""
    parts = []
    if pictures["speeds"]:
        parts.append(figure(pictures["speeds"], "speeds by pattern",
                            "Speed of every crack over the shear speed of the stretched sheet, by its pattern. Above "
                            "the dashed line cracks are supersonic."))
    if pictures["velocities"]:
        parts.append(figure(pictures["velocities"], "velocity about the tip",
                            "Velocity along x about the tip (+), averaged over time, in the undeformed sheet. Blue: "
                            "against the way of the crack; the line is where it changes sign."))
    for run, seed, png in pictures["sheets"]:
        parts.append(figure(png, f"sheet of {run}", f"The sheet of {escape(run)}, seed {seed}, in its last frame."))
    return f'<h2 id="pictures">Pictures</h2>{"".join(parts)}' if parts else ""


def runs_table(study):
    """A line for each case."""
    lines = []
    for name, (about, changed, seeds) in study.runs.items():
        changes = "<br>".join(f"{escape(key)} = {escape(value)}" for key, value in changed.items()) or "–"
        lines.append("<tr>" + "".join(f'<td class="{kind}">{text}</td>' for kind, text in (
            ("short", escape(name)), ("words", escape(about)), ("words", changes),
            ("short", ", ".join(str(seed.seed) for seed in seeds)), ("short", escape(pattern_text(seeds))),
            ("number", value_text(mean_of(seeds, "speed_lagrangian"))),
            ("number", value_text(mean_of(seeds, "wavelength"), 100)),
            ("number", value_text(mean_of(seeds, "amplitude"), 100)))) + "</tr>")
    return table(["run", "about", "changes", "seeds", "pattern", "#speed [m/s]", "#wavelength [cm]",
                  "#amplitude [cm]"], lines)


def settings(document):
    """What all runs share beside the base case."""
    lines = [f"{key} = {value}" for key, value in document["settings"].items()]
    if document["left_out"]:
        lines.append(f"left out in the quick version: {', '.join(document['left_out'])}")
    return f"<p class=\"soft\">For all runs: {escape('; '.join(lines))}</p>" if lines else ""
