"""Rasterisation of a sheet, much faster than drawing its quarter of a million bonds one by one.

A triangle of nearest neighbours is filled if its three bonds are intact. Bonds of sites that have lost some are drawn on
top as lines of one pixel, so that torn and bridged regions remain visible.
"""
import numpy as np
from matplotlib.tri import Triangulation

LONGEST_LINE, MOST_GROUPS = 400, 12  # samples along a bond or side; largest number of samples with a separate group


class Mesh:
    """Bonds and triangles of a sheet, and the times at which they break."""

    def __init__(self, frame, broken=None):
        """frame: with all bonds. broken: table of `broken_bonds.csv`, whose site numbers are in frame.fields["site"]."""
        self.bonds = frame.bonds
        count = len(frame.reference)
        keys = bond_keys(frame.bonds, count)
        order = np.argsort(keys)
        sorted_keys = keys[order]
        self.bond_end = np.full(len(keys), np.inf)  # time at which it breaks [s]
        if broken is not None and len(keys):
            sites = np.argsort(frame.fields["site"])
            ends = find(frame.fields["site"][sites], np.column_stack((broken["site"], broken["other_site"])).astype(int))
            known = (ends >= 0).all(axis=1)
            found = find(sorted_keys, bond_keys(sites[ends[known]], count))
            self.bond_end[order[found[found >= 0]]] = broken["t"][known][found >= 0]
        length = np.linalg.norm(frame.reference[self.bonds[:, 0]] - frame.reference[self.bonds[:, 1]], axis=1)
        nearest = length < 1.3 * length.min() if len(length) else np.empty(0, dtype=bool)
        self.triangles, self.triangle_end = np.empty((0, 3), dtype=int), np.empty(0)
        flat = len(frame.reference) < 3 or np.ptp(frame.reference, axis=0).min() == 0
        if flat or not nearest.any():
            return
        triangles = Triangulation(*frame.reference.T).triangles
        ends = np.where(nearest, self.bond_end, -np.inf)  # next-nearest bonds bound no triangle
        sides = np.stack([find(sorted_keys, bond_keys(triangles[:, list(side)], count))
                          for side in ((0, 1), (1, 2), (2, 0))])
        whole = (sides >= 0).all(axis=0)
        end = ends[order[sides[:, whole]]].min(axis=0)
        self.triangles, self.triangle_end = triangles[whole][end > -np.inf], end[end > -np.inf]


def bond_keys(ends, count):
    """A unique number for each pair of sites."""
    ends = np.sort(ends, axis=1).astype(np.int64)
    return ends[:, 0] * count + ends[:, 1]


def find(sorted_values, wanted):
    """Indices of values in a sorted array; -1 for missing values."""
    place = np.searchsorted(sorted_values, wanted)
    place[place == len(sorted_values)] = 0
    return np.where(sorted_values[place] == wanted, place, -1)


class Raster:
    """Pixels of a box (x from, to, y from, to) in the unit of the positions."""

    def __init__(self, box, width):
        self.low = np.array((box[0], box[2]))
        self.pixels_per_unit = width / (box[1] - box[0])
        self.width, self.height = width, max(1, round(width * (box[3] - box[2]) / (box[1] - box[0])))

    def draw(self, mesh, position, values, time=-np.inf):
        """Values of the sites in the pixels of the sheet at a time; NaN outside the sheet."""
        picture = np.full(self.height * self.width, np.nan, dtype=np.float32)
        place = ((position - self.low) * self.pixels_per_unit).astype(np.float32)
        inside = ((place >= 0) & (place < (self.width, self.height))).all(axis=1)
        values = values.astype(np.float32)
        triangles = mesh.triangles[mesh.triangle_end > time]
        self.put(picture, place, values, triangles[inside[triangles].all(axis=1)], triangle_weights)
        # Bonds between intact sites lie within triangles.
        torn = np.ones(len(position), dtype=bool)
        torn[triangles] = False
        torn[mesh.bonds[mesh.bond_end <= time]] = True
        bonds = mesh.bonds[(mesh.bond_end > time) & torn[mesh.bonds].any(axis=1)]
        self.put(picture, place, values, bonds[inside[bonds].all(axis=1)], line_weights)
        return picture.reshape(self.height, self.width)[::-1]

    def put(self, picture, place, values, corners, weights_for):
        """Sets every pixel between corners; larger elements are sampled more densely."""
        size = np.ptp(place[corners], axis=1).max(axis=1, initial=0.0)
        samples = np.minimum(np.ceil(size).astype(int), LONGEST_LINE)
        samples[samples > MOST_GROUPS] = samples.max(initial=0)
        for number in np.unique(samples):
            weights = weights_for(max(number, 1)).astype(np.float32)
            some = corners[samples == number]
            columns, rows = (place[some, axis] @ weights.T for axis in (0, 1))
            picture[rows.astype(np.int32) * self.width + columns.astype(np.int32)] = values[some] @ weights.T


def triangle_weights(n):
    """Barycentric coordinates of points less than a pixel apart in a triangle of n pixels."""
    a, b = np.meshgrid(np.arange(n + 1), np.arange(n + 1))
    a, b = a[a + b <= n] / n, b[a + b <= n] / n
    return np.column_stack((a, b, 1 - a - b))


def line_weights(n):
    """Barycentric coordinates of points less than a pixel apart on a line of n pixels."""
    along = np.linspace(0, 1, n + 1)
    return np.column_stack((1 - along, along))
