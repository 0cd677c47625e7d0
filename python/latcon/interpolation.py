"""Interpolation of finite element fields at points."""
from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy.spatial import cKDTree

from .frames import Floats

Indices = NDArray[np.int64]


def interpolate(points: Floats, nodes: Floats, values: Floats, cells: Sequence[Indices], tolerance: float) -> tuple[Floats, Any]:
    """Evaluates fields at points, and returns also which points are outside of all cells: the values are NaN there. On boundaries of
    cells, where derivatives jump, takes the mean over the adjacent cells.

    Newton's method inverts the mapping of curved cells, so that polynomials of their degree are reproduced to round-off, which
    VTK's search does not. `values` are fields at the `nodes`, shape (nodes, components), `cells` the nodes of quadrilaterals of
    each degree p, shape (cells, (p + 1)²): equidistant, the first coordinate runs fastest. A point belongs to a cell up to the
    distance `tolerance` [m] outside.
    """
    total, count = np.zeros((len(points), values.shape[1])), np.zeros(len(points), np.int64)
    for of_degree in cells:
        n_side = round(of_degree.shape[1]**0.5)
        site, cell = _near_cells(points, nodes[of_degree], tolerance)
        unit, is_inside = _invert(points[site], nodes, of_degree[cell], n_side, tolerance)
        site, cell, unit = site[is_inside], cell[is_inside], unit[:, is_inside]
        turn = np.arange(len(site)) - np.searchsorted(site, site)  # number among the cells of a point
        first, second = (_basis(n_side - 1, coordinate)[0] for coordinate in unit)
        for now in (np.flatnonzero(turn == number) for number in range(turn.max(initial=-1) + 1)):
            found = total[site[now]]
            for node in range(n_side**2):
                shape = first[node % n_side][now] * second[node // n_side][now]
                found += shape[:, None] * values[of_degree[cell[now], node]]
            total[site[now]] = found
        count += np.bincount(site, minlength=len(points))
    with np.errstate(invalid="ignore"):
        return total / np.where(count > 0, count, np.nan)[:, None], count == 0


def _near_cells(points: Floats, corners: Floats, tolerance: float) -> tuple[Indices, Indices]:
    """Returns pairs of a point and a cell in whose bounding box it is, sorted."""
    low, high = corners.min(axis=1), corners.max(axis=1)
    # A curved side may extend beyond the box of its nodes, by much less than the length of the cell.
    margin = (0.1 * (high - low).max(axis=1) + tolerance)[:, None]
    low, high = low - margin, high + margin
    near = cKDTree(points).query_ball_point((low + high) / 2, 0.5001 * (high - low).max(axis=1), p=np.inf)
    cell = np.repeat(np.arange(len(near)), [len(some) for some in near])
    site = np.concatenate(near).astype(np.int64)
    kept = ((points[site] >= low[cell]) & (points[site] <= high[cell])).all(axis=1)
    site, cell = site[kept], cell[kept]
    order = np.lexsort((cell, site))
    return site[order], cell[order]


def _invert(points: Floats, nodes: Floats, cells: Indices, n_side: int, tolerance: float) -> tuple[Floats, Any]:
    """Finds the coordinates of each point in the unit square of its cell, and whether it is in the cell."""
    unit, is_inside = np.full((2, len(points)), 0.5), np.zeros(len(points), bool)
    active = np.arange(len(points))
    for _ in range(30):
        at = unit[:, active]
        (first, first_slope), (second, second_slope) = (_basis(n_side - 1, coordinate) for coordinate in at)
        x, along, across = np.zeros((3, 2, len(active)))
        for node in range(n_side**2):
            i, j = node % n_side, node // n_side
            position = nodes[cells[active, node]].T
            x += first[i] * second[j] * position
            along += first_slope[i] * second[j] * position
            across += first[i] * second_slope[j] * position
        rest = points[active].T - x
        with np.errstate(all="ignore"):
            determinant = along[0] * across[1] - along[1] * across[0]
            step = np.array((across[1] * rest[0] - across[0] * rest[1], along[0] * rest[1] - along[1] * rest[0])) / determinant
            # Far outside the cell the polynomials are meaningless.
            is_near = (abs(at - 0.5) < 2).all(axis=0) & np.isfinite(step.sum(axis=0))
            at = unit[:, active] = at + step
            # The convergence is quadratic: after a step this small the error is round-off.
            is_found = is_near & (abs(step).sum(axis=0) < 1e-9)
            beyond = np.where(at < 0, at, np.maximum(0, at - 1))
            distance = np.hypot(*(along * beyond[0] + across * beyond[1]))
        is_inside[active[is_found]] = distance[is_found] <= tolerance
        active = active[is_near & ~is_found]
        if not len(active):
            break
    return unit, is_inside


def _basis(degree: int, x: Floats) -> tuple[Floats, Floats]:
    """Returns the Lagrange polynomials on equidistant nodes of [0, 1] and their derivatives, shape (degree + 1, points)."""
    s = x * degree  # nodes at 0, 1 ... degree
    values, slopes = np.ones((degree + 1, len(x))), np.zeros((degree + 1, len(x)))
    for k in range(degree + 1):
        for m in (m for m in range(degree + 1) if m != k):
            factor = 1 / (k - m)
            slopes[k] = (slopes[k] * (s - m) + values[k]) * factor
            values[k] *= (s - m) * factor
    return values, slopes * degree
