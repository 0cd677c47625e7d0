"""A run and the dry run of a file refuse the cases of refusals.txt, with the place of what is wrong, and nothing is written;
and no others. So are the words of words.txt.
"""
import pathlib
import shlex

import pytest

from program import CASES, latcon

MOTION = {"Continuum/solution": "motion", "Time/end": "0.01 ms", "Continuum/cells x": 3, "Continuum/cells y": 2, "Continuum/degree": 2}
NONLOCAL = {"Sheet/spacing": "1 mm", "Sheet/length": "30 mm", "Sheet/height": "16 mm", "Fracture/seed sites": 8,
            "Time/integrator": "runge-kutta-chebyshev", "Fracture/stop position": 0.7}
HISTORY = {"Loading/history times": "0.1 ms, 0.3 ms, 0.4003 ms, 0.7 ms", "Loading/history strain y": "1.8, 0.6, 0.6, 1.8"}
# Words of a command, and entries that its cases share.
COMMANDS = {"lattice": (["lattice"], {}), "continuum": (["continuum"], {}), "motion": (["continuum"], MOTION),
            "fracture": (["fracture", "--skip-verification", "--no-report"], {}),
            "history": (["fracture", "--skip-verification", "--no-report"], HISTORY),
            "nonlocal": (["fracture", "--side", "continuum", "--skip-verification", "--no-report"], NONLOCAL)}


def listed(name):
    """Pairs of a line and the parts of a message, from a file beside this one."""
    lines = [line for line in pathlib.Path(__file__).with_name(name).read_text().splitlines() if line and line[0] != "#"]
    return [(line, message[2:].split(" | ")) for line, message in zip(lines[::2], lines[1::2], strict=True)]


def refusals():
    for case, parts in listed("refusals.txt"):
        (command, name), entries = case.partition(": ")[0].split(), case.partition(": ")[2].split("; ")
        yield pytest.param(command, name, dict(entry.split("=", 1) for entry in entries), parts, id=case)


def write_case(path, name, entries):
    """Writes a shipped case with these entries in place of its own."""
    kept, section = [], ""
    for line in (CASES / f"{name}.prm").read_text().splitlines(True):
        words = line.partition("=")[0].split(maxsplit=1)
        section = words[1].strip() if words[:1] == ["subsection"] else section
        if words[:1] != ["set"] or f"{section}/{words[1].strip()}" not in entries:
            kept.append(line)
    path.write_text("".join(kept) + "".join("subsection {}\n  set {} = {}\nend\n".format(*key.split("/"), value) for key, value in entries.items()))


@pytest.mark.parametrize("command, name, entries, parts", refusals())
def test_is_refused_with_its_place(out, tmp_path, command, name, entries, parts):
    words, shared = COMMANDS[command]
    entries = shared | entries
    changed = [word for entry in entries.items() for word in ("--set", "{}={}".format(*entry))]
    out.mkdir()
    (out / "case.prm").write_text("of an earlier run")
    write_case(tmp_path / "a.prm", name, entries)
    run = latcon(*words, CASES / f"{name}.prm", "--output-dir", out, *changed, expect=2)
    dry = latcon(*words, tmp_path / "a.prm", "--output-dir", out, "--dry-run", expect=2)
    for part in parts:
        assert part in run.stderr and part in dry.stderr
    assert ("--set" in run.stderr or f"{name}.prm:" in run.stderr) == (f"{tmp_path}/a.prm:" in dry.stderr)
    assert [path.name for path in out.iterdir()] == ["case.prm"]
    assert (out / "case.prm").read_text() == "of an earlier run"


def test_a_long_case_is_read_to_its_end(tmp_path):
    comments = "# a comment\n" * 10000
    (tmp_path / "a.prm").write_text(f"{comments}subsection Sheet\n  set length = -1\nend\n")
    assert "a.prm:10002: Sheet/length = -1" in latcon("lattice", tmp_path / "a.prm", "--dry-run", expect=2).stderr


@pytest.mark.parametrize("words, parts", [("", ["a command is required: verify, lattice, "]), *listed("words.txt")])
def test_words_are_refused(tmp_path, words, parts):
    run = latcon(*shlex.split(words), cwd=tmp_path, expect=2)
    assert (run.stdout, run.stderr.count("\n")) == ("", 1)
    for part in parts:
        assert part in run.stderr
    assert list(tmp_path.iterdir()) == []


@pytest.mark.parametrize("entries", [
    {}, {"Initial state/base": "equilibrium"},
    {"Initial state/displacement x": "1e-6*sin(pi*x/0.04)*(y-0.01)*(y+0.01)", "Left edge/condition": "free", "Right edge/condition": "free"}])
def test_nothing_else_is_refused(out, entries):
    changed = [word for entry in (MOTION | entries).items() for word in ("--set", "{}={}".format(*entry))]
    for more in ["--dry-run"], []:
        latcon("continuum", CASES / "quick.prm", "--quiet", "--output-dir", out, *changed, *more)
    assert (out / "results.json").exists()
