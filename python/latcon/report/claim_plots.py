"""Tables and plots of all claims, from the `plots.py` in the folders of claims.

A `plots.py` defines PLOTS, a tuple of Plot, and, if its tables have columns of words other than those of all claims, WORDS,
{column: the words allowed in it}. All other columns are of numbers; a plot reads those that it draws.
"""
import importlib.util
from pathlib import Path

from ..errors import UnreadableFile
from ..files import if_present, read_columns
from .claim_tables import Table

# In the data folder of the program, or in the source tree; a package alone has none.
ROOT = Path(__file__).resolve().parents[3]


MODULES = {}  # by name of the claim
for _path in (*sorted(ROOT.glob("claims/*/plots.py")), *sorted(ROOT.glob("verification/claims/*/plots.py"))):
    _spec = importlib.util.spec_from_file_location(f"claim_plots_{_path.parent.name}", _path)
    MODULES[_path.parent.name.replace("_", "-")] = importlib.util.module_from_spec(_spec)
    _spec.loader.exec_module(MODULES[_path.parent.name.replace("_", "-")])
# Words of columns, None for any.
WORDS = {"shells": None, "law": None, "wave": ("L", "S"),
         **{column: words for module in MODULES.values() for column, words in getattr(module, "WORDS", {}).items()}}
# {name of a claim: its plots}
PLOTS = {claim: module.PLOTS for claim, module in MODULES.items()}


def all_plots():
    """The plots of all claims."""
    return [plot for plots in PLOTS.values() for plot in plots]


def read_claim_tables(folder):
    """The tables of a folder that have rows: {name: Table}. Numbers may be nan: not computed."""
    tables = {}
    for name in (name for plot in all_plots() for name in (plot.name, *plot.others)):
        path = folder / f"{name}.csv"
        columns = if_present(read_columns, path, None, texts=tuple(WORDS), finite=False)
        if columns is None or not len(next(iter(columns.values()))):
            continue
        tables[name] = Table(path, columns)
        for column in columns.keys() & WORDS.keys():
            strange = [word for word in columns[column] if WORDS[column] is not None and word not in WORDS[column]]
            if strange:
                raise UnreadableFile(path, f"{column} is {strange[0]!r}, allowed: {', '.join(WORDS[column])}")
    return tables
