"""Checks that the tests named in docs/reliability.md and docs/security.md exist."""
import pathlib
import re

SOURCE = pathlib.Path(__file__).resolve().parents[1]


def known_tests():
    """Names of tests as written on the pages: Suite.Name of ctest, FILE.py::METHOD of Python."""
    names = set()
    for path in (SOURCE / "tests").rglob("*"):
        if path.suffix == ".cc":
            names |= {f"{suite}.{test}" for suite, test in
                      re.findall(r"^TEST(?:_F|_P)?\((\w+),\s*(\w+)\)", path.read_text(), re.MULTILINE)}
        elif path.name == "CMakeLists.txt":
            names |= set(re.findall(r"(?:add_test\(NAME|latcon_\w+test\w*\()\s*(\w+\.\w+)", path.read_text()))
        elif path.suffix == ".py":
            names |= {f"{path.name}::{method}" for method in re.findall(r"def (test_\w+)", path.read_text())}
    return names


def answers(section):
    """Cells of the rows of the table in a section."""
    text = (SOURCE / "docs" / "reliability.md").read_text().partition(f"## {section}\n")[2].partition("\n## ")[0]
    rows = [[cell.strip() for cell in line.strip("|").split("|")] for line in text.splitlines() if line.startswith("|")]
    return rows[2:]


def test_every_answer_names_tests_that_there_are():
    known = known_tests()
    assert len(known) > 500
    rows = answers("Findings of a review")
    assert len(rows) > 60
    for row in rows:
        *answer, tests = row
        assert all(answer[1:])
        named = re.findall(r"`([^`]+)`", tests)
        assert named
        assert [name for name in named if name not in known and not (SOURCE / name).is_file()] == []


def test_page_of_security_names_tests_that_there_are():
    known = known_tests()
    suites = {name.partition(".")[0] + ".*" for name in known}
    named = re.findall(r"`(\w+\.py::\w+|[A-Z]\w*[a-z]\w*\.(?:[A-Z]\w+|\*))`", (SOURCE / "docs" / "security.md").read_text())
    assert len(named) > 20
    assert [name for name in named if name not in known and name not in suites] == []
