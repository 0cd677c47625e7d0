"""Study that a user asks for (a file, a shipped one, or a sweep on the command line), its resolved runs, and its shares.

All cases are checked before the first run starts.
"""
from __future__ import annotations

import contextlib
import dataclasses
import enum
import json
import math
import os
import pathlib
import re
from collections.abc import Mapping, Sequence
from typing import Any

from ..files import object_in
from ..folder import write_atomically
from ..schema import SEED_ENTRY
from .program import InputError, Program, printable, read_input
from .study_file import Settings, Study, StudyRun, read_study
from .sweep import sweep_study


class Verification(enum.Enum):
    """Cases of a study whose claims are checked before its cracks run."""

    NONE = "none (--skip-verification)"
    BASE_CASE = "material and pre-stretch of the base case alone (--quick)"
    EVERY_RUN = "material and pre-stretch of every run"


@dataclasses.dataclass(frozen=True, slots=True)
class PlannedRun:
    """Fracture run: a case with one seed. Seeds of a run share `changes` and `values`.

    `changes` are ``Section/Name=value`` without the seed, `values` those of the entries that the study varies or compares:
    numbers in SI units, or texts. `case_sha256` is that of all entries and their values. `spacing` is d [m]; `zeta` the
    retardation time of the bonds over the travel time of a wave over one spacing [-], None for linear bonds. `size` is the
    number of sites or cells, `evaluations` that of force evaluations, `seconds` the estimated time on one core [s], `memory`
    estimated [bytes].
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


def base_text(program: Program, study: Study) -> str:
    """Returns the text of the base case, for claims that are checked on it alone."""
    changes = [f"{key}={value}" for key, value in study.settings.items()]
    return program.ask(changes=changes, seeds=[], checks_laws=True, wants_text=True)


_OF_ZETA = ("Nearest neighbours/law", "Nearest neighbours/a", "Nearest neighbours/viscosity", "Material/density", "Sheet/spacing")


def zeta_of(values: Mapping[str, Any]) -> float | None:
    """Returns zeta = (eta / a) / (d / sqrt(a / rho)), theory.md, eq. (L.5), for values of entries; None for linear bonds."""
    law, a, viscosity, density, spacing = (_value(values[key]) for key in _OF_ZETA)
    return viscosity / a * math.sqrt(a / density) / spacing if law == "mooney-rivlin" and a > 0 else None


def _value(text: Any) -> Any:
    """Returns the value of an entry: a number or, if it is none, its text."""
    with contextlib.suppress(ValueError):
        if math.isfinite(number := float(text)):
            return number
    return text


def plan_runs(program: Program, study: Study, verification: Verification, added: Sequence[StudyRun] | None = None) -> list[PlannedRun]:
    """Returns the runs of a study, or those `added` to it, with all their seeds, in their order, with the first and the last frame alone.

    Raises InputError with the problems of all cases and of rows whose `against` is not a number in any of their runs.
    """
    keys = {key for run in study.runs for key in run.own} | set(study.swept)
    keys |= {row.against for claim in study.claims for row in claim.rows if row.against}
    keys -= {"zeta"}
    frames = {"Output/frame interval": "0", "Output/motion frames": "0"}
    runs: list[PlannedRun] = []
    problems: list[str] = []
    for run in study.runs if added is None else added:
        changes = [f"{key}={value}" for key, value in (run.all | frames).items()]
        try:
            reply = program.ask(changes=changes, seeds=run.seeds, on_continuum=run.on_continuum, keys=sorted(keys | set(_OF_ZETA)),
                                checks_laws=verification is Verification.EVERY_RUN, wants_text=False)
        except InputError as error:
            # A problem of the base case occurs in every run: report it once.
            problems += [f"{study.file}: runs/{run.name}: {problem}" for problem in error.args
                         if not any(known.endswith(": " + problem) for known in problems)]
        if not problems:
            digests, values = reply.pop("sha256"), {key: _value(text) for key, text in reply.pop("values").items()}
            runs += [PlannedRun(run.name, seed, run.on_continuum, changes, {key: values[key] for key in sorted(keys)}, digest,
                                zeta=zeta_of(values), **reply)
                     for seed, digest in zip(run.seeds, digests)]
    if not problems and added is None:
        problems = [f"{row.place}/against: {row.against} is not a number in any of these runs"
                    for claim in study.claims for row in claim.rows
                    if row.against and not set(row.runs) <= set(study.left_out)
                    and not any(run.run in row.runs and run.value(row.against) is not None for run in runs)]
    if problems:
        raise InputError(*problems)
    if verification is Verification.BASE_CASE:
        base_text(program, study)
    return runs


SWEEP_FILE, PLAN_FILE = "sweep.json", "plan.json"
"""Study file that a sweep leaves in its output directory, and the plan there that the shards of a study share."""


def default_folder(study: str, is_sweep: bool) -> str:
    """Default output directory of a study; of the study file that a sweep wrote beside a copy of its case, its own folder."""
    folder, name = os.path.split(study)
    if name == SWEEP_FILE and any(os.path.exists(os.path.join(folder, base)) for base in ("base.prm", "base.json")):
        return folder or os.getcwd()
    return f"output/{os.path.splitext(name)[0]}{'-sweep' if is_sweep else ''}"


@dataclasses.dataclass
class RequestedStudy:
    """Study with its base case, read but not planned.

    `file` is the study file. `kept` are the texts of the files of a sweep by path, not written yet: the study file, and the
    copy of its case.
    """

    study: Study
    file: str
    kept: dict[str, bytes] = dataclasses.field(default_factory=dict)

    def write_sweep(self) -> None:
        """Writes the files of a sweep into the existing output directory, which this process has locked, unless they exist."""
        for file, text in self.kept.items():
            if not os.path.exists(file):
                write_atomically(file, text)


def read_requested_study(program: Program, options: Mapping[str, Any]) -> RequestedStudy:
    """Reads the study, or the case of a sweep; raises InputError also if the output directory has the files of another sweep."""
    if options["sweeps"]:
        return _read_sweep(program, options)
    if options["seeds"]:
        raise InputError("--seeds is an option of --sweep; a study file lists its seeds")
    studies = program.shipped("studies", ".json")
    file = options["study"]
    if file in studies and not os.path.isfile(file):
        file = studies[file]
    text, problem = read_input(file)
    if problem:
        shipped = f", or a shipped one: {', '.join(studies)}" if studies else ""
        raise InputError(f"{printable(file)}: cannot read the study: {problem}; give a study file (.json){shipped}")
    study = read_study(program, file, options["quick"], text)
    program.ask(base=os.fsencode(_case_path(program, study.base)).hex())
    study.override(parse_settings(options["overrides"]))
    return RequestedStudy(study, file)


def _read_sweep(program: Program, options: Mapping[str, Any]) -> RequestedStudy:
    name = _case_path(program, options["study"])
    base, problem = read_input(name)
    if problem:
        shipped = program.shipped("cases", ".prm")
        nearest = program.ask(nearest=printable(pathlib.PurePath(name).stem), known=list(shipped))
        hint = f"; nearest shipped case: {nearest}" if nearest else f"; shipped cases: {', '.join(shipped)}" if shipped else ""
        raise InputError(f"{printable(name)}: cannot read the case of --sweep: {problem}{hint}")
    program.ask(base=os.fsencode(name).hex())
    copy = "base.json" if name.endswith(".json") else "base.prm"
    file, base_file = (os.path.join(options["output_dir"], part) for part in (SWEEP_FILE, copy))
    text = sweep_study(program, options["sweeps"], pathlib.PurePath(name).stem, copy,
                       parse_settings(options["overrides"]), options["seeds"]).encode("utf-8", "replace")
    study = read_study(program, file, options["quick"], text)
    study.base = name  # for messages
    requested = RequestedStudy(study, file, {base_file: base, file: text})
    # Files that the user may have edited are not replaced.
    for path, other in ((file, "this sweep"), (base_file, name)):
        if os.path.exists(path) and read_input(path)[0] != requested.kept[path]:
            stored = os.path.join(os.path.dirname(path), SWEEP_FILE)
            raise InputError(f"{path} differs from {other}; to run the stored sweep: latcon study {stored}; for another one choose "
                             "another --output-dir")
    return requested


def _case_path(program: Program, name: str) -> str:
    """Returns the file of a shipped case, unless there is a file of this name; a folder is no case."""
    return name if os.path.exists(name) and not os.path.isdir(name) else program.shipped("cases", ".prm").get(name, name)


def verification_of(options: Mapping[str, Any]) -> Verification:
    """Returns the cases whose claims the study checks, as chosen by --quick and --skip-verification."""
    if options["skip_verification"]:
        return Verification.NONE
    return Verification.BASE_CASE if options["quick"] else Verification.EVERY_RUN


def require_no_refinement(study: Study) -> None:
    """Refuses a study whose runs depend on the outcomes of others, and that cannot run in shards therefore."""
    if study.refine:
        raise InputError(f"{study.file}: refine = {study.refine}: a refined study does not run in shards, because its points depend "
                         "on the patterns of others; allowed: 0, or latcon study without --shard and --collect")


def require_folder_of(study: Study, directory: str) -> None:
    """Refuses an output directory with the results of another study."""
    for file, key in (("study.json", "title"), ("run.json", "study"), (PLAN_FILE, "study")):
        title = object_in(os.path.join(directory, file)).get(key)
        if isinstance(title, str) and title != study.title:
            raise InputError(f"{directory} has the results of another study, '{printable(title)}'; choose another folder "
                             "(--output-dir)")


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
    return sorted(range(len(plan)), key=lambda i: -plan[i].seconds)[index - 1::count]


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
