"""Results of a run: the contents of its output directory."""
from __future__ import annotations

import contextlib
import functools
import os
import pathlib
from typing import TYPE_CHECKING, Any

from .case import Case
from .errors import ClaimFailed, ProgramNotFound, UnreadableFile
from .files import read_json, read_rows, read_table, read_text
from .folder import absolute
from .frames import Frames, read_near_tip
from .program import find_program, output_of, page_command
from .quantities import Quantities

if TYPE_CHECKING:
    import matplotlib.axes
    import pandas as pd
    import xarray

_PATH_UNITS = {"t": "s", "X": "m", "Y": "m", "x": "m", "y": "m", "speed": "m/s", "bonds_broken": "1"}
_BROKEN_UNITS = {"t": "s", "site": "1", "other_site": "1", "X": "m", "Y": "m", "stretch": "1"}
_RESULT_COLUMNS = ("claim", "quantity", "unit", "lattice", "continuum", "theory", "error", "tolerance", "verdict")


class Run:
    """Results of a run in an output directory. Each file is read once, when it is first accessed.

    Parameters
    ----------
    directory
        Output directory.

    Raises
    ------
    UnreadableFile
        If the directory has no `run.json`; from a property, if its file is missing or damaged.
    """

    def __init__(self, directory: str | os.PathLike[str]) -> None:
        self.directory = absolute(directory)
        self.info  # raises if the directory is not that of a run

    def __repr__(self) -> str:
        return f"latcon.open({str(self.directory)!r})"

    @functools.cached_property
    def info(self) -> dict[str, Any]:
        """`run.json`: version, commit, libraries, wall times, memory, exit code."""
        return read_json(self.directory / "run.json")

    @property
    def exit_code(self) -> int | None:
        """Exit code of the program; None while it runs, or if it was killed."""
        return self.info.get("exit_code")

    @functools.cached_property
    def case(self) -> Case:
        """The resolved case. Without the program, values are those of `run.json`."""
        path = self.directory / "case.prm"
        if not path.is_file():
            raise UnreadableFile(path, "no such file")
        try:
            find_program()
        except ProgramNotFound:
            return Case.of_run(path, self.info.get("entries", {}), read_text(path))
        return Case(path)

    @functools.cached_property
    def crack(self) -> Quantities:
        """`crack.json`: pattern, speeds, wavelength, amplitude, each a :class:`Value`."""
        return Quantities(read_json(self.directory / "crack.json"))

    @functools.cached_property
    def near_tip(self) -> Quantities:
        """`near_tip.json`: the fields around the running tip as numbers."""
        return Quantities(read_json(self.directory / "near_tip.json"))

    @functools.cached_property
    def path(self) -> pd.DataFrame:
        """`crack.csv`: one row each time the tip moves.

        Columns ``t`` [s], ``X``, ``Y`` (undeformed), ``x``, ``y`` (current) [m], ``speed`` (Lagrangian) [m/s],
        ``bonds_broken``; units in ``attrs["units"]``.
        """
        return read_table(self.directory / "crack.csv", _PATH_UNITS)

    @functools.cached_property
    def broken_bonds(self) -> pd.DataFrame:
        """`broken_bonds.csv`: one row per broken bond.

        Columns ``t`` [s], ``site``, ``other_site`` (the field ``site`` of frames), ``X``, ``Y`` of the undeformed midpoint [m],
        ``stretch``; units in ``attrs["units"]``.
        """
        return read_table(self.directory / "broken_bonds.csv", _BROKEN_UNITS)

    @functools.cached_property
    def energy(self) -> pd.DataFrame:
        """`energy.csv`: energies per unit sheet thickness [J/m] against ``t`` [s] or ``load_factor``.

        Columns of a lattice: ``elastic``, ``kinetic``, ``viscous``, ``broken``, ``boundary_work``, ``contact``, ``imbalance``;
        for those of Maxwell branches and of finite elements see docs/reference-files.md. Units in ``attrs["units"]``.
        """
        return read_table(self.directory / "energy.csv", {"t": "s", "load_factor": "1"}, "J/m")

    @functools.cached_property
    def results(self) -> pd.DataFrame:
        """`results.json`: one row per checked quantity.

        Columns ``claim``, ``quantity``, ``unit``, ``lattice``, ``continuum``, ``theory``, ``error``, ``tolerance``,
        ``verdict`` (``holds``, ``fails``, ``reported``); numbers that do not apply are NaN. The first three numbers are in
        ``unit``, error and tolerance as the claim defines them.
        """
        return results_table(self.directory / "results.json")

    @functools.cached_property
    def frames(self) -> Frames:
        """Frames of the lattice, `lattice.pvd`, otherwise of the continuum: ``run.frames[-1]`` is the last :class:`Frame`."""
        continuum = self.directory / "continuum.pvd"
        lattice = self.directory / "lattice.pvd"
        return Frames(continuum if continuum.exists() and not lattice.exists() else lattice)

    @functools.cached_property
    def motion(self) -> Frames:
        """Reduced frames of a running crack, `motion.pvd`: displacement and velocity of the sites, no bonds."""
        return Frames(self.directory / "motion.pvd")

    def near_tip_fields(self, folded: bool = False) -> xarray.Dataset:
        """Mean fields around the running tip.

        Parameters
        ----------
        folded
            Whether samples where the path descends were mirrored in Y first.

        Returns
        -------
        xarray.Dataset
            See :func:`latcon.frames.read_near_tip`.
        """
        return read_near_tip(self.directory / f"near_tip{'_folded' if folded else ''}.vti")

    def plot_path(self, ax: matplotlib.axes.Axes | None = None, **style: Any) -> matplotlib.axes.Axes:
        """Draws the path of the tip and the broken bonds in the undeformed sheet [cm].

        Parameters
        ----------
        ax
            Axes to draw in; default: those of a new figure.
        **style
            Arguments of matplotlib's ``Axes.plot`` for the path, such as ``color`` or ``label``.
        """
        from .plots import draw_path
        return draw_path(self, ax, **style)

    def plot_sheet(self, frame: int = -1, color: str = "stretch", ax: matplotlib.axes.Axes | None = None,
                   **style: Any) -> matplotlib.axes.Axes:
        """Draws the bonds of the sheet in the current configuration [cm].

        Parameters
        ----------
        frame
            Index of the frame.
        color
            Field of the bonds, or field of the sites (a bond has the mean of its ends): a scalar such as ``"stretch"``,
            ``"damage"``, ``"strain_energy_density"``, or a component of a vector or tensor such as ``"velocity x"``,
            ``"cauchy_stress yy"``.
        ax
            Axes to draw in; default: those of a new figure.
        **style
            Arguments of matplotlib's ``LineCollection``, such as ``cmap``, ``clim`` or ``linewidths``.
        """
        from .plots import draw_sheet
        return draw_sheet(self.frames[frame], color, ax, **style)

    def to_html(self) -> pathlib.Path:
        """Creates `report.html` as ``latcon report`` does and returns its path.

        Raises
        ------
        ProgramError
            If the report cannot be made.
        """
        with contextlib.suppress(ClaimFailed):  # the page shows rows that fail
            output_of(page_command("report", self.directory))
        return self.directory / "report.html"


def open_run(directory: str | os.PathLike[str]) -> Run:
    """Opens the output directory of a run.

    Raises
    ------
    UnreadableFile
        If the directory is not that of a run.
    """
    return Run(directory)


def results_table(path: pathlib.Path) -> pd.DataFrame:
    """Returns the rows of a `results.json` as :attr:`Run.results`."""
    import pandas as pd
    return pd.DataFrame(read_rows(path), columns=list(_RESULT_COLUMNS)).astype(dict.fromkeys(_RESULT_COLUMNS[3:8], float))
