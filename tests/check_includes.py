#!/usr/bin/python3
"""Fails if an include goes against docs/architecture.md: if a folder includes one that ALLOWED does not give it, or a library
that LIBRARIES keeps from it or HEADERS from its headers; if folders include each other in a circle; if a source opens a namespace of another folder than
its own; or if docs/pictures/includes.svg is not the graph of the sources.

Usage: check_includes.py PROJECT_ROOT [--draw]     --draw: make the picture, with Graphviz
The rules are first applied to deliberate violations, so that a rule that has no effect fails as well.
"""
import collections
import html
import pathlib
import re
import subprocess
import sys

INCLUDE = re.compile(r'^\s*#\s*include\s*[<"]([^>"]+)[>"]', re.MULTILINE)
SIDES = ("support", "lattice/bonds", "lattice", "continuum", "continuum/damage")
MODELS = (*SIDES, "verification/input", "verification/bridge", "verification/analysis", "verification/output")
# The folders that a folder may include in addition to itself; `claims/*` is the folder of any one claim.
ALLOWED = {
    "support": (),
    "lattice/bonds": ("support",),
    "lattice": ("support", "lattice/bonds"),
    "continuum": ("support",),
    "continuum/damage": ("support", "continuum"),
    "verification/analysis": ("support", "lattice/bonds", "lattice"),
    "verification/input": ("support", "lattice/bonds", "lattice"),
    "verification/bridge": (*SIDES, "verification/input"),
    "verification/output": (*SIDES, "verification/input", "verification/bridge", "verification/analysis"),
    "verification/compare": ("support", "verification/output"),
    "verification/stepping": ("support", "lattice/bonds", "lattice", "verification/input", "verification/bridge"),
    "verification/resources": MODELS,
    "verification/claims": MODELS,
    "verification/claims/*": (*MODELS, "verification/claims"),
    "verification/elements": ("support", "verification/input", "verification/claims"),
    "verification/commands": (*MODELS, "verification/compare", "verification/resources", "verification/claims",
                              "verification/elements"),
    # The program, and the module with the finite elements.
    "verification": ("support", "continuum", "verification/bridge", "verification/commands", "verification/elements"),
    # Tests of one side must not depend on the other either.
    "tests/support": ("support",),
    "tests/lattice": ("support", "lattice/bonds", "lattice", "tests/support"),
    "tests/continuum": ("support", "continuum", "continuum/damage", "tests/support"),
    "tests/verification/analysis": ("support", "lattice", "verification/analysis", "tests/support", "tests/lattice"),
}
# Folders that may not include a library, by the beginning of its headers' names.
LIBRARIES = {
    "deal.II/": ("support", "verification/input", "verification/compare", "verification/elements", "verification/resources",
                 "lattice/bonds", "lattice", "verification/analysis", "tests/support", "tests/lattice", "tests/verification/analysis"),
    "vtk": [folder for folder in ALLOWED if folder not in ("verification/output", "verification/compare")],
}
# Headers below the folder of the first column that may include a library: every source that includes them pays for it.
HEADERS = [
    ("verification/", "deal.II/", ("verification/bridge/affine_displacement.h", "verification/bridge/field_function.h",
                                   "verification/claims/wave_sheet.h")),
    ("", "vtk", ("verification/compare/frame.h", "verification/compare/quiet_vtk.h", "verification/output/field_units.h")),
    ("", "nlohmann/json.hpp", ()),
    *[("", f"Eigen/{part}", ()) for part in ("Cholesky", "Dense", "Eigen", "LU", "QR", "SVD")],
]
PLANTED_IN_HEADERS = [
    ("verification/claims/claim.h", "#include <deal.II/grid/tria.h>"),
    ("verification/output/results.h", "#include <vtkPolyData.h>"),
    ("verification/input/case_text.h", "#include <nlohmann/json.hpp>"),
    ("lattice/waves.h", "#include <Eigen/Eigenvalues>"),
]
PLANTED = [
    ("support", '#include "lattice/bonds/bond_law.h"'),
    ("support", "#include <deal.II/base/mpi.h>"),
    ("lattice", '#include "continuum/material.h"'),
    ("lattice", "#include <deal.II/base/tensor.h>"),
    ("lattice", "#include <vtkPolyData.h>"),
    ("lattice/bonds", '#include "lattice/state.h"'),
    ("lattice/bonds", "#include <deal.II/base/tensor.h>"),
    ("lattice", '  #  include "../verification/input/case.h"'),
    ("lattice", '#include "verification/analysis/path_fit.h"'),
    ("continuum", '#include "lattice/bonds/bond_law.h"'),
    ("continuum", '#include "verification/input/case.h"'),
    ("continuum", '#include "continuum/damage/damage_field.h"'),
    ("verification/analysis", '#include "continuum/dynamic_solver.h"'),
    ("verification/analysis", '#include "verification/output/csv.h"'),
    ("verification/input", '#include "verification/output/csv.h"'),
    ("verification/output", '#include "verification/claims/claim_outcome.h"'),
    ("verification/claims", '#include "verification/claims/energy/energy_claim.h"'),
    ("verification/claims/energy", '#include "verification/claims/prestretch/cut_study.h"'),
    ("tests/lattice", "#include <deal.II/base/tensor.h>"),
    ("tests/verification/analysis", '#include "tests/verification/claims/subjects.h"'),
]
NAMESPACE = re.compile(r"^namespace latcon::(\w+)", re.MULTILINE)
# Opened to declare names of another folder, whose header is not included.
DECLARATION = re.compile(r"^namespace latcon::\w+\n\{\n(?:(?:class|struct) \w+;\n)+\}", re.MULTILINE)
ROOTS = ("support", "lattice", "continuum", "verification", "tests")
PICTURE = "docs/pictures/includes.svg"
# Side of the comparison, by the start of a folder's name, and its colour.
COLOURS = {"support": "#cfe3c0", "lattice": "#f4c7a1", "continuum": "#a9cbe8", "verification": "#e4e4e4"}


