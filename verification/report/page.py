"""The report as one HTML file that needs nothing beside it."""
import json
from html import escape
from pathlib import Path

from claim_sections import claim_links, claim_sections
from markup import figure, first_sentence, folded, number, raised, row, table, verb
from near_tip_table import near_tip_table
from summary import VERDICTS, comparisons, percent, ratio_text, tallies, tally_of, with_uncertainty

CAPTIONS = {
    "animation.gif": "The crack as it runs, in slow motion of one pace: the sheet as it is, coloured by the speed of "
                     "the material. What is filled has all its bonds; lines are bonds of sites that have lost some.",
    "sheet.png": "The sheet in its last frame, as it is: every unbroken bond is a line, the crack is the white "
                 "opening; lines across it are bonds that still hold.",
    "sheet_fields.png": "Fields of the last frame: speed and opening stress in the sheet as it is, damage where it was "
                        "before the loading. Stress is force per current length and undeformed thickness. Scales end "
                        "where 1 % of the sites are beyond.",
    "crack_path.png": "The crack in the undeformed sheet. Above: its tip, the right-most site that has lost enough "
                      "bonds; the dashed sinusoid has the measured wavelength and amplitude, its phase, offset and "
                      "slope are least squares. Below: where bonds broke, coloured by time.",
    "energy.png": "Where the elastic energy went, per metre of sheet thickness, from the cut of the seed crack on. The "
                  "dashed line is what the bonds gave; the areas are what was found elsewhere; the small axis is the "
                  "difference, over the energy given to the sheet.",
    "near_tip_velocity.png": "Velocity of the material around the tip (cross), mean over samples; where the path "
                             "descends, samples were mirrored first, so that the two sides of an oscillating crack "
                             "stay apart. White: the opening, or fewer than half the samples had material there. "
                             "Numbers are in the table below.",
    "near_tip_stress.png": "Stress across the crack, in the same mean. Two lobes off the axis are what is called "
                           "kidney shaped.",
}


def page(title, runs, pictures, plots, unreadable=()):
    """The whole page.

    unreadable: runs that cannot be shown
    pictures: of cracks, {folder of a run: {name in CAPTIONS: (picture, still picture for print or None)}}
    plots: of claims, {folder of a run: {plot name: (PNG file, error metrics)}}
    """
    style = (Path(__file__).parent / "style.css").read_text(encoding="utf-8")
    versions = sorted({f"latcon {run.info['version']}" for run in runs if run.info and "version" in run.info})
    cracks = [crack_section(run, number, pictures.get(run.folder, {})) for number, run in enumerate(runs)
              if run.is_fracture]
    links = [f'<a href="#crack-{number}">{escape(run.name)}</a>' for number, run in enumerate(runs) if run.is_fracture]
    links += ['<a href="#claims">Claims:</a>', *claim_links(runs, plots), '<a href="#inputs">Inputs and versions</a>']
    return f"""<!DOCTYPE html>
<html lang="en">
<head>
<meta charset="utf-8">
<meta name="viewport" content="width=device-width, initial-scale=1">
<title>latcon: {escape(title)}</title>
<style>
{style}</style>
</head>
<body>
<h1>latcon report: {escape(title)}</h1>
<p class="soft">{escape(", ".join(versions) or "latcon")}: what was checked, what came out, and whether it holds</p>
<main>
{banner(runs, unreadable)}
{key_numbers(runs)}
<nav aria-label="sections">{"".join(links)}</nav>
{"".join(cracks)}
<h2 id="claims">Claims</h2>
{overview(runs)}
{claim_sections(runs, plots)}
<h2 id="inputs">Inputs and versions</h2>
{"".join(inputs_section(run, number) for number, run in enumerate(runs))}
</main>
</body>
</html>
"""


def banner(runs, unreadable=()):
    """The verdict over everything, and what a reader must know first."""
    checks = [check for run in runs for check in run.checks]
    total = tally_of(None, "", checks).count
    checked = total["holds"] + total["fails"]
    incomplete = [run for run in runs if run.state != "complete"]
    unverified = [run for run in runs if run.skipped_verification]
    notes = []
    if total["fails"]:
        kind, head = "fails", f"✗ Fails: {total['fails']} of {checked} checks {verb(total['fails'], 'fails', 'fail')}"
        notes += [f'<b class="fails">{escape(run.name)}, {escape(check.claim)}: {escape(check.quantity)}</b>, '
                  f"error {number(check.error, '.3g')}, allowed {number(check.tolerance, '.3g')}"
                  for run in runs for check in run.checks if check.verdict == "fails"]
    elif incomplete or unreadable:
        kind, head = "warns", f"! Not complete: {'what is there holds' if checked else 'nothing was checked'}"
    elif unverified:
        kind, head = "warns", f"! Not verified: {'what was checked holds' if checked else 'nothing was checked'}"
    elif checked:
        kind, head = "holds", f"✓ Holds: all {checked} checks are within their tolerances"
    else:
        kind, head = "reported", "· Reported: nothing here has a tolerance"
    notes += [f'<b class="fails">{escape(run.name)}: cannot be read, not shown</b>: {escape(run.problem)}'
              for run in unreadable]
    notes += [f"{escape(run.name)}: the run {'was interrupted' if run.state == 'interrupted' else 'has not ended'}; "
              "what it had written by then is shown" for run in incomplete]
    notes += [f"{escape(run.name)}: the crack was run without its material and pre-stretch having been verified "
              "(--skip-verification)" for run in unverified]
    notes += [f"{escape(run.name)}: {headline(run)}" for run in runs if run.crack is not None]
    if total["reported"]:
        rows = verb(total["reported"], "1 row has", f"{total['reported']} rows have")
        notes.append(f"{rows} no tolerance and {verb(total['reported'], 'is', 'are')} for information")
    items = "".join(f"<li>{note}</li>" for note in notes)
    return f'<div class="banner {kind}"><strong>{head}</strong>{f"<ul>{items}</ul>" if items else ""}</div>'


