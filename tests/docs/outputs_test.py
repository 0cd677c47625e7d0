"""Checks that docs/reference-*.md document every output file of a run and its contents; see documented.py."""
import json

from documented import undocumented
from program import CASES, latcon, settings

SMALL = settings("Sheet/length=2.5 cm", "Sheet/height=1.5 cm", "Time/end=1.5 ms")
STUDY = {"title": "Small", "base": str(CASES / "quick.prm"),
         "set": {"Sheet/length": "2.5 cm", "Sheet/height": "1.5 cm", "Time/end": "0.4 ms"},
         "runs": {"one": {"about": "as it is"}, "two": {"about": "tougher", "set": {"Fracture/breaking stretch": 3.2}}},
         "claims": [{"claim": "It moves", "paper": "-", "note": "-", "rows": [
             {"run": "one", "quantity": "speed_lagrangian"}, {"run": "two", "quantity": "pattern", "is": "straight"},
             {"runs": ["one", "two"], "quantity": "pattern", "against": "Fracture/breaking stretch"}]}]}
HOLE = settings("Sheet/length=3 cm", "Sheet/height=2 cm", "Sheet/hole radius=3 mm")


def run_(tmp_path, command, *arguments, codes=0):
    out = tmp_path / command
    latcon(command, *arguments, "--quiet", "--output-dir", out, expect=codes)
    return out


def check(folder, *files):
    for file in files:
        assert list(folder.rglob(file)), file
    assert "\n".join(undocumented(folder)) == ""


def test_of_a_crack(tmp_path):
    out = run_(tmp_path, "fracture", CASES / "quick.prm", "--skip-verification", *SMALL,
               *settings("Checkpoints/steps=2000", "Output/frame interval=0.5 ms"))
    check(out, "crack.json", "near_tip.vti", "lattice-0001.vtp", "sheet.png", "checkpoint-*.h5")


def test_of_both_sides_and_their_difference(tmp_path):
    lattice = run_(tmp_path, "lattice", CASES / "hole.prm", *HOLE)
    continuum = run_(tmp_path, "continuum", CASES / "hole.prm", *HOLE,
                     *settings("Continuum/adaptive cycles=1", "Continuum/reaction tolerance=1"))
    difference = run_(tmp_path, "compare", lattice, continuum)
    check(lattice, "lattice-0001.vtp")
    check(continuum, "continuum_0001.vtu", "newton.csv", "meshes.csv", "reactions.csv")
    check(difference, "difference_sites.vtp", "difference_continuum.vtu")


def test_of_motions(tmp_path):
    for command, *files in (("lattice", "energy.csv"), ("continuum", "energy.csv", "continuum_0001.vtu")):
        waves = settings(f"{command.capitalize()}/solution=motion", "Time/end=0.1 ms")
        check(run_(tmp_path, command, CASES / "quick.prm", *SMALL[:4], *waves), *files)


def test_of_a_study(tmp_path):
    file = tmp_path / "small.json"
    file.write_text(json.dumps(STUDY))
    check(run_(tmp_path, "study", file, "--skip-verification", codes=(0, 3)), "study.json", "study.csv", "study.html", "log.txt")
