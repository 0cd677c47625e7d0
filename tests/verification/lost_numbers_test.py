#!/usr/bin/python3
"""Fails if a source that creates rows of claims takes a maximum or minimum that can lose a NaN, or a test the largest of errors.

std::max(0., NaN) is 0, and so an error that could not be computed would hold. The sources below take errors and extremes
from support/largest_error.h. What has an integer type by name, as std::max<std::size_t>(a, b), is not meant. In tests the
largest of magnitudes is meant alone, x = std::max(x, std::abs(error)).

Usage: lost_numbers_test.py PROJECT_ROOT
"""
import pathlib
import re
import sys

# All sources that contribute to a row with a verdict.
SOURCES = ("support/largest_error.*",
           *(f"verification/{path}" for path in (
             "bridge/anisotropy.*", "bridge/bloch.*", "bridge/equivalent_sheet.*", "bridge/homogenisation.*", "bridge/plane_waves.*",
             "bridge/slowest_wave.*", "bridge/subject.h", "claims/*", "claims/*/*", "commands/verify.cc", "compare/comparison.*",
             "output/continuum_record.*", "output/crack_record.*")))
INTEGER = r"<(?:std::size_t|unsigned int|int|long|std::ptrdiff_t)>"
LOSES = re.compile(
    rf"std::(?:max|min)\b(?!{INTEGER})|\bstd::f(?:max|min)[fl]?\b|\bstd::(?:minmax|(?:max|min|minmax)_element)\b"
    r"|\.cwise(?:Max|Min)\(|\.(?:max|min)Coeff\(|-?\b1e-?3\d\d\b")
LOSES_ERRORS = re.compile(r"([\w.]+)\s*=\s*std::max\(\s*\1,[^;]*(?:std::abs|std::hypot|\.norm\(\))[^;]*;")
# Lines of code that must be found, and such as must not.
PLANTED = {
    "error = std::max(0., -x);": True, "largest = std::max({a, b});": True, "x = std::max<double>(a, b);": True,
    "x = *std::max_element(v.begin(), v.end());": True, "y = e.cwiseMax(0.);": True, "z = std::fmin(a, b);": True,
    "double hardest = 1e300;": True, "std::max(1e-300, x)": True, "v.lpNorm() + M.maxCoeff();": True,
    "n = std::max<std::size_t>(1, n);": False, "x = largest_of({a, b});": False, "x = std::clamp(x, low, high);": False,
    "// std::max(0., NaN) is 0": False, "double x = 1e30;": False,
}
PLANTED_IN_TESTS = {
    "worst = std::max(worst, std::abs(a - b));": True, "e.u =\n  std::max(e.u, (x - y).norm() / l);": True,
    "worst = support::largest_of({worst, std::abs(a - b)});": False, "x = std::max(0., 1. - std::abs(y));": False,
    "most = std::max(most, count);": False,
}


def lost_errors(text):
    """[(line number, statement)] of the largest of errors that can lose a NaN."""
    return [(text.count("\n", 0, found.start()) + 1, " ".join(found[0].split())) for found in LOSES_ERRORS.finditer(text)]


def losses(text):
    """[(line number, line)] of the lines that can lose a NaN."""
    return [(number, line.strip()) for number, line in enumerate(text.splitlines(), start=1)
            if LOSES.search(line.partition("//")[0])]


def main(root):
    for line, is_found in PLANTED.items():
        if bool(losses(line)) != is_found:
            return f"the rule itself is wrong about: {line}"
    for text, is_found in PLANTED_IN_TESTS.items():
        if bool(lost_errors(text)) != is_found:
            return f"the rule itself is wrong about: {text}"
    folder = pathlib.Path(root)
    problems = []
    for pattern in SOURCES:
        files = sorted(path for path in folder.glob(pattern) if path.suffix in (".h", ".cc"))
        if not files:
            problems.append(f"{pattern}: no such source; correct the list in {pathlib.Path(__file__).name}")
        problems += [f"{path.relative_to(folder)}:{number}: {line}" for path in files
                     for number, line in losses(path.read_text(encoding="utf-8"))]
    tests = sorted(path for path in folder.glob("tests/**/*") if path.suffix in (".h", ".cc"))
    if len(tests) < 100:
        problems.append(f"{len(tests)} sources of tests were found")
    problems += [f"{path.relative_to(folder)}:{number}: {statement}" for path in tests
                 for number, statement in lost_errors(path.read_text(encoding="utf-8"))]
    if problems:
        return ("A NaN is lost here, and the row or the test that asks for it would hold. Take LargestError, Extremes, largest_of, "
                "smallest_of or one_sided of support/largest_error.h:\n  " + "\n  ".join(problems))
    return None


if __name__ == "__main__":
    sys.exit(main(*sys.argv[1:]))