def headline(run):
    """A crack in one line."""
    found = [f"{escape(c.quantity.split(',')[0])} {with_uncertainty(c.measured, c.uncertainty)} {escape(c.unit)} "
             f"({percent(c.difference)} from the paper)" for c in comparisons(run) if c.measured is not None]
    return "; ".join([pattern_phrase(run.crack)] + found)


def overview(runs):
    """Counts by run and claim."""
    rows = []
    for position, run in enumerate(runs):
        link = f'<a href="#run-{position}">{escape(run.name)}</a>'
        for tally in tallies(run):
            verdict = next((v for v in VERDICTS if tally.count[v]), "reported")
            rows.append(row(verdict, [
                ("short", link), ("short", f'<a href="#claim-{escape(tally.claim)}">{escape(tally.claim)}</a>'),
                *(("number", str(tally.count[v])) for v in ("holds", "fails", "reported")),
                ("number", ratio_text(tally.worst))]))
        if not run.checks:
            word = "reported" if run.state == "complete" else run.state
            rows.append(row(word, [("short", link), ("short", "none"), *[("number", "–")] * 4]))
    head = ["verdict", "run", "claim", "#holds", "#fails", "#reported", "#worst error / tolerance"]
    return table(head, rows, "narrow") if rows else ""


def crack_section(run, position, pictures):
    """A crack: what it did, as pictures and numbers."""
    parts = [f'<h2 id="crack-{position}">Crack: {escape(run.name)}</h2>', pattern_sentence(run)]
    parts += [figure(pictures[name][0], f"{run.name}: {first_sentence(caption)}", caption, pictures[name][1])
              for name, caption in CAPTIONS.items() if name in pictures]
    if run.near_tip is not None:
        parts.append(near_tip_table(run.near_tip))
    missing = [name for name in CAPTIONS if name not in pictures]
    if missing:
        parts.append(f'<p class="soft">Not drawn, for the run left nothing to draw: {", ".join(missing)}</p>')
    return "\n".join(parts)


def inputs_section(run, position):
    """What a run was given, and what it ran on."""
    parts = [f'<h3 id="run-{position}">{escape(run.name)}</h3>', facts(run)]
    if run.case_text is not None:
        parts.append(folded("Inputs (case.prm, SI units)", run.case_text))
    if run.info is not None:
        parts.append(folded("Versions, machine, threads, wall times (run.json)",
                            json.dumps(run.info, indent=2, ensure_ascii=False)))
    return "\n".join(part for part in parts if part)


def facts(run):
    """Version, commit, time and memory in one line, as far as run.json tells."""
    info = run.info or {}
    found = []
    if "version" in info:
        found.append(f"latcon {info['version']}")
    if "git_commit" in info:
        commit, _, changed = str(info["git_commit"]).partition("-")
        found.append(f"commit {commit[:12]}{' and changes' if changed else ''}")
    if isinstance(info.get("wall_time_total_s"), (int, float)):
        found.append(f"{info['wall_time_total_s']:.3g} s on {info.get('threads', '?')} threads")
    if isinstance(info.get("peak_memory_bytes"), (int, float)):
        found.append(f"{info['peak_memory_bytes'] / 1e6:.0f} MB")
    verification = info.get("verification")
    if isinstance(verification, dict) and verification.get("reused"):
        found.append(f"verdicts of {verification.get('checked_at')}, reused")
    if run.state != "complete":
        found.append(run.state)
    return f'<p class="soft">{escape(" · ".join(found))}</p>' if found else ""


def pattern_phrase(crack):
    """The pattern of a crack in words."""
    word = escape(crack["pattern"])
    return "the pattern of the crack is <b>undecided</b>" if word == "undecided" else f"the crack is <b>{word}</b>"


def pattern_sentence(run):
    """What the crack did, and why it is called that."""
    if run.crack is None:
        return "<p>The run did not get to the measurement of its crack (no crack.json).</p>"
    phrase = pattern_phrase(run.crack)
    reason = f": {escape(run.crack['reason'])}" if run.crack.get("reason") else ""
    return f"<p>{phrase[:1].upper()}{phrase[1:]}{reason}.</p>"


def key_numbers(runs):
    """What was measured of the cracks, beside what was published."""
    several = sum(run.crack is not None for run in runs) > 1
    rows = [row(c.verdict, [
        *([("short", escape(run.name))] if several else []), ("words", raised(c.quantity)),
        ("number", "not measured" if c.measured is None else with_uncertainty(c.measured, c.uncertainty)),
        ("number", number(c.published, ".4g")), ("short", raised(c.unit)), ("number", percent(c.difference))])
        for run in runs for c in comparisons(run)]
    head = ["verdict", *(["run"] if several else []), "quantity", "#latcon", "#paper", "unit", "#difference"]
    return f'<div class="key">{table(head, rows, "narrow")}</div>' if rows else ""
