"""Includes and namespaces follow docs/architecture.md: a folder includes only those that ALLOWED gives it, and no library that
LIBRARIES keeps from it or HEADERS from its headers, and a source opens no namespace of another folder than its own.
"""
import pathlib
import re

ROOT = pathlib.Path(__file__).resolve().parents[1]

INCLUDE = re.compile(r'^\s*#\s*include\s*[<"]([^>"]+)[>"]', re.MULTILINE)
SIDES = ("support", "lattice/bonds", "lattice", "continuum")
MODELS = (*SIDES, "verification/input", "verification/bridge", "verification/analysis", "verification/output")
# The folders that a folder may include in addition to itself, each below those that it includes; `claims/*` is the folder of any one claim.
ALLOWED = {
    "support": (),
    "lattice/bonds": ("support",),
    "lattice": ("support", "lattice/bonds"),
    "continuum": ("support",),
    "verification/analysis": ("support", "lattice/bonds", "lattice"),
    "verification/input": ("support", "lattice/bonds", "lattice"),
    "verification/bridge": (*SIDES, "verification/input"),
    "verification/output": (*SIDES, "verification/input", "verification/bridge", "verification/analysis"),
    "verification/stepping": (*SIDES[:3], "verification/input", "verification/bridge", "verification/output"),
    "verification/resources": MODELS,
    "verification/claims": MODELS,
    "verification/claims/*": (*MODELS, "verification/claims"),
    "verification/elements": ("support", "verification/input", "verification/claims"),
    "verification/commands": (*MODELS, "verification/resources", "verification/claims", "verification/elements"),
    # The program, and the module with the finite elements.
    "verification": ("support", "continuum", "verification/bridge", "verification/commands", "verification/elements"),
    # Tests of one side must not depend on the other either.
    "tests/support": ("support",),
    "tests/lattice": ("support", "lattice/bonds", "lattice", "tests/support"),
    "tests/continuum": ("support", "continuum", "tests/support"),
    "tests/verification/analysis": ("support", "lattice", "verification/analysis", "tests/support", "tests/lattice"),
}
# Folders that may not include a library, by the beginning of its headers' names.
LIBRARIES = {
    "deal.II/": ("support", "verification/input", "verification/elements", "verification/resources",
                 "lattice/bonds", "lattice", "verification/analysis", "tests/support", "tests/lattice", "tests/verification/analysis"),
    "vtk": [folder for folder in ALLOWED if folder != "verification/output"],
}
# Headers below the folder of the first column that may include a library: every source that includes them pays for it.
HEADERS = [
    ("verification/", "deal.II/", ("verification/bridge/affine_displacement.h",)),
    ("", "vtk", ()),
    ("", "nlohmann/json.hpp", ()),
    *[("", f"Eigen/{part}", ()) for part in ("Cholesky", "Dense", "Eigen", "LU", "QR", "SVD")],
]
NAMESPACE = re.compile(r"^namespace latcon::(\w+)", re.MULTILINE)
# Opened to declare names of another folder, whose header is not included.
DECLARATION = re.compile(r"^namespace latcon::\w+\n\{\n(?:(?:class|struct) \w+;\n)+\}", re.MULTILINE)
ROOTS = ("support", "lattice", "continuum", "verification", "tests")


def included(text):
    """Names of the included files, without steps up and down."""
    return ["/".join(part for part in pathlib.PurePosixPath(name).parts if part not in ("..", ".")) for name in INCLUDE.findall(text)]


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


def sources():
    """Pairs (folder, source) of all sources with a rule; folders are relative to the root."""
    files = sorted(path for top in ROOTS for path in (ROOT / top).rglob("*") if path.suffix in (".h", ".cc", ".inc"))
    return [(folder, path) for path in files if rule(folder := str(path.relative_to(ROOT).parent))]


def test_folders_are_listed_above_those_that_include_them():
    order = list(ALLOWED)
    assert [folder for folder, others in ALLOWED.items() if any(order.index(other) >= order.index(folder) for other in others)] == []


def test_every_source_has_a_rule():
    checked = sources()
    assert {rule(folder) for folder, _ in checked} == set(ALLOWED)
    every = {path for top in ROOTS[:-1] for path in (ROOT / top).rglob("*.cc")}
    assert every - {path for _, path in checked} == set()


def test_sources_include_what_their_folder_may():
    assert [f"{path.relative_to(ROOT)} includes {name}" for folder, path in sources() for text in [path.read_text()]
            for name in violations(folder, text) + heavy(str(path.relative_to(ROOT)), text)] == []


def test_namespaces_follow_folders():
    assert [f"{path.relative_to(ROOT)} opens latcon::{name}" for folder, path in sources()
            if folder != "verification" and folder.split("/")[0] != "tests" for name in wrong_namespaces(folder, path.read_text())] == []
