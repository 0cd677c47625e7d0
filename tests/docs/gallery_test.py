"""The numbers of the gallery are those of the program: its cracks, run again, to the digits on the page."""
import pathlib
import re

import pytest

ROOT = pathlib.Path(__file__).resolve().parents[2]
import latcon as package
from program import FULL, latcon, read_json

STUDY = ROOT / "verification" / "studies" / "paper.json"
SHOWN = re.compile(r"Patterns over its seeds.*?Pictures of seed (\d+): (\w+)\. Measured: speed ([\d.]+) m/s .*?detached sites (\d+) ")
CRACKS = {title: SHOWN.search(" ".join(text.split())).groups()
          for title, text in re.findall(r"^## [^\n]*: `([^`]+)`\n(.*?)(?=^## )", (ROOT / "docs" / "gallery.md").read_text(), re.M | re.S)
          if "Pictures of seed" in text}
QUICK = "small-1.065"  # the shortest


def test_cracks_are_found():
    assert {"fig1", "eta-0.15", "no-nnn-across", QUICK} <= set(CRACKS)


@pytest.mark.parametrize("name", [name for name in CRACKS if FULL or name == QUICK])
def test_numbers_are_those_of_the_program(out, name):
    seed, pattern, speed, detached = CRACKS[name]
    study = read_json(STUDY)
    entries = {**study["set"], **study["runs"][name]["set"], "Lattice/noise seed": seed}
    settings = [word for key, value in entries.items() for word in ("--set", f"{key}={str(value).lower() if isinstance(value, bool) else value}")]
    latcon("fracture", STUDY.parent / study["base"], "--skip-verification", "--no-report", "--output-dir", out, *settings, expect=(0, 3))
    crack = package.open(out).crack
    assert (crack.pattern, f"{float(crack.speed_lagrangian):.4g}", f"{float(crack.detached_sites):g}") == (pattern, speed, detached)
