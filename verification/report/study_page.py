"""The page of a study: table of its claims, their plots, its runs. One self-contained HTML file."""
import re
from html import escape

from markup import figure, first_sentence, plain_row, plural, row, table, whole_page
from study_plots import pattern_text
from study_quantities import MEASURED, NEAR_TIP
from study_runs import mean_of, value_text

RUN_PICTURES = {
    "sheet": "The deformed sheet in its last frame.",
    "velocity": "Velocity of the material around the tip (cross): mean over samples, mirrored where the path descends. "
                "Blue: motion against the direction of the crack.",
    "stress": "Opening stress, averaged in the same way.",
}
# CSS class of each verdict, of rows and of claims.
KINDS = {"holds": "holds", "does not hold": "fails", "reported": "reported", "not measured": "warns"}
CLAIM_KINDS = {**KINDS, "incomplete": "warns"}


def page(study, pictures):
    """The whole page.

    pictures: {"overview": [(caption, PNG), ...], "paths": {claim number: PNG},
    "sweeps": {claim number: [(caption, PNG), ...]}, "speeds": PNG or None,
    "runs": [(run, seed, {kind of RUN_PICTURES: PNG}), ...]}
    """
    title = study.document["title"]
    sections = [claim_section(number, claim, pictures) for number, claim in enumerate(study.claims)]
    return whole_page(title, f"""<h1>{escape(title)}</h1>
<p class="soft">{escape(facts(study))}</p>
{banner(study)}
{"".join(figure(png, first_sentence(caption), escape(caption)) for caption, png in pictures["overview"])}
{overview(study)}
{"".join(sections)}
{common_pictures(pictures)}
<h2 id="runs">Runs</h2>
{runs_table(study)}
<p class="soft">Means and standard deviations over the seeds, with their number:</p>
{measured_table(study, MEASURED)}
<h3>Near the tip</h3>
{measured_table(study, NEAR_TIP)}
{settings(study.document)}""")


def facts(study):
    """Version, size and cost in one line."""
    document = study.document
    commit, _, changed = document["git_commit"].partition("-")
    hours = sum(seed.wall_time for seed in study.seeds) / 3600
    return " · ".join([f"latcon {document['version']}, commit {commit[:12]}{' and changes' if changed else ''}",
                       f"{len(study.runs)} cases, {len(study.seeds)} runs, {hours:.3g} core hours",
                       *(["quick version"] if document["quick"] else []),
                       f"verified: {document['verification']}"])


def counts(rows):
    """Number of rows with each verdict: {verdict: count}."""
    return {verdict: sum(r["verdict"] == verdict for r in rows) for verdict in KINDS}


def banner(study):
    """The overall verdict, with the most important notes."""
    count = counts([r for claim in study.claims for r in claim["rows"]])
    judged = count["holds"] + count["does not hold"]
    verified = study.document.get("verified") is True
    broken = [seed for seed in study.seeds if seed.state != "measured"]
    if count["does not hold"]:
        kind = "fails"
        head = f"✗ {count['does not hold']} of {judged} rows {plural(count['does not hold'], 'does', 'do')} not hold"
    elif count["not measured"] or broken:
        rows = plural(count["holds"], "1 row holds", f"{count['holds']} rows hold")
        kind, head = "warns", f"! Incomplete: {rows}, but not everything was measured"
    elif not judged:
        kind, head = "reported", f"· Reported: {'no row has a rule' if study.claims else 'the study has no claims'}"
    elif not verified:
        rows = plural(judged, "the only row holds", f"all {judged} rows hold")
        kind, head = "warns", f"! Not verified: {rows}, but not every run was verified"
    else:
        kind, head = "holds", f"✓ Holds: {plural(judged, 'the only row', f'all {judged} rows')}"
    notes = [f'<b class="fails">{escape(seed.run)}, seed {seed.seed}: {escape(seed.state)}</b> {escape(seed.problem)}'
             for seed in broken]
    if count["not measured"]:
        notes.append(f"{count['not measured']} {plural(count['not measured'], 'row was', 'rows were')} not measured")
    if count["reported"]:
        notes.append(f"{count['reported']} {plural(count['reported'], 'row has', 'rows have')} no rule")
    notes.append(f"verified: {escape(study.document['verification'])}")
    return f'<div class="banner {kind}"><strong>{head}</strong><ul>{"".join(f"<li>{n}</li>" for n in notes)}</ul></div>'


