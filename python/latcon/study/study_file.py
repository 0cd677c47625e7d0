"""Reader of study files: runs of a parameter sweep, and claims about them (docs/reference-studies.md)."""
from __future__ import annotations

import dataclasses
import enum
import os
import re
from typing import Any

from ..schema import SEED_ENTRY
from .program import InputError, Program
from .strict_json import JsonPlace, parse_json
from .sweep import Sweep, combinations, parse_sweep

Settings = dict[str, str]
"""Entries of a case with their values, in the order of their first occurrence."""

PATTERNS = ["straight", "oscillating", "branching", "arrested"]
UNDECIDED = "undecided"


class Rule(enum.Enum):
    """Rule of a row: its key in the file."""

    REPORTED = ""  # informational
    BELOW = "below"  # mean <= bound
    ABOVE = "above"  # mean >= bound
    BRACKET = "bracket"  # one pattern at small values of `against`, another at large values
    FALLS = "falls"  # means fall along `against`
    IS = "is"  # every seed has the pattern
    IS_NEAR = "is near"  # |mean / bound - 1| <= tolerance
    ONSET_EXPONENT = "onset exponent"  # |exponent of the onset - bound| <= tolerance, with 95 % confidence
    RISES = "rises"  # means rise along `against`

    @property
    def is_along(self) -> bool:
        """Whether the rule is about runs along an abscissa."""
        return self in (Rule.RISES, Rule.FALLS, Rule.BRACKET, Rule.ONSET_EXPONENT)


@dataclasses.dataclass
class StudyRun:
    """Case that is run once per seed."""

    name: str
    about: str = ""
    own: Settings = dataclasses.field(default_factory=dict)
    all: Settings = dataclasses.field(default_factory=dict)
    seeds: list[int] = dataclasses.field(default_factory=list)
    is_swept: bool = False
    level: int = 0
    on_continuum: bool = False


@dataclasses.dataclass
class StudyRow:
    """Statement about one quantity of one or more runs; `bound` in the SI unit of the quantity."""

    place: str = ""
    runs: list[str] = dataclasses.field(default_factory=list)
    quantity: str = ""
    unit: str = "1"
    rule: Rule = Rule.REPORTED
    pattern: str = ""
    start: str = ""  # of a bracket: the pattern at small values
    to: str = ""
    bound: float = 0.0
    bound_run: str = ""
    tolerance: float = 0.0
    against: str = ""
    against_unit: str = ""


@dataclasses.dataclass
class StudyClaim:
    """Claim of a source, and the rows that test it."""

    claim: str = ""
    paper: str = ""
    note: str = ""
    rows: list[StudyRow] = dataclasses.field(default_factory=list)


@dataclasses.dataclass
class Study:
    """Study in one of its two sizes."""

    file: str
    title: str = ""
    base: str = ""
    settings: Settings = dataclasses.field(default_factory=dict)
    runs: list[StudyRun] = dataclasses.field(default_factory=list)
    swept: list[str] = dataclasses.field(default_factory=list)
    refine: int = 0
    left_out: list[str] = dataclasses.field(default_factory=list)
    claims: list[StudyClaim] = dataclasses.field(default_factory=list)
    pictures: list[str] = dataclasses.field(default_factory=list)


def read_study(program: Program, path: str, quick: bool, text: bytes) -> Study:
    """Reads a study, the content of a file whose folder the name of its base case is relative to.

    Raises InputError with all problems and their positions: unknown or missing keys, values of another type or out of range,
    unknown runs, quantities and entries.
    """
    return _Reader(program, path, quick).read(text)


