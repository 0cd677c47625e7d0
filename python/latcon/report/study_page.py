"""Contents of the page of a study, which the template study.html shows."""
from markupsafe import Markup

from .pages import FAILED, plain_row, plural, row
from .study_plots import pattern_text
from .study_quantities import MEASURED, NEAR_TIP
from .study_runs import mean_of, value_text

RUN_PICTURES = {
    "sheet": "The deformed sheet in its last frame.",
    "velocity": "Velocity of the material around the tip (cross): mean over samples, mirrored where the path descends. "
                "Blue: motion against the direction of the crack.",
    "stress": "Opening stress, averaged in the same way.",
}
# CSS class of each verdict, of rows and of claims.
KINDS = {"holds": "holds", "does not hold": "fails", "reported": "reported", "not measured": "warns"}
CLAIM_KINDS = {**KINDS, "incomplete": "warns"}


def contents(study, pictures):
    """Values of the template.

    pictures: {"overview": [(caption, PNG), ...], "paths": {claim number: PNG},
    "sweeps": {claim number: [(caption, PNG), ...]}, "speeds": PNG or None,
    "runs": [(run, seed, {kind of RUN_PICTURES: PNG}), ...]}
    """
    return {
        "title": study.document["title"], "with_viewer": False, "with_plots": False,
        "facts": facts(study), "result": banner(study), "overview": pictures["overview"],
        "summary": [row(CLAIM_KINDS[claim["verdict"]],
                        [("words", Markup('<a href="#claim-{}">{}</a>').format(number, claim["claim"])),
                         *(("number", str(count)) for count in counts(claim["rows"]).values())], claim["verdict"])
                    for number, claim in enumerate(study.claims)],
        "claims": [{**claim, "rows": [claim_row(r) for r in claim["rows"]], "sweeps": pictures["sweeps"].get(number, []),
                    "paths": pictures["paths"].get(number)} for number, claim in enumerate(study.claims)],
        "speeds": pictures["speeds"], "pictures": pictures["runs"], "captions": RUN_PICTURES,
        "runs": [plain_row([("short", name), ("words", about),
                            ("words", "\n".join(f"{key} = {value}" for key, value in changed.items()) or "–"),
                            ("short", ", ".join(str(seed.seed) for seed in seeds))])
                 for name, (about, changed, seeds) in study.runs.items()],
        "measured": measured_table(study, MEASURED), "near_tip": measured_table(study, NEAR_TIP), "settings": settings(study.document),
    }


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
    """The overall verdict: (class, text, most important notes)."""
    count = counts([r for claim in study.claims for r in claim["rows"]])
    judged = count["holds"] + count["does not hold"]
    verified = study.document.get("verified") is True
    broken = [seed for seed in study.seeds if not seed.is_measured]
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
    notes = [FAILED.format(f"{seed.run}, seed {seed.seed}: {seed.state.value}", f" {seed.problem}") for seed in broken]
    if count["not measured"]:
        notes.append(f"{count['not measured']} {plural(count['not measured'], 'row was', 'rows were')} not measured")
    if count["reported"]:
        notes.append(f"{count['reported']} {plural(count['reported'], 'row has', 'rows have')} no rule")
    return kind, head, [*notes, f"verified: {study.document['verification']}"]


def claim_row(judged):
    """One row of a claim, lists with one entry per line."""
    return row(KINDS[judged["verdict"]], [
        ("short", "\n".join(judged["runs"])), ("short", judged["quantity"]), ("words", judged["expected"] or "–"),
        ("words", judged["measured"].replace("; ", "\n")), ("words", judged["note"].replace("; ", "\n"))], judged["verdict"])


def measured_table(study, columns):
    """Head and rows of a table: a line per case with its pattern and the means of some quantities."""
    return ["run", "pattern", *(f"#{head}" for *_, head in columns)], [plain_row([
        ("short", name), ("words", pattern_text(seeds)),
        *(("number", value_text(mean_of(seeds, quantity), scale)) for quantity, scale, _ in columns)])
        for name, (_, _, seeds) in study.runs.items()]


def omitted(names, most=20):
    """Names of runs, and their number if there are more than `most`."""
    return ", ".join(names[:most]) + (f", ... ({len(names)} in all)" if len(names) > most else "")


def settings(document):
    """Entries that all runs change in the base case."""
    lines = [f"{key} = {value}" for key, value in document["settings"].items()]
    if document["left_out"]:
        lines.append(f"omitted in the quick version: {omitted(document['left_out'])}")
    return "; ".join(lines)