def overview(study):
    """One line per claim; empty if the study has none."""
    judged = [(f"claim-{number}", claim["claim"], claim["verdict"], claim["rows"])
              for number, claim in enumerate(study.claims)]
    if not judged:
        return ""
    lines = [row(CLAIM_KINDS[verdict], [("words", f'<a href="#{escape(place)}">{escape(heading)}</a>'),
                                  *(("number", str(count)) for count in counts(rows).values())], verdict)
             for place, heading, verdict, rows in judged]
    return '<h2 id="summary">Claims</h2>' + table(["verdict", "claim", "#hold", "#do not", "#reported", "#not measured"], lines, "narrow")


def claim_section(number, claim, pictures):
    """Section of a claim: statement of the source, rows, paths, sweeps."""
    lines = [row(KINDS[r["verdict"]], [
        ("short", "<br>".join(escape(name) for name in r["runs"])), ("short", escape(r["quantity"])),
        ("words", escape(r["expected"]) or "–"), ("words", broken(r["measured"])), ("words", broken(r["note"]))],
        r["verdict"]) for r in claim["rows"]]
    parts = [f'<section id="claim-{number}"><h2>{escape(claim["claim"])}</h2>',
             *([f'<p><b>Paper:</b> {escape(claim["paper"])}</p>'] if claim["paper"] else []),
             table(["verdict", "runs", "quantity", "expected", "latcon", "missing"], lines)]
    if claim["note"]:
        parts.append(f'<p>{escape(claim["note"])}</p>')
    for caption, png in pictures["sweeps"].get(number, []):
        parts.append(figure(png, first_sentence(caption), escape(caption)))
    if number in pictures["paths"]:
        parts.append(figure(pictures["paths"][number], f"Paths of the crack tip: {claim['claim']}",
                            "Paths of the crack tip in the undeformed sheet, with the seeds of a run superimposed. "
                            "Y is exaggerated."))
    return "".join(parts) + "</section>"


def broken(text):
    """A list separated by semicolons, with one entry per line."""
    return escape(text).replace("; ", "<br>")


def common_pictures(pictures):
    """Pictures that do not belong to a single claim."""
    parts = []
    if pictures["speeds"]:
        parts.append(figure(pictures["speeds"], "Speeds of all cracks by pattern",
                            "Speed of every crack over the shear wave speed of the stretched sheet, by pattern. Cracks "
                            "above the dashed line are supersonic."))
    for run, seed, drawn in pictures["runs"]:
        parts.append(f"<h3>{escape(run)}, seed {seed}</h3>")
        parts += [figure(png, f"{run}: {first_sentence(RUN_PICTURES[kind])}", escape(RUN_PICTURES[kind]))
                  for kind, png in drawn.items()]
    return f'<h2 id="pictures">Pictures</h2>{"".join(parts)}' if parts else ""


def runs_table(study):
    """One line per case."""
    lines = []
    for name, (about, changed, seeds) in study.runs.items():
        changes = "<br>".join(f"{escape(key)} = {escape(value)}" for key, value in changed.items()) or "–"
        lines.append(plain_row([("short", escape(name)), ("words", escape(about)), ("words", changes),
                                ("short", ", ".join(str(seed.seed) for seed in seeds))]))
    return table(["run", "about", "changes", "seeds"], lines)


def measured_table(study, columns):
    """One line per case with its pattern and the means of some quantities."""
    lines = [plain_row([
        ("short", escape(name)), ("words", escape(pattern_text(seeds))),
        *(("number", value_text(mean_of(seeds, quantity), scale)) for quantity, scale, _ in columns)])
             for name, (_, _, seeds) in study.runs.items()]
    return table(["run", "pattern", *(f"#{head}" for *_, head in columns)], lines)


def omitted(names, most=20):
    """Names of runs, and their number if there are more than `most`."""
    return ", ".join(names[:most]) + (f", ... ({len(names)} in all)" if len(names) > most else "")


def settings(document):
    """Entries that all runs change in the base case."""
    lines = [f"{key} = {value}" for key, value in document["settings"].items()]
    if document["left_out"]:
        lines.append(f"omitted in the quick version: {omitted(document['left_out'])}")
    return f"<p class=\"soft\">For all runs: {escape('; '.join(lines))}</p>" if lines else ""
