"""Resolved runs of a study: all cases are checked before the first run starts."""
from __future__ import annotations

import dataclasses
import enum
from collections.abc import Mapping, Sequence
from typing import Any

from ..schema import SEED_ENTRY
from .program import InputError, Program, printable
from .study_file import Settings, Study


class Verification(enum.Enum):
    """Cases of a study whose claims are checked before its cracks run."""

    NONE = "none (--skip-verification)"
    BASE_CASE = "material and pre-stretch of the base case alone (--quick)"
    EVERY_RUN = "material and pre-stretch of every run"


@dataclasses.dataclass(frozen=True, slots=True)
class PlannedRun:
    """Fracture run: a case with one seed. Seeds of a run share `changes` and `values`.

    Attributes
    ----------
    changes : list of str
        ``Section/Name=value`` without the seed.
    values : mapping
        Values of the entries that the study varies or compares: numbers in SI units, or texts.
    case_sha256 : str
        Of all entries and their values.
    spacing : float
        d [m].
    zeta : float or None
        Retardation time of the bonds over the travel time of a wave over one spacing [-]; None for linear bonds.
    size, evaluations, seconds, memory : float
        Number of sites or cells, number of force evaluations, estimated time on one core [s], estimated memory [bytes].
    """

    run: str
    seed: int
    on_continuum: bool
    changes: list[str]
    values: Mapping[str, float | str]
    case_sha256: str
    spacing: float
    zeta: float | None
    size: float
    evaluations: float
    seconds: float
    memory: float

    @property
    def folder(self) -> str:
        """Name of the output directory."""
        return f"{self.run}-{self.seed}"

    @property
    def side(self) -> str:
        """Side that breaks, as in `crack.json`."""
        return "continuum" if self.on_continuum else "lattice"

    def value(self, against: str) -> float | None:
        """Returns the value of ``zeta`` or of an entry; None if it is not a number."""
        if against == "zeta":
            return self.zeta
        value = float(self.seed) if against == SEED_ENTRY else self.values.get(against)
        return None if isinstance(value, str) or value is None else float(value)

    def text(self, program: Program) -> str:
        """Returns the text of the resolved case."""
        return program.ask(changes=self.changes, seeds=[self.seed], checks_laws=False, wants_text=True,
                           on_continuum=self.on_continuum)  # checked when planned


def parse_settings(texts: Sequence[str]) -> Settings:
    """Splits settings ``Section/Name=value`` of the command line."""
    settings: Settings = {}
    for text in texts:
        key, equals, value = text.partition("=")
        if not equals:
            raise InputError(f"--set: not understood: '{printable(text)}'; allowed: --set Section/Name=value")
        settings[key.strip()] = value.strip()
    if SEED_ENTRY in settings:
        raise InputError(f"--set: {SEED_ENTRY} is set by the seeds of the study")
    return settings


def assignments(settings: Settings) -> list[str]:
    """Returns settings as ``Section/Name=value``."""
    return [f"{key}={value}" for key, value in settings.items()]


def base_text(program: Program, study: Study, overrides: Settings) -> str:
    """Returns the text of the base case, for claims that are checked on it alone."""
    return program.ask(changes=assignments(study.settings | overrides), seeds=[], checks_laws=True, wants_text=True)


def plan_runs(program: Program, study: Study, overrides: Settings, verification: Verification) -> list[PlannedRun]:
    """Returns all runs of a study with all their seeds, in the order of the file, with the first and the last frame alone.

    Raises
    ------
    InputError
        With the problems of all cases, of rows whose `against` is not a number in any of their runs, and of settings of entries
        that the study sweeps.
    """
    for key in overrides:
        if key in study.swept:
            raise InputError(f"--set: {key} is also an entry of the sweep of {study.file}")
    keys = {key for run in study.runs for key in run.own} | set(study.swept)
    keys |= {row.against for claim in study.claims for row in claim.rows if row.against}
    frames = {"Output/frame interval": "0", "Output/motion frames": "0"}
    cases: list[dict[str, Any]] = [{"changes": assignments(run.all | overrides | frames), "seeds": run.seeds, "on_continuum": run.on_continuum}
             for run in study.runs]
    runs: list[PlannedRun] = []
    problems: list[str] = []
    for run, case in zip(study.runs, cases):
        try:
            reply = program.ask(**case, keys=sorted(keys - {"zeta"}), checks_laws=verification is Verification.EVERY_RUN, wants_text=False)
        except InputError as error:
            # A problem of the base case occurs in every run: report it once.
            problems += [f"{study.file}: runs/{run.name}: {problem}" for problem in error.problems
                         if not any(known.endswith(": " + problem) for known in problems)]
        if not problems:
            digests = reply.pop("sha256")
            runs += [PlannedRun(run.name, seed, run.on_continuum, case["changes"], case_sha256=digest, **reply)
                     for seed, digest in zip(run.seeds, digests)]
    if not problems:
        problems = _without_abscissa(study, runs)
    if problems:
        raise InputError(*problems)
    if verification is Verification.BASE_CASE:
        base_text(program, study, overrides)
    return runs


def _without_abscissa(study: Study, runs: Sequence[PlannedRun]) -> list[str]:
    problems = []
    for row in (row for claim in study.claims for row in claim.rows if row.against):
        names = set(row.runs)
        if not any(run.run in names and run.value(row.against) is not None for run in runs) and not names <= set(study.left_out):
            problems.append(f"{row.place}/against: {row.against} is not a number in any of these runs")
    return problems


def longest_first(runs: Sequence[PlannedRun]) -> list[int]:
    """Returns the indices of the runs in the order of decreasing time."""
    return sorted(range(len(runs)), key=lambda i: -runs[i].seconds)
