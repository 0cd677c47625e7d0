#!/usr/bin/python3
"""Writes docs/entries.csv: every entry of a case, as `latcon schema` lists it.

Usage: entries_page.py PATH_OF_LATCON FOLDER_OF_THE_TABLE
"""
import csv
import io
import json
import pathlib
import re
import subprocess
import sys

HEADER = ["section", "name", "unit", "allowed", "default", "meaning"]


def schema(latcon):
    """The document that `latcon schema` prints."""
    return json.loads(subprocess.run([latcon, "schema"], check=True, capture_output=True, text=True).stdout)


def default_of(entry):
    """Cell of the default."""
    if entry["required"]:
        return "required"
    value = entry["default"]
    return "auto" if value is None else value if isinstance(value, str) else json.dumps(value).removesuffix(".0")


def row(entry):
    """Cells of an entry, without its section."""
    unit = entry["unit"] or ""
    return (entry["name"], "-" if unit == "1" else unit, re.sub(r"^one of ", "", entry["allowed"]), default_of(entry),
            entry["documentation"])


def table(document):
    """Contents of the file."""
    sections = {}
    for entry in document["entries"]:
        sections.setdefault(entry["section"], []).append(row(entry))
    shared = {}  # sections with the same entries, as the edges have, share rows
    for section, rows in sections.items():
        shared.setdefault(tuple(rows), []).append(section)
    file = io.StringIO()
    csv.writer(file, lineterminator="\n").writerows(
        [HEADER, *((", ".join(names), *cells) for rows, names in shared.items() for cells in rows)])
    return file.getvalue()


def main(latcon, docs):
    (pathlib.Path(docs) / "entries.csv").write_text(table(schema(latcon)), encoding="utf-8")


if __name__ == "__main__":
    main(*sys.argv[1:])
