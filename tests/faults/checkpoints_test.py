"""Forged checkpoints are refused; with LATCON_FAULTS=N those of every run. Damaged ones: resume_test.py."""
import os
import random

import pytest

import hostile
import victims

TIMES = int(os.environ.get("LATCON_FAULTS", 1))
# One change for each number or list of a checkpoint with a size, an index, a time or a count.
CRACK = {
    "run/command": [hostile.many], "run/case": [hostile.unterminated], "run/commit": [hostile.elsewhere],
    "run/step": [hostile.LARGE], "run/time": [hostile.value(1e308)],
    "simulation/x": [hostile.longer, hostile.another_type], "simulation/vx": [hostile.endless], "simulation/bonds": [hostile.value(0xffff)],
    "simulation/lost_bonds": [hostile.value(255)], "simulation/work_viscous": [hostile.shorter],
    "simulation/ay": [hostile.no_number], "simulation/time": [hostile.value(-1e308)],
    "simulation/parts": [hostile.value(1 << 30), hostile.value(3)], "simulation/n_broken": [hostile.LARGE],
    "simulation/initial_energy": [hostile.value(1e300)], "simulation/fracture/tip": [hostile.LARGE],
    "record/last_tip": [hostile.LARGE, hostile.longer], "record/tip": [hostile.LARGE, hostile.shorter],
    "record/broken_bonds": [hostile.LARGE, hostile.value(6), hostile.value(.5), hostile.shorter], "record/energies": [hostile.value(1e308)],
    "near_tip/sampler/plain/motion/weights": [hostile.many], "near_tip/sampler/folded/n": [hostile.LARGE],
    "near_tip/sampler/folded/0/tensors/values": [hostile.longer],
    "near_tip/sampler/n_pending": [hostile.LARGE], "near_tip/sampler/path": [hostile.shorter], "near_tip/sampler/pending/n": [hostile.LARGE],
    "near_tip/sampler/pending/0/block": [hostile.value(4)], "near_tip/sampler/last_tip": [hostile.LARGE],
    "near_tip/sampler/plain/samples": [hostile.LARGE], "near_tip/blocks/n": [hostile.LARGE],
    "near_tip/blocks/0/vortices/sizes": [hostile.LARGE, hostile.value(0)], "near_tip/blocks/1/asymmetry": [hostile.longer],
    "film/frames/times": [hostile.value(-1.), hostile.shorter], "frames/times": [hostile.many],
    "next_frame": [hostile.value(-1e308), hostile.longer],
}
SHEET = {
    "solver/steps": [hostile.LARGE], "solver/time": [hostile.value(-1e308)], "solver/displacement": [hostile.longer],
    "solver/velocity": [hostile.no_number], "solver/linear_solver/is_stale": [hostile.value(2)],
    "solver/elastic_diagonal": [hostile.shorter], "record/energies": [hostile.value(-1.)],
    "frames/frames": [hostile.LARGE, hostile.value(0)], "next_frame": [hostile.value(1e-300)],
}


@pytest.mark.parametrize("name, changes", [("crack", CRACK), ("sheet in motion", SHEET)])
def test_contents_that_nobody_left_are_refused(tmp_path, name, changes):
    left, checkpoint = hostile.prepared(name, tmp_path)
    flat = [(array, change) for array, all_changes in changes.items() for change in all_changes]
    hostile.require_refused(name, left, checkpoint, flat)


@pytest.mark.skipif(TIMES == 1, reason="long")
@pytest.mark.parametrize("name", victims.VICTIMS)
def test_any_array_that_nobody_left_is_refused(tmp_path, name):
    left, checkpoint = hostile.prepared(name, tmp_path)
    variants = hostile.variants(checkpoint)
    hostile.require_refused(name, left, checkpoint, random.Random(1).sample(variants, min(len(variants), 20 * TIMES)))
