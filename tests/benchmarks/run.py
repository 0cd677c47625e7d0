#!/usr/bin/python3
"""Compares latcon with LAMMPS and dolfinx on this machine, and prints tables.

tests/benchmarks/run installs and builds the prerequisites and calls this script. All numbers are written to benchmarks.json
in the output directory; --write-docs writes the tables to docs/performance.txt. Nothing else should run on the machine.
"""
import argparse
import json
import pathlib
import sys
import time

sys.dont_write_bytecode = True

import machine
import page
from measure import ROOT, Failed, Skipped
from parts import PARTS, Plan


def arguments():
    parser = argparse.ArgumentParser(prog="tests/benchmarks/run", description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--quick", action="store_true", help="small versions: whether all of it runs, in a minute")
    parser.add_argument("--only", nargs="+", choices=PARTS, metavar="PART", help="of " + " ".join(PARTS) +
                        "; others stay as measured before by the same commit on the same day")
    parser.add_argument("--output-dir", type=pathlib.Path, default=ROOT / "output" / "benchmarks")
    parser.add_argument("--build", type=pathlib.Path, default=ROOT / "build" / "release", help="folder of the programs")
    parser.add_argument("--from-json", type=pathlib.Path, metavar="FILE", help="measure nothing, show these numbers")
    parser.add_argument("--write-docs", action="store_true", help="write docs/performance.txt")
    options = parser.parse_args()
    if options.write_docs and options.quick:
        parser.error("--write-docs: small versions say nothing")
    return options


def begun(path, conditions, names):
    """Earlier measurements under the same conditions, without the parts to be measured."""
    document = json.loads(path.read_text(encoding="utf-8")) if path.exists() else {}
    if any(document.get(key) != value for key, value in conditions.items()):
        document = conditions
    return {**conditions, **{kind: {name: value for name, value in document.get(kind, {}).items() if name not in names}
                             for kind in ("parts", "skipped", "failed")}}


def measured(options):
    """Measures the parts one after another, even if one fails, and saves the results after each."""
    output = options.output_dir.resolve()
    output.mkdir(parents=True, exist_ok=True)
    plan = Plan(options.build.resolve(), output, options.quick)
    path = output / "benchmarks.json"
    document = begun(path, {"machine": machine.facts(plan.build), "quick": options.quick}, options.only or PARTS)
    for name in options.only or PARTS:
        start = time.monotonic()
        print(f"{name} ...", end="", file=sys.stderr, flush=True)
        try:
            document["parts"][name] = PARTS[name](plan)
        except Skipped as reason:
            document["skipped"][name] = str(reason)
        except Failed as error:
            document["failed"][name] = str(error)
        print(f" {time.monotonic() - start:.0f} s", file=sys.stderr)
        path.write_text(json.dumps(document, indent=1) + "\n", encoding="utf-8")
    return document


def main():
    options = arguments()
    try:
        document = json.loads(options.from_json.read_text(encoding="utf-8")) if options.from_json else measured(options)
    except (OSError, ValueError) as error:
        print(f"tests/benchmarks/run: {error}", file=sys.stderr)
        return 1
    print(page.text(document))
    if options.write_docs:
        (ROOT / "docs" / "performance.txt").write_text(page.text(document) + "\n", encoding="utf-8")
    return 1 if document["failed"] else 0


if __name__ == "__main__":
    sys.exit(main())
