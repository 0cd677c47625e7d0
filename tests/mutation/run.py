#!/usr/bin/python3
"""Plants small faults into the sources, one at a time, and records every test that fails: a matrix of faults and tests.

tests/mutation/run installs the prerequisites and calls this script. Faults are planted in a git worktree of the last commit,
build/mutation, with a build of its own; the checkout is not changed. A fault that no test detects is printed with its position:
either a test is missing, or the fault has no observable effect, which matrix.csv then records with the reason. It is such a matrix,
of a sample of all folders and of the Python package, with the tests that fail and an answer for each survivor.
"""
import argparse
import collections
import csv
import json
import math
import os
import pathlib
import re
import signal
import subprocess
import sys
import time

from scipy.stats import binomtest

sys.dont_write_bytecode = True

import mutants

ROOT = pathlib.Path(__file__).resolve().parents[2]
TREE = ROOT / "build" / "mutation"
BUILD = TREE / "build" / "develop"  # one object a source
MATRIX = pathlib.Path(__file__).with_name("matrix.csv")
COMMANDS = ["CommandLine.KeepsItsContract", "CommandLine.RunsFiniteElementCases", "CommandLine.RefusesBadCases", "NearTip.IsMeasuredAndWritten"]
CLAIMS = ["claims_tests", "verification_tests"]
# Tests of ctest that should detect the faults of a source, by the longest prefix of its name.
PLACES = {
    "support/": ["support_tests"],
    "lattice/": ["lattice_tests", "LatticeRanks.AgreeOn2"],
    **dict.fromkeys(("lattice/bonds/expression_law", "lattice/bonds/law_check", "lattice/bonds/library_law"), ["verification_tests"]),
    "continuum/": ["continuum_tests", "Ranks.AgreeOn2"],
    "verification/": CLAIMS,
    "verification/analysis/": ["analysis_tests"],
    "verification/input/": ["verification_tests"],
    "verification/output/": ["verification_tests", *COMMANDS],
    "verification/commands/": COMMANDS,
    "verification/elements/": COMMANDS,
}
# Address space [bytes] and size of files of a test, since a fault may allocate or write without end.
LIMITS = ["prlimit", f"--as={6 << 30}", f"--fsize={1 << 29}", "--core=0"]


def tests_for(file):
    return PLACES[max(filter(file.startswith, PLACES), key=len)]


def sources(root, only):
    """Names of the sources to mutate. @throws ValueError for an unknown name"""
    known = [str(path.relative_to(root)) for folder in sorted({place.split("/")[0] for place in PLACES})
             for path in sorted((root / folder).rglob("*")) if path.suffix in (".h", ".cc", ".inc")]
    for name in only:
        if not any(file.startswith(name) for file in known):
            raise ValueError(f"--only {name}: neither a source of the program nor a folder with some")
    return [file for file in known if file.startswith(tuple(only))] if only else known


def equivalents(root):
    """Reason by (file, line, line with the fault). @throws ValueError for a line that its file does not have"""
    with MATRIX.open(encoding="utf-8", newline="") as file:
        rows = [row for row in csv.DictReader(file) if row["outcome"] == "equivalent"]
    for row in rows:
        if row["before"] not in (root / row["file"]).read_text(encoding="utf-8"):
            raise ValueError(f"{MATRIX.name}: {row['file']} has no line {row['before']}")
    return {(row["file"], row["before"], row["after"]): row["answer"] for row in rows}


def worktree():
    """The last commit in a worktree, configured. @return its folder"""
    if not TREE.exists():
        subprocess.run(["git", "-C", ROOT, "worktree", "add", "--quiet", "--detach", TREE], check=True)
    commit = subprocess.run(["git", "-C", ROOT, "rev-parse", "HEAD"], stdout=subprocess.PIPE, text=True, check=True).stdout.strip()
    subprocess.run(["git", "-C", TREE, "checkout", "--quiet", "--force", "--detach", commit], check=True)
    subprocess.run(["cmake", "--preset", "develop"], cwd=TREE, stdout=subprocess.DEVNULL, check=True)
    return TREE


def built(tests):
    """Builds the programs of tests. @return whether that was possible, and what was printed"""
    targets = {"fork_server" if "." in test and "Ranks" not in test else "lattice_ranks_tests" if "." in test else test for test in tests}
    done = subprocess.run(["ninja", "-C", BUILD, *sorted(targets)], stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, check=False)
    return done.returncode == 0, done.stdout


def failing(tests, seconds):
    """Names of all tests that fail within a time: of GoogleTest, of pytest, or of ctest for a program that crashes or does not end."""
    command = [*LIMITS, "ctest", "--test-dir", BUILD, "--output-on-failure", "-R", f"^({'|'.join(map(re.escape, tests))})$"]
    process = subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, errors="replace", start_new_session=True,
                               env={**os.environ, "OMPI_ALLOW_RUN_AS_ROOT": "1", "OMPI_ALLOW_RUN_AS_ROOT_CONFIRM": "1",
                                    "OMPI_MCA_rmaps_base_oversubscribe": "1", "CTEST_PARALLEL_LEVEL": "2"})
    try:
        printed, _ = process.communicate(timeout=seconds)
    except subprocess.TimeoutExpired:
        return ["time limit"]
    finally:
        try:
            os.killpg(process.pid, signal.SIGKILL)
        except ProcessLookupError:
            pass
        process.wait()
    single = re.findall(r"^\[  FAILED  \] ([\w./]+)|^FAILED (\S+)", printed, re.MULTILINE)
    whole = re.findall(r"^\s*\d+ - (\S+) \(", printed, re.MULTILINE)
    if process.returncode and not whole:
        raise ValueError(f"ctest failed: {printed[-2000:]}")
    return sorted({a or b for a, b in single}) or sorted(set(whole))


