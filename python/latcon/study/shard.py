"""Shares of a study, one for each task of a job array, and the plan that they share."""
from __future__ import annotations

import json
import re
from collections.abc import Sequence

from .plan import PlannedRun, longest_first
from .program import InputError, printable

PLAN_FILE = "plan.json"
"""File in the output directory of a study that its shards share."""

_MAX_SHARDS = 100000


def parse_shard(text: str) -> tuple[int, int]:
    """Parses ``I/N`` with 1 <= I <= N <= 100,000."""
    if match := re.fullmatch(r"([0-9]{1,18})/([0-9]{1,18})", text):
        index, count = int(match[1]), int(match[2])
        if 1 <= index <= count <= _MAX_SHARDS:
            return index, count
    raise InputError(f"--shard '{printable(text)}': expected I/N with 1 <= I <= N <= {_MAX_SHARDS}, for example 3/8")


def runs_of_shard(plan: Sequence[PlannedRun], index: int, count: int) -> list[int]:
    """Returns the indices of the runs of a shard, the most expensive first. Shards have about the same cost."""
    return longest_first(plan)[index - 1::count]


def plan_text(title: str, plan: Sequence[PlannedRun], skip_verification: bool, n_shards: int) -> str:
    """Returns the text of `plan.json`: the same study gives the same text. `n_shards` 0: any number, for a comparison."""
    runs = [{"run": run.folder, "side": run.side, "case_sha256": run.case_sha256} for run in plan]
    document = {"study": title, "skip_verification": skip_verification, **({"shards": n_shards} if n_shards else {}), "runs": runs}
    return json.dumps(document, indent=1, ensure_ascii=False) + "\n"


def plan_difference(stored: str, wanted: str) -> str:
    """Returns the first difference between the plan in a file and that of this study, in words; empty if they are the same."""
    here = json.loads(wanted)
    try:
        there = json.loads(stored)
        if there["study"] != here["study"]:
            return f"it is of another study, '{printable(there['study'])}'"
        if there["skip_verification"] != here["skip_verification"]:
            return "it was begun with another choice of --skip-verification"
        if "shards" in here and there["shards"] != here["shards"]:
            return f"it was begun with {json.dumps(there['shards'])} shards"
        for old, new in zip(there["runs"], here["runs"]):
            if old != new:
                return f"the case of run {new['run']} differs"
        if len(there["runs"]) != len(here["runs"]):
            return f"it has {len(there['runs'])} runs, now there are {len(here['runs'])}"
    except (ValueError, KeyError, TypeError):
        return f"{PLAN_FILE} is damaged"
    return ""
