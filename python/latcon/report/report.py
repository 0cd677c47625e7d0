"""Draws the pictures of runs and writes report.html, the contents of the template of that name."""
import json
import os
import signal
import sys
from contextlib import contextmanager, suppress
from pathlib import Path

from markupsafe import Markup

from ..errors import UnreadableFile
from ..folder import list_files
from ..quantities import number_text
from ..study.pool import end_with
from .claim_plots import all_plots
from .claim_sections import WORDS, claim_sections
from .crack_path import draw_crack_path
from .crack_section import crack_section, pattern_phrase
from .near_tip_plots import opening_stress_picture, velocity_picture
from .pages import FAILED, has_dygraphs, number, plural, row, superscripts, write_page
from .pictures import draw_energy, draw_fields, draw_sheet
from .runs import Unreadable, find_runs, has_rows, read_last_frame, read_motion
from .sheet_data import LARGEST_SHEETS, sheet_data
from .summary import comparisons, percent, ratio_text, tallies, tally_of, text_summary, unpublished


def pictures_of(run, motion, folder):
    """Pictures of a fracture run for which it has files: {name: (picture, still picture for print or None, function that draws)}.

    motion: frames of the run to animate, or None. folder: where the pictures are written.
    """
    found = {}

    def add(name, draw, *data, still=(), **options):
        found[name] = (folder / name, *(still or [None]), lambda: draw(*data, folder / name, *still, **options))

    if motion is not None:
        from .animation import draw_animation
        add("animation.gif", draw_animation, motion, still=[folder / "animation.png"])
    frame = read_last_frame(run.folder)
    if frame is not None:
        add("sheet.png", draw_sheet, frame, run.input_number("Fracture/breaking stretch"))
        if {"velocity", "cauchy_stress", "damage"} <= set(frame.fields):
            add("sheet_fields.png", draw_fields, frame)
    if has_rows(run.tip, 2):
        add("crack_path.png", draw_crack_path, run)
    if has_rows(run.energy, 2):
        add("energy.png", draw_energy, run.energy)
    means = run.folder / "near_tip_folded.vti"
    if means.exists():
        add("near_tip_velocity.png", velocity_picture, means, crack_speed=(run.crack or {}).get("speed_laboratory"))
        add("near_tip_stress.png", opening_stress_picture, means)
    return found


@contextmanager
def drawn_meanwhile(draws):
    """Calls functions that draw in processes of their own, one on each other core, while the body of `with` runs, then in this one
    as well. If one of these processes fails, all are called here again, for the error."""
    queue, numbers = os.pipe()  # one byte for each function, which one process takes
    os.write(numbers, bytes(range(len(draws))))
    os.close(numbers)

    def draw_next():
        while number := os.read(queue, 1):
            draws[number[0]]()

    parent, processes = os.getpid(), []
    for _ in range(min(len(os.sched_getaffinity(0)) - 1, len(draws))):
        processes.append(os.fork())
        if processes[-1] == 0:
            code = 1
            try:
                end_with(parent, signal.SIGKILL)
                draw_next()
                code = 0
            finally:
                os._exit(code)
    try:
        yield
        draw_next()
    finally:
        os.close(queue)
        codes = [os.waitpid(process, 0)[1] for process in processes]
    if any(codes):
        for draw in draws:
            draw()


