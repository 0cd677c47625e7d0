"""Explanations of the command line: typing errors, shipped cases, entries, a case to start from, runs that cost too much."""
import json
import re
import subprocess

from program import CASES, LATCON, latcon, refused

SHORT = ["--skip-verification", "--no-report", "--set", "Time/end=0.01 ms"]
FINE = ["--set", "Sheet/spacing=0.0125 mm"]  # weeks of computing


def test_commands_that_only_the_package_starts_are_not_suggested():
    for words in (["help", "gat"], ["resolv"], ["zzz"], []):
        assert not re.search(r"\b(gate|resolve)\b", refused(*words))


def test_the_list_of_claims_says_which_are_checked_without_names():
    lines = {line.split()[0]: line for line in latcon("verify", "--help").stdout.split("Claims:")[1].splitlines() if line.strip()}
    for claim in json.loads(latcon("schema").stdout)["claims"]:
        assert ("only if named" in lines[claim["name"]]) == (not claim["default"]), claim["name"]


def test_shipped_cases_have_names(tmp_path):
    latcon("fracture", "quick", *SHORT, cwd=tmp_path)
    assert (tmp_path / "output/quick/crack.json").exists()
    for command in ("lattice", "continuum"):
        latcon(command, "hole", "--quiet", "--set", "Sheet/spacing=1 mm", "--set", "Continuum/adaptive cycles=0", cwd=tmp_path)
        assert (tmp_path / f"output/hole-{command}/run.json").exists()
    # A folder of that name is no case, a file is.
    (tmp_path / "quick").mkdir()
    latcon("fracture", "quick", "--dry-run", cwd=tmp_path)
    (tmp_path / "hole").write_text("subsection Sheet\n")
    assert "hole:" in refused("lattice", "hole", cwd=tmp_path)


def test_entries_are_those_of_the_schema():
    entries = json.loads(latcon("schema").stdout)["entries"]
    text = latcon("entries").stdout
    assert max(map(len, text.splitlines())) <= 120
    sections = re.split(r"^(?=[A-Z])", text, flags=re.M)
    of = {section.split("\n")[0]: section for section in sections}
    for entry in entries:
        assert re.search(rf"(?m)^  {re.escape(entry['name'])} ", of[entry["section"]])
    assert latcon("entries", "near tip").stdout.split("\n\nColumns")[0] == of["Near tip"].strip()
    for line in [r"  spacing +m +required +\S", r"  orientation +rows-along-crack +\S"]:
        assert re.search(line, of["Sheet"])


def test_help_on_an_entry_has_all_of_it():
    text = latcon("help", "Fracture/toughening").stdout
    for part in ["Fracture/toughening\n", "one of none, behind-tip, retraction", "default:  none",
                 '--set "Fracture/toughening=none"']:
        assert part in text
    assert latcon("help", "toughening").stdout == text
    assert "unit:     m;" in latcon("help", "near", "tip/ahead").stdout
    assert latcon("help", "viscosity").stdout.count("default:") == 4  # of three shells and the contact
    assert latcon("help", "Contact").stdout == latcon("entries", "Contact").stdout


def test_init_makes_a_case_that_runs(tmp_path):
    run = latcon("init", "my strip/", cwd=tmp_path)
    case = tmp_path / "my strip" / "my strip.prm"
    assert "run it:       latcon fracture 'my strip/my strip.prm'\n" in run.stdout
    assert case.read_bytes() == (CASES / "start.prm").read_bytes()
    assert [path.name for path in case.parent.iterdir()] == ["my strip.prm"]
    assert refused("init", "my strip", cwd=tmp_path) == "latcon: my strip/my strip.prm exists; give another folder"
    latcon("fracture", "my strip/my strip.prm", *SHORT, cwd=tmp_path)
    assert (tmp_path / "output/my strip/crack.json").exists()


def test_absurd_cost_needs_yes(out):
    for command, *entries in [("fracture", *FINE), ("lattice", "--set", "Lattice/solution=motion", "--set", "Time/end=1e5 s")]:
        for mode in ([], ["--dry-run"]):
            run = latcon(command, "quick", *entries, *mode, "--output-dir", out, expect=2)
            assert re.search(r"the run would take about \S+ days, more than 10; .*; use --yes", run.stderr)
            assert not out.exists()
        latcon(command, "quick", *entries, "--dry-run", "--yes")
    cells = ["--set", "Continuum/cells x=8192", "--set", "Continuum/cells y=8192"]
    assert re.search(r"memory: .* \d{11,} bytes .*; use --yes to run it anyway", refused("continuum", "quick", *cells, "--output-dir", out))


def log(out):
    return (out / "log.txt").read_text().splitlines()


def run_(out, *arguments, expect=0):
    return latcon("fracture", "quick", *SHORT, "--output-dir", out, *arguments, expect=expect)


def test_is_that_of_each_run(out):
    first = run_(out)
    assert log(out)[1:] == first.stdout.splitlines()
    other = ["--set", "Loading/strain y=1.7", "--set", "Checkpoints/steps=16"]
    second = run_(out, *other)
    assert log(out)[1:] == second.stdout.splitlines()
    assert (out / "earlier-run/log.txt").read_text().splitlines()[1:] == first.stdout.splitlines()
    third = run_(out, *other, "--resume")
    assert len([line for line in log(out) if line.startswith("$ ")]) == 2
    assert log(out)[-len(third.stdout.splitlines()):] == third.stdout.splitlines()


def test_ends_with_the_error(out):
    (out / "crack.csv").mkdir(parents=True)
    run = run_(out, expect=5)
    assert "crack.csv" in run.stderr
    assert log(out)[-1:] == run.stderr.splitlines()


def test_is_left_alone_where_output_goes_to_it(out):
    out.mkdir()
    with (out / "log.txt").open("w") as file:
        subprocess.run([LATCON, "fracture", "quick", *SHORT, "--output-dir", out], stdout=file, check=True)
    assert "$ " not in log(out)[0]
    assert "crack" in log(out)[0]
