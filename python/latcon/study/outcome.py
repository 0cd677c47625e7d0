"""Outcome of a run of a study, as read from its folder."""
from __future__ import annotations

import dataclasses
import enum
import json
import pathlib
from typing import Any

from ..errors import CLAIM_FAILED, DONE
from ..tables import table_values
from .plan import PlannedRun
from .program import Program, printable


class RunState(enum.Enum):
    """State of a run, as in the output files."""

    MEASURED = "measured"
    REFUSED = "refused: verification"  # material or pre-stretch failed
    REJECTED = "failed its checks"  # a row other than those about published values, as that of the energy ledger
    FAILED = "failed"
    NOT_RUN = "not run"


@dataclasses.dataclass(slots=True)
class RunOutcome:
    """Outcome of one run with one seed. Pattern, reason and values but zeta are empty unless it was measured."""

    run: str
    seed: int
    state: RunState = RunState.NOT_RUN
    exit_code: int = 0
    problem: str = ""  # of a refused or failed run: the last message it printed; of a rejected one: the rows
    pattern: str = ""
    reason: str = ""
    values: dict[str, float] = dataclasses.field(default_factory=dict)
    wall_time: float = 0.0  # [s]


def read_outcome(program: Program, run: PlannedRun, folder: str, exit_code: int | None = None) -> RunOutcome:
    """Reads the outcome of a run that ended.

    Parameters
    ----------
    folder
        Output directory of the run, with its output in `log.txt`.
    exit_code
        Of the process; default: that of `run.json`.
    """
    outcome = RunOutcome(run.run, run.seed)
    if run.zeta is not None:
        outcome.values["zeta"] = run.zeta
    info, crack = _object_in(f"{folder}/run.json"), _object_in(f"{folder}/crack.json")
    outcome.exit_code = _number(info, "exit_code", -1) if exit_code is None else exit_code
    outcome.wall_time = _number(info, "wall_time_total_s", 0.0)
    pattern = crack.get("pattern")
    if outcome.exit_code not in (DONE, CLAIM_FAILED) or not isinstance(pattern, str) or not pattern:
        outcome.state = RunState.REFUSED if outcome.exit_code == CLAIM_FAILED else RunState.FAILED
        outcome.problem = printable(last_words(content(f"{folder}/log.txt")), 300)
        return outcome
    if outcome.exit_code == CLAIM_FAILED:
        outcome.problem = unfit_rows(info)
    if outcome.problem:
        outcome.state = RunState.REJECTED
        return outcome
    outcome.state = RunState.MEASURED
    outcome.pattern = pattern
    reason = crack.get("reason")
    outcome.reason = reason if isinstance(reason, str) else ""
    outcome.values |= measured_values(program, folder, run.spacing)
    return outcome


def measured_values(program: Program, folder: str, spacing: float) -> dict[str, float]:
    """Returns the quantities of a measured crack by name."""
    found = _object_in(f"{folder}/near_tip.json") | _object_in(f"{folder}/crack.json")
    numbers = {name: _number(found, name, None) for name in program.units}
    values = {name: float(value) for name, value in numbers.items() if value is not None}
    for name in ("wavelength", "amplitude", "crest_amplitude"):
        for suffix in ("", "_uncertainty"):
            if name + suffix in values:
                values[f"{name}_over_d{suffix}"] = values[name + suffix] / spacing
    return values | table_values(folder, spacing, values.get("window_begin", 0.0), values.get("window_end", 0.0))


def is_begun(program: Program, run: PlannedRun, folder: str, case: str, skip_verification: bool) -> bool:
    """Returns whether a folder contains a possibly unfinished run of exactly this case by exactly this program.

    It must have the same choice of verification, if it has recorded one.

    Parameters
    ----------
    case
        File with the resolved case.
    """
    info, crack = _object_in(f"{folder}/run.json"), _object_in(f"{folder}/crack.json")
    # Cracks of the lattice do not name their side. A run that has not ended has no crack.json.
    if crack and crack.get("side", "lattice") != run.side or info.get("program_hash") != program.facts["program_hash"]:
        return False
    skipped = info.get("skip_verification")
    # A killed run has not recorded whether it was verified.
    return ((not isinstance(skipped, bool) or skipped == skip_verification)
            and content(f"{folder}/case.prm") == content(case) != "")


def is_finished(program: Program, run: PlannedRun, folder: str, case: str, skip_verification: bool) -> bool:
    """Returns whether a folder contains this run, and its crack ended: another run would end alike."""
    return (is_begun(program, run, folder, case, skip_verification)
            and read_outcome(program, run, folder).state in (RunState.MEASURED, RunState.REJECTED))


def content(path: str) -> str:
    """Returns the text of a file; empty if it cannot be read."""
    try:
        return pathlib.Path(path).read_bytes().decode("utf-8", "replace")
    except OSError:
        return ""


def _object_in(path: str) -> dict[str, Any]:
    try:
        document = json.loads(content(path))
    except ValueError:
        return {}
    return document if isinstance(document, dict) else {}


def _number(document: dict[str, Any], key: str, otherwise: Any) -> Any:
    value = document.get(key)
    return value if isinstance(value, (int, float)) and not isinstance(value, bool) else otherwise


def last_words(text: str) -> str:
    """Returns the last message: everything from the last line that begins with the name of the program, or the last line."""
    text = "\n" + text.strip()
    begin = text.rfind("\nlatcon: ")
    if begin < 0:
        begin = max(text.rfind("\n"), text.rfind("\r"))
    return text[begin + 1:].replace("\n", "; ")


def unfit_rows(info: dict[str, Any]) -> str:
    """Returns the rows that failed and compare nothing with published values, each with its kind."""
    failed = info.get("failed_rows")
    if not isinstance(failed, dict) or not failed:
        return "run.json does not say which rows failed"
    return "; ".join(f"{row} ({kind if isinstance(kind, str) else json.dumps(kind)})"
                     for row, kind in sorted(failed.items()) if kind != "reference")
