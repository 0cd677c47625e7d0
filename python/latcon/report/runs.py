"""Reader of the runs in a folder: their checks and measurements, the last frame of a sheet, and those of its motion."""
from collections import namedtuple
from dataclasses import dataclass
from pathlib import Path

from ..errors import INTERRUPTED, UnreadableFile
from ..files import checked_number, if_present, read_columns, read_json, read_rows, read_series, read_text
from ..folder import EARLIER
from ..frames import Frame, read_frame
from ..rows import ratio_to_tolerance, verdict
from .claim_plots import read_claim_tables
from .raster import Mesh

# A folder with any of these files is the output directory of a run, complete or interrupted.
SIGNS_OF_A_RUN = ("results.json", "run.json", "crack.json", "crack.csv", "lattice.pvd")
# Numbers of crack.json that the page shows, None where they were not measured.
CRACK_NUMBERS = (*(name + ending for name in ("speed_lagrangian", "speed_laboratory", "wavelength", "amplitude")
                   for ending in ("", "_uncertainty")), "window_begin", "window_end",
                 "sinusoid_offset", "sinusoid_slope", "sinusoid_phase")
# First columns of energy.csv of an equilibrium and of a motion of the continuum.
CONTINUUM_ENERGIES = ("load_factor,", "t,elastic,kinetic,micro_inertia,")


@dataclass(frozen=True)
class Check:
    """Row of results.json. Values that do not apply are None."""

    claim: str
    quantity: str
    unit: str  # of lattice, continuum and theory; "1" for a pure number
    lattice: float
    continuum: float
    theory: float  # closed formula, or, in the claim "fracture", the published value
    error: float  # as the claim defines it, smaller is better
    tolerance: float  # None: for information only
    verdict: str  # "holds", "fails" or "reported"
    verified: bool = True  # whether the material of the run was verified

    @property
    def kind(self):
        """CSS class: rows of an unverified run are not shown as holding."""
        return "warns" if self.verdict == "holds" and not self.verified else self.verdict

    @property
    def word(self):
        """The verdict in words."""
        return "holds, not verified" if self.kind == "warns" else self.verdict

    @property
    def ratio(self):
        """Error over tolerance; None without a tolerance, infinite if a given number is not finite."""
        return ratio_to_tolerance(self.error, self.tolerance, (self.lattice, self.continuum, self.theory))


@dataclass(frozen=True)
class Run:
    """Contents of the output directory of a run. Missing parts are None."""

    name: str
    folder: Path
    checks: list  # of Check; empty without results.json
    has_results: bool
    info: dict  # run.json
    case_text: str  # case.prm
    crack: dict  # crack.json, SI units
    near_tip: dict  # near_tip.json, SI units
    tip: dict  # crack.csv: t [s], X, Y [m] in the undeformed sheet
    broken: dict  # broken_bonds.csv: t [s], the two sites, X, Y [m] in the undeformed sheet
    energy: dict  # energy.csv of a motion of the lattice: t [s], the rest in J per metre of sheet thickness
    claims: dict  # claims.json: {name: (title, statement)}, in the order in which they are checked; empty without it
    tables: dict  # of the claims, {file name without ".csv": {column: array}}; those that exist
    skipped_verification: bool  # whether the crack was run without checking the claims for its material

    @property
    def is_fracture(self):
        """True if a crack was run, or at least started."""
        return self.crack is not None or has_rows(self.tip) or any(c.claim == "fracture" for c in self.checks)

    @property
    def on_continuum(self):
        """True if the crack ran through the nonlocal continuum."""
        return (self.info or {}).get("side") == "continuum"

    @property
    def state(self):
        """State of the run: "complete", "interrupted" or "unfinished"."""
        exit_code = (self.info or {"exit_code": 0}).get("exit_code")
        if exit_code == INTERRUPTED:
            return "interrupted"
        return "complete" if self.has_results and exit_code is not None else "unfinished"

    def input_number(self, key):
        """Value of an entry of the case, SI unit, as run.json records it; None if it is missing or not a number."""
        try:
            return float((self.info or {})["entries"][key])
        except (KeyError, ValueError):
            return None


# A run that cannot be read: the file and what is wrong with it.
Unreadable = namedtuple("Unreadable", "name problem")


def has_rows(table, at_least=1):
    """Returns whether a table was read and has at least `at_least` rows."""
    return table is not None and len(table["t"]) >= at_least


def find_runs(folder):
    """Finds the runs in `folder` and in its sub-folders, runs without a crack first, and the runs that cannot be read.

    Studies have their own page and are omitted if there are other runs.
    @return (list of Run, list of Unreadable)
    """
    try:
        candidates = [folder] + sorted(path for path in folder.iterdir()
                                       if path.is_dir() and not path.name.startswith(EARLIER))
        candidates = [path for path in candidates if any((path / sign).exists() for sign in SIGNS_OF_A_RUN)]
    except OSError as error:
        raise UnreadableFile(folder, error.strerror) from error
    if not candidates:
        raise UnreadableFile(folder, "no run found (no results.json here or in a sub-folder)")
    plain = [path for path in candidates if not (path / "study.json").exists()]
    runs, unreadable = [], []
    for path in plain or candidates:
        try:
            runs.append(read_run(path))
        except UnreadableFile as error:
            unreadable.append(Unreadable(path.resolve().name, str(error)))
    return sorted(runs, key=lambda run: run.is_fracture), unreadable


