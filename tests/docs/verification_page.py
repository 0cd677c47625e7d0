#!/usr/bin/python3
"""Writes docs/verification.csv, the results of `latcon verify --quick`.

Usage: verification_page.py PATH_OF_LATCON FOLDER_OF_THE_TABLE
"""
import csv
import io
import json
import math
import pathlib
import re
import subprocess
import sys
import tempfile

from printed_numbers import agrees

# Parts of a name that distinguish rows with the same check in other states, directions and lattices, and of other cracks.
STATES = (re.compile(r"^NN(?:\+NNN)?(?:, F = (?:I|\([^)]*\)))?(?:: |, )"), re.compile(r"^kd = [\d.]+: "),
          re.compile(r" about F = (?:I|\([^)]*\))"), re.compile(r", F = \([^)]*\)(?=,)"), re.compile(r", (?:F = I|loaded)$"),
          re.compile(r"^(?:square|triangular) grid, m = [\d.]+, "), re.compile(r" at \d+ degrees"), re.compile(r", beta [\d.]+, Delta/Delta_G [\d.]+$"))
ROUND_OFF = 1e-8  # smaller errors differ between machines


def shared_name(quantity):
    for state in STATES:
        quantity = state.sub("", quantity)
    return quantity


def share(row):
    """Fraction of the tolerance that the error uses."""
    if row["tolerance"] is None:
        return -1.0
    return row["error"] / row["tolerance"] if row["tolerance"] else float(row["error"] > 0)


def worst_rows(results, claim):
    """{name: (number of rows, the row with the largest error over tolerance)}, in order of appearance."""
    groups = {}
    for row in results["claims"]:
        if row["claim"] == claim:
            groups.setdefault(shared_name(row["quantity"]), []).append(row)
    return {name: (len(rows), max(rows, key=lambda row: (share(row), row["error"] or 0.0))) for name, rows in groups.items()}


def number(value):
    return "" if value is None else "0" if value == 0 else f"{value:.2g}"


HEADER = ["claim", "quantity", "rows", "error", "tolerance", "verdict"]


def table(results):
    """Lines of the table, without its header."""
    lines = []
    for claim in dict.fromkeys(row["claim"] for row in results["claims"]):
        for name, (count, row) in worst_rows(results, claim).items():
            error = "round-off" if row["error"] is not None and 0 < abs(row["error"]) < ROUND_OFF else number(row["error"])
            lines.append([claim, name, str(count), error, number(row["tolerance"]), row["verdict"]])
    return lines


def text(results):
    """Contents of the file."""
    file = io.StringIO()
    csv.writer(file, lineterminator="\n").writerows([HEADER, *table(results)])
    return file.getvalue()


def differences(written, results, relative=0.1):
    """Rows of the file that differ from these results in name, count or verdict, in a tolerance by value, or in an error by more than
    `relative` (two digits are shown) and round-off."""
    header, *shown = csv.reader(io.StringIO(written))
    known = table(results)
    wrong = [] if header == HEADER else [f"header: {header}"]
    for claim in dict.fromkeys(line[0] for line in shown + known):
        old_lines, new_lines = ([line for line in lines if line[0] == claim] for lines in (shown, known))
        if len(old_lines) != len(new_lines):
            wrong.append(f"{claim}: {len(old_lines)} rows, not {len(new_lines)}")
        for old, new in zip(old_lines, new_lines):
            both = [line[3].replace("round-off", "0") for line in (old, new)]
            errors = both[0] == both[1] or ("" not in both and
                                            math.isclose(*map(float, both), rel_tol=relative, abs_tol=10 * ROUND_OFF))
            if old[:3] + old[5:] != new[:3] + new[5:] or not agrees(old[4], new[4]) or not errors:
                wrong.append(f"{' | '.join(old)}: now {' | '.join(new[1:])}")
    return wrong


def main(latcon, docs):
    with tempfile.TemporaryDirectory() as folder:
        subprocess.run([latcon, "verify", "--quick", "--quiet", "--output-dir", folder], check=True)
        results = json.loads((pathlib.Path(folder) / "results.json").read_text())
    (pathlib.Path(docs) / "verification.csv").write_text(text(results), encoding="utf-8")


if __name__ == "__main__":
    main(*sys.argv[1:])
