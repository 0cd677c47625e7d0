"""Commands of the program as functions that return the opened run."""
from __future__ import annotations

import os
import threading

from .case import Case
from .errors import Interrupted
from .folder import absolute
from .program import Process, Progress, run
from .results import Run, open_run

CaseLike = Case | str | os.PathLike[str]
Directory = str | os.PathLike[str]


def fracture(case: CaseLike, directory: Directory, *, threads: int | None = None, resume: bool = False,
             skip_verification: bool = False, report: bool = True, yes: bool = False, progress: Progress = True,
             side: str = "lattice") -> Run:
    """Verifies the material and the pre-stretch of a case, then runs its crack (``latcon fracture``).

    Parameters
    ----------
    case
        The case, or what :class:`Case` accepts.
    directory
        Output directory; created if needed. Files of earlier runs are moved to `earlier-run`, `earlier-run-2`, ... in it,
        unless `resume`.
    threads
        Threads; default: ``OMP_NUM_THREADS``, or all cores that this process may use.
    resume
        Whether to continue from the last checkpoint.
    skip_verification
        Whether to run the crack without verification; every output states it.
    report
        Whether to create pictures and `report.html`.
    yes
        Whether to run even if the program estimates more than ten days, or more memory than the machine has.
    progress
        True: a progress indicator on standard error, tqdm if it is installed. False: none. A function: called with each
        progress line of the program.
    side
        ``"lattice"`` or ``"continuum"``: what breaks, the latter the nonlocal continuum of the case.

    Returns
    -------
    Run
        The results.

    Raises
    ------
    BadInput, ClaimFailed, DidNotConverge, OutputFailed, InternalError
        If the program ends with exit code 2, 3, 4, 5, 1.
    Interrupted
        After Ctrl-C or another signal: a checkpoint and all results are written.
    """
    options = ["--side", side] + ["--skip-verification"] * skip_verification + ["--no-report"] * (not report)
    return _run("fracture", case, directory, threads, resume, yes, progress, options)


def lattice(case: CaseLike, directory: Directory, *, threads: int | None = None, resume: bool = False,
            yes: bool = False, progress: Progress = True) -> Run:
    """Computes the equilibrium or the motion of the unbroken lattice sheet (``latcon lattice``).

    Parameters, result and errors are those of :func:`fracture`.
    """
    return _run("lattice", case, directory, threads, resume, yes, progress)


def continuum(case: CaseLike, directory: Directory, *, threads: int | None = None, resume: bool = False,
              yes: bool = False, progress: Progress = True) -> Run:
    """Computes the equilibrium or the motion of the finite element sheet (``latcon continuum``).

    Parameters, result and errors are those of :func:`fracture`.
    """
    return _run("continuum", case, directory, threads, resume, yes, progress)


def start(case: CaseLike, directory: Directory, *, command: str = "fracture", threads: int | None = None, resume: bool = False,
          skip_verification: bool = False, report: bool = True, yes: bool = False) -> Job:
    """Starts a run in the background.

    Parameters
    ----------
    command
        ``"fracture"``, ``"lattice"`` or ``"continuum"``.
    case, directory, threads, resume, skip_verification, report, yes
        As in :func:`fracture`; `skip_verification` and `report` apply to cracks.

    Returns
    -------
    Job
        The run, which continues if Python ends.
    """
    options = ["--skip-verification"] * skip_verification + ["--no-report"] * (not report) if command == "fracture" else []
    return Job(Process(run_words(command, as_case(case), directory, threads, resume, yes, options), absolute(directory)))


class Job:
    """Run in the background, as :func:`start` returns it.

    Parameters
    ----------
    process
        The program.

    Attributes
    ----------
    directory : pathlib.Path
        Output directory.
    """

    def __init__(self, process: Process) -> None:
        self.directory = process.directory
        self._process = process
        self._reader = threading.Thread(target=process.follow, args=(lambda **update: None,), daemon=True)
        self._reader.start()

    @property
    def progress(self) -> str:
        """Last progress line; empty before the first."""
        return self._process.progress

    @property
    def is_running(self) -> bool:
        """True until the run has ended."""
        return self._process.is_running

    def wait(self, timeout: float | None = None) -> Run:
        """Waits for the end of the run, at most `timeout` [s], and returns its results. Ctrl-C ends the waiting, not the run.

        Raises
        ------
        TimeoutError
            If the run has not ended.
        ProgramError, Interrupted
            If the exit code of the program is not 0.
        """
        self._reader.join(timeout)
        if self._reader.is_alive():
            raise TimeoutError(f"{self.directory}: the run has not ended")
        self._process.end()
        return open_run(self.directory)

    def stop(self) -> Run:
        """Stops the run, which writes a checkpoint and its results, and returns them.

        Errors are those of :meth:`wait`, and UnreadableFile if it had not begun."""
        if self.is_running:
            self._process.interrupt()
        try:
            return self.wait()
        except Interrupted:
            return open_run(self.directory)


def verify(*claims: str, directory: Directory, case: CaseLike | None = None, quick: bool = False,
           threads: int | None = None, progress: Progress = True) -> Run:
    """Checks that lattice and continuum agree, claim by claim (``latcon verify``).

    Parameters
    ----------
    *claims
        Names of claims, such as ``"energy"`` (``latcon verify --help`` lists them); default: those not marked "only if named".
    directory
        Output directory.
    case
        Case whose material, loading and laws to verify; default: every law on the rubber of Fig. 1.
    quick
        Whether to use the small versions of the claims.
    threads, progress
        As in :func:`fracture`.

    Raises
    ------
    ClaimFailed
        If a quantity is outside its tolerance; ``latcon.open(directory).results`` has all rows.
    BadInput, DidNotConverge, OutputFailed, InternalError, Interrupted
        As in :func:`fracture`.
    """
    words = ["verify", *claims, *["--quick"] * quick]
    if case is not None:
        case = as_case(case)
        words += ["--case", os.fspath(case.file), *case.arguments()]
    run([*words, *common_words(directory, threads)], absolute(directory), progress)
    return open_run(directory)


def as_case(case: CaseLike) -> Case:
    """Returns a case, or that of a file."""
    return case if isinstance(case, Case) else Case(case)


def _run(command: str, case: CaseLike, directory: Directory, threads: int | None, resume: bool, yes: bool, progress: Progress,
         options: list[str] | None = None) -> Run:
    run(run_words(command, as_case(case), directory, threads, resume, yes, options or []), absolute(directory), progress)
    return open_run(directory)


def run_words(command: str, case: Case, directory: Directory, threads: int | None, resume: bool, yes: bool, options: list[str]
              ) -> list[str]:
    """Returns the words of a command of the program that runs a case."""
    return [command, os.fspath(case.file), *case.arguments(), *options, *["--resume"] * resume, *["--yes"] * yes,
            *common_words(directory, threads)]


def common_words(directory: Directory, threads: int | None) -> list[str]:
    """Returns the options of all commands that run."""
    return ["--output-dir", os.fspath(absolute(directory)), *([] if threads is None else ["--threads", str(threads)])]
