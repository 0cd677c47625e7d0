#!/usr/bin/python3
"""Fails if an include goes against docs/architecture.md: support <- lattice, continuum <- verification, no other arrow; if
folders include each other in a circle; or if docs/pictures/includes.svg is not the graph of the sources.

Usage: check_includes.py PROJECT_ROOT [--draw]     --draw: make the picture, with Graphviz
The rules are tried on planted violations first, so that a rule which has stopped biting fails as well.
"""
import collections
import html
import pathlib
import re
import subprocess
import sys

INCLUDE = re.compile(r'^\s*#\s*include\s*[<"]([^>"]+)[>"]', re.MULTILINE)
FORBIDDEN = {
    "support": ("lattice/", "continuum/", "verification/", "deal.II/"),
    "lattice": ("continuum/", "verification/", "deal.II/"),
    "continuum": ("lattice/", "verification/"),
    "verification": (),
    # Tests of one side must not lean on the other either.
    "tests/support": ("lattice/", "continuum/", "verification/", "deal.II/"),
    "tests/lattice": ("continuum/", "verification/", "deal.II/"),
    "tests/continuum": ("lattice/", "verification/"),
}
PLANTED = [
    ("support", '#include "lattice/bond_law.h"'),
    ("support", "#include <deal.II/base/mpi.h>"),
    ("lattice", '#include "continuum/material.h"'),
    ("lattice", "#include <deal.II/base/tensor.h>"),
    ("lattice", '  #  include "../verification/case.h"'),
    ("continuum", '#include "lattice/bond_law.h"'),
    ("continuum", '#include "verification/case.h"'),
    ("tests/lattice", "#include <deal.II/base/tensor.h>"),
]
PICTURE = "docs/pictures/includes.svg"
# Side of the comparison, by the start of a folder's name, and its colour.
COLOURS = {"support": "#cfe3c0", "lattice": "#f4c7a1", "continuum": "#a9cbe8", "verification": "#e4e4e4"}


def included(text):
    """Names of the included files, without steps up and down."""
    return ["/".join(part for part in pathlib.PurePosixPath(name).parts if part not in ("..", "."))
            for name in INCLUDE.findall(text)]


def violations(folder, text):
    """Includes in `text` that a source in `folder` may not have."""
    return [name for name in included(text) if name.startswith(FORBIDDEN[folder])]


def sources(root, folder):
    return sorted(path for path in (root / folder).rglob("*") if path.suffix in (".h", ".cc", ".inc"))


def graph(root):
    """Pairs (folder, folder that it includes), relative to the root. main.cc is above all folders and left out."""
    found = set()
    for top in COLOURS:
        for path in sources(root, top):
            own = str(path.relative_to(root).parent)
            others = {str(pathlib.PurePosixPath(name).parent) for name in included(path.read_text())}
            if path.name != "main.cc":
                found |= {(own, other) for other in others if (root / other).is_dir() and other.startswith(tuple(COLOURS))}
    return {(own, other) for own, other in found if own != other}


def circle(pairs):
    """Folders that lead back to the first of them; none: []."""
    after = collections.defaultdict(list)
    for folder, other in sorted(pairs):
        after[folder].append(other)
    without = set()

    def follow(path):
        for other in after[path[-1]]:
            if other in path:
                return path[path.index(other):]
            if other not in without and (found := follow([*path, other])):
                return found
        without.add(path[-1])
        return []

    return next((found for folder in list(after) if folder not in without and (found := follow([folder]))), [])


def drawing(pairs):
    """The graph in Graphviz' language."""
    lines = ["digraph {", 'graph [bgcolor=white, nodesep=0.25, ranksep=0.6]', 'edge [color="#555555", arrowsize=0.7]',
             'node [shape=box, style="filled,rounded", fontname="DejaVu Sans", fontsize=11, penwidth=0]']
    for folder in sorted({folder for pair in pairs for folder in pair}):
        lines.append(f'"{folder}" [label="{folder}/", fillcolor="{COLOURS[folder.split("/")[0]]}"]')
    lines += [f'"{folder}" -> "{other}"' for folder, other in sorted(pairs)]
    return "\n".join([*lines, "}"])


def drawn(picture):
    """The pairs that a picture made by Graphviz shows."""
    titles = re.findall(r"<title>(.*?)</title>", picture)
    return {tuple(html.unescape(title).split("->")) for title in titles if "->" in html.unescape(title)}


def main():
    for folder, line in PLANTED:
        if len(violations(folder, line)) != 1:
            sys.exit(f"the rule for {folder}/ no longer catches: {line}")
    if circle({("a", "b"), ("b", "c"), ("d", "a"), ("c", "b")}) != ["b", "c"] or circle({("a", "b"), ("d", "b")}):
        sys.exit("circles are no longer found")
    root = pathlib.Path(sys.argv[1])
    checked = 0
    bad = []
    for folder in FORBIDDEN:
        for path in sources(root, folder):
            checked += 1
            bad += [f"{path.relative_to(root)} includes {name}" for name in violations(folder, path.read_text())]
    if checked == 0:
        sys.exit(f"no sources found under {root}")
    if bad:
        sys.exit("forbidden includes:\n  " + "\n  ".join(bad))
    pairs = graph(root)
    if found := circle(pairs):
        sys.exit("folders include each other: " + " -> ".join([*found, found[0]]))
    if "--draw" in sys.argv[2:]:
        picture = subprocess.run(["dot", "-Tsvg"], input=drawing(pairs), capture_output=True, text=True, check=True).stdout
        (root / PICTURE).write_text(picture)
    if different := drawn((root / PICTURE).read_text()) ^ pairs:
        sys.exit(f"{PICTURE} is not the graph of the sources: {sorted(different)}; `--target include_graph` makes it")
    print(f"{checked} sources follow the include rules")


if __name__ == "__main__":
    main()
