"""Sweeps and studies: runs of many cases, with their results as a table or a dataset."""
from __future__ import annotations

import contextlib
import functools
import math
import os
import pathlib
from collections.abc import Iterable, Mapping
from typing import TYPE_CHECKING, Any, Protocol

from .case import Settable, entry_text, set_options
from .commands import CaseLike, Directory, as_case, common_words
from .errors import BadInput, ClaimFailed, DidNotConverge, optional_package
from .files import read_json
from .folder import absolute
from .program import Progress, interrupt_runs, progress_indicator, run
from .results import Run, open_run, results_table
from .schema import SEED_ENTRY

if TYPE_CHECKING:
    import pandas as pd
    import xarray

_MAX_TASKS = 1000  # each plans the whole sweep


class Executor(Protocol):
    """Executor of :mod:`concurrent.futures`, Dask, loky or submitit."""

    def submit(self, function: Any, /, *arguments: Any) -> Any:
        """Returns a future."""


class Study:
    """Results of a study or a sweep in an output directory.

    Parameters
    ----------
    directory
        Output directory.

    Raises
    ------
    UnreadableFile
        If the directory has no `study.json`.
    """

    def __init__(self, directory: Directory) -> None:
        self.directory = absolute(directory)
        self.info  # raises if the directory is not that of a study

    def __repr__(self) -> str:
        return f"latcon.open_study({str(self.directory)!r})"

    @functools.cached_property
    def info(self) -> dict[str, Any]:
        """`study.json`: runs, seeds, quantities, claims with their tests."""
        return read_json(self.directory / "study.json")

    @functools.cached_property
    def table(self) -> pd.DataFrame:
        """One row per run and seed.

        Columns ``run``, ``seed``, ``folder``, ``state`` (``measured``, ``failed``, ...), ``pattern``, the entries in which the runs
        differ by key, in SI units, and all quantities of cracks, NaN if not determined; units in ``attrs["units"]``.
        """
        import pandas as pd
        info, units = self.info, dict(self.info["units"])
        varied = {entry["entry"]: dict(zip(dict.fromkeys(seed["run"] for seed in info["seeds"]), entry["values"]))
                  for entry in info["varied"]}
        table = pd.DataFrame([{**{name: seed[name] or "" for name in ("run", "folder", "state", "pattern")}, "seed": seed["seed"],
                               **{key: values[seed["run"]] for key, values in varied.items()}} for seed in info["seeds"]],
                             columns=["run", "seed", "folder", "state", "pattern", *varied])
        quantities = pd.DataFrame([seed["values"] for seed in info["seeds"]], columns=list(units), dtype=float)
        table = pd.concat([table, quantities], axis=1)
        table.attrs["units"] = {**{entry["entry"]: entry["unit"] or "1" for entry in info["varied"]}, **units}
        return table

    @functools.cached_property
    def results(self) -> pd.DataFrame:
        """`results.json`: one row per tested statement, with the columns of :attr:`Run.results`."""
        return results_table(self.directory / "results.json")

    def run(self, name: str, seed: int) -> Run:
        """Opens a run.

        Parameters
        ----------
        name
            Name of the run, as in :attr:`table`.
        seed
            Noise seed.
        """
        return open_run(self.directory / "runs" / f"{name}-{seed}")

    def to_xarray(self) -> xarray.Dataset:
        """Quantities on the grid of the swept entries and ``seed``; without a sweep, on ``run`` and ``seed``.

        Dimensions have the names of the entries with ``_`` for blanks: ``data["speed_lagrangian"].sel(strain_y=1.7)``; those whose
        name is taken have their section too: ``Disorder_seed``. Units are in ``attrs["units"]``; quantities that are not determined
        and points between those of a refined grid are NaN.

        Raises
        ------
        LatconError
            If xarray is not installed.
        """
        optional_package("xarray", "to_xarray needs", "xarray (Debian: python3-xarray)")
        table, units = self.table, self.table.attrs["units"]
        swept = [entry for entry in self.info["swept"] if entry in table]
        if swept:  # a study may have other runs as well, also at a point of the grid
            grid = [run["run"] for run in self.info["runs"] if set(run["set"]) == set(self.info["swept"])]
            table = table[table["run"].isin(grid)].drop_duplicates([*swept, "seed"])
        tails = [entry.partition("/")[2].replace(" ", "_") for entry in swept]
        names = {entry: tail if tails.count(tail) == 1 and tail not in table else entry.replace(" ", "_").replace("/", "_")
                 for entry, tail in zip(swept, tails)}
        others = [entry["entry"] for entry in self.info["varied"] if entry["entry"] not in swept]
        axes = list(names.values()) or ["run"]
        data = table.rename(columns=names).drop(columns=[*(["run"] if swept else []), *others]).set_index([*axes, "seed"]).to_xarray()
        for entry, name in {**{entry: entry for entry in units}, **names}.items():
            if name in data.variables:
                data[name].attrs["units"] = units[entry]
        for entry, name in names.items():
            data[name].attrs["long_name"] = entry
        for name in ("folder", "state", "pattern"):
            data[name] = data[name].fillna("")
        return data


