"""Checks that CITATION.cff has the version of CMakeLists.txt and conforms to the format 1.2.0."""


import re
import types

import pytest

from folders import SOURCE

REQUIRED = {"cff-version", "message", "title", "authors"}
KNOWN = REQUIRED | {"abstract", "type", "version", "license", "date-released", "doi", "identifiers", "keywords", "url",
                    "repository-code", "commit", "contact", "license-url", "preferred-citation", "references",
                    "repository", "repository-artifact"}


@pytest.fixture
def made():
    made = types.SimpleNamespace()
    made.text = (SOURCE / "CITATION.cff").read_text()
    made.entries = dict(re.findall(r"^([a-z-]+):[ ]*(.*)$", made.text, re.M))
    return made


def test_has_the_version_of_the_project(made):
    project = re.search(r"project\(latcon VERSION ([\d.]+)", (SOURCE / "CMakeLists.txt").read_text()).group(1)
    assert made.entries["version"] == project


def test_has_the_keys_of_the_format(made):
    assert REQUIRED <= set(made.entries)
    assert set(made.entries) <= KNOWN
    assert made.entries["cff-version"] == "1.2.0"
    assert made.entries["type"] == "software"
    assert made.entries["license"] == "LGPL-2.1-or-later"
    assert re.search(r"(?m)^authors:\n  - (name|family-names): \S", made.text)
