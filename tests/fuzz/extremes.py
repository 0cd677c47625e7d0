#!/usr/bin/python3
"""Runs tiny sheets with entries anywhere in their documented ranges.

Usage: extremes.py FORK_SERVER [--runs N] [--seed S] [--only NUMBER] [--failures DIR]

Allowed outcomes are the exit codes 0, 2 (the dry run ends likewise, and nothing is written), 3, 4, 5. Other codes, signals,
timeouts, and non-finite numbers in a file of a run that ended with 0 are findings. A run is determined by seed and number alone.
Failing runs are saved in DIR, with the command that repeats them.
"""
import collections
import json
import math
import pathlib
import random
import re
import sys

sys.dont_write_bytecode = True
import vtk
from vtk.util.numpy_support import vtk_to_numpy
import numpy

import mutate

BASE = mutate.ROOT / "verification" / "cases" / "quick.prm"
# About 180 sites, or a few finite elements, with a seed crack.
TINY = {"Sheet/spacing": "0.4 mm", "Sheet/length": "6 mm", "Sheet/height": "4 mm", "Time/end": "0.004 ms", "Continuum/cells x": "3",
        "Continuum/cells y": "2", "Continuum/refinements": "0", "Continuum/degree": "2", "Fracture/seed sites": "2",
        "Fracture/seed position": "0.2", "Output/frame interval": "0.002 ms", "Near tip/behind": "2 mm", "Near tip/ahead": "2 mm",
        "Near tip/half height": "1.5 mm"}
COMMANDS = (["lattice"], ["lattice"], ["continuum"], ["continuum"], ["fracture", "--skip-verification", "--no-report"],
            ["fracture", "--skip-verification", "--no-report"])
MOVES = {"lattice": "Lattice/solution", "continuum": "Continuum/solution"}
EXPRESSIONS = ["0", "loading", "1e-5*x", "1e-3*y", "0.2*x+0.1*y", "1e-5*sin(1000*x)", "1e3", "-1e3*y", "1e-12", "if(x>0.003,1e-5,0)"]
MOST_STEPS = 60  # of a run whose automatic step is known; other runs are limited by time
LARGE = re.compile(r"^(length|height|spacing|cells [xy]|refinements|mesh file|adaptive cycles)$")  # they set the cost
RANGE = re.compile(r"(>=|>|<=|<) (\S+)")
# By definition not finite where no sample has a site.
MAY_HAVE_GAPS = {"near_tip.vti", "near_tip_folded.vti"}
# By definition not finite where too few bonds are left.
MAY_BE_UNKNOWN = {"strain_gradient_x", "strain_gradient_y"}
ENDS = {"exit 0", "exit 2", "exit 3", "exit 4", "exit 5"}


def bounds(rule):
    """Lower and upper bound of a range, and whether each is included."""
    low, high = (-math.inf, True), (math.inf, True)
    for sign, number in RANGE.findall(rule):
        if sign[0] == ">":
            low = (float(number.rstrip(",")), sign == ">=")
        else:
            high = (float(number.rstrip(",")), sign == "<=")
    return low, high


def number_in(rule, middle, pick):
    """Random number in a range, as often at its ends as inside, on a logarithmic scale around a number."""
    (low, with_low), (high, with_high) = bounds(rule)
    is_whole = "whole number" in rule
    kind = pick.random()
    if kind < 0.25:
        value = low if pick.random() < 0.5 else high
        if not math.isfinite(value):
            value = pick.choice([0., 1., 4294967295., 1e6])
        elif value == low and not with_low:
            value = math.nextafter(low, math.inf)
        elif value == high and not with_high:
            value = math.nextafter(high, -math.inf)
    else:
        middle = abs(middle or 1.)  # None is auto
        decades = 2. if kind < 0.75 else 20.
        value = middle * 10.**pick.uniform(-decades, decades)
        if low < 0. and pick.random() < 0.5:
            value = -value if low < -value else low * pick.random()
        value = min(max(value, low if with_low else math.nextafter(low, math.inf)), high if with_high else math.nextafter(high, -math.inf))
    return str(int(value)) if is_whole else repr(value)


def value_of(entry, value, pick):
    """@param value value in the base case"""
    rule = entry["allowed"]
    if rule.startswith("one of "):
        return pick.choice(rule[len("one of "):].split(", "))
    if rule.endswith(", or auto") and pick.random() < 0.2:
        return "auto"
    if RANGE.search(rule) or "number" in rule:
        return number_in(rule, value, pick)
    return pick.choice(EXPRESSIONS)


