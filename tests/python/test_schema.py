"""Checks that `latcon schema` has every entry of a case, with the types, ranges and defaults that the program uses."""
import json
import math
import os
import pathlib
import re
import subprocess

import latcon
from latcon.program import ask

TYPES = {"number": (int, float), "integer": int, "numbers": list, "boolean": bool, "word": str, "text": str}
# Largest number of problems that the program reports.
MOST_PROBLEMS = 50
OUT_OF_RANGE = re.compile(r"(number \d+ in the list: )?(out of range|beyond)")


def run(*arguments):
    return subprocess.run([os.environ["LATCON"], *map(str, arguments)], capture_output=True, text=True, check=False)


def refused(overrides):
    """Keys that the program refuses, with its messages."""
    found = {}
    items = list(overrides.items())
    for at in range(0, len(items), MOST_PROBLEMS):
        words = [word for key, value in items[at:at + MOST_PROBLEMS] for word in ("--set", f"{key}={value}")]
        ended = run("schema", latcon.schema().cases["quick"], *words)
        for line in ended.stderr.splitlines():
            if match := re.match(r"(?:latcon: )?--set: ([^=]+) = .*?: (.*)", line):
                found[match[1]] = match[2]
    return found


def test_prints_one_document_with_format_and_version():
    document = json.loads(run("schema").stdout)
    assert document["format"] == "latcon-schema" and document["format_version"] == 1
    assert document["version"] == run("--version").stdout.split()[1] and "case" not in document
    assert {"fig1", "quick", "hole"} <= set(document["cases"])
    assert all(pathlib.Path(path).is_file() for path in document["cases"].values())


def test_types_units_and_ranges_parse():
    for key, entry in latcon.schema().items():
        assert entry.type in TYPES, key
        assert entry.documentation and (entry.allowed or entry.type in ("text", "number")), key
        assert (entry.type == "word") == bool(entry.words), key
        assert set(entry.range) <= {"minimum", "exclusive_minimum", "maximum", "exclusive_maximum"}, key
        assert (entry.unit is not None) == (entry.type in ("number", "numbers")), key
        if entry.required:
            assert entry.default is None, key
        elif entry.default is None:
            assert entry.auto, key
        else:
            assert isinstance(entry.default, TYPES[entry.type]), key
            numbers = entry.default if entry.type == "numbers" else [entry.default]
            if entry.type in ("number", "integer", "numbers"):
                bounds = entry.range
                assert all(bounds.get("minimum", -math.inf) <= number <= bounds.get("maximum", math.inf) and
                           bounds.get("exclusive_minimum", -math.inf) < number < bounds.get("exclusive_maximum", math.inf)
                           for number in numbers), key
            assert not entry.words or entry.default in entry.words


def test_bounds_are_those_that_the_program_keeps():
    entries = latcon.schema()
    beyond, excluded, included = {}, {}, {}
    for key, entry in entries.items():
        bounds = entry.range
        step = 1 if entry.type == "integer" else 1e-3
        for end, outwards in (("maximum", step), ("minimum", -step)):  # the lower one where there are both
            if end in bounds:
                included[key], beyond[key] = bounds[end], bounds[end] + outwards * max(1, abs(bounds[end]))
        if "exclusive_minimum" in bounds:
            excluded[key] = bounds["exclusive_minimum"]
    assert len(beyond) > 50 and excluded
    for overrides in (beyond, excluded):
        problems = refused(overrides)
        assert set(problems) == set(overrides)
        # A negative number is not of the type of an unsigned entry.
        assert all(OUT_OF_RANGE.match(problem) for problem in problems.values())
    # Checks of several entries may refuse them together, but not for their ranges.
    assert not any(OUT_OF_RANGE.match(problem) for problem in refused(included).values())
    # The upper ends of those that have two.
    above = {key: (entry.range["maximum"] + 1 if entry.type == "integer" else 1.001 * entry.range["maximum"])
             for key, entry in entries.items() if "maximum" in entry.range}
    assert set(refused(above)) == set(above)


def test_words_and_truth_values_are_those_that_the_program_takes():
    closed = {key: entry for key, entry in latcon.schema().items() if entry.type in ("word", "boolean")}
    assert set(refused(dict.fromkeys(closed, "nonsense"))) == set(closed)
    problems = refused({key: entry.words[-1] if entry.words else "true" for key, entry in closed.items()})
    assert not any("not a word" in problem for problem in problems.values())


def test_defaults_are_those_of_a_dry_run(tmp_path):
    needed = {key: {"Sheet/spacing": "0.001", "Sheet/length": "0.04", "Sheet/height": "0.02", "Material/density": "944"}
              .get(key, "0.1") for key, entry in latcon.schema().items() if entry.required}
    case = tmp_path / "case.json"
    sections = {}
    for key, value in needed.items():
        section, name = key.split("/")
        sections.setdefault(section, {})[name] = float(value)
    case.write_text(json.dumps(sections))
    ended = run("lattice", case, "--dry-run")
    assert ended.returncode == 0, ended.stderr
    section, seen = "", set()
    for line in ended.stdout.splitlines():
        if line.startswith("subsection "):
            section = line.removeprefix("subsection ")
        elif match := re.match(r" *set (.+?) *=(.*)$", line):
            entry = latcon.schema()[f"{section}/{match[1]}"]
            seen.add(entry.key)
            if entry.required:
                continue
            text = match[2].partition(" # ")[0].strip()
            if text == "auto":
                value = None
            elif entry.type == "numbers":
                value = [float(number) for number in text.split(",") if number.strip()]
            elif entry.type in ("number", "integer"):
                value = float(text)
            else:
                value = {"true": True, "false": False}.get(text, text)
            assert value == entry.default and type(value == entry.default) is bool, entry.key
    assert seen == set(latcon.schema())


def test_values_of_a_case_are_printed_in_si():
    quick = latcon.schema().cases["quick"]
    case = json.loads(ask("schema", str(quick), "--set", "Sheet/height=15 mm", "--set", "Contact/present=false"))["case"]
    assert case["values"]["Sheet/height"] == 0.015
    assert case["values"]["Contact/present"] is False
    assert case["values"]["Time/step"] is None
    printed = run("fracture", quick, "--set", "Sheet/height=15 mm", "--set", "Contact/present=false", "--dry-run").stdout
    assert "subsection Sheet" in case["resolved"] and printed.startswith(case["resolved"])
