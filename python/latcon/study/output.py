"""Output files and tables of a study."""
from __future__ import annotations

import csv
import dataclasses
import io
import json
import math
import re
import textwrap
from collections.abc import Iterable, Sequence
from typing import Any

import numpy as np

from ..rows import finite_or_text
from .outcome import RunOutcome, RunState, group_by_run, statistics, total
from .plan import PlannedRun, Verification
from .program import Program
from .study_file import Rule, Study
from .table import ClaimOutcome, RowOutcome

_WIDTH = 120
_INTERVAL = ("value", "low", "high")


@dataclasses.dataclass
class StudyResults:
    """Study, and the outcomes of its runs in the order of the plan."""

    study: Study
    plan: list[PlannedRun]
    quick: bool
    verification: Verification
    outcomes: list[RunOutcome] = dataclasses.field(default_factory=list)
    claims: list[ClaimOutcome] = dataclasses.field(default_factory=list)


def study_json(program: Program, results: StudyResults) -> str:
    """Returns the content of `study.json`: all data, for the page and for other programs. Equal runs give equal texts."""
    study = results.study
    document = {
        "title": study.title, "version": program.facts["version"], "git_commit": program.facts["git_commit"], "quick": results.quick,
        "verification": results.verification.value, "verified": results.verification is Verification.EVERY_RUN,
        "settings": study.settings, "units": program.units,
        "runs": [{"run": run.name, "about": run.about, "set": run.own, "level": run.level} for run in study.runs],
        "swept": study.swept, "varied": _varied(program, results), "left_out": study.left_out, "pictures": study.pictures,
        "seeds": [{"run": outcome.run, "seed": outcome.seed, "folder": f"runs/{planned.folder}", "state": outcome.state.value,
                   "exit_code": outcome.exit_code, "problem": outcome.problem, "pattern": outcome.pattern or None,
                   "reason": outcome.reason, "side": planned.side, "sites": int(planned.size),
                   "values": {name: outcome.values.get(name) for name in program.units}}
                  for planned, outcome in zip(results.plan, results.outcomes)],
        "claims": [{"claim": claim.claim.claim, "paper": claim.claim.paper, "note": claim.claim.note,
                    "verdict": claim.verdict.value, "rows": [_row(row) for row in claim.rows]} for claim in results.claims]}
    return json.dumps(document, indent=2, ensure_ascii=False) + "\n"


def _row(outcome: RowOutcome) -> dict[str, Any]:
    row, fit = outcome.row, outcome.onset
    document: dict[str, Any] = {
        "runs": row.runs, "quantity": row.quantity, "unit": row.unit, "against": row.against or None,
        "against_unit": row.against_unit if row.against else None, "expected": outcome.expected,
        "measured": "; ".join(outcome.measured), "number": finite_or_text(outcome.number)}
    if row.rule is Rule.ONSET_EXPONENT:
        document["onset"] = fit and {
            "exponent": dict(zip(_INTERVAL, fit.exponent)), "onset": dict(zip(_INTERVAL, fit.onset)), "prefactor": fit.prefactor,
            "p_fit": fit.p_fit}
    return document | {"note": "; ".join(outcome.note), "verdict": outcome.verdict.value, "values": [
        {"run": seeds.run, "against": finite_or_text(seeds.abscissa), "seeds": seeds.n_seeds, "n": seeds.n,
         "mean": finite_or_text(seeds.mean), "standard_deviation": finite_or_text(seeds.deviation), "patterns": seeds.patterns, "undecided": seeds.n_undecided}
        for seeds in outcome.runs]}


def _varied(program: Program, results: StudyResults) -> list[dict[str, Any]]:
    """Entries in which the runs differ, with their value in each run: a number, or a text."""
    runs = list({run.run: run for run in reversed(results.plan)}.values())[::-1]  # the first seed of each
    keys = dict.fromkeys(key for run in results.study.runs for key in run.own)
    entries = [{"entry": key, "unit": program.entries[key].unit or "", "values": [run.values.get(key, "") for run in runs]} for key in keys]
    return [entry for entry in entries if any(value != entry["values"][0] for value in entry["values"])]