def report(folder, output_dir=None, quiet=False, animated=False, dry_run=False):
    """Draws and writes the report of a folder; a dry run only lists the runs.

    output_dir: folder for the page and the pictures, those of each run in the same sub-folder as the run; None: the folder itself
    @return exit code: 0; 3 if a claim fails; 2 if a run cannot be read, which is listed with its error, while the others are shown
    """
    output = Path(output_dir or folder)
    readable, unreadable = find_runs(folder)
    if not quiet:
        sys.stdout.reconfigure(errors="replace")
    if dry_run:
        with suppress(BrokenPipeError):  # the reader does not want more
            for run in [] if quiet else readable:
                print(run.folder)
        for one in unreadable:
            print(f"latcon: {one.problem}", file=sys.stderr)
        return 2 if unreadable else 0
    # By folder of the run: {name in CAPTIONS: (picture, still or None)}, {plot: (PNG, error metrics)}, data of the viewer or None.
    runs, pictures, plots, sheets = [], {}, {}, {}
    most = LARGEST_SHEETS // max(1, sum(run.is_fracture for run in readable))
    for run in readable:
        try:  # frames and fields are read here
            place = output / run.folder.relative_to(folder)
            place.mkdir(parents=True, exist_ok=True)
            animation = read_motion(run) if run.is_fracture and animated else None
            found = pictures_of(run, animation, place) if run.is_fracture else {}
            pictures[run.folder] = {name: files for name, (*files, _) in found.items()}
            pngs = {plot: place / f"{plot.name}.png" for plot in all_plots() if plot.name in run.tables}
            together = [*pictures[run.folder].values(), pngs.values()]
            list_files(str(place), [file.name for files in together for file in files if file])
            with drawn_meanwhile([draw for *_, draw in found.values()]):
                motion = animation or (read_motion(run) if run.is_fracture else None)
                sheets[run.folder] = None if motion is None else sheet_data(run, motion, most)
                plots[run.folder] = {plot.name: (png, plot.write(run.tables, png)) for plot, png in pngs.items()}
            runs.append(run)
        except UnreadableFile as error:
            unreadable.append(Unreadable(run.name, str(error)))
    versions = sorted({f"latcon {run.info['version']}" for run in runs if run.info and "version" in run.info})
    several = sum(run.crack is not None for run in runs) > 1
    cracks = [crack_section(run, position, pictures[run.folder], sheets[run.folder], animated)
              for position, run in enumerate(runs) if run.is_fracture]
    write_page(
        output / "report.html", "report.html", title=folder.resolve().name, versions=", ".join(versions) or "latcon",
        result=banner(runs, unreadable), cracks=cracks, key_rows=key_rows(runs, several),
        key_head=["verdict", *["run"] * several, "~quantity", "#latcon", "#paper", "unit", "#difference"],
        claims=claim_sections(runs, plots), counts=counts(runs),
        inputs=[{"name": run.name, "facts": facts(run), "case": run.case_text, "info": None if run.info is None else json.dumps(
            run.info, indent=2, ensure_ascii=False)} for run in runs],
        with_plots=has_dygraphs() and bool(cracks), with_viewer=any(sheet is not None for sheet in sheets.values()))
    for one in unreadable:
        print(f"latcon: {one.problem}", file=sys.stderr)
    with suppress(BrokenPipeError):  # the reader does not want more
        if not quiet:
            print(text_summary(runs, unreadable), os.path.join(output_dir or folder, "report.html"), sep="\n\n")
    if unreadable:
        return 2
    return 3 if any(c.verdict == "fails" for run in runs for c in run.checks) else 0


def banner(runs, unreadable):
    """The overall verdict: (class, text, most important notes)."""
    checks = [check for run in runs for check in run.checks]
    total = tally_of("", checks).count
    checked = total["holds"] + total["fails"]
    incomplete = [run for run in runs if run.state != "complete"]
    unverified = [run for run in runs if run.skipped_verification]
    notes = []
    if total["fails"]:
        kind, head = "fails", f"✗ Fails: {total['fails']} of {checked} checks {plural(total['fails'], 'fails', 'fail')}"
        notes += [FAILED.format(f"{run.name}, {check.claim}: {check.quantity}", f", error {number(check.error, '.3g')}, allowed "
                                                                                f"{number(check.tolerance, '.3g')}")
                  for run in runs for check in run.checks if check.verdict == "fails"]
    elif incomplete or unreadable:
        kind, head = "warns", f"! Not complete: {'all checks made so far hold' if checked else 'nothing was checked'}"
    elif unverified:
        kind, head = "warns", f"! Not verified: {'all checks made hold' if checked else 'nothing was checked'}"
    elif checked:
        kind, head = "holds", f"✓ Holds: all {checked} checks are within their tolerances"
    else:
        kind, head = "reported", "· Reported: nothing here has a tolerance"
    notes += [FAILED.format(f"{run.name}: cannot be read, not shown", f": {run.problem}") for run in unreadable]
    notes += [f"{run.name}: the run {'was interrupted' if run.state == 'interrupted' else 'has not ended'}; "
              "the results written so far are shown" for run in incomplete]
    notes += [f"{run.name}: the crack was run without verification of its material and pre-stretch "
              "(--skip-verification)" for run in unverified]
    notes += [Markup("{}: {}").format(run.name, pattern_phrase(run.crack)) for run in runs if run.crack is not None]
    if total["reported"]:
        rows = plural(total["reported"], "1 row has", f"{total['reported']} rows have")
        notes.append(f"{rows} no tolerance and {plural(total['reported'], 'is', 'are')} for information only")
    return kind, head, notes


def counts(runs):
    """Rows of the table of counts by run and claim."""
    rows = []
    for position, run in enumerate(runs):
        link = Markup('<a href="#run-{}">{}</a>').format(position, run.name)
        for tally in tallies(run):
            rows.append(row(tally.kind, [
                link, Markup('<a href="#claim-{0}">{0}</a>').format(tally.claim),
                *(str(tally.count[v]) for v in ("holds", "fails", "reported")), ratio_text(tally.worst)], WORDS[tally.kind]))
        if not run.checks:
            word = "reported" if run.state == "complete" else run.state
            rows.append(row(word, [link, "none", *"–" * 4]))
    return rows


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
    return " · ".join(found)


def key_rows(runs, several):
    """Measured values of the cracks, with published values where there are any; with names if there are several runs."""
    return [row(c.check.kind if c.check else "reported", [
        *[c.run.name] * several, superscripts(c.quantity),
        "not measured" if c.measured is None else number_text(c.measured, c.uncertainty), number(c.published, ".4g"),
        superscripts(c.unit), percent(c.difference) if c.check else "–"], c.check.word if c.check else "measured")
        for find in (comparisons, unpublished) for run in runs for c in find(run)]