def included(text):
    """Names of the included files, without steps up and down."""
    return ["/".join(part for part in pathlib.PurePosixPath(name).parts if part not in ("..", "."))
            for name in INCLUDE.findall(text)]


def rule(folder):
    """Key of ALLOWED for a folder, None if there is none."""
    return folder if folder in ALLOWED else "verification/claims/*" if folder.startswith("verification/claims/") else None


def violations(folder, text):
    """Includes in `text` that a source in `folder` may not have."""
    own, found = rule(folder), []
    for name in included(text):
        other = str(pathlib.PurePosixPath(name).parent)
        is_ours = other not in (folder, ".") and other.split("/")[0] in ROOTS
        if is_ours and (rule(other) or other) not in ALLOWED[own]:
            found.append(name)
        if any(name.startswith(library) and own in folders for library, folders in LIBRARIES.items()):
            found.append(name)
    return found


def heavy(path, text):
    """Libraries that the header with this name, relative to the root, may not include."""
    if not path.endswith(".h") or path.startswith("tests/"):
        return []
    return [name for name in included(text) for below, library, headers in HEADERS
            if path.startswith(below) and name.startswith(library) and path not in headers]


def namespace(folder):
    """The namespace, below latcon, of the sources in a folder."""
    parts = folder.split("/")
    return parts[1] if parts[0] == "verification" else parts[0]


def wrong_namespaces(folder, text):
    """Namespaces other than its folder's that a source opens."""
    return [name for name in NAMESPACE.findall(DECLARATION.sub("", text)) if name != namespace(folder)]


def sources(root):
    """Pairs (folder, source) of all sources with a rule; folders are relative to the root."""
    files = sorted(path for top in ROOTS for path in (root / top).rglob("*") if path.suffix in (".h", ".cc", ".inc"))
    return [(folder, path) for path in files if rule(folder := str(path.relative_to(root).parent))]


