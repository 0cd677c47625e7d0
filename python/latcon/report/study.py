"""Draws the plots of a study and writes study.html, the contents of the template of that name."""
from markupsafe import Markup

from .near_tip_plots import opening_stress_picture, velocity_picture
from .pages import FAILED, plural, row, write_page
from .pictures import draw_sheet, shrink
from .runs import read_last_frame, read_run
from .study_plots import (MEASURED, NEAR_TIP, PATH, asked_quantities, draw_map, draw_paths, draw_speeds, draw_sweep, pattern_text,
                          sweeps_of)
from .study_runs import mean_of, read_study, value_text

RUN_PICTURES = {
    "sheet": "The deformed sheet in its last frame.",
    "velocity": "Velocity of the material around the tip (cross): mean over samples, mirrored where the path descends. "
                "Blue: motion against the direction of the crack.",
    "stress": "Opening stress, averaged in the same way.",
}
# CSS class of each verdict, of rows and of claims.
KINDS = {"holds": "holds", "does not hold": "fails", "reported": "reported", "not measured": "warns"}
CLAIM_KINDS = {**KINDS, "incomplete": "warns"}
MOST_LEFT_OUT = 20  # names of runs that the quick version omits
LARGEST_PICTURE = 400_000  # [bytes] per picture of a run, since the page contains all of them


def draw_overview(study, folder):
    """Draws the map over two swept entries, or the sweep along one unless a claim shows it: [(caption, PNG), ...]."""
    png = folder / "map.png"
    if caption := draw_map(study, png):
        return [(caption, png)]
    if len(study.abscissas) != 1:
        return []
    (entry,) = study.abscissas
    if any(row["against"] == entry["entry"] for claim in study.claims for row in claim["rows"]):
        return []
    sweep = {"against": entry["entry"], "against_unit": entry["unit"],
             "values": [{"run": run, "against": value} for run, value in zip(study.runs, entry["values"])]}
    png = folder / "sweep.png"
    if not draw_sweep(study, sweep, ("speed_lagrangian", *PATH), png):
        return []
    return [(sweep_caption("speed, wavelength and amplitudes", entry["entry"]), png)]


def sweep_caption(names, against):
    """Caption of quantities along an abscissa."""
    return (f"{names[:1].upper()}{names[1:]} against {against}: mean and standard deviation over the seeds; a symbol is that of the most "
            "frequent pattern, of several the first by name. Open ones at 0: not defined for this crack.")


def draw_sweeps(study, number, claim, folder):
    """Draws one picture for each set of runs along one abscissa, with the quantities of its rows: [(caption, PNG), ...]."""
    drawn = []
    for sweep in sweeps_of(claim["rows"]):
        quantities = asked_quantities(sweep)
        png = folder / f"sweep-{number + 1}-{len(drawn) + 1}.png"
        onsets = {row["quantity"]: row["onset"] for row in sweep if row.get("onset")}
        if draw_sweep(study, sweep[0], quantities, png, onsets):
            names = ", ".join(name.replace("_", " ") for name in quantities)
            drawn.append((sweep_caption(names, sweep[0]["against"]), png))
    return drawn


def draw_run(seed, folder, most, kinds=tuple(RUN_PICTURES)):
    """Draws the sheet of a run and the fields near its tip, if they exist: {kind: PNG of at most `most` bytes}."""
    drawn = {}
    frame = read_last_frame(seed.folder)
    if frame is not None:
        drawn["sheet"] = folder / f"{seed.run}-sheet.png"
        draw_sheet(frame, read_run(seed.folder).input_number("Fracture/breaking stretch"), drawn["sheet"])
    means = seed.folder / "near_tip_folded.vti"
    if means.exists() and "velocity" in kinds:
        drawn["velocity"] = folder / f"{seed.run}-velocity.png"
        velocity_picture(means, drawn["velocity"], crack_speed=seed.values.get("speed_laboratory"))
    if means.exists() and "stress" in kinds:
        drawn["stress"] = folder / f"{seed.run}-stress.png"
        opening_stress_picture(means, drawn["stress"])
    for png in drawn.values():
        shrink(png, most)
    return drawn


def study_page(folder):
    """Draws all pictures for which the runs have data, and writes the page. Returns its path."""
    study, page, folder = read_study(folder), folder / "study.html", folder / "pictures"
    folder.mkdir(exist_ok=True)
    claims = []
    for number, claim in enumerate(study.claims):
        names = list(dict.fromkeys(name for row in claim["rows"] for name in row["runs"] if name in study.runs))
        paths = folder / f"paths-{number + 1}.png"
        caption = draw_paths(study, names, paths)
        claims.append({**claim, "rows": [claim_row(judged) for judged in claim["rows"]],
                       "pictures": [*draw_sweeps(study, number, claim, folder), *([(caption, paths)] if caption else [])]})
    shown = [(name, next((seed for seed in study.runs[name][2] if seed.is_measured), None))
             for name in study.document["pictures"] if name in study.runs]
    speeds = folder / "speeds.png"
    write_page(
        page, "study.html", title=study.document["title"], with_viewer=False, with_plots=False,
        facts=facts(study), result=banner(study), overview=draw_overview(study, folder),
        summary=[row(CLAIM_KINDS[claim["verdict"]],
                        [Markup('<a href="#claim-{}">{}</a>').format(number, claim["claim"]),
                         *map(str, counts(claim["rows"]).values())], claim["verdict"])
                    for number, claim in enumerate(study.claims)],
        claims=claims, speeds=speeds if draw_speeds(study, speeds) else None,
        pictures=[(name, seed.seed, draw_run(seed, folder, LARGEST_PICTURE)) for name, seed in shown if seed],
        captions=RUN_PICTURES,
        runs=[("", [name, about, "\n".join(f"{key} = {value}" for key, value in changed.items()) or "–",
                       ", ".join(str(seed.seed) for seed in seeds)])
                 for name, (about, changed, seeds) in study.runs.items()],
        measured=measured_table(study, MEASURED), near_tip=measured_table(study, NEAR_TIP), settings=settings(study.document))
    return page


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
        "\n".join(judged["runs"]), judged["quantity"], judged["expected"] or "–", judged["measured"].replace("; ", "\n"),
        judged["note"].replace("; ", "\n")], judged["verdict"])


def measured_table(study, columns):
    """Head and rows of a table: a line per case with its pattern and the means of some quantities."""
    return ["run", "~pattern", *(f"#{head}" for *_, head in columns)], [("", [
        name, pattern_text(seeds), *(value_text(mean_of(seeds, quantity), scale) for quantity, scale, _ in columns)])
        for name, (_, _, seeds) in study.runs.items()]


def settings(document):
    """Entries that all runs change in the base case."""
    lines = [f"{key} = {value}" for key, value in document["settings"].items()]
    if left_out := document["left_out"]:
        more = f", ... ({len(left_out)} in all)" if len(left_out) > MOST_LEFT_OUT else ""
        lines.append(f"omitted in the quick version: {', '.join(left_out[:MOST_LEFT_OUT])}{more}")
    return "; ".join(lines)