def make(schema, seed, number):
    """A command, and the entries that it sets.

    @param schema output of `latcon schema` for the base case
    """
    pick = random.Random(f"{seed}/{number}")
    command = pick.choice(COMMANDS)
    chosen = dict(TINY)
    if command[0] in MOVES and pick.random() < 0.7:
        chosen[MOVES[command[0]]] = "motion"
    may_change = [entry for entry in schema["entries"]
                  if not LARGE.match(entry["name"]) and entry["section"] not in ("Output", "Checkpoints", "Reference")]
    for entry in pick.sample(may_change, pick.choice([1, 1, 2, 2, 3, 5])):
        key = f"{entry['section']}/{entry['name']}"
        chosen[key] = value_of(entry, schema["case"]["values"][key], pick)
    return command, chosen


def read(reader, path):
    reader.SetFileName(str(path))
    reader.Update()
    return reader.GetOutput()


READERS = {".vtp": vtk.vtkXMLPolyDataReader, ".vtu": vtk.vtkXMLUnstructuredGridReader}


def not_finite(folder):
    """Files that contain a non-finite number."""
    found = []
    for path in sorted(folder.rglob("*")):
        if path.suffix in (".csv", ".json", ".pvd", ".prm"):
            if re.search(r"(?i)(?<![a-z_])[+-]?(nan|inf|infinity)(?![a-z_])", path.read_text(errors="replace")):
                found.append(path.name)
        elif path.suffix in READERS:
            data = read(READERS[path.suffix](), path)
            arrays = [data.GetPoints().GetData()] + [part.GetArray(i) for part in (data.GetPointData(), data.GetCellData(), data.GetFieldData())
                                                     for i in range(part.GetNumberOfArrays())]
            for array in arrays:
                values = vtk_to_numpy(array)
                bad = numpy.isinf(values) if array.GetName() in MAY_BE_UNKNOWN and path.suffix == ".vtp" else ~numpy.isfinite(values)
                if bad.any():
                    found.append(f"{path.name} ({array.GetName()})")
        elif path.suffix == ".vti" and path.name not in MAY_HAVE_GAPS:
            found.append(path.name + " (not looked at)")
    return found


class Extremes(mutate.Subject):
    def __init__(self, options):
        super().__init__(options)
        outcome, _, printed, _ = self.run(["schema", str(BASE)])
        if outcome != "exit 0":
            raise SystemExit(f"no list of entries: {outcome}")
        self.schema = json.loads(printed)

    def arguments(self, command, chosen):
        return [command[0], str(BASE), *command[1:], *(word for key, value in chosen.items() for word in ("--set", f"{key}={value}"))]

    def check(self, number):
        command, chosen = make(self.schema, self.options.seed, number)
        dry, said, printed, _ = self.run([*self.arguments(command, chosen), "--dry-run"])
        # A limited number of steps, whatever their length.
        step = re.search(r"time step:? (\S+) s", printed)
        if (dry == "exit 0" or "--yes" in said) and step and "Time/end" in chosen:
            chosen["Time/end"] = repr(min(float(chosen["Time/end"].split()[0]) * (1e-3 if chosen["Time/end"].endswith("ms") else 1.),
                                          MOST_STEPS * float(step[1])))
            if float(chosen["Time/end"]) > 0.:
                chosen["Output/frame interval"] = repr(0.4 * float(chosen["Time/end"]))
            dry, said, printed, _ = self.run([*self.arguments(command, chosen), "--dry-run"])
        seconds = re.search(r"^# time: about (\S+) s", printed, re.M)
        if dry == "exit 0" and seconds and float(seconds[1]) > mutate.SHORT:
            self.counts["too long to run, as the dry run says"] += 1
            return
        arguments = [*self.arguments(command, chosen), "--output-dir", "out", "--threads", "1", "--quiet"]
        outcome, said, _, left = self.run(arguments)
        finding = ""
        if outcome not in ENDS or any(alarm in said for alarm in mutate.ALARMS):
            finding = outcome
        elif (outcome == "exit 2") != (dry == "exit 2"):
            finding = f"{outcome} after a dry run with {dry}"
        elif outcome == "exit 2" and left:
            finding = "exit 2 with files: " + " ".join(left)
        elif outcome in ("exit 2", "exit 4", "exit 5") and not said.strip():
            finding = f"{outcome} without a word"
        elif outcome == "exit 0" and (found := not_finite(self.work / "input")):
            finding = "exit 0, not finite: " + " ".join(found)
        self.counts[outcome] += 1
        if finding:
            self.save(number, finding, arguments)


if __name__ == "__main__":
    sys.exit(mutate.campaign(__doc__.splitlines()[0], "runs", 3000, 20., Extremes))
