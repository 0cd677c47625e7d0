"""Forged checkpoints are refused; with LATCON_FAULTS=N those of every run. Damaged ones: resume_test.py."""
import os
import random

import pytest

import hostile
import victims

TIMES = int(os.environ.get("LATCON_FAULTS", 1))


@pytest.mark.parametrize("name", ["crack", "sheet in motion"])
def test_contents_that_nobody_left_are_refused(tmp_path, name):
    """One change for each number or list with a size, an index, a time or a count, and each kind of change once."""
    left, checkpoint = hostile.prepared(name, tmp_path)
    variants, chosen = hostile.variants(checkpoint), {}
    for array, change in random.Random(1).sample(variants, len(variants)):
        chosen.setdefault(hostile.number_of(array) if hasattr(change, "alters") else change, (array, change))
    hostile.require_refused(name, left, checkpoint, chosen.values())


@pytest.mark.skipif(TIMES == 1, reason="long")
@pytest.mark.parametrize("name", victims.VICTIMS)
def test_any_array_that_nobody_left_is_refused(tmp_path, name):
    left, checkpoint = hostile.prepared(name, tmp_path)
    variants = hostile.variants(checkpoint)
    hostile.require_refused(name, left, checkpoint, random.Random(1).sample(variants, min(len(variants), 20 * TIMES)))
