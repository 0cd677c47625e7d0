"""Checks that a distributed lattice writes the same files as one rank, byte for byte, and that an error of one rank ends all."""
import json

import pytest

from program import CASES, expect_same, files, latcon, latcon_on_ranks, read_csv

# Toughening, contact, samples near the tip, frames.
STRIP = ["fracture", CASES / "quick.prm", "--skip-verification", "--no-report", "--quiet", "--threads", "1", "--set",
         "Sheet/length=3 cm", "--set", "Sheet/height=1.5 cm", "--set",
         "Contact/present=true", "--set", "Near tip/interval=4e-6", "--set", "Output/energy interval=50"]
MOTION = ["lattice", CASES / "quick.prm", "--quiet", "--threads", "1", "--set", "Lattice/solution=motion", "--set",
          "Time/end=0.1 ms", "--set", "Output/frame interval=0.05 ms"]


def compare(tmp_path, arguments, ranks):
    alone = latcon(*arguments, "--output-dir", tmp_path / "alone")
    assert alone.returncode in (0, 3), alone.stderr
    expected = files(tmp_path / "alone")
    run = latcon_on_ranks(ranks, *arguments, "--output-dir", tmp_path / "shared")
    assert run.returncode == alone.returncode, run.stderr
    expect_same(tmp_path / "shared", expected)
    return expected


# Strains that change while the upper edge rolls along x.
HISTORY = ["--set", "Loading/history times=0.2 ms, 0.5 ms", "--set", "Loading/history strain y=1.5, 1.8", "--set",
           "Top edge/displacement x=free"]


@pytest.mark.parametrize("strip", [[*STRIP, "--set", "Fracture/right end=absorbing"], STRIP + HISTORY],
                         ids=["absorbing end", "history"])
def test_crack_leaves_the_files_of_one_rank(tmp_path, strip):
    written = compare(tmp_path, strip, 2)
    assert len(read_csv(tmp_path / "alone" / "crack.csv")) > 20
    assert json.loads(written["near_tip.json"])["samples"] > 5
    assert json.loads(written["crack.json"])["bonds_broken"] > 100
    assert "lattice-0002.vtp" in written


def test_motion_leaves_the_files_of_one_rank(tmp_path):
    written = compare(tmp_path, MOTION, 3)
    assert "lattice-0002.vtp" in written


def test_error_of_one_rank_ends_all(out):
    (out / "lattice-0001.vtp" / "in the way").mkdir(parents=True)
    run = latcon_on_ranks(2, *STRIP, "--output-dir", out)
    assert run.returncode == 5, run.stderr
    assert "lattice-0001.vtp" in run.stderr
