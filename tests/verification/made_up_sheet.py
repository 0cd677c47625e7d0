"""Synthetic frames of a triangular lattice with a running crack, in the format of `latcon fracture`."""
import json

import numpy as np

from made_up_runs import HOLDS, PUBLISHED, opening, write_fracture, write_series, write_sites, write_table

SPACING, COLUMNS, ROWS, FRAMES = 1e-3, 60, 21, 12
STRAIN = 0.8  # along y


def lattice():
    """Undeformed positions [m], (sites, 2), and bonds with nearest neighbours, (bonds, 2)."""
    row, column = np.divmod(np.arange(ROWS * COLUMNS), COLUMNS)
    reference = SPACING * np.column_stack((column + 0.5 * (row % 2), (row - ROWS // 2) * 3**0.5 / 2))
    close = [(i, j) for i in range(len(reference)) for j in range(i + 1, min(i + COLUMNS + 2, len(reference)))
             if np.hypot(*(reference[i] - reference[j])) < 1.1 * SPACING]
    return reference, np.array(close)


def write_torn_sheet(folder):
    """Writes a run whose crack opens from the left, one bond after the other."""
    write_fracture(folder, [HOLDS, PUBLISHED])
    generator = np.random.default_rng(7)
    reference, bonds = lattice()
    site = generator.permutation(10 * len(reference))[:len(reference)]  # numbers are not those of the points
    middle = reference[bonds].mean(axis=1)
    end = reference[:, 0].max()
    # Bonds across the wave y = A sin x, in the order of x.
    wave = 2.5e-3 * np.sin(2 * np.pi * reference[:, 0] / 2e-2)
    above = reference[:, 1] > wave
    across = np.flatnonzero(above[bonds[:, 0]] != above[bonds[:, 1]])
    across = across[np.argsort(middle[across, 0])]
    breaks = dict(zip(across.tolist(), 1e-3 * middle[across, 0] / end))  # time [s]
    seed = [b for b in across.tolist() if middle[b, 0] < 0.1 * end]
    broken = [b for b in across.tolist() if b not in seed]
    times = np.linspace(1e-4, 1e-3, FRAMES)
    columns = [np.array(values) for values in zip(*[(breaks[b], *site[bonds[b]], *middle[b], 3.0) for b in broken])]
    write_table(folder / "broken_bonds.csv", "t,site,other_site,X,Y,stretch", columns)
    tip = np.array([(breaks[b], *middle[b]) for b in broken])
    t, X, Y = tip[:, 0], np.maximum.accumulate(tip[:, 1]), tip[:, 2]
    write_table(folder / "crack.csv", "t,X,Y,x,y,speed,bonds_broken", (t, X, Y, X, Y, 0 * t, np.arange(len(t))))
    crack = json.loads((folder / "crack.json").read_text())
    crack.update(window_begin=0.02, window_end=0.055)
    (folder / "crack.json").write_text(json.dumps(crack))
    degree = np.bincount(bonds.ravel(), minlength=len(reference))

    def fields(time, number):
        open_by = np.where(above, 1, -1) * 4e-3 * np.clip((time / 1e-3 * end - reference[:, 0]) / end, 0, None)
        moved = np.column_stack((0.1 * reference[:, 0], STRAIN * reference[:, 1] + open_by))
        velocity = np.column_stack((5 * np.cos(number + 300 * reference[:, 0]), 20 * open_by / 4e-3))
        lost = [b for b in across if breaks[b] <= time or b in seed]
        gone = np.bincount(bonds[lost].ravel(), minlength=len(reference))
        return {"displacement": moved, "velocity": velocity, "damage": gone / degree, "site": site, "cauchy_stress": opening(1e4 + open_by)}
    whole = {}
    for name, time, number in (("lattice-0000.vtp", 0.0, 0), ("lattice-0001.vtp", times[-1], FRAMES - 1)):
        values = fields(time, number)
        kept = [b for b in range(len(bonds)) if b not in seed and (b not in breaks or breaks[b] > time)]
        now, before = (np.linalg.norm(np.diff(place[bonds[kept]], axis=1)[:, 0], axis=1)
                       for place in (reference + values["displacement"], reference))
        write_sites(folder / name, reference, values, bonds[kept], now / before)
        whole[name] = float(time)
    write_series(folder / "lattice.pvd", whole)
    names = {f"motion-{number:04}.vtp": float(time) for number, time in enumerate(times)}
    for number, (name, time) in enumerate(names.items()):
        values = fields(time, number)
        write_sites(folder / name, reference, {key: values[key] for key in ("displacement", "velocity")})
    write_series(folder / "motion.pvd", names)
