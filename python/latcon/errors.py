"""Exceptions of the package. Those of a run contain the program's message and exit code."""
from __future__ import annotations

import importlib
import os
import pathlib
from typing import Any

DONE, INTERNAL_ERROR, BAD_INPUT, CLAIM_FAILED, SOLVER_FAILED, OUTPUT_FAILED, INTERRUPTED = 0, 1, 2, 3, 4, 5, 130
"""Exit codes of the program."""

PACKAGES_MISSING = 69
"""Exit code of `report/__main__.py`, which has named the packages."""


class LatconError(Exception):
    """Base class of all errors of this package except :class:`Interrupted`."""


class ProgramNotFound(LatconError):
    """The program ``latcon`` was not found."""


class UnreadableFile(LatconError):
    """A file of a run is missing or damaged.

    Parameters
    ----------
    path
        The file.
    problem
        What is wrong with it.
    """

    def __init__(self, path: str | os.PathLike[str], problem: str) -> None:
        super().__init__(path, problem)  # all arguments, with which pickle makes it again
        self.path = pathlib.Path(path)
        self.problem = problem

    def __str__(self) -> str:
        return f"{self.path}: {self.problem}"


def optional_package(module: str, purpose: str, package: str) -> Any:
    """Imports a module of a package that not every user has; otherwise raises LatconError with the name of the package."""
    try:
        return importlib.import_module(module)
    except ImportError as error:
        raise LatconError(f"{purpose} the Python package {package}: {error}") from error


class _EndOfProgram(BaseException):
    """Message, exit code and output directory of a program that ended with a non-zero exit code."""

    def __init__(self, message: str, exit_code: int, directory: pathlib.Path | None = None) -> None:
        super().__init__(message, exit_code, directory)
        self.message = message
        self.exit_code = exit_code
        self.directory = directory

    def __str__(self) -> str:
        return self.message


class ProgramError(_EndOfProgram, LatconError):
    """The program ended with an error.

    Attributes
    ----------
    message : str
        The program's message, without the leading program name.
    exit_code : int
        Exit status; negative: number of the signal that killed the program.
    directory : pathlib.Path or None
        Output directory of the run. It holds all results up to the error.
    """


class InternalError(ProgramError):
    """A defect of latcon itself (exit code 1)."""


class BadInput(ProgramError, ValueError):
    """A case, an option or an input file is wrong, or the output directory is in use (exit code 2)."""


class UnknownEntry(BadInput, KeyError):
    """A key is not an entry of a case; the message names the nearest known one."""


class ClaimFailed(ProgramError):
    """A checked quantity is outside its tolerance (exit code 3)."""


class DidNotConverge(ProgramError):
    """A solver did not converge, or the state blew up (exit code 4)."""


class OutputFailed(ProgramError):
    """A file could not be written (exit code 5)."""


class Interrupted(_EndOfProgram, KeyboardInterrupt):
    """The run was stopped by Ctrl-C or another signal, with its results written (exit code 130; negative: killed before that).

    A subclass of :class:`KeyboardInterrupt` and not of :class:`LatconError`: a loop over runs that continues after errors
    stops at Ctrl-C. Has the attributes of :class:`ProgramError`. ``resume=True`` continues the run.
    """


_BY_EXIT_CODE: dict[int, type[ProgramError] | type[Interrupted]] = {
    INTERNAL_ERROR: InternalError, BAD_INPUT: BadInput, CLAIM_FAILED: ClaimFailed, SOLVER_FAILED: DidNotConverge,
    OUTPUT_FAILED: OutputFailed, INTERRUPTED: Interrupted}


def error_of(exit_code: int, message: str, directory: pathlib.Path | None = None) -> ProgramError | Interrupted:
    """Returns the exception for an exit code of the program."""
    return _BY_EXIT_CODE.get(exit_code, ProgramError)(message, exit_code, directory)
