"""Study that a user asks for: a file, a shipped one, or a sweep on the command line."""
from __future__ import annotations

import dataclasses
import json
import os
import pathlib
from collections.abc import Mapping
from typing import Any

from ..folder import write_atomically
from .plan import Verification, parse_settings
from .program import InputError, Program, printable, read_input
from .shard import PLAN_FILE
from .study_file import Settings, Study, read_study
from .sweep import sweep_study

SWEEP_FILE = "sweep.json"
"""Study file that a sweep leaves in its output directory."""


@dataclasses.dataclass
class RequestedStudy:
    """Study with its base case, read but not planned.

    Attributes
    ----------
    overrides : dict
        Of ``--set``; none for a sweep, whose study file contains them.
    file : str
        Study file.
    kept : dict
        Texts of the files of a sweep by path, not written yet: the study file, and the copy of its case.
    """

    study: Study
    overrides: Settings
    file: str
    kept: dict[str, bytes] = dataclasses.field(default_factory=dict)

    def write_sweep(self) -> None:
        """Writes the files of a sweep into the existing output directory, which this process has locked, unless they exist."""
        for file, text in self.kept.items():
            if not os.path.exists(file):
                write_atomically(file, text)


def read_requested_study(program: Program, options: Mapping[str, Any]) -> RequestedStudy:
    """Reads the study, or the case of a sweep.

    Raises
    ------
    InputError
        Also if the output directory has the files of another sweep.
    """
    if options["sweeps"]:
        return _read_sweep(program, options)
    if options["seeds"]:
        raise InputError("--seeds is an option of --sweep; a study file lists its seeds")
    studies = program.shipped("studies", ".json")
    file = options["study"]
    if file in studies and not os.path.exists(file):
        file = studies[file]
    text, problem = read_input(file)
    if problem:
        shipped = f", or a shipped one: {', '.join(studies)}" if studies else ""
        raise InputError(f"{printable(file)}: cannot read the study: {problem}; give a study file (.json){shipped}")
    study = read_study(program, file, options["quick"], text)
    program.ask(base=os.fsencode(_case_path(program, study.base)).hex())
    return RequestedStudy(study, parse_settings(options["overrides"]), file)


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
    requested = RequestedStudy(study, {}, file, {base_file: base, file: text})
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
        try:
            document = json.loads(read_input(os.path.join(directory, file))[0])
        except ValueError:
            continue
        title = document.get(key) if isinstance(document, dict) else None
        if isinstance(title, str) and title != study.title:
            raise InputError(f"{directory} has the results of another study, '{printable(title)}'; choose another folder "
                             "(--output-dir)")