def outcome(mutant, limits):
    """Plants a fault. @return killed, survived, or no program (the fault does not compile), and the tests that fail"""
    path, tests = TREE / mutant.file, tests_for(mutant.file)
    text = path.read_text(encoding="utf-8")
    path.write_text(mutant.planted(text), encoding="utf-8")
    try:
        if not built(tests)[0]:
            return "no program", []
        by = failing(tests, limits[tuple(tests)])
        return "killed" if by else "survived", by
    finally:
        path.write_text(text, encoding="utf-8")


def table(records, n_all):
    """Scores of folders, with Wilson's interval of 95 % for all faults where these are a sample, and the survivors in full."""
    lines = [f"{'folder':14}{'killed':>8}{'survived':>10}{'equivalent':>12}{'no program':>12}{'score':>8}"]
    for folder in [*sorted({r["file"].split("/")[0] + "/" for r in records}), ""]:
        n = collections.Counter(r["outcome"] for r in records if r["file"].startswith(folder))
        lines.append(f"{folder or 'all':14}{n['killed']:8}{n['survived']:10}{n['equivalent']:12}{n['no program']:12}"
                     f"{100. * n['killed'] / max(n['killed'] + n['survived'], 1):6.1f} %")
    seen = n["killed"] + n["survived"]
    if seen and len(records) < n_all:
        low, high = (100. * end for end in binomtest(n["killed"], seen).proportion_ci(method="wilson"))
        lines.append(f"{len(records)} of {n_all} faults; with 95 % confidence the score of all is between {low:.1f} % and {high:.1f} %")
    lines += [f"survived: {r['file']}:{r['line']}  {r['kind']}\n    - {r['before']}\n    + {r['after']}" for r in records
              if r["outcome"] == "survived"]
    return "\n".join(lines), n["killed"] / seen if seen else 1.


def main():
    parser = argparse.ArgumentParser(prog="tests/mutation/run", description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--only", nargs="+", default=[], metavar="FILE", help="of these sources or folders, relative to the root")
    parser.add_argument("--sample", type=int, metavar="N", help="N faults, drawn at random; by default all")
    parser.add_argument("--hours", type=float, default=math.inf, metavar="H", help="plant no further fault after H hours")
    parser.add_argument("--seed", default="1", metavar="S", help="what the sample depends on (1)")
    parser.add_argument("--list", action="store_true", help="show the faults, plant none")
    parser.add_argument("--output", type=pathlib.Path, default=ROOT / "build" / "mutants.jsonl", metavar="FILE", help="gets a line of JSON for "
                        "each fault, with the tests that fail; faults that it has are not planted again (build/mutants.jsonl)")
    parser.add_argument("--at-least", type=float, default=0.9, metavar="SHARE", help="killed, or the exit status is 1 (0.9)")
    options = parser.parse_args()
    deadline = time.monotonic() + 3600. * options.hours
    try:
        root = ROOT if options.list else worktree()
        chosen = [mutant for file in sources(root, options.only) for mutant in mutants.of_file(root / file, file)]
        n_all, reasons = len(chosen), equivalents(root)
        chosen = mutants.in_random_order(chosen, options.seed)[:options.sample]
        if options.list:
            print("\n".join(map(str, chosen)))
            return 0
        known = {tuple(r[key] for key in ("file", "line", "before", "after")): r for r in
                 map(json.loads, options.output.read_text(encoding="utf-8").splitlines() if options.output.exists() else [])}
        limits, records = {}, []
        for mutant in chosen:
            name = (mutant.file, mutant.line, mutant.before.strip(), mutant.after.strip())
            if name not in known:
                if time.monotonic() > deadline:
                    break
                tests = tests_for(mutant.file)
                if tuple(tests) not in limits:
                    is_built, printed = built(tests)
                    start = time.monotonic()
                    if not is_built or (by := failing(tests, 3600.)):
                        raise ValueError(f"{' '.join(tests)} without a fault: " + (" ".join(by) if is_built else printed[-2000:]))
                    limits[tuple(tests)] = 60. + 10. * (time.monotonic() - start)
                verdict, by = outcome(mutant, limits)
                if verdict == "survived" and (reason := reasons.get((mutant.file, *name[2:]))):
                    verdict, by = "equivalent", [reason]
                known[name] = dict(zip(("file", "line", "before", "after"), name), kind=mutant.kind, outcome=verdict, by=by)
                with options.output.open("a", encoding="utf-8") as file:
                    file.write(json.dumps(known[name]) + "\n")
                print(f"{verdict:10} {mutant.file}:{mutant.line} {mutant.kind}  {' '.join(by[:3])}", file=sys.stderr, flush=True)
            records.append(known[name])
    except (OSError, ValueError, subprocess.CalledProcessError) as error:
        print(f"tests/mutation/run: {error}", file=sys.stderr)
        return 2
    text, score = table(records, n_all)
    print(text)
    return 1 if score < options.at_least else 0


if __name__ == "__main__":
    sys.exit(main())
