"""Study that a user asks for: a file, a shipped one, or a sweep on the command line."""
from __future__ import annotations

import dataclasses
import json
import os
import pathlib
from collections.abc import Mapping
from typing import Any

from .plan import Verification, parse_settings
from .service import InputError, Service
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
    kept: dict[str, str] = dataclasses.field(default_factory=dict)

    def write_sweep(self, service: Service) -> None:
        """Writes the files of a sweep into the existing output directory, which this process has locked, unless they exist."""
        for file, text in self.kept.items():
            if not os.path.exists(file):
                service.ask("keep", file=file, text=text)


def read_requested_study(service: Service, options: Mapping[str, Any]) -> RequestedStudy:
    """Reads the study, or the case of a sweep.

    Raises
    ------
    InputError
        Also if the output directory has the files of another sweep.
    """
    if options["sweeps"]:
        return _read_sweep(service, options)
    if options["seeds"]:
        raise InputError("--seeds is an option of --sweep; a study file lists its seeds")
    studies = service.ask("studies")
    file = options["study"]
    if file in studies and not os.path.exists(file):
        file = studies[file]
    problem = service.ask("read", file=file)["problem"]
    if problem:
        shipped = f", or a shipped one: {', '.join(studies)}" if studies else ""
        raise InputError(f"{service.printable(file)}: cannot read the study: {problem}; give a study file (.json){shipped}")
    study = read_study(service, file, options["quick"])
    service.ask("base", case=study.base)
    return RequestedStudy(study, parse_settings(service, options["overrides"]), file)


def _read_sweep(service: Service, options: Mapping[str, Any]) -> RequestedStudy:
    base = service.ask("base", case=options["study"], is_shipped_name=True)
    name = base["file"]
    if base["problem"]:
        raise InputError(f"{service.printable(name)}: cannot read the case of --sweep: {base['problem']}{base['hint']}")
    copy = "base.json" if name.endswith(".json") else "base.prm"
    file, base_file = (os.path.join(options["output_dir"], part) for part in (SWEEP_FILE, copy))
    text = sweep_study(service, options["sweeps"], pathlib.PurePath(name).stem, copy,
                       parse_settings(service, options["overrides"]), options["seeds"])
    study = read_study(service, file, options["quick"], text)
    study.base = name  # for messages
    requested = RequestedStudy(study, {}, file, {base_file: base["text"], file: text})
    # Files that the user may have edited are not replaced.
    for path, other in ((file, "this sweep"), (base_file, name)):
        if os.path.exists(path) and service.ask("read", file=path)["text"] != requested.kept[path]:
            stored = os.path.join(os.path.dirname(path), SWEEP_FILE)
            raise InputError(f"{path} differs from {other}; to run the stored sweep: latcon study {stored}; for another one choose "
                             "another --output-dir")
    return requested


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


def require_folder_of(service: Service, study: Study, directory: str) -> None:
    """Refuses an output directory with the results of another study."""
    for file, key in (("study.json", "title"), ("run.json", "study"), (PLAN_FILE, "study")):
        try:
            document = json.loads(service.ask("read", file=os.path.join(directory, file))["text"])
        except ValueError:
            continue
        title = document.get(key) if isinstance(document, dict) else None
        if isinstance(title, str) and title != study.title:
            raise InputError(f"{directory} has the results of another study, '{service.printable(title)}'; choose another folder "
                             "(--output-dir)")