def open_study(directory: Directory) -> Study:
    """Opens the output directory of a study or sweep (``latcon study``), also without the program."""
    return Study(directory)


def sweep(case: CaseLike, values: Mapping[str, Iterable[Settable]], directory: Directory = "output/sweep", *, seeds: int = 1,
          executor: Executor | None = None, tasks: int | None = None, threads: int | None = None, skip_verification: bool = False,
          report: bool = True, yes: bool = False, progress: Progress = True) -> xarray.Dataset:
    """Runs cracks for all combinations of values of entries (``latcon study --sweep``).

    Finished runs of an earlier call with the same arguments are used again. Runs that fail have a ``state`` other than
    ``measured``, and no quantities.

    Parameters
    ----------
    case
        The case, or what :class:`Case` accepts.
    values
        Two values or more by key, as :meth:`Case.set` takes them, but for lists.
    directory
        Output directory; it must not have another sweep.
    seeds
        Number of noise seeds for each combination, 1 to `seeds`.
    executor
        Object with the method ``submit`` of :mod:`concurrent.futures`, which runs shares of the sweep in threads, processes or
        jobs of a cluster that have the directory and the program; None: this machine, one run per thread.
    tasks
        Number of shares, with an executor; default: one per run, at most 1000.
    threads
        Concurrent runs without an executor; default: all cores that this process may use.
    skip_verification
        Whether to run the cracks without verification.
    report
        Whether to create `study.html`.
    yes
        Whether to run even if runs are estimated to take more than ten days.
    progress
        As in :func:`fracture`.

    Returns
    -------
    xarray.Dataset
        That of :meth:`Study.to_xarray`.

    Raises
    ------
    BadInput
        If the case or a value is wrong, before any run.
    LatconError
        If xarray is not installed.
    Interrupted, KeyboardInterrupt
        After Ctrl-C: the runs of this machine write checkpoints; call again to continue.
    """
    optional_package("xarray", "sweeps need", "xarray (Debian: python3-xarray)")
    if not values:
        raise BadInput("values: give at least one entry to sweep", 2)
    case, place = as_case(case), absolute(directory)
    overrides = {key: value for key, value in case.overrides.items() if key != SEED_ENTRY and key not in values}
    texts = {key: [entry_text(key, value) for value in of_key] for key, of_key in values.items()}
    words = ["study", os.fspath(case.file), *set_options(overrides), "--seeds", str(seeds), *["--skip-verification"] * skip_verification,
             *["--yes"] * yes, *(word for key, found in texts.items() for word in ("--sweep", f"{key}={','.join(found)}"))]
    if executor is None:
        _run_study([*words, "--resume"], place, threads, report, progress)
        return open_study(place).to_xarray()
    n_tasks = tasks or min(seeds * math.prod(map(len, texts.values())), _MAX_TASKS)
    run([*words, "--dry-run", *common_words(place, 1)], place, False)  # reports wrong input once
    futures = [executor.submit(_run_study, [*words, "--shard", f"{i}/{n_tasks}"], place, 1, False, False)
               for i in range(1, n_tasks + 1)]
    with progress_indicator(progress) as show:
        try:
            for done, future in enumerate(futures):
                show(f"{done} of {n_tasks} tasks")
                future.result()
        except BaseException:
            for future in futures:
                future.cancel()
            interrupt_runs(place)
            raise
    _run_study([*words, "--collect"], place, 1, report, False)
    return open_study(place).to_xarray()


def _run_study(words: list[str], place: pathlib.Path, threads: int | None, report: bool, progress: Progress) -> None:
    with contextlib.suppress(ClaimFailed, DidNotConverge):  # runs that failed are in the table
        run([*words, *["--no-report"] * (not report), *common_words(place, threads)], place, progress)