def read_run(folder):
    """Reads all files of a run except its fields. The verdicts of rows must follow from their numbers."""
    results = folder / "results.json"
    rows, info = if_present(read_rows, results), if_present(read_json, folder / "run.json")
    crack = read_numbers(folder / "crack.json", "pattern", CRACK_NUMBERS)
    skipped = any((document or {}).get("skip_verification") for document in (info, crack))
    checks = [Check(**row, verified=not skipped) for row in rows or []]
    for number, check in enumerate(checks, start=1):
        if check.verdict != verdict(check.ratio):
            raise UnreadableFile(results, f"row {number} of \"claims\": the verdict {check.verdict!r} contradicts its numbers")
    return Run(
        name=folder.resolve().name,
        folder=folder,
        checks=checks,
        has_results=rows is not None,
        info=info,
        case_text=if_present(read_text, folder / "case.prm"),
        crack=crack,
        near_tip=read_numbers(folder / "near_tip.json", "reason"),
        tip=if_present(read_columns, folder / "crack.csv", ("t", "X", "Y")),
        broken=if_present(read_columns, folder / "broken_bonds.csv", ("t", "site", "other_site", "X", "Y")),
        energy=read_energy(folder / "energy.csv"),
        claims=read_claims(folder / "claims.json"),
        tables=read_claim_tables(folder),
        skipped_verification=skipped,
    )


def read_energy(path):
    """Reads energy.csv of a motion of sites. None if there is none, or for the two forms written by the finite elements
    (docs/reference-files.md), which have other columns."""
    text = if_present(read_text, path)
    if text is None or text.startswith(CONTINUUM_ENERGIES):
        return None
    return if_present(read_columns, path, ("t", "elastic", "kinetic", "viscous", "broken", "boundary_work", "contact", "imbalance"))


def read_claims(path):
    """Titles and statements in claims.json."""
    claims = (if_present(read_json, path) or {"claims": []}).get("claims")
    try:
        return {claim["name"]: (str(claim["title"]), str(claim["statement"])) for claim in claims}
    except (KeyError, TypeError) as error:
        raise UnreadableFile(path, f"holds no list of claims with name, title and statement: {error!r}") from error


def read_numbers(path, text, names=None):
    """Reads crack.json or near_tip.json, which must have a text, and checks some numbers or all; None if there is none."""
    found = if_present(read_json, path)
    if found is None:
        return None
    if not isinstance(found.get(text), str):
        raise UnreadableFile(path, f'"{text}" is missing')
    names = [name for name in found if name not in (text, "units")] if names is None else names
    return found | {name: checked_number(path, name, found.get(name)) for name in names}


FIELDS = ("displacement", "stretch", "velocity", "cauchy_stress", "damage", "site")  # that pictures show


@dataclass(frozen=True)
class Motion:
    """A sheet in motion; sites are numbered as in the frames."""

    mesh: Mesh
    whole: Frame  # first full frame, with bonds
    frames: list  # of Frame, without bonds


def read_last_frame(folder):
    """Reads the last existing frame of points and lines listed in lattice.pvd; None if there is none."""
    found = [(path, time) for time, path in if_present(read_series, folder / "lattice.pvd") or []
             if path.suffix == ".vtp" and path.exists()]
    return read_sheet(*found[-1]) if found else None


def read_sheet(path, time):
    """Reads a frame with its bonds."""
    frame = read_frame(path, time, FIELDS)
    if not len(frame.bonds):
        raise UnreadableFile(path, "truncated, or without bonds")
    return frame


def read_motion(run):
    """Reads the frames listed in motion.pvd of a run; None for fewer than two, or without the table of broken bonds."""
    frames = [(time, path) for time, path in if_present(read_series, run.folder / "motion.pvd") or [] if path.exists()]
    sheets = if_present(read_series, run.folder / "lattice.pvd")
    if len(frames) < 2 or not sheets or not sheets[0][1].exists() or run.broken is None:
        return None
    whole = read_sheet(sheets[0][1], sheets[0][0])
    mesh = Mesh(whole, run.broken)
    motion = Motion(mesh, whole, [])
    for time, path in frames:
        motion.frames.append(read_frame(path, time, FIELDS))
        if "velocity" not in motion.frames[-1].fields or len(motion.frames[-1].position) <= mesh.bonds.max(initial=0):
            raise UnreadableFile(path, "not a frame of the motion of this sheet: velocities or sites are missing")
    return motion
