"""Whatever a user gives latcon, it is run or refused: exit code 0, 2, 3 or 4, in bounded time, no file left where the input is bad.

Inputs are made by hypothesis from the entries that `latcon schema` declares, the shipped cases and the shipped studies; a failing one
is reduced to its smallest form. By default they are the same in every run; LATCON_FUZZ=N makes N times as
many, and `--hypothesis-seed=S` chooses others.
"""
import json
import math
import os
import pathlib
import re
import sys
import tempfile

import numpy

sys.path.append(str(pathlib.Path(__file__).resolve().parents[1] / "verification"))
os.environ.update(ASAN_OPTIONS="detect_leaks=0:abort_on_error=0", UBSAN_OPTIONS=
                  f"print_stacktrace=1:suppressions={pathlib.Path(__file__).with_name('ubsan-suppressions.txt')}")
from program import CACHE, CASES, latcon, read

os.environ["HYPOTHESIS_STORAGE_DIRECTORY"] = f"{CACHE.name}/hypothesis"
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

STUDIES = sorted((CASES.parent / "studies").glob("*.json"))
QUICK, START, HOLE = ({"name": name, **json.loads(latcon("schema", name).stdout)} for name in ("quick", "start", "hole"))
ENTRIES = QUICK["entries"]
ALARMS = ("internal error", "runtime error:", "AddressSanitizer", "terminate called")

NUMBERS = ["0", "1", "-1", "2", "0.5", "1e-3", "1e3", "1e9", "1e20", "1e-20", "1e21", "1e300", "4.9e-324", "1e400", "-0", "nan", "-inf",
           "0x10", "1,5", "1.5.2", "1e", "--1", "+3", "4294967295", "4294967296", "18446744073709551616", "auto", "none", "", " ", "12"]
EXPRESSIONS = ["0", "loading", "x", "1e-5*x", "0.2*x+0.1*y", "1e-5*sin(1000*x)", "-1e3*y", "if(x>0.003,1e-5,0)", "1/0", "1/x", "sqrt(-1)",
               "log(0)", "1e300*x", "rand()", "x=3", "x,y", "((((", "x?1:0", "2^2^2^2", "exp(1000)", "min(1)", "x y", "0*x/0", "!x"]
UNITS = ["m", "mm", "um", "Pa", "MPa", "s", "ms", "kg/m^3", "g/cm^3", "N s/m", "%", "deg", "1", "furlong", "mm^-1", "m^99", "m/", "/s", "µm"]
BYTES = [b"\0", b"\xff", b"\xef\xbb\xbf", b"\r\n", b"\\\n", b"#", b"=", b"/", b"\x1b[2J", b"\xc3\x28", b"{", b"]", b"\"", b"end\n",
         b"subsection ", b"set ", b"\t", b" " * 300, b"A" * 70000]
WORDS = ["", "-", "--", "--set", "--set=", "--threads", "0", "-1", "1e9", "--output-dir=", "--quiet", "--case", ".", "/", "/dev/null",
         "none.prm", "case.prm", "lattice", "continuum", "fracture", "verify", "study", "compare", "paper", "energy", "--quick", "--help",
         "--version", "--tolerance", "displacement=1", "--time", "nan", "\udcff", "a" * 5000, "--resume", "--no-report"]


def examples(number):
    """Settings of a test with this number of inputs by default."""
    times = os.environ.get("LATCON_FUZZ")
    return settings(max_examples=number * int(times or 1), derandomize=times is None, database=None, deadline=None, print_blob=True,
                    suppress_health_check=list(HealthCheck))


def key(entry):
    return f"{entry['section']}/{entry['name']}"


