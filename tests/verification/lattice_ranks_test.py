#!/usr/bin/python3
"""Checks that a distributed lattice writes the same files as one rank, byte for byte, and that an error of one rank ends all.

Usage: lattice_ranks_test.py PATH_OF_LATCON
"""
import json
import unittest

from program import CASES, TemporaryFolder, latcon, latcon_on_ranks, read_csv

# All features: toughening, contact, an absorbing end, samples near the tip, frames.
STRIP = ["fracture", CASES / "quick.prm", "--skip-verification", "--no-report", "--quiet", "--threads", "1", "--set",
         "Sheet/length=3 cm", "--set", "Sheet/height=1.5 cm", "--set", "Fracture/right end=absorbing", "--set",
         "Contact/present=true", "--set", "Near tip/interval=4e-6", "--set", "Output/energy interval=50"]
MOTION = ["lattice", CASES / "quick.prm", "--quiet", "--threads", "1", "--set", "Lattice/solution=motion", "--set",
          "Time/end=0.1 ms", "--set", "Output/frame interval=0.05 ms"]


def files(folder):
    """Contents of files by name, without those that record the circumstances of the run."""
    return {path.name: path.read_bytes() for path in folder.iterdir() if path.name not in ("run.json", "log.txt")}


class LatticeRanks(TemporaryFolder):
    def compare(self, arguments, ranks):
        alone = latcon(*arguments, "--output-dir", self.folder / "alone")
        self.assertIn(alone.returncode, (0, 3), alone.stderr)
        expected = files(self.folder / "alone")
        run = latcon_on_ranks(ranks, *arguments, "--output-dir", self.folder / "shared")
        self.assertEqual(run.returncode, alone.returncode, run.stderr)
        found = files(self.folder / "shared")
        self.assertEqual(sorted(found), sorted(expected))
        for name, content in expected.items():
            self.assertEqual(found[name] == content, True, f"{name} on {ranks} ranks")
        return expected

    def test_crack_leaves_the_files_of_one_rank(self):
        written = self.compare(STRIP, 2)
        self.assertGreater(len(read_csv(self.folder / "alone" / "crack.csv")), 20)
        self.assertGreater(json.loads(written["near_tip.json"])["samples"], 5)
        self.assertGreater(json.loads(written["crack.json"])["bonds_broken"], 100)
        self.assertIn("lattice-0002.vtp", written)

    def test_motion_leaves_the_files_of_one_rank(self):
        written = self.compare(MOTION, 3)
        self.assertIn("lattice-0002.vtp", written)

    def test_error_of_one_rank_ends_all(self):
        (self.out / "lattice-0001.vtp" / "in the way").mkdir(parents=True)
        run = latcon_on_ranks(2, *STRIP, "--output-dir", self.out)
        self.assertEqual(run.returncode, 5, run.stderr)
        self.assertIn("lattice-0001.vtp", run.stderr)


if __name__ == "__main__":
    unittest.main(verbosity=2)