class _Reader:
    def __init__(self, program: Program, path: str, quick: bool) -> None:
        self.program = program
        self.quick = quick
        self.study = Study(path)
        self.problems: list[str] = []
        self.names: list[str] = []  # of all runs of the file
        self.n_swept = 0
        self.is_continuous = True

    def read(self, text: bytes) -> Study:
        study = self.study
        top = JsonPlace(parse_json(study.file, text), study.file, "", self.problems, self.program)
        top.is_object("title", "base", "side", "set", "seeds", "quick", "sweep", "refine", "runs", "claims", "pictures")
        if title := top.required("title"):
            study.title = title.text()
        if base := top.required("base"):
            study.base = os.path.normpath(os.path.join(os.path.dirname(study.file), base.text() or "."))
        self.on_continuum = _is_on_continuum(top, False)
        self.whole = self.change(top)
        self.small: tuple[Settings, list[int]] = ({}, [])
        if top.has("quick"):
            top.at("quick").is_object("set", "seeds", "sweep", "refine")
            self.small = self.change(top.at("quick"))
        study.settings = self.whole[0] | (self.small[0] if self.quick else {})
        self.sweeps(top)
        self.refinement(top, "")
        if top.has("quick"):
            self.refinement(top.at("quick"), " of the study")
        runs = None if top.has("sweep") and not top.has("runs") else top.required("runs")
        if runs:
            for name, place in runs.members():
                self.run(name, place)
            if not study.runs and not self.problems:
                runs.problem("no run is left")
        for place in top.at("claims").list() if top.has("claims") else ():
            self.claim(place)
        for place in top.at("pictures").list() if top.has("pictures") else ():
            study.pictures.append(self.known_run(place))
        if self.problems:
            raise InputError(*self.problems)
        return study

    def change(self, place: JsonPlace) -> tuple[Settings, list[int]]:
        """Settings and seeds in an object of the file; empty if absent."""
        return (self.settings(place.at("set")) if place.has("set") else {},
                _seeds(place.at("seeds")) if place.has("seeds") else [])

    def settings(self, place: JsonPlace) -> Settings:
        found = {}
        for key, value in place.members():
            if key not in self.program.entries:
                value.problem("not an entry of a case" + self.program.hint(key, self.program.sorted_entries))
            elif key == SEED_ENTRY:
                value.problem('is set by "seeds"')
            elif isinstance(value.value, str):
                found[key] = value.text()
            elif isinstance(value.value, (int, float)):
                found[key] = value.dump()
            else:
                value.problem("must be a text, a number, true or false")
        return found

    def run(self, name: str, place: JsonPlace) -> None:
        if not re.fullmatch(r"[A-Za-z0-9_-][A-Za-z0-9._-]*", name):
            place.problem("the name of a run must consist of letters, digits, '.', '_' and '-', and must not begin with '.'")
        if name in self.names[:self.n_swept]:
            place.problem("a run of the sweep has this name")
        self.names.append(name)
        if not place.is_object("about", "side", "set", "seeds", "quick"):
            return
        run = StudyRun(name, place.optional_text("about"))
        run.on_continuum = _is_on_continuum(place, self.on_continuum)
        own = self.change(place)
        small: tuple[Settings, list[int]] = ({}, [])
        left_out = False
        if place.has("quick"):
            quick = place.at("quick")
            if isinstance(quick.value, bool):
                left_out = not quick.value
            elif quick.is_object("set", "seeds"):
                small = self.change(quick)
        candidates = [small, self.small, own, self.whole] if self.quick else [own, self.whole]
        run.seeds = next((seeds for _, seeds in candidates if seeds), [1])
        run.own = own[0] | (small[0] if self.quick else {})
        run.all = self.study.settings | run.own
        if self.quick and left_out:
            self.study.left_out.append(name)
        else:
            self.study.runs.append(run)

    def sweeps(self, top: JsonPlace) -> None:
        """Adds a run per combination of values of this size, and the names of those of the full size."""
        has_quick = top.has("quick") and top.at("quick").has("sweep")
        if not top.has("sweep"):
            if has_quick:
                top.at("quick").at("sweep").problem("needs the key 'sweep' of the study")
            return
        seeds = self.whole[1] or [1]
        small_seeds = self.small[1] or seeds
        full = self.sweep(top.at("sweep"), len(seeds), not self.quick or not has_quick)
        small = self.sweep(top.at("quick").at("sweep"), len(small_seeds), self.quick) if has_quick else full
        for name, own in (small if self.quick else full).items():
            self.study.runs.append(StudyRun(name, "", own, self.study.settings | own, small_seeds if self.quick else seeds, True,
                                            on_continuum=self.on_continuum))
        known = {run.name for run in self.study.runs}
        self.study.left_out = [name for name in full if name not in known]
        self.names = [run.name for run in self.study.runs] + self.study.left_out
        self.n_swept = len(self.names)

    def sweep(self, place: JsonPlace, n_seeds: int, is_run: bool) -> dict[str, Settings]:
        try:
            found: list[Sweep] = [parse_sweep(self.program, text.text()) for text in place.list()]
            cases = combinations(found, n_seeds)
        except InputError as error:
            place.problem(str(error))
            return {}
        for sweep in found if is_run else ():
            self.study.swept.append(sweep.entry)
            self.is_continuous = self.is_continuous and sweep.is_continuous
        return cases

    def refinement(self, of: JsonPlace, owner: str) -> None:
        if not of.has("refine"):
            return
        place = of.at("refine")
        if not _is_unsigned(place.value) or place.value > 6:  # spacings below a hundredth of the grid's
            place.problem("must be a whole number from 0 to 6")
        elif place.value > 0 and not self.study.swept:
            place.problem("needs the key 'sweep'" + owner)
        elif place.value > 0 and not self.is_continuous:
            place.problem("needs sweeps of numbers that are not whole")
        elif not owner or self.quick:
            self.study.refine = place.value

    def known_run(self, place: JsonPlace) -> str:
        return place.word(self.names, "run")

    def claim(self, place: JsonPlace) -> None:
        if not place.is_object("claim", "paper", "rows", "note"):
            return
        claim = StudyClaim()
        if text := place.required("claim"):
            claim.claim = text.text()
        claim.paper, claim.note = place.optional_text("paper"), place.optional_text("note")
        if rows := place.required("rows"):
            claim.rows = [self.row(row) for row in rows.list()]
        self.study.claims.append(claim)

    def row(self, place: JsonPlace) -> StudyRow:
        row = StudyRow(place.place)
        if not place.is_object("run", "runs", "quantity", "is", "is near", "tolerance", "above", "below", "rises", "falls",
                               "bracket", "onset exponent", "against", "quick"):
            return row
        if place.has("run") == place.has("runs"):
            place.problem('a row needs either "run" or "runs"')
        elif place.has("run"):
            row.runs = [self.known_run(place.at("run"))]
        else:
            for run in place.at("runs").list():
                row.runs.append(self.known_run(run))
                if row.runs[-1] and row.runs.count(row.runs[-1]) > 1:
                    run.problem(f"'{row.runs[-1]}' is given twice")
        if quantity := place.required("quantity"):
            row.quantity = quantity.word(["pattern", *self.program.units], "quantity")
            row.unit = self.program.units.get(row.quantity, "1")
        if place.has("against"):
            against = place.at("against")
            row.against = against.text()
            known = ["zeta", *self.program.sorted_entries]
            if row.against not in known:
                against.problem("must be zeta or an entry of a case" + self.program.hint(row.against, known))
            else:
                row.against_unit = "1" if row.against == "zeta" else self.program.entries[row.against].unit or ""
        self.rule(place, row)
        if place.has("quick") and not place.at("quick").boolean() and self.quick:
            row.rule = Rule.REPORTED
        return row

    def rule(self, place: JsonPlace, row: StudyRow) -> None:
        for rule in sorted(Rule, key=lambda rule: rule.value):
            if rule is Rule.REPORTED or not place.has(rule.value):
                continue
            if row.rule is not Rule.REPORTED:
                place.problem(f'a row can have only one rule; the second one is "{rule.value}"')
            row.rule = rule
            self.rule_value(place.at(rule.value), row)
        of_patterns = row.rule in (Rule.IS, Rule.BRACKET)
        if row.rule is not Rule.REPORTED and row.quantity and of_patterns != (row.quantity == "pattern"):
            place.problem('this rule is only for the quantity "pattern"' if of_patterns
                          else "this rule is only for numbers, not for patterns")
        is_near = row.rule in (Rule.IS_NEAR, Rule.ONSET_EXPONENT)
        if place.has("tolerance") != is_near:
            place.problem('"is near" or "onset exponent" and "tolerance" must be given together')
        elif is_near:
            row.tolerance = place.at("tolerance").number()
            if not row.tolerance > 0:
                place.at("tolerance").problem("must be larger than 0")
        if row.rule.is_along and not row.against:
            place.problem('this rule needs "against"')
        if row.rule.is_along and len(row.runs) == 1:
            place.problem("this rule needs two runs or more")

    def rule_value(self, place: JsonPlace, row: StudyRow) -> None:
        if row.rule is Rule.IS:
            row.pattern = place.word(PATTERNS, "pattern")
        elif row.rule is Rule.BRACKET:
            if place.is_object("from", "to"):
                if start := place.required("from"):
                    row.start = start.word(PATTERNS, "pattern")
                if to := place.required("to"):
                    row.to = to.word(PATTERNS, "pattern")
                if row.start == row.to and row.start:
                    place.problem("the two patterns must differ")
        elif row.rule in (Rule.RISES, Rule.FALLS):
            if not isinstance(place.value, bool) or not place.value:
                place.problem("must be true")
        elif row.rule is Rule.ONSET_EXPONENT:
            row.bound = place.number()
            if not row.bound > 0:
                place.problem("must be larger than 0")
        elif isinstance(place.value, dict):
            if place.is_object("run") and place.has("run"):
                row.bound_run = self.known_run(place.at("run"))
            else:
                place.problem('must be a number or {"run": NAME}')
        else:
            row.bound = place.number()
            if row.rule is Rule.IS_NEAR and place.is_number and row.bound == 0:
                place.problem("must not be 0, because the tolerance is relative")


def _is_unsigned(value: Any) -> bool:
    return isinstance(value, int) and not isinstance(value, bool) and value >= 0


def _seeds(place: JsonPlace) -> list[int]:
    found: list[int] = []
    for seed in place.list():
        if not _is_unsigned(seed.value):
            seed.problem("must be a whole number >= 0")
        elif seed.value in found:
            seed.problem("this seed is given twice")
        else:
            found.append(seed.value)
    return found


def _is_on_continuum(place: JsonPlace, otherwise: bool) -> bool:
    return place.at("side").word(["lattice", "continuum"], "side") == "continuum" if place.has("side") else otherwise
