"""Outcome of a run of a study, as read from its folder; statistics over the seeds of a run; numbers that follow from its tables."""
from __future__ import annotations

import dataclasses
import enum
import json
import math
import pathlib
from collections import Counter
from collections.abc import Iterable, Sequence
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from ..errors import CLAIM_FAILED, DONE, UnreadableFile
from ..files import content, object_in, read_columns
from ..quantities import quantity_text
from .plan import PlannedRun
from .program import Program, printable
from .statistical_tests import SampleMean
from .study_file import UNDECIDED


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
    """Reads the outcome of a run that ended, with its output in `log.txt` of its folder. `exit_code` is that of the process;
    default: that of `run.json`.
    """
    outcome = RunOutcome(run.run, run.seed)
    if run.zeta is not None:
        outcome.values["zeta"] = run.zeta
    info, crack = object_in(f"{folder}/run.json"), object_in(f"{folder}/crack.json")
    outcome.exit_code = number_of(info, "exit_code", -1) if exit_code is None else exit_code
    outcome.wall_time = number_of(info, "wall_time_total_s", 0.0)
    pattern = crack.get("pattern")
    if outcome.exit_code not in (DONE, CLAIM_FAILED) or not isinstance(pattern, str) or not pattern:
        outcome.state = RunState.REFUSED if outcome.exit_code == CLAIM_FAILED else RunState.FAILED
        outcome.problem = printable(last_words(content(f"{folder}/log.txt")), 300)
        if not outcome.problem and outcome.exit_code > 128:
            outcome.problem = f"killed by signal {outcome.exit_code - 128}"
        return outcome
    if outcome.exit_code == CLAIM_FAILED:
        outcome.problem = unfit_rows(info)
    if outcome.problem:
        outcome.state = RunState.REJECTED
        return outcome
    try:
        outcome.values |= measured_values(program, folder, run.spacing)
    except UnreadableFile as error:
        outcome.state, outcome.problem = RunState.FAILED, printable(str(error), 300)
        return outcome
    outcome.state = RunState.MEASURED
    outcome.pattern = pattern
    reason = crack.get("reason")
    outcome.reason = reason if isinstance(reason, str) else ""
    return outcome


def measured_values(program: Program, folder: str, spacing: float) -> dict[str, float]:
    """Returns the quantities of a measured crack by name."""
    found = object_in(f"{folder}/near_tip.json") | object_in(f"{folder}/crack.json")
    numbers = {name: number_of(found, name, None) for name in program.units}
    values = {name: float(value) for name, value in numbers.items() if value is not None}
    for name in ("wavelength", "amplitude", "crest_amplitude"):
        for suffix in ("", "_uncertainty"):
            if name + suffix in values:
                values[f"{name}_over_d{suffix}"] = values[name + suffix] / spacing
    return values | table_values(folder, spacing, values.get("window_begin", 0.0), values.get("window_end", 0.0))


def is_begun(program: Program, run: PlannedRun, folder: str, case: str, skip_verification: bool) -> bool:
    """Returns whether a folder contains a possibly unfinished run of exactly this case by exactly this program.

    It must have the same choice of verification, if it has recorded one. `case` is the file with the resolved case.
    """
    info, crack = object_in(f"{folder}/run.json"), object_in(f"{folder}/crack.json")
    # Cracks of the lattice do not name their side. A run that has not ended has no crack.json.
    if crack and crack.get("side", "lattice") != run.side or info.get("program_hash") != program.facts["program_hash"]:
        return False
    skipped = info.get("skip_verification")
    # A killed run has not recorded whether it was verified.
    return ((not isinstance(skipped, bool) or skipped == skip_verification)
            and content(f"{folder}/case.prm") == content(case) != "")


def number_of(document: dict[str, Any], key: str, otherwise: Any) -> Any:
    """Returns a number of a JSON object, or another value if there is none."""
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