def numbers(entry, middle):
    """Numbers in the range of an entry: its ends, and both near and far from a value on a logarithmic scale."""
    limits = entry.get("range", {})
    low = limits.get("minimum", math.nextafter(limits.get("exclusive_minimum", -1e300), math.inf))
    high = limits.get("maximum", math.nextafter(limits.get("exclusive_maximum", 1e300), -math.inf))
    middle = abs(middle) if isinstance(middle, (int, float)) and middle else 1.
    powers = st.one_of(st.floats(-2., 2.), st.floats(-20., 20.))
    values = st.one_of(st.sampled_from([low, high, 0.]), st.builds(lambda power, sign: sign * middle * 10.**power, powers, st.sampled_from([1., -1.])))
    values = values.map(lambda value: min(max(value, low), high))
    if entry["type"] == "integer":
        return values.map(lambda value: str(min(int(max(value, 0.)), int(limits.get("maximum", 2**64 - 1)))))
    return values.map(repr)


def allowed(entry, values=None):
    """Values in the documented range of an entry, as text; words of expressions where it is a text."""
    if "words" in entry or entry["type"] == "boolean":
        return st.sampled_from(entry.get("words", ["true", "false"]))
    if entry["type"] == "text":
        return st.sampled_from(EXPRESSIONS)
    one = numbers(entry, (values or QUICK["case"]["values"])[key(entry)])
    if entry["type"] == "numbers":
        return st.lists(one, max_size=3).map(", ".join)
    return st.one_of(one, st.just("auto")) if entry.get("auto") else one


def any_value(entry):
    """Allowed values, and others of any kind."""
    number = st.sampled_from(NUMBERS)
    return st.one_of(allowed(entry), allowed(entry), number, st.sampled_from(EXPRESSIONS), st.text(max_size=12),
                     st.builds("{} {}".format, number, st.sampled_from(UNITS)))


@st.composite
def assignments(draw):
    """(section, name, value) of any entry, some of them misspelt."""
    entry = draw(st.sampled_from(ENTRIES))
    place = [entry["section"], entry["name"]]
    if draw(st.integers(0, 5)) == 0:
        which, at = draw(st.integers(0, 1)), draw(st.integers(0, 8))
        place[which] = place[which][:at] + draw(st.sampled_from(["", "x", " ", "/", "é", "#"])) + place[which][at + 1:]
    return (*place, draw(any_value(entry)))


def damaged(draw, data):
    """Bytes, one time in eight with some of them replaced."""
    if draw(st.integers(0, 7)):
        return data
    at, length = draw(st.integers(0, len(data))), draw(st.sampled_from([0, 1, 2, 10, 100, 10**6]))
    return data[:at] + draw(st.one_of(st.sampled_from(BYTES), st.binary(max_size=4))) + data[at + length:]


def text_of(value):
    return ", ".join(map(str, value)) if isinstance(value, list) else "auto" if value is None else json.dumps(value).strip('"')


@st.composite
def cases(draw):
    """Name and bytes of a case: a shipped one with entries changed, repeated, lost or misspelt, in either format."""
    values = draw(st.sampled_from([QUICK, START, HOLE]))["case"]["values"]
    entries = [(*name.split("/"), text_of(value)) for name, value in values.items()]
    for added in draw(st.lists(assignments(), max_size=3)):
        at = draw(st.integers(0, len(entries) - 1))
        own = [number for number, entry in enumerate(entries) if entry[:2] == added[:2]]
        how = draw(st.sampled_from(["replace", "replace", "repeat", "lose", "swap"]))
        if how == "replace" and own:
            entries[own[0]] = added
        elif how == "lose":
            del entries[at]
        elif how == "swap" and own:
            entries[own[0]], entries[at] = (*added[:2], entries[at][2]), (*entries[at][:2], added[2])
        else:
            entries.insert(at, added)
    sections = {}
    for section, name, value in entries:
        sections.setdefault(section, []).append((name, value))
    if draw(st.integers(0, 3)) == 0:
        document = draw(trees({section: dict(own) for section, own in sections.items()}))
        return draw(st.sampled_from(["case.json", "case.JSON"])), damaged(draw, json.dumps(document).encode())
    text = "".join(f"subsection {section}\n" + "".join(f"  set {name} = {value}\n" for name, value in own) + "end\n" for section, own in sections.items())
    return "case.prm", damaged(draw, text.encode("utf-8", "surrogatepass"))


