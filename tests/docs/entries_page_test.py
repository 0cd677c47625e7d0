#!/usr/bin/python3
"""docs/reference-entries.md holds what the program declares today.

Usage: entries_page_test.py PATH_OF_LATCON SOURCE_FOLDER
"""
import pathlib
import re
import sys
import unittest

sys.dont_write_bytecode = True
sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent))
import entries_page


class EntriesPage(unittest.TestCase):
    def test_is_that_of_the_program(self):
        page = (SOURCE / "docs" / "reference-entries.md").read_text(encoding="utf-8")
        self.assertEqual(page, entries_page.page(entries_page.resolved_case(LATCON)),
                         "remake it: cmake --build build/release --target entries_page")

    def test_has_every_entry_that_shipped_cases_set(self):
        known = {(section, name) for section, name, *_ in entries_page.entries(entries_page.resolved_case(LATCON))}
        self.assertGreater(len(known), 100)
        for path in (SOURCE / "verification" / "cases").glob("*.prm"):
            section = None
            for line in path.read_text().splitlines():
                if begins := re.match(r"subsection (.+)", line):
                    section = begins[1]
                elif entry := re.match(r" *set (.+?) *=", line):
                    self.assertIn((section, entry[1]), known, path)

    def test_every_entry_says_what_it_means_and_what_is_allowed(self):
        for section, name, unit, rule, default, meaning in entries_page.entries(entries_page.resolved_case(LATCON)):
            with self.subTest(f"{section}/{name}"):
                self.assertGreater(len(meaning), 4)
                self.assertTrue(rule or "expression" in meaning or "file" in name or unit)
                self.assertTrue(default or "file" in name)

    def test_columns_come_from_the_documentation(self):
        text = """subsection Sheet
  # of a (round) hole; x [m] in
  # words [m] (>= 0, or auto)
  set hole   = auto # default: 1
  # words (one of a, b; required)
  set shape = a
end
"""
        self.assertEqual(entries_page.entries(text),
                         [("Sheet", "hole", "m", ">= 0, or auto", "auto", "of a (round) hole; x [m] in words"),
                          ("Sheet", "shape", "", "one of a, b", "required", "words")])


if __name__ == "__main__":
    LATCON, SOURCE = sys.argv[1], pathlib.Path(sys.argv[2])
    unittest.main(argv=sys.argv[:1], verbosity=2)