@dataclasses.dataclass
class SeedStatistics:
    """Statistics of a quantity of one run.

    Of `n_seeds` planned seeds `n` have the quantity; `mean` and `deviation` (n - 1) are over those, None for the pattern, if n
    = 0, and the latter if n < 2. `uncertainty` is the root mean square of the uncertainties of single measurements, over seeds
    with one. `abscissa` is the value of the row's `against`. `patterns` are the numbers of seeds per pattern, sorted, without
    ``undecided``. `n_lost` seeds were refused, rejected, failed, or not run; `missing` has ``seed 3 failed`` for each seed
    without the quantity.
    """

    run: str
    n_seeds: int = 0
    n: int = 0
    abscissa: Any = None
    mean: Any = None
    deviation: float | None = None
    uncertainty: float | None = None
    patterns: dict[str, int] = dataclasses.field(default_factory=dict)
    n_undecided: int = 0
    n_lost: int = 0
    missing: list[str] = dataclasses.field(default_factory=list)

    @property
    def is_measured(self) -> bool:
        """True if at least three quarters of the seeds have the quantity, as every rule requires. The mean is biased if seeds lack
        it systematically: by 0.42 standard deviations without the lowest quarter of a normal distribution, by 0.80 without the
        lowest half."""
        return self.n > 0 and 4 * self.n >= 3 * self.n_seeds

    @property
    def is_lost(self) -> bool:
        """True if more than a quarter of the seeds ended without a measurement. A run that is not lost may still lack the quantity,
        as a straight crack has no amplitude."""
        return 4 * self.n_lost > self.n_seeds

    @property
    def count(self) -> str:
        """Number of seeds that have the quantity: "5", or "4 of 5"."""
        return f"{self.n} of {self.n_seeds}" if self.n < self.n_seeds else f"{self.n}"

    def sample(self) -> SampleMean:
        """Returns mean and scatter over the seeds, for tests. The run must have a mean."""
        return SampleMean(self.mean, self.n, (self.deviation or 0.0)**2, (self.uncertainty or 0.0)**2)

    def shows(self, pattern: str) -> bool:
        """Returns whether the pattern is measured and all seeds with a pattern have this one."""
        return self.is_measured and list(self.patterns) == [pattern]

    def text(self, unit: str) -> str:
        """Describes the result: "2.29 ± 0.04 cm (5)", or "(4 of 5)" if a seed lacks it; "oscillating 4/5, undecided 1/5"."""
        if self.mean is not None:
            return f"{quantity_text(self.mean, self.deviation, unit)} ({self.count})"
        counts = self.patterns | ({UNDECIDED: self.n_undecided} if self.n_undecided else {})
        return ", ".join(f"{pattern} {count}/{self.n_seeds}" for pattern, count in counts.items()) or "not measured"


def group_by_run(outcomes: Sequence[RunOutcome]) -> dict[str, list[RunOutcome]]:
    """Returns the outcomes of the seeds of each run."""
    groups: dict[str, list[RunOutcome]] = {}
    for outcome in outcomes:
        groups.setdefault(outcome.run, []).append(outcome)
    return groups


def total(numbers: Iterable[float]) -> float:
    """Adds in order: the sum of Python 3.12 is compensated, and tables would depend on the version."""
    return float(np.cumsum([0.0, *numbers])[-1])


def statistics(run: str, quantity: str, outcomes: Sequence[RunOutcome]) -> SeedStatistics:
    """Computes the statistics of one quantity over the outcomes of the seeds of a run."""
    seeds = SeedStatistics(run, len(outcomes))
    values, uncertainties = [], []
    patterns: Counter[str] = Counter()
    for outcome in outcomes:
        if outcome.state is not RunState.MEASURED:
            seeds.n_lost += 1
            seeds.missing.append(f"seed {outcome.seed} {outcome.state.value}")
        elif quantity == "pattern" and outcome.pattern != UNDECIDED:
            patterns[outcome.pattern] += 1
        elif quantity in outcome.values:
            values.append(outcome.values[quantity])
            if quantity + "_uncertainty" in outcome.values:
                uncertainties.append(outcome.values[quantity + "_uncertainty"])
        else:  # a crack with this pattern does not have this quantity
            seeds.n_undecided += quantity == "pattern"
            seeds.missing.append(f"seed {outcome.seed} {outcome.pattern}")
    seeds.patterns = dict(sorted(patterns.items()))
    seeds.n = len(values) + patterns.total()
    if values:
        mean = seeds.mean = total(values) / len(values)
        if len(values) > 1:
            seeds.deviation = math.sqrt(total((value - mean) * (value - mean) for value in values) / (len(values) - 1))
        if uncertainties:
            seeds.uncertainty = math.sqrt(total(value * value for value in uncertainties) / len(uncertainties))
    return seeds


