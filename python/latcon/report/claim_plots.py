"""Tables and plots of all claims, from the `plots.py` in the folders of claims.

A `plots.py` defines TABLES, {file name without ".csv": (columns of text, columns of numbers)}, the former a dict of the
words allowed in each column, None for any; and PLOTS, a tuple of Plot. Tables may have further columns.
"""
import importlib.util
from pathlib import Path

from ..errors import UnreadableFile
from ..files import if_present, read_columns

# In the data folder of the program, or in the source tree; a package alone has none.
ROOT = Path(__file__).resolve().parents[3]


MODULES = {}  # by name of the claim
for _path in (*sorted(ROOT.glob("claims/*/plots.py")), *sorted(ROOT.glob("verification/claims/*/plots.py"))):
    _spec = importlib.util.spec_from_file_location(f"claim_plots_{_path.parent.name}", _path)
    MODULES[_path.parent.name.replace("_", "-")] = importlib.util.module_from_spec(_spec)
    _spec.loader.exec_module(MODULES[_path.parent.name.replace("_", "-")])
TABLES = {name: columns for module in MODULES.values() for name, columns in module.TABLES.items()}
# {name of a claim: its plots}
PLOTS = {claim: module.PLOTS for claim, module in MODULES.items()}


def all_plots():
    """The plots of all claims."""
    return [plot for plots in PLOTS.values() for plot in plots]


def read_claim_tables(folder):
    """The tables of a folder that have rows: {name: {column: array}}. Numbers may be nan: not computed."""
    tables = {}
    for name, (texts, numbers) in TABLES.items():
        path = folder / f"{name}.csv"
        table = if_present(read_columns, path, numbers, texts=tuple(texts), finite=False)
        if table is None or not len(table[numbers[0]]):
            continue
        for column, allowed in texts.items():
            strange = [word for word in table[column] if allowed is not None and word not in allowed]
            if strange:
                raise UnreadableFile(path, f"{column} is {strange[0]!r}, allowed: {', '.join(allowed)}")
        tables[name] = table
    return tables