def study_csv(program: Program, results: StudyResults) -> str:
    """Returns the content of `study.csv`: a line per run and seed, empty fields for quantities that were not measured."""
    own = {run.name: "; ".join(f"{key}={value}" for key, value in run.own.items()) for run in results.study.runs}
    return csv_text(["run", "seed", "set", "state", "pattern", *(f"{name} [{unit}]" for name, unit in program.units.items())],
                    [[outcome.run, outcome.seed, own[outcome.run], outcome.state.value, outcome.pattern,
                      *(outcome.values.get(name) for name in program.units)] for outcome in results.outcomes])


def csv_text(header: Sequence[str], rows: Iterable[Iterable[Any]]) -> str:
    """Returns a table: numbers in their shortest form, None as an empty field."""
    text = io.StringIO()
    csv.writer(text, lineterminator="\n").writerows(
        [header, *([shortest(value) if isinstance(value, float) else value for value in row] for row in rows)])
    return text.getvalue()


def shortest(value: float) -> str:
    """Returns the shortest text that converts back to the same number, as C++ writes it: of equal ones without an exponent."""
    return min(np.format_float_positional(value, trim="-"), np.format_float_scientific(value, trim="-", exp_digits=2), key=len)


def plan_table(study: Study, plan: Sequence[PlannedRun], n_cores: int) -> str:
    """Returns the runs with their sizes and estimated time on `n_cores` cores."""
    width = max([4, *(len(run.folder) for run in plan)])
    lines = [f"{'run':<{width}}{'size':>10}{'evaluations':>12}{'core time':>12}"]
    lines += [f"{run.folder:<{width}}{_rounded(run.size):>10}{_rounded(run.evaluations):>12}{math.ceil(run.seconds):>10} s"
              for run in plan]
    minutes = total(run.seconds for run in plan) / 60
    lines.append(f"{len(plan)} runs, about {math.ceil(minutes)} core minutes, {math.ceil(minutes / n_cores)} minutes on "
                 f"{n_cores} cores")
    if study.refine:
        lines.append(f"refined {study.refine} time{'s' if study.refine > 1 else ''} where neighbours differ, at a cost that depends "
                     "on the patterns")
    return "\n".join(lines)


def _rounded(value: float) -> int:
    return math.floor(value + 0.5)


def result_table(program: Program, results: StudyResults) -> str:
    """Returns the table of verdicts, at most 120 columns wide; without claims a line per run, of at most 60: patterns, speed,
    wavelength and amplitude over the seeds.
    """
    lines: list[str] = []
    groups, runs = group_by_run(results.outcomes), results.study.runs
    for run in () if results.claims else runs[:60]:
        outcomes = groups.get(run.name, [])
        lines.append(f"{run.name}: {statistics(run.name, 'pattern', outcomes).text('')}")
        for quantity, label in (("speed_lagrangian", ""), ("wavelength", "wavelength "), ("amplitude", "amplitude ")):
            seeds = statistics(run.name, quantity, outcomes)
            if seeds.n:
                lines[-1] += f", {label}{seeds.text(program.units[quantity])}"
    if not results.claims and len(runs) > 60:
        lines.append(f"... {len(runs)} cases in all: study.csv")
    for claim in results.claims:
        lines += _wrapped(f"{claim.claim.claim}: {claim.verdict.value}", "", "")
        for row in claim.rows:
            text = f"{', '.join(row.row.runs)}, {row.row.quantity}: {'; '.join(row.measured)}"
            text += (f" [{row.expected}]" if row.expected else "") + (f" - {'; '.join(row.note)}" if row.note else "")
            lines += _wrapped(text, f"{'  ' + row.verdict.value:<17}", " " * 17)
    for outcome in results.outcomes:
        if outcome.state is not RunState.MEASURED:
            problem = f": {outcome.problem}" if outcome.problem else ""
            lines += _wrapped(f"{outcome.run}, seed {outcome.seed}: {outcome.state.value}{problem}", "", "  ")
    return "\n".join(lines)


def _wrapped(text: str, first: str, indent: str) -> list[str]:
    """Wraps a text at blanks, and within words that are too long; control characters would break the table."""
    lines = textwrap.wrap(re.sub(r"[\x00-\x1f\x7f]", "?", text), _WIDTH - len(indent), break_on_hyphens=False)
    return [lead + line for lead, line in zip([first] + [indent] * len(lines), lines)]
