"""A sheet in motion as the viewer of the report reads it (sheet_viewer.js): integers, compressed, in JSON.

Positions are multiples of a quantum of 1/2000 of the spacing, speeds of 1/65535 of the largest: half of it is what a value
may be off. Integers are differences to the number before, then bytes of equal weight side by side, deflated, in base64.
"""
import base64
import json
import math
import zlib
from dataclasses import dataclass

import matplotlib
import numpy as np

STEPS_PER_SPACING, SPEED_STEPS = 2000, 65535
LARGEST_INTEGER = 2**29  # of a position, so that differences fit into 32 bits
FEWEST_FRAMES = 8  # a film with fewer is not worth a viewer, unless the run left no more
# Colour maps without their ends that vanish in white or in black.
COLOURS = {"stretch": ("viridis", 0.0, 1.0), "speed": ("plasma", 0.06, 0.93), "damage": ("YlOrRd", 0.15, 1.0)}


@dataclass(frozen=True)
class Sheet:
    """What the viewer reads."""

    contents: dict
    text: str  # JSON of it


def sheet_data(run, motion, most):
    """The Sheet of a motion, at most so many bytes; None if that is too little.

    Until it fits every second frame is left out, not the first and the last.
    """
    frames = motion.frames
    while True:
        found = contents(run, motion, frames)
        text = json.dumps(found, separators=(",", ":"))
        if len(text) <= most:
            return Sheet(found, text)
        if len(frames) < 2 * FEWEST_FRAMES:
            return None
        frames = [frames[i] for i in np.round(np.linspace(0, len(frames) - 1, (len(frames) + 1) // 2)).astype(int)]


def contents(run, motion, frames):
    """What the viewer needs of some frames; lengths in m, speeds in m/s, times in s."""
    mesh, whole = motion.mesh, motion.whole
    times = np.array([frame.time for frame in frames])
    positions = np.array([frame.position.T for frame in frames])
    speeds = np.array([np.linalg.norm(frame.fields["velocity"][:, :2], axis=1) for frame in frames])
    length = np.linalg.norm(np.diff(whole.reference[mesh.bonds], axis=1)[:, 0], axis=1)
    spacing = float(length.min(initial=np.inf))
    spacing = spacing if math.isfinite(spacing) and spacing > 0 else float(np.ptp(whole.reference, axis=0).max())
    quantum = max(spacing / STEPS_PER_SPACING, float(np.abs(positions).max()) / LARGEST_INTEGER)
    speed_quantum = float(speeds.max()) / SPEED_STEPS or 1.0
    steps = np.round(positions / quantum).astype(np.int64)
    stretch = [ends_distance(frame.position, mesh.bonds) / length for frame in (frames[0], frames[-1])]
    breaking = run.input_number("Fracture", "breaking stretch")
    low, high = np.percentile(np.concatenate(stretch), (1, 99)) if len(length) else (1.0, 2.0)
    return {
        "times": times.tolist(),
        "spacing": spacing,
        "quantum": quantum,
        "speedQuantum": speed_quantum,
        "position": packed(np.diff(steps, axis=0, prepend=0)),
        "speed": packed(np.round(speeds / speed_quantum)),
        "reference": packed_floats(whole.reference.T),
        "site": packed(whole.fields.get("site", np.arange(len(whole.reference)))),
        "degree": packed(bonds_at_first(whole, mesh)),
        "bonds": packed(mesh.bonds.T),
        "bondEnd": packed(np.searchsorted(times, mesh.bond_end)),
        "triangles": packed(mesh.triangles.T),
        "triangleEnd": packed(np.searchsorted(times, mesh.triangle_end)),
        "box": box_of(positions),
        "tip": tip_points(run.tip, times, whole.reference),
        "breaking": breaking,
        "ranges": {"stretch": [float(low), max(float(breaking or high), float(low) + 1e-3)],
                   "speed": [0.0, float(max(np.percentile(speed, 99) for speed in speeds)) or 1.0],
                   "damage": [0.0, 1.0]},
        "colours": {name: colour_table(*parts) for name, parts in COLOURS.items()},
    }


def box_of(positions):
    """Ends of the sheet along x and y over all frames, fragments that flew off left out [m]."""
    low, high = np.percentile(positions, 0.1, axis=2).min(axis=0), np.percentile(positions, 99.9, axis=2).max(axis=0)
    low, high = np.minimum(low, positions[0].min(axis=1)), np.maximum(high, positions[0].max(axis=1))
    return np.column_stack((low, high)).tolist()


def ends_distance(position, bonds):
    """Current lengths of bonds [m]."""
    return np.linalg.norm(position[bonds[:, 0]] - position[bonds[:, 1]], axis=1)


def bonds_at_first(frame, mesh):
    """Bonds that each site had before any broke: those of the frame, over the fraction that is not damaged."""
    degree = np.bincount(mesh.bonds.ravel(), minlength=len(frame.reference))
    damage = frame.fields.get("damage", np.zeros(len(degree)))
    return np.where(damage < 1, np.round(degree / np.where(damage < 1, 1 - damage, 1)), 1)


def tip_points(tip, times, reference):
    """The point where the tip is in each frame; None without a path."""
    if tip is None or not len(tip["t"]):
        return None
    rows = np.maximum(np.searchsorted(tip["t"], times, side="right") - 1, 0)
    places = np.column_stack((tip["X"], tip["Y"]))[rows]
    return [int(((reference - place) ** 2).sum(axis=1).argmin()) for place in places]


def colour_table(name, low, high):
    """256 colours (RGB), base64."""
    colours = np.round(255 * matplotlib.colormaps[name](np.linspace(low, high, 256))[:, :3]).astype(np.uint8)
    return base64.b64encode(colours.tobytes()).decode("ascii")


def packed(integers):
    """Integers of at most 31 bits; differences run along the last axis."""
    integers = np.asarray(integers).astype(np.int64)
    steps = np.diff(integers, axis=-1, prepend=0)
    return deflated(((steps << 1) ^ (steps >> 63)).astype("<u4"))


def packed_floats(values):
    """Numbers in double precision."""
    return deflated(np.ascontiguousarray(values, dtype="<f8"))


def deflated(array):
    """Bytes of equal weight side by side, deflated, and the shape they are for."""
    weights = np.ascontiguousarray(array).reshape(-1).view(np.uint8).reshape(-1, array.itemsize).T
    data = base64.b64encode(zlib.compress(weights.tobytes(), 9)).decode("ascii")
    return {"shape": list(array.shape), "data": data}
