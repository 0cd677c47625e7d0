"""A sheet of linear bonds moves in LAMMPS as it does in latcon: lammps_test.py LATTICE_MOTION.

The two programs share no code, and LAMMPS reads the sheet as a list of sites, bonds and constants. Both take the same
steps of velocity Verlet from the same bits, so that their positions differ by round-off alone.
"""
import json
import math
import os
import shutil

import pytest

import lammps
from measure import run

SITES, STEPS, REPETITIONS = 400, 200, 9


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


@pytest.mark.skipif(shutil.which("lmp") is None, reason="lmp is not installed")
def test_trajectories_are_the_same_to_round_off(tmp_path):
    motion = json.loads(run([os.environ["LATTICE_MOTION"], "linear", SITES, STEPS, REPETITIONS, 1, 0, tmp_path / "sheet.data",
                             tmp_path / "ours"]))
    (tmp_path / "in.sheet").write_text(lammps.input_text("sheet.data", motion["time_step"], STEPS, REPETITIONS, "theirs"))
    lammps.move(tmp_path, "none")
    theirs = lammps.read_positions((tmp_path / "theirs").read_text())
    lines = (tmp_path / "ours").read_text().splitlines()
    sites = motion["sites"]
    ours = [tuple(map(float, line.split())) for line in lines]
    assert len(ours) == (REPETITIONS + 1) * sites
    assert list(theirs) == [STEPS * n for n in range(REPETITIONS + 2)]
    start = theirs[0]
    size = max(abs(x) for site in start for x in site)
    spacing = min(math.dist(start[0], site) for site in start[1:])
    for n in range(1, REPETITIONS + 2):
        frame, steps = ours[(n - 1) * sites:n * sites], n * STEPS
        way, difference = largest_distance(frame, start), largest_distance(frame, theirs[steps])
        bound = round_off(size, sites, steps)
        print(f"{steps} steps: moved {way / spacing:.3f} bonds, differ by {difference / spacing:.1e}, bound {bound / spacing:.1e}")
        assert difference < bound
        # The sheet moves far enough for a meaningful bound: an error of 1e-6 in a constant would exceed it.
        assert way > 0.02 * spacing
        assert bound < 1e-6 * way
