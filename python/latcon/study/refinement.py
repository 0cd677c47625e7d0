"""Refinement of a sweep where neighbouring cases have different patterns."""
from __future__ import annotations

import bisect
import dataclasses
import math
from collections.abc import Sequence

from .outcome import RunOutcome, RunState
from .plan import PlannedRun
from .study_file import Study, StudyRun
from .sweep import MAX_NAME_LENGTH, combination_name, plain_number


def refined_runs(study: Study, plan: Sequence[PlannedRun], outcomes: Sequence[RunOutcome], level: int) -> list[StudyRun]:
    """Returns the runs half way between neighbours of a swept grid with different patterns.

    They bracket the boundary between two patterns at half the distance. Neighbours are points at the spacing of this level,
    from 1, along one swept entry, with the same values of the others: the spacing of the grid for level 1, half of it for level
    2, and so on; values between those of the grid are interpolated. Two points differ unless all seeds of both have the same
    pattern, where ``undecided`` is a pattern. A point without a measured seed differs from none. The values of the sweep are
    numbers; the study has the runs of the earlier levels, with a seed each in `plan`, and `outcomes` in the same order.
    """
    swept = {run.name: run for run in study.runs if run.is_swept}
    planned = {run.run: run for run in plan if run.run in swept}
    def value(run: PlannedRun, entry: str) -> float:
        number = run.value(entry)
        assert number is not None, f"{entry} is not a number"
        return number

    axes = [sorted({value(run, entry) for run in planned.values() if swept[run.run].level == 0}) for entry in study.swept]
    per_interval = 2**level  # points of this level are at odd indices
    points = {tuple(_index(axis, value(run, entry), per_interval) for entry, axis in zip(study.swept, axes)): name
              for name, run in planned.items()}
    patterns: dict[str, set[str]] = {}
    for outcome in outcomes:
        if outcome.state is RunState.MEASURED:
            patterns.setdefault(outcome.run, set()).add(outcome.pattern)
    found: dict[tuple[int, ...], StudyRun] = {}
    for at, name in sorted(points.items()):
        for i in range(len(axes)):
            middle, following = (at[:i] + (at[i] + shift,) + at[i + 1:] for shift in (1, 2))
            if following not in points or middle in points:
                continue
            seen = patterns.get(name, set()), patterns.get(points[following], set())
            if not all(seen) or seen[0] == seen[1] and len(seen[0]) == 1 or middle in found:
                continue
            values = [plain_number(_value(axis, index, per_interval)) for axis, index in zip(axes, middle)]
            own = dict(zip(study.swept, values))
            run = swept[name]
            found[middle] = dataclasses.replace(run, name=combination_name(study.swept, values), level=level, own=run.own | own,
                                                all=run.all | own)
    names = {run.name for run in study.runs}
    refined = [run for _, run in sorted(found.items())]
    for number, run in enumerate(refined, 1):
        if len(run.name) > MAX_NAME_LENGTH or run.name in names:
            run.name = f"level-{level}-{number}"
    return refined


def _value(axis: Sequence[float], index: int, per_interval: int) -> float:
    left, rest = divmod(index, per_interval)
    return axis[left] if rest == 0 else axis[left] + rest / per_interval * (axis[left + 1] - axis[left])


def _index(axis: Sequence[float], value: float, per_interval: int) -> int:
    """Returns the index of the finest level closest to a value, since values are written with twelve digits."""
    if len(axis) < 2:
        return 0
    above = bisect.bisect_right(axis, value, 1, len(axis) - 1)
    share = (value - axis[above - 1]) / (axis[above] - axis[above - 1])
    return (above - 1) * per_interval + math.floor(share * per_interval + 0.5)
