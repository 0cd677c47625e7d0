"""docs/entries.csv holds what the program declares today."""
import os
import pathlib

import pytest

import entries_page


@pytest.fixture(scope="module")
def schema():
    return entries_page.schema(os.environ["LATCON"])


def test_is_that_of_the_program(schema):
    table = (pathlib.Path(__file__).resolve().parents[2] / "docs" / "entries.csv").read_text(encoding="utf-8")
    assert table == entries_page.table(schema), "remake it: cmake --build build/release --target entries_page"


def test_every_entry_says_what_it_means_and_what_is_allowed(schema):
    assert len(schema["entries"]) > 100
    for entry in schema["entries"]:
        assert len(entry["documentation"]) > 4
        # What a text may be is in its documentation.
        assert entry["allowed"] or entry["type"] == "text" or entry["unit"]
        assert entries_page.default_of(entry) or entry["type"] == "text"
