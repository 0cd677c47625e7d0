"""Checks that docs/reference-*.md document the contents of an output directory: files, columns, keys, fields."""
import csv
import pathlib
import re

from program import read, read_json

REFERENCE = sorted((pathlib.Path(__file__).resolve().parents[2] / "docs").glob("reference*.md"))


def rows_of_tables(text):
    """(first cell, row with the header of its table) for every row of every table; for a header, the whole table."""
    found, table = [], []
    for line in [*text.splitlines(), ""]:
        if line.startswith("|"):
            table.append(line)
        elif table:
            header = table[0]
            found += [(line.split("|")[1], f"{header}\n{line}") for line in table[2:]]
            found.append((header.split("|")[1], "\n".join(table)))
            table = []
    return found


class Reference:
    def __init__(self):
        self.text = "\n\n".join(path.read_text(encoding="utf-8") for path in REFERENCE)
        self.rows = rows_of_tables(self.text)

    def about(self, name):
        """Documentation of a file: rows and tables that begin with its name, with place holders for numbers and for runs of
        a study."""
        patterns = {name, re.sub(r"^.+-\d+\.prm$", "cases/NAME-SEED.prm", name), re.sub(r"\d{4}", "NNNN", name),
                    re.sub(r"-\d+\.h5$", "-STEP.h5", name)}
        return "\n".join(said for first, said in self.rows if patterns & set(re.findall(r"`([^`]+)`", first)))

    def field(self, name):
        name = re.sub(r"_(continuum|difference)$", "", name)
        return any(f"`{name}`" in first for first, _ in self.rows)


def named(name, text):
    """Whether a name is an item of a text, between separators of a list or of a table: a word of a sentence documents nothing."""
    if "`_uncertainty`" in text:
        name = name.removesuffix("_uncertainty")
    return re.search(rf"(?:^|[|,;:(`{{/]|\band|\bor)\s*{re.escape(name)}(?=\s*(?:[,;:.)`|}}/\[(]|and\b|or\b|$))", text, re.MULTILINE) is not None


def columns(path):
    with path.open(newline="", encoding="utf-8") as file:
        return [re.sub(r" \[[^\]]*\]$", "", column) for column in next(csv.reader(file))]


# Objects whose keys are names of parts of the program, libraries, runs, entries, or rows.
OPEN = ("entries", "wall_time_s", "failed_rows", "libraries", "set", "settings", "units")


def keys(value):
    """Keys of an object and of nested objects; for lists, the keys of the elements."""
    if isinstance(value, dict):
        return [*value, *(key for name, inside in value.items() if name not in OPEN for key in keys(inside))]
    return [key for inside in value for key in keys(inside)] if isinstance(value, list) else []


def arrays(path):
    data = read(path)
    return [name for part in (data.PointData, data.CellData, data.FieldData) for name in part.keys()]


def undocumented(folder):
    """`FILE: NAME` of all contents that the reference does not document."""
    reference = Reference()
    missing = set()
    for path in sorted(path for path in pathlib.Path(folder).rglob("*") if path.is_file()):
        about = reference.about(path.name)
        if path.suffix == ".png" and not about:
            about = reference.about(path.with_suffix(".csv").name)
        if not about and path.parent.name == "pictures":
            about = reference.about("pictures/")
        if not about:
            missing.add(path.name)
            continue
        if path.stem == "study":  # its quantities are those of the runs
            about += reference.about("crack.json") + reference.about("near_tip.json")
        inside = []
        if path.suffix == ".csv":
            inside = [name for name in columns(path) if not named(name, about)]
        elif path.suffix == ".json":
            inside = [name for name in keys(read_json(path)) if not named(name, about)]
        elif path.suffix in (".vtp", ".vtu", ".vti"):
            inside = [name for name in arrays(path) if not reference.field(name)]
        missing |= {f"{path.name}: {name}" for name in inside}
    return sorted(missing)
