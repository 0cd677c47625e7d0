#!/usr/bin/python3
"""docs/reference-entries.md holds what the program declares today.

Usage: entries_page_test.py PATH_OF_LATCON SOURCE_FOLDER
"""
import pathlib
import sys
import unittest

sys.dont_write_bytecode = True
sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent))
import entries_page


class EntriesPage(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.schema = entries_page.schema(LATCON)

    def test_is_that_of_the_program(self):
        page = (SOURCE / "docs" / "reference-entries.md").read_text(encoding="utf-8")
        self.assertEqual(page, entries_page.page(self.schema), "remake it: cmake --build build/release --target entries_page")

    def test_every_entry_says_what_it_means_and_what_is_allowed(self):
        self.assertGreater(len(self.schema["entries"]), 100)
        for entry in self.schema["entries"]:
            with self.subTest(f"{entry['section']}/{entry['name']}"):
                self.assertGreater(len(entry["documentation"]), 4)
                # What a text may be is in its documentation.
                self.assertTrue(entry["allowed"] or entry["type"] == "text" or entry["unit"])
                self.assertTrue(entries_page.default_of(entry) or entry["type"] == "text")

    def test_cells_show_the_declaration(self):
        entry = {"section": "Sheet", "name": "hole", "unit": "m", "required": False, "default": None,
                 "allowed": ">= 0, or auto", "documentation": "a|b * c"}
        self.assertEqual(entries_page.row(entry), "| `hole` | m | >= 0, or auto | `auto` | a\\|b \\* c |\n")
        entry.update(unit="1", default=1e-10, allowed="one of a, b")
        self.assertEqual(entries_page.row(entry), "| `hole` | - | a, b | `1e-10` | a\\|b \\* c |\n")
        for default, cell in ((False, "`false`"), (100000.0, "`100000`"), ("", ""), (12, "`12`")):
            self.assertEqual(entries_page.default_of({"required": False, "default": default}), cell)
        self.assertEqual(entries_page.default_of({"required": True}), "required")


if __name__ == "__main__":
    LATCON, SOURCE = sys.argv[1], pathlib.Path(sys.argv[2])
    unittest.main(argv=sys.argv[:1], verbosity=2)