_COLUMN = 2.0  # spacings over which hops of the tip are averaged, as in the measurement of a path
_LONGEST_CORRELATION = 0.9


def table_values(folder: str, spacing: float, begin: float, end: float) -> dict[str, float]:
    """Numbers of the path between two X, and energies per area of crack between the first and the last rows of energies there.

    `folder` is the output directory of a crack, `spacing` d of the lattice [m], `begin` and `end` the window of the
    measurement, undeformed [m]. Returns ``path_rms`` [m], ``path_growth`` [1/m] and its uncertainty, ``viscous_per_area`` and
    ``broken_per_area`` [J/m^2]; those that can be measured.
    """
    tip = read_columns(pathlib.Path(folder, "crack.csv"), ("t", "X", "Y"))
    energy = read_columns(pathlib.Path(folder, "energy.csv"), ("t", "viscous", "broken"))
    inside = (tip["X"] >= begin) & (tip["X"] <= end)
    X, Y, t = tip["X"][inside], tip["Y"][inside], tip["t"][inside]
    if len(X) < 2:
        return {}
    values = {"path_rms": float(np.std(Y))}
    if fit := path_growth(X, Y, spacing):
        values |= dict(zip(("path_growth", "path_growth_uncertainty"), fit))
    rows = np.flatnonzero((energy["t"] >= t[0]) & (energy["t"] <= t[-1]))
    if len(rows) > 1:
        advance = np.diff(np.interp(energy["t"][rows[[0, -1]]], t, X))[0]
        values |= {f"{name}_per_area": float((energy[name][rows[-1]] - energy[name][rows[0]]) / advance)
                   for name in ("viscous", "broken") if advance > 0}
    return values


def path_growth(X: ArrayLike, Y: ArrayLike, spacing: float) -> tuple[float, float] | None:
    """Fits exp(s X), or exp(s X) (a cos k X + b sin k X), to a path about the middle of the sheet, as a linear instability has
    it.

    Of the two the one with the higher Bayesian evidence (BIC) is taken. A path that returns to the middle has s < 0. Returns s
    and its standard deviation [1/m], that of least squares whose residuals are correlated from column to column; None for a
    path of fewer than 10 columns of 2 d, and for one that stays on the middle.
    """
    from scipy.optimize import least_squares
    x, y = np.asarray(X, float) / spacing, np.asarray(Y, float) / spacing
    column = np.floor((x - x[0]) / _COLUMN).astype(int)
    count = np.bincount(column)
    kept = count > 0
    x, y = np.bincount(column, x)[kept] / count[kept], np.bincount(column, y)[kept] / count[kept]
    n, x, length = len(x), x - x.mean(), x[-1] - x[0]
    if n < 10 or not np.abs(y).max() > 1e-3:
        return None

    def residuals(p: Any) -> Any:
        waves = [np.ones(n)] if len(p) == 1 else [np.cos(p[1] * x), np.sin(p[1] * x)]
        basis = (np.exp(p[0] * x) * waves).T
        return y - basis @ np.linalg.lstsq(basis, y, rcond=None)[0]

    rates = np.linspace(-6.0, 6.0, 7) / length
    # From three quarters of a period to a wavelength of 8 d, the shortest of the measurement.
    wavenumbers = 2.0 * math.pi / length * np.arange(0.75, length / 8.0, 0.5)
    starts: list[list[tuple[float, ...]]] = [[(rate,) for rate in rates], [(rate, k) for rate in rates for k in wavenumbers]]
    fits = [least_squares(residuals, min(some, key=lambda p: float(residuals(p) @ residuals(p))), x_scale=1.0 / length)
            for some in starts if some]
    # One or two amplitudes besides the parameters.
    best = min(fits, key=lambda fit: n * math.log(max(2.0 * fit.cost, 1e-12)) + 2 * len(fit.x) * math.log(n))
    rest = best.fun
    correlation = min(max(float(rest[1:] @ rest[:-1]) / max(float(rest @ rest), 1e-300), 0.0), _LONGEST_CORRELATION)
    variance = 2.0 * best.cost / max(n - 2 * len(best.x), 1) * (1.0 + correlation) / (1.0 - correlation)
    covariance = np.linalg.pinv(best.jac.T @ best.jac) * variance
    return float(best.x[0]) / spacing, math.sqrt(covariance[0, 0]) / spacing
