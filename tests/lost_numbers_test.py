"""No source that creates rows of claims takes a maximum or minimum that can lose a NaN, and no test the largest of errors.

std::max(0., NaN) is 0, and so an error that could not be computed would hold. The sources below take errors and extremes
from support/largest_error.h. What has an integer type by name, as std::max<std::size_t>(a, b), is not meant. In tests the
largest of magnitudes is meant alone, x = std::max(x, std::abs(error)).
"""
import pathlib
import re

import pytest

ROOT = pathlib.Path(__file__).resolve().parents[1]

# All sources that contribute to a row with a verdict.
SOURCES = ("support/largest_error.*",
           *(f"verification/{path}" for path in (
             "bridge/equivalent_sheet.*", "bridge/homogeneous_response.*", "bridge/homogenisation.*", "bridge/plane_waves.*",
             "bridge/subject.*", "claims/*", "claims/*/*", "commands/verify.cc", "output/continuum_record.*",
             "output/crack_record.*")))
INTEGER = r"<(?:std::size_t|unsigned int|int|long|std::ptrdiff_t)>"
LOSES = re.compile(
    rf"std::(?:max|min)\b(?!{INTEGER})|\bstd::f(?:max|min)[fl]?\b|\bstd::(?:minmax|(?:max|min|minmax)_element)\b"
    r"|\.cwise(?:Max|Min)\(|\.(?:max|min)Coeff\(|-?\b1e-?3\d\d\b")
LOSES_ERRORS = re.compile(r"([\w.]+)\s*=\s*std::max\(\s*\1,[^;]*(?:std::abs|std::hypot|\.norm\(\))[^;]*;")


def lost_errors(text):
    """[(line number, statement)] of the largest of errors that can lose a NaN."""
    return [(text.count("\n", 0, found.start()) + 1, " ".join(found[0].split())) for found in LOSES_ERRORS.finditer(text)]


def losses(text):
    """[(line number, line)] of the lines that can lose a NaN."""
    return [(number, line.strip()) for number, line in enumerate(text.splitlines(), start=1)
            if LOSES.search(line.partition("//")[0])]


@pytest.mark.parametrize("pattern", SOURCES)
def test_rows_lose_no_number(pattern):
    files = sorted(path for path in ROOT.glob(pattern) if path.suffix in (".h", ".cc"))
    assert files, "no such source"
    assert [(path, found) for path in files for found in losses(path.read_text(encoding="utf-8"))] == []


def test_tests_lose_no_error():
    tests = sorted(path for path in ROOT.glob("tests/**/*") if path.suffix in (".h", ".cc"))
    assert len(tests) > 100
    assert [(path, found) for path in tests for found in lost_errors(path.read_text(encoding="utf-8"))] == []
