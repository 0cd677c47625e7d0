#!/usr/bin/python3
"""Fails if an include goes against docs/architecture.md: lattice <- verification -> continuum, and no other arrow.

Usage: check_includes.py PROJECT_ROOT
The rules are tried on planted violations first, so that a rule which has stopped biting fails as well.
"""
import pathlib
import re
import sys

INCLUDE = re.compile(r'^\s*#\s*include\s*[<"]([^>"]+)[>"]', re.MULTILINE)
FORBIDDEN = {
    "lattice": ("continuum/", "verification/", "deal.II/"),
    "continuum": ("lattice/", "verification/"),
    "verification": (),
    # Tests of one side must not lean on the other either.
    "tests/lattice": ("continuum/", "verification/", "deal.II/"),
    "tests/continuum": ("lattice/", "verification/"),
}
PLANTED = [
    ("lattice", '#include "continuum/material.h"'),
    ("lattice", "#include <deal.II/base/tensor.h>"),
    ("lattice", '  #  include "../verification/case.h"'),
    ("continuum", '#include "lattice/bond_law.h"'),
    ("continuum", '#include "verification/case.h"'),
    ("tests/lattice", "#include <deal.II/base/tensor.h>"),
]


def violations(folder, text):
    """Includes in `text` that a source in `folder` may not have."""
    found = []
    for name in INCLUDE.findall(text):
        parts = pathlib.PurePosixPath(name).parts
        plain = "/".join(part for part in parts if part not in ("..", "."))
        if plain.startswith(FORBIDDEN[folder]):
            found.append(name)
    return found


def main():
    for folder, line in PLANTED:
        if len(violations(folder, line)) != 1:
            sys.exit(f"the rule for {folder}/ no longer catches: {line}")
    root = pathlib.Path(sys.argv[1])
    checked = 0
    bad = []
    for folder in FORBIDDEN:
        for path in sorted((root / folder).rglob("*")):
            if path.suffix in (".h", ".cc"):
                checked += 1
                bad += [f"{path.relative_to(root)} includes {name}" for name in violations(folder, path.read_text())]
    if checked == 0:
        sys.exit(f"no sources found under {root}")
    if bad:
        sys.exit("forbidden includes:\n  " + "\n  ".join(bad))
    print(f"{checked} sources follow the include rules")


if __name__ == "__main__":
    main()
