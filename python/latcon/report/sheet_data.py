"""Data of a moving sheet for the viewer of the report (sheet_viewer.js): compressed integers in JSON.

Positions are multiples of a quantum of 1/2000 of the spacing, speeds of 1/65535 of the largest; values are accurate to half
a quantum. Integers are stored as differences to the previous number, grouped by byte significance, deflated, in base64.
"""
import base64
import json
import math
import zlib
from dataclasses import dataclass
from functools import cached_property

import matplotlib
import numpy as np

# Largest size of all sheets of a page [bytes]. With pictures and scripts, at most 3.5 MB for Fig. 1, a page is below 8 MB.
LARGEST_SHEETS = 4_500_000
STEPS_PER_SPACING, SPEED_STEPS = 2000, 65535
LARGEST_INTEGER = 2**29  # largest position, so that differences fit into 32 bits
FEWEST_FRAMES = 8  # below this number frames are not dropped to save space
# Colour maps without the ends that are indistinguishable from white or black.
COLOURS = {"stretch": ("viridis", 0.0, 1.0), "speed": ("plasma", 0.06, 0.93), "damage": ("YlOrRd", 0.15, 1.0)}


@dataclass(frozen=True)
class Sheet:
    """Data for the viewer."""

    contents: dict

    @cached_property
    def text(self):
        """JSON of the contents."""
        return json.dumps(self.contents, separators=(",", ":"))

    @property
    def precision(self):
        """Half a quantum of each value, as text. Both ends of a bond may have this error along x and y."""
        quantum, spacing = self.contents["quantum"], self.contents["spacing"]
        return (f"{0.5e6 * quantum:.2g} µm (positions), {0.5 * self.contents['speedQuantum']:.2g} m/s (speeds), "
                f"{2**0.5 * quantum / spacing:.1g} (stretch)")


def sheet_data(run, motion, most):
    """The Sheet of a motion with at most `most` bytes; None if it does not fit.

    Every second frame is dropped until the data fit; the first and the last frame are kept.
    """
    frames, sites = motion.frames, len(motion.whole.reference)
    while True:
        is_short = len(frames) < 2 * FEWEST_FRAMES
        if is_short or len(frames) * sites <= most:  # a site takes more than a byte per frame
            sheet = Sheet(contents(run, motion, frames))
            if len(sheet.text) <= most:
                return sheet
        if is_short:
            return None
        frames = [frames[i] for i in np.round(np.linspace(0, len(frames) - 1, (len(frames) + 1) // 2)).astype(int)]


def contents(run, motion, frames):
    """Viewer data of the given frames; lengths in m, speeds in m/s, times in s."""
    mesh, whole = motion.mesh, motion.whole
    times = np.array([frame.time for frame in frames])
    positions = np.array([frame.position.T for frame in frames])
    speeds = np.array([np.linalg.norm(frame.fields["velocity"], axis=1) for frame in frames])
    length = np.linalg.norm(np.diff(whole.reference[mesh.bonds], axis=1)[:, 0], axis=1)
    spacing = float(length.min(initial=np.inf))
    spacing = spacing if math.isfinite(spacing) and spacing > 0 else float(np.ptp(whole.reference, axis=0).max())
    quantum = max(spacing / STEPS_PER_SPACING, float(np.abs(positions).max()) / LARGEST_INTEGER)
    speed_quantum = float(speeds.max()) / SPEED_STEPS or 1.0
    steps = np.round(positions / quantum).astype(np.int64)
    stretch = [np.linalg.norm(frame.position[mesh.bonds[:, 0]] - frame.position[mesh.bonds[:, 1]], axis=1) / length
               for frame in (frames[0], frames[-1])]
    breaking = run.input_number("Fracture/breaking stretch")
    low, high = np.percentile(np.concatenate(stretch), (1, 99)) if len(length) else (1.0, 2.0)
    # Bonds of each site before any broke: its bonds in the frame over the undamaged fraction.
    left = np.bincount(mesh.bonds.ravel(), minlength=len(whole.reference))
    damage = whole.fields.get("damage", np.zeros(len(left)))
    # Extent over all frames, without fragments that flew off.
    ends = [choose(np.percentile(positions, percentage, axis=2), axis=0) for choose, percentage in ((np.min, 0.1), (np.max, 99.9))]
    box = np.minimum(ends[0], positions[0].min(axis=1)), np.maximum(ends[1], positions[0].max(axis=1))
    return {
        "times": times.tolist(),
        "spacing": spacing,
        "quantum": quantum,
        "speedQuantum": speed_quantum,
        "position": packed(np.diff(steps, axis=0, prepend=0)),
        "speed": packed(np.round(speeds / speed_quantum)),
        "reference": deflated(whole.reference.T.astype("<f8")),
        "site": packed(whole.fields.get("site", np.arange(len(whole.reference)))),
        "degree": packed(np.where(damage < 1, np.round(left / np.where(damage < 1, 1 - damage, 1)), 1)),
        "bonds": packed(mesh.bonds.T),
        "bondEnd": packed(np.searchsorted(times, mesh.bond_end)),
        "triangles": packed(mesh.triangles.T),
        "triangleEnd": packed(np.searchsorted(times, mesh.triangle_end)),
        "box": np.column_stack(box).tolist(),
        "tip": tip_points(run.tip, times, whole.reference),
        "breaking": breaking,
        "ranges": {"stretch": [float(low), max(float(breaking or high), float(low) + 1e-3)],
                   "speed": [0.0, float(max(np.percentile(speed, 99) for speed in speeds)) or 1.0],
                   "damage": [0.0, 1.0]},
        # Tables of 256 colours (RGB), in base64.
        "colours": {name: base64.b64encode(np.round(255 * matplotlib.colormaps[colours](np.linspace(low, high, 256))[:, :3])
                                           .astype(np.uint8).tobytes()).decode("ascii")
                    for name, (colours, low, high) in COLOURS.items()},
    }


def tip_points(tip, times, reference):
    """Index of the site at the tip in each frame; None without a path."""
    if tip is None or not len(tip["t"]):
        return None
    rows = np.maximum(np.searchsorted(tip["t"], times, side="right") - 1, 0)
    places = np.column_stack((tip["X"], tip["Y"]))[rows]
    return [int(((reference - place) ** 2).sum(axis=1).argmin()) for place in places]


def packed(integers):
    """Compresses integers of at most 31 bits; differences are taken along the last axis."""
    integers = np.asarray(integers).astype(np.int64)
    steps = np.diff(integers, axis=-1, prepend=0)
    return deflated(((steps << 1) ^ (steps >> 63)).astype("<u4"))


def deflated(array):
    """Shape of an array, and its bytes grouped by significance, deflated, in base64."""
    weights = np.ascontiguousarray(array).reshape(-1).view(np.uint8).reshape(-1, array.itemsize).T
    return {"shape": list(array.shape), "data": base64.b64encode(zlib.compress(weights.tobytes())).decode("ascii")}