@st.composite
def trees(draw, tree):
    """A JSON tree with a value changed, removed, renamed or repeated somewhere in it, or as it is."""
    if not draw(st.booleans()):
        return tree
    if isinstance(tree, (dict, list)) and tree and draw(st.integers(0, 5)):
        tree = tree.copy()
        at = draw(st.sampled_from(list(tree) if isinstance(tree, dict) else range(len(tree))))
        how = draw(st.integers(0, 5))
        if how:
            tree[at] = draw(trees(tree[at]))
        elif isinstance(tree, list):
            tree.insert(at, draw(st.sampled_from(tree)))
        else:
            value = tree.pop(at)
            if draw(st.booleans()):
                tree[at + draw(st.sampled_from(["x", " ", "é"]))] = value
        return tree
    scalars = st.one_of(st.none(), st.booleans(), st.integers(-2**65, 2**65), st.floats(allow_nan=False, allow_infinity=False), st.text(max_size=9),
                        st.sampled_from(NUMBERS + EXPRESSIONS))
    return draw(st.recursive(scalars, lambda inner: st.one_of(st.lists(inner, max_size=3), st.dictionaries(st.text(max_size=3), inner, max_size=3)),
                             max_leaves=4))


def options(given_):
    return [word for section, name, value in given_ for word in ("--set", f"{section}/{name}={value}".replace("\0", ""))]


def outcome(arguments, files, codes=(0, 2, 3, 4)):
    """Runs latcon in a folder with files and checks how it ends. Returns the run and a folder with what it left."""
    folder = tempfile.TemporaryDirectory()
    for name, data in files.items():
        pathlib.Path(folder.name, name).write_bytes(data)
    run = latcon(*arguments, cwd=folder.name, timeout=60, expect=codes)
    left = {path.name for path in pathlib.Path(folder.name).iterdir()} - set(files)
    assert not any(alarm in run.stderr for alarm in ALARMS), run.stderr
    assert not left or run.returncode != 2 and "--dry-run" not in arguments, left
    assert run.returncode in (0, 3) or run.stderr.strip(), "not a word of what is wrong"
    return run, folder


@examples(90)
@given(cases(), st.sampled_from(["lattice", "continuum", "fracture", "verify"]), st.lists(assignments(), max_size=2))
def test_any_case_is_read_or_refused(case, command, more):
    name, data = case
    outcome([command, *["--case"] * (command == "verify"), name, *options(more), "--dry-run"], {name: data})


@st.composite
def studies(draw):
    """Bytes of a study: a shipped one with few runs, changed somewhere."""
    document = json.loads(draw(st.sampled_from(STUDIES)).read_text())
    if "sweep" in document:
        document["sweep"] = document["sweep"][:1]
    else:
        kept = draw(st.lists(st.sampled_from(list(document["runs"])), min_size=1, max_size=3, unique=True))
        document["runs"] = {name: document["runs"][name] for name in kept}
        document["claims"] = [dict(claim, rows=rows) for claim in document["claims"]
                              if (rows := [row for row in claim["rows"] if set(row.get("runs", [row.get("run")])) <= set(kept)])]
        document["pictures"] = [name for name in document.get("pictures", []) if name in kept] or kept[:1]
    return damaged(draw, json.dumps(draw(trees(dict(document, base="case.prm", seeds=[1])))).encode())


@examples(20)
@given(studies(), st.sampled_from([[], ["--quick"]]), st.lists(assignments(), max_size=1))
def test_any_study_is_read_or_refused(study, quick, more):
    files = {"study.json": study, "case.prm": (CASES / "quick.prm").read_bytes()}
    outcome(["study", "study.json", "--dry-run", *quick, *options(more)], files)


@examples(20)
@given(st.lists(st.sampled_from(WORDS), min_size=1, max_size=6))
def test_any_options_are_understood_or_refused(words):
    outcome([*words, "--dry-run"], {"case.prm": (CASES / "quick.prm").read_bytes()})


