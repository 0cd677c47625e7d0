"""The report as one self-contained HTML file."""
import json
from html import escape

from claim_sections import WORDS, claim_sections
from crack_section import crack_section, pattern_phrase
from live import has_dygraphs, scripts, styles
from markup import details, number, plural, row, superscripts, table, whole_page
from summary import comparisons, percent, ratio_text, tallies, tally_of, unpublished, with_uncertainty


def page(title, runs, pictures, plots, sheets, unreadable=(), animated=False):
    """The whole page.

    animated: whether animations were asked for. unreadable: runs that cannot be read
    pictures: pictures of cracks, {folder of a run: {name of crack_section.CAPTIONS: (picture, still for print or None)}}
    plots: plots of claims, {folder of a run: {plot name: (PNG file, error metrics)}}
    sheets: viewer data of cracks (sheet_data.py), {folder of a run: data or None}
    """
    versions = sorted({f"latcon {run.info['version']}" for run in runs if run.info and "version" in run.info})
    cracks = [crack_section(run, number, pictures.get(run.folder, {}), sheets.get(run.folder), animated)
              for number, run in enumerate(runs) if run.is_fracture]
    with_plots = has_dygraphs() and bool(cracks)
    heading = f'latcon report: {escape(title)} <small>{escape(", ".join(versions) or "latcon")}</small>'
    body = f"""<h1>{heading}</h1>
{contents(runs)}
<main>
<div class="result">
{banner(runs, unreadable)}
{key_numbers(runs)}
</div>
{"".join(cracks)}
<h2 id="claims">Claims</h2>
{claim_sections(runs, plots)}
{overview(runs)}
<h2 id="inputs">Inputs and versions</h2>
{"".join(inputs_section(run, number) for number, run in enumerate(runs))}
</main>"""
    return whole_page(title, body, styles(with_plots), scripts(any(sheet is not None for sheet in sheets.values()), with_plots))


def contents(runs):
    """Links to the sections, always in view."""
    links = [("top", "Result")]
    links += [(f"crack-{number}", f"Crack {run.name}") for number, run in enumerate(runs) if run.is_fracture]
    links += [("claims", "Claims"), ("inputs", "Inputs")]
    return f'<nav aria-label="sections">{"".join(f"""<a href="#{to}">{escape(text)}</a>""" for to, text in links)}</nav>'


def banner(runs, unreadable=()):
    """The overall verdict, with the most important notes."""
    checks = [check for run in runs for check in run.checks]
    total = tally_of(None, "", checks).count
    checked = total["holds"] + total["fails"]
    incomplete = [run for run in runs if run.state != "complete"]
    unverified = [run for run in runs if run.skipped_verification]
    notes = []
    if total["fails"]:
        kind, head = "fails", f"✗ Fails: {total['fails']} of {checked} checks {plural(total['fails'], 'fails', 'fail')}"
        notes += [f'<b class="fails">{escape(run.name)}, {escape(check.claim)}: {escape(check.quantity)}</b>, '
                  f"error {number(check.error, '.3g')}, allowed {number(check.tolerance, '.3g')}"
                  for run in runs for check in run.checks if check.verdict == "fails"]
    elif incomplete or unreadable:
        kind, head = "warns", f"! Not complete: {'all checks made so far hold' if checked else 'nothing was checked'}"
    elif unverified:
        kind, head = "warns", f"! Not verified: {'all checks made hold' if checked else 'nothing was checked'}"
    elif checked:
        kind, head = "holds", f"✓ Holds: all {checked} checks are within their tolerances"
    else:
        kind, head = "reported", "· Reported: nothing here has a tolerance"
    notes += [f'<b class="fails">{escape(run.name)}: cannot be read, not shown</b>: {escape(run.problem)}'
              for run in unreadable]
    notes += [f"{escape(run.name)}: the run {'was interrupted' if run.state == 'interrupted' else 'has not ended'}; "
              "the results written so far are shown" for run in incomplete]
    notes += [f"{escape(run.name)}: the crack was run without verification of its material and pre-stretch "
              "(--skip-verification)" for run in unverified]
    notes += [f"{escape(run.name)}: {pattern_phrase(run.crack)}" for run in runs if run.crack is not None]
    if total["reported"]:
        rows = plural(total["reported"], "1 row has", f"{total['reported']} rows have")
        notes.append(f"{rows} no tolerance and {plural(total['reported'], 'is', 'are')} for information only")
    items = "".join(f"<li>{note}</li>" for note in notes)
    return f'<div class="banner {kind}"><strong>{head}</strong>{f"<ul>{items}</ul>" if items else ""}</div>'


def overview(runs):
    """Counts by run and claim, collapsed."""
    rows = []
    for position, run in enumerate(runs):
        link = f'<a href="#run-{position}">{escape(run.name)}</a>'
        for tally in tallies(run):
            rows.append(row(tally.kind, [
                ("short", link), ("short", f'<a href="#claim-{escape(tally.claim)}">{escape(tally.claim)}</a>'),
                *(("number", str(tally.count[v])) for v in ("holds", "fails", "reported")),
                ("number", ratio_text(tally.worst))], WORDS[tally.kind]))
        if not run.checks:
            word = "reported" if run.state == "complete" else run.state
            rows.append(row(word, [("short", link), ("short", "none"), *[("number", "–")] * 4]))
    head = ["verdict", "run", "claim", "#holds", "#fails", "#reported", "#worst error / tolerance"]
    return f"<details><summary>Counts by run and claim</summary>{table(head, rows, 'narrow')}</details>" if rows else ""


def inputs_section(run, position):
    """Input of a run, and the versions and machine it ran on."""
    parts = [f'<h3 id="run-{position}">{escape(run.name)}</h3>', facts(run)]
    if run.case_text is not None:
        parts.append(details("Inputs (case.prm, SI units)", run.case_text))
    if run.info is not None:
        parts.append(details("Versions, machine, threads, wall times (run.json)",
                            json.dumps(run.info, indent=2, ensure_ascii=False)))
    return "\n".join(part for part in parts if part)


def facts(run):
    """Version, commit, time and memory in one line, as far as run.json contains them."""
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
        found.append(f"cached verdicts of {verification.get('checked_at')}")
    if run.state != "complete":
        found.append(run.state)
    return f'<p class="soft">{escape(" · ".join(found))}</p>' if found else ""


def key_numbers(runs):
    """Measured values of the cracks, with published values where there are any."""
    several = sum(run.crack is not None for run in runs) > 1
    rows = [row(c.check.kind, [
        *([("short", escape(run.name))] if several else []), ("words", superscripts(c.quantity)),
        ("number", "not measured" if c.measured is None else with_uncertainty(c.measured, c.uncertainty)),
        ("number", number(c.published, ".4g")), ("short", superscripts(c.unit)), ("number", percent(c.difference))],
        c.check.word) for run in runs for c in comparisons(run)]
    rows += [row("reported", [
        *([("short", escape(run.name))] if several else []), ("words", superscripts(quantity)),
        ("number", with_uncertainty(value, uncertainty)), ("number", "–"), ("short", unit), ("number", "–")], "measured")
        for run in runs for quantity, unit, value, uncertainty in unpublished(run)]
    head = ["verdict", *(["run"] if several else []), "quantity", "#latcon", "#paper", "unit", "#difference"]
    return f'<div class="key">{table(head, rows, "narrow")}</div>' if rows else ""
