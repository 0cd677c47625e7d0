#!/usr/bin/python3
"""Writes docs/reference-entries.md: every entry of a case, as `latcon lattice CASE --dry-run` documents it.

Usage: entries_page.py PATH_OF_LATCON FOLDER_OF_THE_PAGE
"""
import pathlib
import re
import subprocess
import sys
import tempfile

HEAD = """# Entries of a case

Made by `cmake --build build/release --target entries_page` from what the program declares; do not edit. How cases are
written: [reference.md](reference.md#cases). An entry without a unit is a pure number or a word; where a default is `auto`, the
program derives the value. `latcon ... --dry-run` prints the entries of a case with their values.
"""
# What has to be there for a case to be one; all else has its default.
REQUIRED = {"Sheet": {"spacing": "0.001", "length": "0.04", "height": "0.02"}, "Material": {"density": "944"},
            "Loading": {"strain x": "0.1", "strain y": "0.1"}}
# `words [unit] (range; required)`, the last two where there are any.
DOCUMENTATION = re.compile(r"^(?P<meaning>.*?)(?: \[(?P<unit>[^\[\]]*)\])?(?: \((?P<rule>[^()]*)\))?$")


def resolved_case(latcon):
    """A case of defaults, as the program prints it."""
    with tempfile.TemporaryDirectory() as folder:
        case = pathlib.Path(folder) / "case.prm"
        case.write_text("".join(f"subsection {section}\n" + "".join(f"  set {name} = {value}\n" for name, value in
                                                                    entries.items()) + "end\n"
                                for section, entries in REQUIRED.items()))
        return subprocess.run([latcon, "lattice", case, "--dry-run"], check=True, capture_output=True, text=True).stdout


def entries(text):
    """(section, name, unit, range, default or `required`, meaning) of every entry of a resolved case."""
    found, section, comment = [], None, []
    for line in map(str.strip, text.splitlines()):
        words = line.partition(" ")
        if words[0] == "subsection":
            section, comment = words[2], []
        elif words[0] == "end":
            section = None
        elif words[0] == "#" and section:
            comment.append(words[2])
        elif words[0] == "set":
            name, _, value = words[2].partition("=")
            said = DOCUMENTATION.match(" ".join(comment))
            rule = (said["rule"] or "").split("; ")
            required = rule[-1] == "required"
            value = value.split("#")[0].strip()
            found.append((section, name.strip(), said["unit"] or "", "; ".join(rule[:-1] if required else rule),
                          "required" if required else value, said["meaning"]))
            comment = []
    return found


def row(entry):
    _, name, unit, rule, default, meaning = (cell.replace("|", r"\|").replace("*", r"\*") for cell in entry)
    rule = re.sub(r"^one of ", "", rule)
    default = f"`{default}`" if default and default != "required" else default
    return f"| `{name}` | {unit if unit != '1' else '-'} | {rule} | {default} | {meaning} |\n"


def page(text):
    sections = {}
    for entry in entries(text):
        sections.setdefault(entry[0], []).append(row(entry))
    tables = {}  # sections with the same entries, as the edges have, share a table
    for section, rows in sections.items():
        tables.setdefault("".join(rows), []).append(section)
    return HEAD + "".join(f"\n## {', '.join(names)}\n\n| name | unit | allowed | default | meaning |\n"
                          f"| --- | --- | --- | --- | --- |\n{rows}" for rows, names in tables.items())


def main(latcon, docs):
    (pathlib.Path(docs) / "reference-entries.md").write_text(page(resolved_case(latcon)), encoding="utf-8")


if __name__ == "__main__":
    main(*sys.argv[1:])
