"""docs/entries.csv holds what the program declares today."""
import os
import pathlib

import entries_page


def test_is_that_of_the_program():
    schema = entries_page.schema(os.environ["LATCON"])
    table = (pathlib.Path(__file__).resolve().parents[2] / "docs" / "entries.csv").read_text(encoding="utf-8")
    assert table == entries_page.table(schema), "remake it: cmake --build build/release --target entries_page"
