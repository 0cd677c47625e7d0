#!/usr/bin/python3
"""Writes docs/reference-entries.md: every entry of a case, as `latcon schema` lists it.

Usage: entries_page.py PATH_OF_LATCON FOLDER_OF_THE_PAGE
"""
import json
import pathlib
import re
import subprocess
import sys

HEAD = """# Entries of a case

Made by `cmake --build build/release --target entries_page` from what the program declares; do not edit. How cases are
written: [reference.md](reference.md#cases). An entry without a unit is a pure number or a word; where a default is `auto`, the
program derives the value. `latcon ... --dry-run` prints the entries of a case with their values, `latcon schema` all of this as
JSON.
"""


def schema(latcon):
    """The document that `latcon schema` prints."""
    return json.loads(subprocess.run([latcon, "schema"], check=True, capture_output=True, text=True).stdout)


def default_of(entry):
    """Cell of the default."""
    if entry["required"]:
        return "required"
    value = entry["default"]
    text = "auto" if value is None else value if isinstance(value, str) else json.dumps(value).removesuffix(".0")
    return f"`{text}`" if text else ""


def row(entry):
    """Row of the table of a section."""
    name, unit, rule, meaning = (cell.replace("|", r"\|").replace("*", r"\*") for cell in
                                 (entry["name"], entry["unit"] or "", entry["allowed"], entry["documentation"]))
    rule = re.sub(r"^one of ", "", rule)
    return f"| `{name}` | {unit if unit != '1' else '-'} | {rule} | {default_of(entry)} | {meaning} |\n"


def page(document):
    sections = {}
    for entry in document["entries"]:
        sections.setdefault(entry["section"], []).append(row(entry))
    tables = {}  # sections with the same entries, as the edges have, share a table
    for section, rows in sections.items():
        tables.setdefault("".join(rows), []).append(section)
    return HEAD + "".join(f"\n## {', '.join(names)}\n\n| name | unit | allowed | default | meaning |\n"
                          f"| --- | --- | --- | --- | --- |\n{rows}" for rows, names in tables.items())


def main(latcon, docs):
    (pathlib.Path(docs) / "reference-entries.md").write_text(page(schema(latcon)), encoding="utf-8")


if __name__ == "__main__":
    main(*sys.argv[1:])
