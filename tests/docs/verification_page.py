#!/usr/bin/python3
"""Writes the tables of docs/verification.md from the results of `latcon verify --quick`; the text around them is unchanged.

Usage: verification_page.py PATH_OF_LATCON FOLDER_OF_THE_PAGE
"""
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
          re.compile(r" at \d+ degrees"), re.compile(r", beta [\d.]+, Delta/Delta_G [\d.]+$"))
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


def table(results, claim):
    lines = ["| quantity | rows | error | tolerance | verdict |", "| --- | --: | --: | --: | --- |"]
    for name, (count, row) in worst_rows(results, claim).items():
        error = "round-off" if row["error"] is not None and 0 < abs(row["error"]) < ROUND_OFF else number(row["error"])
        name = name.replace("|", r"\|").replace("*", r"\*")
        lines.append(f"| {name} | {count} | {error} | {number(row['tolerance'])} | {row['verdict']} |")
    return "\n".join(lines)


PLACE = re.compile(r"(<!-- table: ([\w-]+) -->\n)(.*?)(<!-- end of table -->)", re.DOTALL)


def filled(text, results):
    """The page with regenerated tables."""
    return PLACE.sub(lambda place: f"{place[1]}\n{table(results, place[2])}\n\n{place[4]}", text)


def cells(text):
    return [[cell.strip() for cell in line.strip("|").split("|")] for line in text.splitlines() if line]


def differences(text, results, relative=0.1):
    """Rows of the page that differ from these results in name, count or verdict, in a tolerance by value, or in an error by more than
    `relative` (two digits are shown) and round-off."""
    shown_claims = {place[2] for place in PLACE.finditer(text)}
    wrong = [f"{claim}: no table" for claim in sorted({row["claim"] for row in results["claims"]} - shown_claims)]
    for place in PLACE.finditer(text):
        shown, known = cells(place[3]), cells(table(results, place[2]))
        if len(shown) != len(known):
            wrong.append(f"{place[2]}: {len(shown) - 2} rows, not {len(known) - 2}")
        for old, new in zip(shown[2:], known[2:]):
            both = [cell.replace("round-off", "0") for cell in (old[2], new[2])]
            errors = both[0] == both[1] or ("" not in both and
                                            math.isclose(*map(float, both), rel_tol=relative, abs_tol=10 * ROUND_OFF))
            if old[:2] + old[4:] != new[:2] + new[4:] or not agrees(old[3], new[3]) or not errors:
                wrong.append(f"{place[2]}: {' | '.join(old)}: now {' | '.join(new)}")
    return wrong


def main(latcon, docs):
    page = pathlib.Path(docs) / "verification.md"
    with tempfile.TemporaryDirectory() as folder:
        subprocess.run([latcon, "verify", "--quick", "--quiet", "--output-dir", folder], check=True)
        results = json.loads((pathlib.Path(folder) / "results.json").read_text())
    page.write_text(filled(page.read_text(encoding="utf-8"), results), encoding="utf-8")


if __name__ == "__main__":
    main(*sys.argv[1:])