# About 180 sites, or a few finite elements, with a seed crack.
TINY = {"Sheet/spacing": "0.4 mm", "Sheet/length": "6 mm", "Sheet/height": "4 mm", "Time/end": "4e-6", "Continuum/cells x": "3",
        "Continuum/cells y": "2", "Continuum/refinements": "0", "Continuum/degree": "2", "Fracture/seed sites": "2",
        "Fracture/seed position": "0.2", "Output/frame interval": "2e-6", "Near tip/behind": "2 mm", "Near tip/ahead": "2 mm",
        "Near tip/half height": "1.5 mm"}
LARGE = re.compile(r"length|height|spacing|cells [xy]|refinements|mesh file|adaptive cycles")  # they set the cost
MAY_CHANGE = [entry for entry in ENTRIES
              if not LARGE.fullmatch(entry["name"]) and entry["section"] not in ("Output", "Checkpoints", "Reference")]
MOST_STEPS, SHORT = 60, 2.  # of a run whose automatic step is known; largest estimated time of a run [s]
# By definition not finite where no sample has a site, or too few bonds are left.
MAY_HAVE_GAPS, MAY_BE_UNKNOWN = {"near_tip.vti", "near_tip_folded.vti"}, {"strain_gradient_x", "strain_gradient_y"}


def not_finite(folder):
    """Files that contain a number that is not finite."""
    for path in sorted(folder.rglob("*")):
        if path.suffix in (".csv", ".json", ".pvd", ".prm"):
            if re.search(r"(?i)(?<![a-z_])[+-]?(nan|inf|infinity)(?![a-z_])", path.read_text(errors="replace")):
                yield path.name
        elif path.suffix in (".vtp", ".vtu"):
            data = read(path)
            parts = (data.PointData, data.CellData, data.FieldData)
            for name, values in [("points", data.Points), *((name, part[name]) for part in parts for name in part.keys())]:
                if (numpy.isinf(values) if name in MAY_BE_UNKNOWN else ~numpy.isfinite(values)).any():
                    yield f"{path.name} ({name})"
        elif path.suffix == ".vti" and path.name not in MAY_HAVE_GAPS:
            yield path.name + " (not looked at)"


@st.composite
def tiny_runs(draw):
    """Command, and its entries by key: a tiny sheet, of which one to five values are anywhere in their ranges."""
    command = draw(st.sampled_from([["lattice"], ["continuum"], ["fracture", "--skip-verification", "--no-report"]]))
    chosen = dict(TINY)
    if command[0] != "fracture" and draw(st.booleans()):
        chosen[command[0].capitalize() + "/solution"] = "motion"
    for entry in draw(st.lists(st.sampled_from(MAY_CHANGE), min_size=1, max_size=5, unique_by=key)):
        chosen[key(entry)] = draw(allowed(entry))
    return command, chosen


@examples(10)
@given(tiny_runs())
def test_allowed_values_run_or_are_refused(tiny):
    command, chosen = tiny

    def words():
        return [command[0], CASES / "quick.prm", *command[1:], *options((*name.split("/"), value) for name, value in chosen.items())]
    dry, _ = outcome([*words(), "--dry-run"], {})
    # A limited number of steps, whatever their length.
    if step := re.search(r"time step:? (\S+) s", dry.stdout):
        chosen["Time/end"] = repr(min(float(chosen["Time/end"]), MOST_STEPS * float(step[1])))
        chosen["Output/frame interval"] = repr(max(0.4 * float(chosen["Time/end"]), 0.))
        dry, _ = outcome([*words(), "--dry-run"], {})
    seconds = re.search(r"^# time: about (\S+) s", dry.stdout, re.M)
    if dry.returncode == 0 and seconds and float(seconds[1]) > SHORT:
        return
    run, folder = outcome([*words(), "--output-dir", "out", "--threads", "1", "--quiet"], {}, codes=(0, 2, 3, 4, 5))
    assert (run.returncode == 2) == (dry.returncode == 2), f"exit code {run.returncode} after a dry run with {dry.returncode}"
    if run.returncode == 0:
        assert not list(not_finite(pathlib.Path(folder.name)))
