"""Code, tests and theory refer to the same equations.

The theory pages number equations by \\tag{L.2}. Code that implements an equation and tests that check it refer to it as (L.2);
(L.17) to (L.20) denotes all four.
"""
import collections
import pathlib
import re

ROOT = pathlib.Path(__file__).resolve().parents[1]
CODE = ("lattice", "continuum", "verification", "python")
KINDS = {".h", ".cc", ".inc", ".py", ".prm", ".json"}

# Steps of a derivation, which the code does not compute; it computes the equation that they lead to.
DERIVATION = {"L.21": "says where damped modes lie, which (L.22) then keeps stable",
              "L.25": "shows for two stages that (L.23) keeps touching sites stable",
              "H.16": "leading term of (H.14), which says why the energy agrees best at one mean stretch"}

TAG = re.compile(r"\\tag\{([^}]+)\}")
NUMBER = r"[A-Z]\.\d+"
RANGE = re.compile(rf"\(({NUMBER})\)\s+(?:[/#]+\s+)?to\s+(?:[/#]+\s+)?\(({NUMBER})\)")
ONE = re.compile(rf"\(({NUMBER})\)")


def references(text):
    """Numbers of the equations that a text refers to; the equations between the ends of a range need not all exist."""
    named = set(ONE.findall(text))
    within = {f"{first[0]}.{number}" for first, last in RANGE.findall(text) for number in range(int(first[2:]), int(last[2:]) + 1)}
    return named, within | named


def bare(text, letters):
    """References without parentheses, which references() does not find."""
    return re.findall(rf"(?:\beqs?\.|\.md,)\s+(?:[/#]+\s+)?[{letters}]\.\d+", text)


def equations():
    """Number of occurrences of each equation number."""
    return collections.Counter(tag for page in (ROOT / "docs").glob("theory*.md") for tag in TAG.findall(page.read_text()))


# A test of C++ or Python with the comments and decorators right above it: a reference elsewhere does not say that the equation
# is checked.
TEST = re.compile(r"(?:^ *//[^\n]*\n)*^TEST(?:_F|_P)?\(.*?^}|(?:^[#@][^\n]*\n)*^def test_.*?(?=^[^\s)]|\Z)", re.MULTILINE | re.DOTALL)


def sources(*folders):
    return [path for folder in folders for path in sorted((ROOT / folder).rglob("*"))
            if path.suffix in KINDS and path.resolve() != pathlib.Path(__file__).resolve()]


def referred_to(paths):
    return set().union(*(references(path.read_text())[1] for path in paths))


def test_each_number_is_given_once():
    given = equations()
    assert len(given) > 90
    assert [number for number, times in given.items() if times > 1] == []


def test_code_refers_to_each_equation():
    assert sorted(set(equations()) - referred_to(sources(*CODE)) - set(DERIVATION)) == []


def test_tests_refer_to_each_equation():
    within = set().union(*(references(test)[1] for path in sources("tests") for test in TEST.findall(path.read_text())))
    assert sorted(set(equations()) - within - set(DERIVATION)) == []


def test_steps_of_derivation_are_equations_without_code():
    assert set(DERIVATION) - set(equations()) == set()
    assert set(DERIVATION) & referred_to(sources(*CODE)) == set()


def test_nobody_refers_to_an_equation_that_is_not_there():
    given = equations()
    letters = "".join(sorted({number[0] for number in given}))
    code = sources(*CODE, "tests")
    for path in code + sorted((ROOT / "docs").rglob("*.md")):
        text = path.read_text()
        assert {n for n in references(text)[0] if n[0] in letters} - set(given) == set()
        assert (bare(text, letters) if path in code else []) == []
