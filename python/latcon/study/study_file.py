"""Reader of study files: runs of a parameter sweep, and claims about them (docs/reference-studies.md)."""
from __future__ import annotations

import dataclasses
import enum
import os
import re

from ..schema import SEED_ENTRY
from .program import InputError, Program
from .strict_json import JsonPlace, parse_json
from .sweep import Sweep, combinations, parse_sweep

Settings = dict[str, str]
"""Entries of a case with their values, in the order of their first occurrence."""

Change = tuple[Settings, list[int]]
"""Settings and seeds in an object of the file; empty if absent."""

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
        """True if the rule is about runs along an abscissa."""
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

    def override(self, settings: Settings) -> None:
        """Sets entries in all runs, whatever these set; raises InputError for entries that the study sweeps."""
        for key in settings:
            if key in self.swept:
                raise InputError(f"--set: {key} is also an entry of the sweep of {self.file}")
        self.settings |= settings
        for run in self.runs:
            run.own = {key: value for key, value in run.own.items() if key not in settings}
            run.all |= settings


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
        study.title = top.text_of("title", True)
        if base := top.required("base"):
            study.base = os.path.normpath(os.path.join(os.path.dirname(study.file), base.text() or "."))
        self.on_continuum = _is_on_continuum(top, False)
        self.whole = self.change(top)
        self.small: Change = ({}, [])
        quick = top.get("quick")
        if quick:
            quick.is_object("set", "seeds", "sweep", "refine")
            self.small = self.change(quick)
        study.settings = self.whole[0] | (self.small[0] if self.quick else {})
        self.sweeps(top.get("sweep"), quick.get("sweep") if quick else None)
        self.refinement(top, "")
        if quick:
            self.refinement(quick, " of the study")
        runs = top.get("runs") if top.get("sweep") else top.required("runs")
        if runs:
            for name, place in runs.members():
                self.run(name, place)
            if not study.runs and not self.problems:
                runs.problem("no run is left")
        if claims := top.get("claims"):
            for place in claims.list():
                self.claim(place)
        if pictures := top.get("pictures"):
            study.pictures = [self.known_run(place) for place in pictures.list()]
        if self.problems:
            raise InputError(*self.problems)
        return study

    def change(self, place: JsonPlace) -> Change:
        settings, seeds = place.get("set"), place.get("seeds")
        found: list[int] = []
        entries = self.settings(settings) if settings else {}
        for item in seeds.list() if seeds else ():
            if (seed := item.unsigned()) is None:
                item.problem("must be a whole number >= 0")
            elif seed in found:
                item.problem("this seed is given twice")
            else:
                found.append(seed)
        return entries, found

    def settings(self, place: JsonPlace) -> Settings:
        found = {}
        for key, value in place.members():
            if key not in self.program.entries:
                value.problem("not an entry of a case" + self.program.hint(key, self.program.sorted_entries))
            elif key == SEED_ENTRY:
                value.problem('is set by "seeds"')
            elif isinstance(value.value, str):
                found[key] = value.value  # empty: no numbers
            elif isinstance(value.value, (int, float)):
                found[key] = value.dump()
            else:
                value.problem("must be a text, a number, true or false")
        return found

    def run(self, name: str, place: JsonPlace) -> None:
        # With a seed and the ending of an unfinished file it has at most 255 letters.
        if not re.fullmatch(r"[A-Za-z0-9_-][A-Za-z0-9._-]{0,207}", name):
            place.problem("the name of a run must consist of at most 208 letters, digits, '.', '_' and '-', and must not begin with '.'")
        if name in self.names[:self.n_swept]:
            place.problem("a run of the sweep has this name")
        self.names.append(name)
        if not place.is_object("about", "side", "set", "seeds", "quick"):
            return
        about, on_continuum = place.text_of("about"), _is_on_continuum(place, self.on_continuum)
        own, quick = self.change(place), place.get("quick")
        small: Change = ({}, [])
        if quick and not isinstance(quick.value, bool) and quick.is_object("set", "seeds"):
            small = self.change(quick)
        if self.quick and quick and quick.value is False:
            self.study.left_out.append(name)
            return
        candidates = [small, self.small, own, self.whole] if self.quick else [own, self.whole]
        settings = own[0] | (small[0] if self.quick else {})
        self.study.runs.append(StudyRun(name, about, settings, self.study.settings | settings,
                                        next((seeds for _, seeds in candidates if seeds), [1]), on_continuum=on_continuum))

    def sweeps(self, whole: JsonPlace | None, quick: JsonPlace | None) -> None:
        """Adds a run per combination of values of this size, and the names of those of the full size."""
        if not whole:
            if quick:
                quick.problem("needs the key 'sweep' of the study")
            return
        seeds = self.whole[1] or [1]
        small_seeds = self.small[1] or seeds
        full = self.sweep(whole, len(seeds), not self.quick or not quick)
        small = self.sweep(quick, len(small_seeds), self.quick) if quick else full
        self.study.runs += [StudyRun(name, "", own, self.study.settings | own, small_seeds if self.quick else seeds, True,
                                     on_continuum=self.on_continuum) for name, own in (small if self.quick else full).items()]
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
        if not (place := of.get("refine")):
            return
        level = place.unsigned()
        if level is None or level > 6:  # spacings below a hundredth of the grid's
            place.problem("must be a whole number from 0 to 6")
        elif level > 0 and not self.study.swept:
            place.problem("needs the key 'sweep'" + owner)
        elif level > 0 and not self.is_continuous:
            place.problem("needs sweeps of numbers that are not whole")
        elif not owner or self.quick:
            self.study.refine = level

    def known_run(self, place: JsonPlace) -> str:
        return place.word(self.names, "run")

    def claim(self, place: JsonPlace) -> None:
        if place.is_object("claim", "paper", "rows", "note"):
            claim = StudyClaim(place.text_of("claim", True), place.text_of("paper"), place.text_of("note"))
            if rows := place.required("rows"):
                claim.rows = [self.row(row) for row in rows.list()]
            self.study.claims.append(claim)

    def row(self, place: JsonPlace) -> StudyRow:
        row = StudyRow(place.place)
        if not place.is_object("run", "runs", "quantity", "is", "is near", "tolerance", "above", "below", "rises", "falls",
                               "bracket", "onset exponent", "against", "quick"):
            return row
        one, several = place.get("run"), place.get("runs")
        if (one is None) == (several is None):
            place.problem('a row needs either "run" or "runs"')
        for run in [one] if one and not several else several.list() if several and not one else []:
            row.runs.append(self.known_run(run))
            if row.runs[-1] and row.runs.count(row.runs[-1]) > 1:
                run.problem(f"'{row.runs[-1]}' is given twice")
        if quantity := place.required("quantity"):
            row.quantity = quantity.word(["pattern", *self.program.units], "quantity")
            row.unit = self.program.units.get(row.quantity, "1")
        if against := place.get("against"):
            row.against = against.text()
            known = ["zeta", *self.program.sorted_entries]
            if row.against not in known:
                against.problem("must be zeta or an entry of a case" + self.program.hint(row.against, known))
            else:
                row.against_unit = "1" if row.against == "zeta" else self.program.entries[row.against].unit or ""
        self.rule(place, row)
        if (quick := place.get("quick")) and not quick.boolean() and self.quick:
            row.rule = Rule.REPORTED
        return row

    def rule(self, place: JsonPlace, row: StudyRow) -> None:
        for rule in sorted(Rule, key=lambda rule: rule.value):
            if rule is not Rule.REPORTED and (found := place.get(rule.value)):
                if row.rule is not Rule.REPORTED:
                    place.problem(f'a row can have only one rule; the second one is "{rule.value}"')
                row.rule = rule
                self.rule_value(found, row)
        of_patterns = row.rule in (Rule.IS, Rule.BRACKET)
        if row.rule is not Rule.REPORTED and row.quantity and of_patterns != (row.quantity == "pattern"):
            place.problem('this rule is only for the quantity "pattern"' if of_patterns
                          else "this rule is only for numbers, not for patterns")
        tolerance = place.get("tolerance")
        if bool(tolerance) != (row.rule in (Rule.IS_NEAR, Rule.ONSET_EXPONENT)):
            place.problem('"is near" or "onset exponent" and "tolerance" must be given together')
        elif tolerance:
            row.tolerance = self.positive(tolerance)
        if row.rule.is_along and not row.against:
            place.problem('this rule needs "against"')
        if row.rule.is_along and len(row.runs) == 1:
            place.problem("this rule needs two runs or more")

    def positive(self, place: JsonPlace) -> float:
        if not (number := place.number()) > 0:
            place.problem("must be larger than 0")
        return number

    def rule_value(self, place: JsonPlace, row: StudyRow) -> None:
        if row.rule is Rule.IS:
            row.pattern = place.word(PATTERNS, "pattern")
        elif row.rule is Rule.BRACKET:
            if place.is_object("from", "to"):
                row.start, row.to = (end.word(PATTERNS, "pattern") if (end := place.required(key)) else "" for key in ("from", "to"))
                if row.start == row.to and row.start:
                    place.problem("the two patterns must differ")
        elif row.rule in (Rule.RISES, Rule.FALLS):
            if place.value is not True:
                place.problem("must be true")
        elif row.rule is Rule.ONSET_EXPONENT:
            row.bound = self.positive(place)
        elif isinstance(place.value, dict):
            if place.is_object("run") and (run := place.get("run")):
                row.bound_run = self.known_run(run)
            else:
                place.problem('must be a number or {"run": NAME}')
        else:
            n_problems = len(self.problems)
            row.bound = place.number()
            if row.rule is Rule.IS_NEAR and row.bound == 0 and len(self.problems) == n_problems:
                place.problem("must not be 0, because the tolerance is relative")


def _is_on_continuum(place: JsonPlace, otherwise: bool) -> bool:
    return side.word(["lattice", "continuum"], "side") == "continuum" if (side := place.get("side")) else otherwise
