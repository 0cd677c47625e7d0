"""Steps the crack of a case from Python, with the lattice in this process.

Needs the module ``latcon_stepping``, which a build with ``-DLATCON_STEPPING=ON`` puts beside the program.
"""
from __future__ import annotations

import functools
import importlib.machinery
import importlib.util
import os
from collections.abc import Callable
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from .commands import CaseLike, as_case
from .errors import LatconError
from .folder import write_atomically
from .frames import Floats, Frame, write_frame
from .program import find_program

Forces = Callable[["Simulation"], ArrayLike]
"""Function that returns forces on all sites, shape (sites, 2), per sheet thickness [N/m]."""


class Simulation:
    """Sheet of a case with its seed crack, at the start or as a checkpoint holds it; the steps are those of ``latcon fracture``.

    Parameters
    ----------
    case
        The case, or what :class:`latcon.Case` accepts.
    checkpoint
        File that :meth:`checkpoint` wrote with the same case, side and program.
    side
        "lattice", or "continuum" for the nonlocal continuum of the case.

    Attributes
    ----------
    case : Case
        The case.
    sites : ndarray of int
        Places of the sites in the fields of the lattice, `x`, `y`, `vx`, `vy`: ``sim.x[sim.sites]`` are the positions x.
    reference : ndarray, shape (sites, 2)
        Undeformed positions X, Y [m].
    broken : list of tuple
        Bonds that broke in steps of this object: time [s], places of both ends, X, Y of the undeformed midpoint [m], stretch.

    Raises
    ------
    BadInput, ValueError
        If the case or the checkpoint is wrong.
    LatconError
        If the module is missing.
    """

    def __init__(self, case: CaseLike, checkpoint: str | os.PathLike[str] | None = None,
                 side: str = "lattice") -> None:
        if side not in ("lattice", "continuum"):
            raise ValueError(f"side must be lattice or continuum, not {side!r}")
        self.case = as_case(case)
        self._sheet = _module().Sheet(self.case.text(), side == "continuum")
        if checkpoint is not None:
            try:
                open(checkpoint, "rb").close()  # the reason of the system
                self._sheet.load(os.fspath(checkpoint))
            except (OSError, ValueError) as error:
                raise ValueError(f"{os.fspath(checkpoint)}: {getattr(error, 'strerror', error)}") from error
        self.sites = self._sheet.sites()
        self.reference: Floats = self._sheet.reference()[self.sites]
        self.broken: list[tuple[float, int, int, float, float, float]] = []

    def step(self, count: int = 1, forces: Forces | None = None) -> None:
        """Advances by time steps.

        Parameters
        ----------
        count
            Number of steps.
        forces
            Forces of your own, evaluated before each step, whose impulse over the step is added to the velocities then; the change
            of kinetic energy counts as boundary work.
        """
        if forces is None:
            self.broken += self._sheet.step(count)
            return
        for _ in range(count):
            impulse = np.zeros((len(self.x), 2))
            impulse[self.sites] = self.time_step * np.asarray(forces(self))
            self._sheet.kick(*impulse.T)
            self.broken += self._sheet.step(1)

    def move_edges(self, velocity_gradient: ArrayLike) -> None:
        """Moves the held edges with v = L X from here on; L is a 2 by 2 matrix [1/s], 0 to stop them.

        A checkpoint holds no L: call this again after one is loaded.
        """
        self._sheet.move_edges(np.broadcast_to(np.asarray(velocity_gradient, float), (2, 2)))

    @property
    def time(self) -> float:
        """Time t [s]."""
        return self._sheet.time

    @property
    def time_step(self) -> float:
        """Time step [s]."""
        return self._sheet.time_step

    @property
    def x(self) -> Floats:
        """Current positions x of all places [m]: a view of the memory of the lattice, which changes with each step. Read-only."""
        return self._sheet.x

    @property
    def y(self) -> Floats:
        """Current positions y, likewise."""
        return self._sheet.y

    @property
    def vx(self) -> Floats:
        """Velocities along x [m/s], likewise."""
        return self._sheet.vx

    @property
    def vy(self) -> Floats:
        """Velocities along y, likewise."""
        return self._sheet.vy

    @property
    def bonds(self) -> np.ndarray[Any, np.dtype[np.int64]]:
        """Sites at the ends of each unbroken bond, as rows of `reference`, shape (bonds, 2)."""
        return self._index(self._sheet.bonds()[0])

    @property
    def tip(self) -> tuple[float, float] | None:
        """Undeformed position of the crack tip [m]; None before a bond broke."""
        if (place := self._sheet.tip) is None:
            return None
        X, Y = self.reference[self._index(place)]
        return float(X), float(Y)

    @property
    def energies(self) -> dict[str, float]:
        """Energies per sheet thickness [J/m], as the columns of `energy.csv`."""
        return self._sheet.energies

    def frame(self) -> Frame:
        """Copies the sheet at this time."""
        ends, stretch = self._sheet.bonds()
        position = np.column_stack((self.x, self.y))[self.sites]
        fields = {"displacement": position - self.reference, "velocity": np.column_stack((self.vx, self.vy))[self.sites],
                  "lost_bonds": self._sheet.lost_bonds[self.sites].astype(np.int64)}
        return Frame(self.time, self.reference, position, self._index(ends), stretch, fields, {"stretch": stretch},
                     {"displacement": "m", "velocity": "m/s"})

    def write_frame(self, path: str | os.PathLike[str]) -> None:
        """Writes the sheet at this time as a `.vtp` file, for ParaView."""
        write_frame(path, self.frame())

    def checkpoint(self, path: str | os.PathLike[str]) -> None:
        """Writes the state, from which a simulation of the same case by the same program continues with the same bits (HDF5)."""
        write_atomically(os.fspath(path), self._sheet.save())

    def _index(self, places: Any) -> Any:
        return np.searchsorted(self.sites, places)


@functools.cache
def _module() -> Any:
    program = find_program()
    # OpenMP reads it while it is loaded with the module; the reason and the number are those of verification/main.cc.
    if not os.environ.keys() & {"OMP_WAIT_POLICY", "GOMP_SPINCOUNT"}:
        os.environ["GOMP_SPINCOUNT"] = "20000"
    for folder in (program.parent, program.parent.parent / "lib" / "latcon"):
        for suffix in importlib.machinery.EXTENSION_SUFFIXES:
            path = folder / f"latcon_stepping{suffix}"
            if path.exists() and (spec := importlib.util.spec_from_file_location("latcon_stepping", path)):
                return importlib.util.module_from_spec(spec)  # which runs it
    raise LatconError(f"there is no module latcon_stepping beside {program}; build with -DLATCON_STEPPING=ON")
