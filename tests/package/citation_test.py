#!/usr/bin/python3
"""Checks that CITATION.cff has the version of CMakeLists.txt and conforms to the format 1.2.0.

Usage: citation_test.py SOURCE_FOLDER BUILD_FOLDER
"""
import re
import unittest

from folders import SOURCE

REQUIRED = {"cff-version", "message", "title", "authors"}
KNOWN = REQUIRED | {"abstract", "type", "version", "license", "date-released", "doi", "identifiers", "keywords", "url",
                    "repository-code", "commit", "contact", "license-url", "preferred-citation", "references",
                    "repository", "repository-artifact"}


class Citation(unittest.TestCase):
    def setUp(self):
        self.text = (SOURCE / "CITATION.cff").read_text()
        self.entries = dict(re.findall(r"^([a-z-]+):[ ]*(.*)$", self.text, re.M))

    def test_has_the_version_of_the_project(self):
        project = re.search(r"project\(latcon VERSION ([\d.]+)", (SOURCE / "CMakeLists.txt").read_text()).group(1)
        self.assertEqual(self.entries["version"], project)

    def test_has_the_keys_of_the_format(self):
        self.assertLessEqual(REQUIRED, set(self.entries))
        self.assertLessEqual(set(self.entries), KNOWN)
        self.assertEqual(self.entries["cff-version"], "1.2.0")
        self.assertEqual(self.entries["type"], "software")
        self.assertEqual(self.entries["license"], "LGPL-2.1-or-later")
        self.assertRegex(self.text, r"(?m)^authors:\n  - (name|family-names): \S")


if __name__ == "__main__":
    unittest.main()
