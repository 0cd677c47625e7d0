"""Plots of a run with matplotlib; lengths in cm."""
from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from .errors import optional_package
from .files import read_columns
from .frames import Floats, Frame

if TYPE_CHECKING:
    import matplotlib.axes

    from .results import Run


def _axes(ax: matplotlib.axes.Axes | None) -> matplotlib.axes.Axes:
    if ax is not None:
        return ax
    plt = optional_package("matplotlib.pyplot", "plots need", "matplotlib (Debian: python3-matplotlib)")
    return plt.subplots(figsize=(10, 5), layout="constrained")[1]


def draw_path(run: Run, ax: matplotlib.axes.Axes | None, **style: Any) -> matplotlib.axes.Axes:
    """Draws the path of the tip, in a style of matplotlib's lines, and the broken bonds in the undeformed sheet."""
    ax = _axes(ax)
    # Without the tables of `run`, which need pandas: a report does not.
    broken, tip = (read_columns(run.directory / file, ("X", "Y")) for file in ("broken_bonds.csv", "crack.csv"))
    ax.scatter(100 * broken["X"], 100 * broken["Y"], s=2, color="0.6", linewidths=0, label="broken bonds")
    ax.plot(100 * tip["X"], 100 * tip["Y"], **{"label": f"tip, {run.crack.speed_lagrangian}", **style})
    ax.set(xlabel="X, undeformed [cm]", ylabel="Y, undeformed [cm]", title=f"crack path: {run.crack.pattern}")
    ax.legend(loc="best")
    return ax


def draw_sheet(frame: Frame, color: str, ax: matplotlib.axes.Axes | None, **style: Any) -> matplotlib.axes.Axes:
    """Draws the bonds of a frame, coloured by a field, in a style of matplotlib's LineCollection."""
    from matplotlib.collections import LineCollection
    ax = _axes(ax)
    values = bond_values(frame, color)
    order = np.argsort(values)  # the largest on top
    lines = LineCollection(list(100 * frame.position[frame.bonds[order]]), array=values[order],
                           **{"linewidths": 0.5, "rasterized": True, **style})
    ax.add_collection(lines)
    ax.autoscale_view()
    is_relaxed = frame.time == 1 and not np.any(frame.fields.get("velocity", np.empty(0)))  # its 1 is no time
    ax.set(aspect="equal", xlabel="x [cm]", ylabel="y [cm]", title="" if is_relaxed else f"t = {1e3 * frame.time:.4g} ms")
    unit = frame.units.get(color.split(" ")[0], "1")
    ax.figure.colorbar(lines, ax=ax, label=f"{color.replace('_', ' ')} [{unit}]")
    return ax


def bond_values(frame: Frame, color: str) -> Floats:
    """Returns the values of a field on the bonds: ``"FIELD"`` of a scalar, ``"FIELD x"`` of a vector, ``"FIELD xy"`` of a
    tensor; for a field of the sites, the mean of both ends.

    Raises ValueError if the frame has no bonds or no such field, or if the component does not match the field.
    """
    if not len(frame.bonds):
        raise ValueError("the frame has no bonds; frames of a lattice have them, but for the reduced ones of run.motion")
    name, _, component = color.partition(" ")
    on_bonds = name in frame.bond_fields
    if not on_bonds and name not in frame.fields:
        known = ", ".join(sorted({*frame.bond_fields, *frame.fields}))
        raise ValueError(f"no field {name!r}; known: {known}")
    values = frame.bond_fields[name] if on_bonds else frame.fields[name]
    if len(component) != values.ndim - 1 or not set(component) <= set("xy"):
        example = f"{name} {'xy'[:values.ndim - 1]}".strip()
        raise ValueError(f"{color!r}: the field has {values.ndim - 1} indices; give for instance {example!r}")
    index: tuple[Any, ...] = (slice(None), *map("xy".index, component))
    numbers: Floats = values[index].astype(float)
    return numbers if on_bonds else np.asarray(numbers[frame.bonds].mean(axis=1))
