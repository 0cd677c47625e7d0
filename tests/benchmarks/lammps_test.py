#!/usr/bin/python3
"""A sheet of linear bonds moves in LAMMPS as it does in latcon: lammps_test.py LATTICE_MOTION.

The two programs share no code, and LAMMPS reads the sheet as a list of sites, bonds and constants. Both take the same
steps of velocity Verlet from the same bits, so that their positions differ by round-off alone.
"""
import json
import math
import pathlib
import shutil
import sys
import tempfile
import unittest

sys.dont_write_bytecode = True

import lammps
from measure import run

SITES, STEPS, REPETITIONS = 400, 200, 9
SKIPPED = 77  # exit code that ctest treats as skipped


def largest_distance(frame, other):
    return max(math.dist(a, b) for a, b in zip(frame, other, strict=True))


def round_off(size, sites, steps):
    """Bound on the accumulated round-off in two programs that start from the same bits [m].

    In each step both round every coordinate once, by at most 2^-53 of the size of the sheet. Rounding of a bond force, about
    ten times 2^-53 of K d, moves a site by h^2 / m times that, which is less, since the step satisfies h^2 K / m < 1 and the
    sheet is longer than ten bonds. A rounding error oscillates about the motion. The step is half of the limit, so that in
    the norm over all 2 n coordinates the oscillation never exceeds 1 / sqrt(1 - 1/4) times the rounding. All roundings may
    add up at one site.
    """
    return 2 * 2. * steps * 2.**-53 * size * math.sqrt(2. * sites) / math.sqrt(0.75)


class Lammps(unittest.TestCase):
    def test_trajectories_are_the_same_to_round_off(self):
        with tempfile.TemporaryDirectory() as name:
            folder = pathlib.Path(name)
            motion = json.loads(run([PROGRAM, "linear", SITES, STEPS, REPETITIONS, 1, 0, folder / "sheet.data", folder / "ours"]))
            (folder / "in.sheet").write_text(
                lammps.input_text("sheet.data", motion["time_step"], STEPS, REPETITIONS, "theirs"), encoding="utf-8")
            lammps.move(folder, "none")
            theirs = lammps.read_positions((folder / "theirs").read_text(encoding="utf-8"))
            lines = (folder / "ours").read_text(encoding="utf-8").splitlines()
        sites = motion["sites"]
        ours = [tuple(map(float, line.split())) for line in lines]
        self.assertEqual(len(ours), (REPETITIONS + 1) * sites)
        self.assertEqual(list(theirs), [STEPS * n for n in range(REPETITIONS + 2)])
        start = theirs[0]
        size = max(abs(x) for site in start for x in site)
        spacing = min(math.dist(start[0], site) for site in start[1:])
        for n in range(1, REPETITIONS + 2):
            frame, steps = ours[(n - 1) * sites:n * sites], n * STEPS
            way, difference = largest_distance(frame, start), largest_distance(frame, theirs[steps])
            bound = round_off(size, sites, steps)
            print(f"{steps} steps: moved {way / spacing:.3f} bonds, differ by {difference / spacing:.1e}, bound {bound / spacing:.1e}")
            self.assertLess(difference, bound)
            # The sheet moves far enough for a meaningful bound: an error of 1e-6 in a constant would exceed it.
            self.assertGreater(way, 0.02 * spacing)
            self.assertLess(bound, 1e-6 * way)


if __name__ == "__main__":
    PROGRAM = sys.argv.pop(1)
    if shutil.which("lmp") is None:
        print("lmp is not installed")
        sys.exit(SKIPPED)
    unittest.main()
