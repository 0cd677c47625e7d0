"""Checks that the manual page and the bash completion have all commands and options of the program."""
import functools
import gzip
import json
import re
import subprocess

import pytest

from folders import BUILD, FOLDER, SOURCE, run

LATCON = BUILD / "verification" / "latcon"


def complete(*words):
    """Completions that bash proposes for the last of some words after `latcon`."""
    script = f'source {BUILD}/latcon.bash; COMP_WORDS=(latcon "$@"); COMP_CWORD=$#; _latcon; printf "%s\\n" "${{COMPREPLY[@]}}"'
    done = subprocess.run(["bash", "-c", script, "bash", *words], cwd=FOLDER, capture_output=True, text=True, check=True)
    return [line for line in done.stdout.split("\n") if line]


@functools.cache
def options_of(*command):
    return set(re.findall(r"^  (?:-[a-z],)?(--[a-z-]+)", run(LATCON, *command, "--help"), re.M))


@pytest.fixture(scope="module")
def commands():
    return re.findall(r"^  ([a-z]+) ", run(LATCON, "--help").split("Subcommands:")[1], re.M)


def test_manual_has_every_command_and_option(commands):
    page = run("groff", "-ww", "-man", "-Tascii", "-P-c", "-P-b", "-P-u",
               input=gzip.decompress((BUILD / "latcon.1.gz").read_bytes()).decode())
    assert "warning" not in page
    assert len(commands) >= 7
    for command in commands:
        part = re.search(rf"^   {command}$.*?(?=^   \S|^\S)", page, re.M | re.S).group(0)
        for option in options_of(command) - {"--help"}:
            assert option in part
    for option in options_of():
        assert option in page
    for claim in json.loads(run(LATCON, "schema"))["claims"]:
        assert claim["title"] in " ".join(page.split())
    for code in (0, 1, 2, 3, 4, 5, 130):
        assert re.search(rf"(?m)^ +{code} +\S", page)


def test_completes_every_option(commands):
    for command in commands:
        assert set(complete(command, "--")) == options_of() | options_of(command)


@pytest.mark.parametrize("words, completions", [
    (["fra"], "fracture"), (["--out"], "--output-dir"), (["verify", "ener"], "energy"), (["batch", "--slurm", "patt"], "patterns"),
    # Of --sweep STUDY is a case.
    (["study", "--sweep", "Sheet/height=1 cm,2 cm", "fig1"], "fig1|fig1-wide"), (["study", "--sweep", "Sheet/height", "=", "1,2", "patt"], ""),
    (["fracture", "my"], "my case.prm"), (["verify", "--case", "my"], "my case.prm"), (["fracture", "--threads", ""], ""),
    (["fracture", "--set", "Sheet/sp"], "Sheet/spacing="), (["fracture", "--set", "Lattice/noise\\ s"], "Lattice/noise\\ seed="),
    (["fracture", "--set", '"Lattice/noise s'], "Lattice/noise seed="), (["entries", "Fra"], "Fracture"), (["help", "Sheet/sp"], "Sheet/spacing"),
    # Bash divides at "=" outside quotes, and not within.
    (["fracture", "--set", "Time/integrator", "=", "run"], "runge-kutta-chebyshev"), (["fracture", "--output-dir", "="], ""),
    (["fracture", "--set", '"Next-nearest neighbours/present=t'], "Next-nearest neighbours/present=true")])
def test_completes_a_word(words, completions):
    (FOLDER / "my case.prm").touch()
    assert "|".join(complete(*words)) == completions


def test_completes_commands_and_claims(commands):
    assert complete("") == commands
    assert complete("verify", "") == [claim["name"] for claim in json.loads(run(LATCON, "schema"))["claims"]]
    assert set(complete("study", "")) - {"cache", "my case.prm"} == {path.stem for path in (SOURCE / "verification/studies").glob("*.json")}