def graph(root):
    """Pairs (folder, included folder), relative to the root; main.cc, which is above all folders, is omitted."""
    found = set()
    for folder, path in sources(root):
        if folder != "verification" and folder.split("/")[0] != "tests":
            others = {str(pathlib.PurePosixPath(name).parent) for name in included(path.read_text())}
            found |= {(folder, other) for other in others if rule(other) and other != folder}
    return found


def circle(pairs):
    """Folders of a cycle, or [] if there is none."""
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


def outline(pairs):
    """The pairs with one folder for all claims, without those implied by others."""
    pairs = {(rule(folder), rule(other)) for folder, other in pairs}
    after = collections.defaultdict(set)
    for folder, other in pairs:
        after[folder].add(other)

    def reached(folder):
        return after[folder].union(*(reached(other) for other in after[folder]))

    return {(folder, other) for folder, other in pairs if not any(other in reached(step) for step in set(after[folder]))}


def drawing(pairs):
    """The graph in Graphviz' language."""
    lines = ["digraph {", 'graph [bgcolor=white, nodesep=0.25, ranksep=0.4]', 'edge [color="#555555", arrowsize=0.7]',
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
    for header, line in PLANTED_IN_HEADERS:
        if not heavy(header, line):
            sys.exit(f"the rule for headers no longer catches {line} in {header}")
    for folder, name in (("lattice", "continuum"), ("verification/claims/energy", "energy"), ("verification/input", "claims")):
        if wrong_namespaces(folder, f"namespace latcon::{name}\n{{\nstruct A\n{{\n}};\n}}\n") != [name]:
            sys.exit(f"the namespace {name} is no longer caught in {folder}/")
    if circle({("a", "b"), ("b", "c"), ("d", "a"), ("c", "b")}) != ["b", "c"] or circle({("a", "b"), ("d", "b")}):
        sys.exit("circles are no longer found")
    if found := circle({(folder, other) for folder, others in ALLOWED.items() for other in others}):
        sys.exit("ALLOWED has a circle: " + " -> ".join([*found, found[0]]))
    root = pathlib.Path(sys.argv[1])
    checked = sources(root)
    if {rule(folder) for folder, _ in checked} != set(ALLOWED):
        sys.exit(f"folders of ALLOWED without sources under {root}")
    if without := sorted({str(path.relative_to(root)) for top in ROOTS[:-1] for path in (root / top).rglob("*.cc")}
                         - {str(path.relative_to(root)) for _, path in checked}):
        sys.exit("sources in folders without a rule: " + ", ".join(without))
    bad = [f"{path.relative_to(root)} includes {name}" for folder, path in checked
           for name in violations(folder, path.read_text()) + heavy(str(path.relative_to(root)), path.read_text())]
    if bad:
        sys.exit("forbidden includes:\n  " + "\n  ".join(bad))
    strange = [f"{path.relative_to(root)} opens latcon::{name}" for folder, path in checked
               if folder != "verification" and folder.split("/")[0] != "tests" for name in wrong_namespaces(folder, path.read_text())]
    if strange:
        sys.exit("namespaces follow folders, but:\n  " + "\n  ".join(strange))
    pairs = graph(root)
    if found := circle(pairs):
        sys.exit("folders include each other: " + " -> ".join([*found, found[0]]))
    pairs = outline(pairs)
    if "--draw" in sys.argv[2:]:
        picture = subprocess.run(["dot", "-Tsvg"], input=drawing(pairs), capture_output=True, text=True, check=True).stdout
        (root / PICTURE).write_text(picture)
    if different := drawn((root / PICTURE).read_text()) ^ pairs:
        sys.exit(f"{PICTURE} is not the graph of the sources: {sorted(different)}; `--target include_graph` makes it")
    print(f"{len(checked)} sources follow the rules of includes and namespaces")


if __name__ == "__main__":
    main()
