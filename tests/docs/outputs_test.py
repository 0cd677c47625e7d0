#!/usr/bin/python3
"""Checks that docs/reference.md documents every output file of a run and its contents; see documented.py.

Usage: outputs_test.py PATH_OF_LATCON
"""
import json
import pathlib
import subprocess
import sys
import tempfile
import unittest

sys.dont_write_bytecode = True
sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent))
from documented import Reference, undocumented

LATCON = sys.argv.pop(1) if len(sys.argv) > 1 else ""
CASES = pathlib.Path(__file__).resolve().parents[2] / "verification" / "cases"
SMALL = ["--set", "Sheet/length=2.5 cm", "--set", "Sheet/height=1.5 cm", "--set", "Time/end=1.5 ms"]
STUDY = {"title": "Small", "base": str(CASES / "quick.prm"),
         "set": {"Sheet/length": "2.5 cm", "Sheet/height": "1.5 cm", "Time/end": "0.4 ms"},
         "runs": {"one": {"about": "as it is"}, "two": {"about": "tougher", "set": {"Fracture/breaking stretch": 3.2}}},
         "claims": [{"claim": "It moves", "paper": "-", "note": "-", "rows": [
             {"run": "one", "quantity": "speed_lagrangian"}, {"run": "two", "quantity": "pattern", "is": "straight"},
             {"runs": ["one", "two"], "quantity": "pattern", "against": "Fracture/breaking stretch"}]}]}
HOLE = ["--set", "Sheet/length=3 cm", "--set", "Sheet/height=2 cm", "--set", "Sheet/hole radius=3 mm"]


class Outputs(unittest.TestCase):
    maxDiff = None

    @classmethod
    def setUpClass(cls):
        cls.temporary = tempfile.TemporaryDirectory()
        cls.folder = pathlib.Path(cls.temporary.name)

    @classmethod
    def tearDownClass(cls):
        cls.temporary.cleanup()

    def run_(self, command, *arguments, name=None, codes=(0,)):
        out = self.folder / (name or command)
        ended = subprocess.run([LATCON, command, *map(str, arguments), "--quiet", "--output-dir", out], capture_output=True,
                               text=True, timeout=600, check=False)
        self.assertIn(ended.returncode, codes, ended.stderr)
        return out

    def check(self, folder, *files):
        for file in files:
            self.assertTrue(list(folder.rglob(file)), file)
        self.assertEqual("\n".join(undocumented(folder)), "")

    def test_of_a_crack(self):
        out = self.run_("fracture", CASES / "quick.prm", "--skip-verification", *SMALL, "--set", "Checkpoints/steps=2000",
                        "--set", "Output/frame interval=0.5 ms")
        self.check(out, "crack.json", "near_tip.vti", "lattice-0001.vtp", "sheet.png", "checkpoint-*.h5")

    def test_of_both_sides_and_their_difference(self):
        lattice = self.run_("lattice", CASES / "hole.prm", *HOLE)
        continuum = self.run_("continuum", CASES / "hole.prm", *HOLE, "--set", "Continuum/adaptive cycles=1", "--set",
                              "Continuum/reaction tolerance=1")
        difference = self.run_("compare", lattice, continuum)
        self.check(lattice, "lattice-0001.vtp")
        self.check(continuum, "continuum_0001.vtu", "newton.csv", "meshes.csv", "reactions.csv")
        self.check(difference, "difference_sites.vtp", "difference_continuum.vtu")

    def test_of_motions(self):
        self.check(self.run_("lattice", CASES / "quick.prm", *SMALL[:4], "--set", "Lattice/solution=motion", "--set",
                             "Time/end=0.1 ms", name="waves"), "energy.csv")
        self.check(self.run_("continuum", CASES / "quick.prm", *SMALL[:4], "--set", "Continuum/solution=motion", "--set",
                             "Time/end=0.1 ms", name="fem-waves"), "energy.csv", "continuum_0001.vtu")

    def test_of_a_study(self):
        file = self.folder / "small.json"
        file.write_text(json.dumps(STUDY))
        self.check(self.run_("study", file, "--skip-verification", codes=(0, 3)), "study.json", "study.csv", "study.html",
                   "log.txt")

    def test_what_is_not_named_is_found(self):
        folder = self.folder / "made-up"
        folder.mkdir()
        (folder / "crack.csv").write_text("t [s],X [m],colour [1]\n")
        (folder / "crack.json").write_text('{"pattern": "straight", "speed_lagrangian_uncertainty": 1, "mood": {"x": 1}}')
        (folder / "lattice.pvd").write_text("")
        (folder / "diary.txt").write_text("")
        text = "| file | content |\n| --- | --- |\n| `crack.csv` | t [s], X [m] |\n| `crack.json` | pattern, speed_lagrangian, " \
               "each with `_uncertainty` |\n"
        self.assertEqual(undocumented(folder, Reference(text)), ["crack.csv: colour", "crack.json: mood", "crack.json: x",
                                                                 "diary.txt", "lattice.pvd"])


if __name__ == "__main__":
    unittest.main(verbosity=2)
