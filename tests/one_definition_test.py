#!/usr/bin/python3
"""Checks that no two files define classes with the same name in the same namespace.

Usage: one_definition_test.py PROJECT_ROOT

Such classes compile and link without a warning: the linker keeps one of their destructors, and calls it for both. Which programs
fail depends on the optimisation. With `tests/clean/run lto` the compiler compares all types of whole programs.
"""
import collections
import pathlib
import re
import sys
import unittest

ROOT = pathlib.Path(sys.argv.pop(1)) if len(sys.argv) > 1 else pathlib.Path(__file__).parents[1]
FOLDERS = ("support", "lattice", "continuum", "verification", "tests")

NOT_CODE = re.compile(r'R"\(.*?\)"|//[^\n]*|/\*.*?\*/|"(?:\\.|[^"\\\n])*"|\'(?:\\.|[^\'\\\n])\'', re.DOTALL)
BLOCK = re.compile(r"\bnamespace\b(?P<namespace>[\w:\s]*)\{|"
                   r"\b(?:struct|class|union|enum(?:\s+(?:class|struct))?)\s+(?P<type>[\w:]+)(?P<special><[^;(){}]*>)?"
                   r"\s*(?:final\s*)?(?::[^;(){}]*)?\{|[{}]")


def classes_in(text):
    """Full names of the classes and enumerations that are defined in namespaces with names."""
    scopes, found = [], []  # of each open brace: its namespace, "" for one without a name, None for other braces
    for match in BLOCK.finditer(NOT_CODE.sub("", text)):
        if match.group() == "}":
            scopes.pop()
        elif match["namespace"] is not None:
            scopes.append(match["namespace"].strip())
        else:
            # Specialisations are distinguished by their arguments.
            if match["type"] and not match["special"] and all(scopes):
                found.append("::".join([*scopes, match["type"]]))
            scopes.append(None)
    return found


def places(texts):
    """{class: files that define it} @param texts {file: text}"""
    found = collections.defaultdict(list)
    for file, text in texts.items():
        for name in classes_in(text):
            found[name].append(file)
    return found


class OneDefinition(unittest.TestCase):
    def test_classes_are_found(self):
        text = ("namespace a\n{\nstruct S\n{\n  struct Inner\n  {\n  };\n};\nnamespace\n{\nstruct Hidden\n{\n};\n} // namespace\n"
                "// struct Comment {\nclass Declared;\nclass S::Impl final : public B\n{\n};\nenum class E : int\n{\n};\n} // namespace a\n"
                "const char *t = R\"({\"x\": 1)\";\nnamespace b::c\n{\ntemplate <class T>\nstruct T1\n{\n};\ntemplate <>\nstruct T1<int>\n{\n};\nvoid f(struct S s)\n{\n}\n"
                "} // namespace b::c\nstruct Global\n{\n};\n")
        self.assertEqual(classes_in(text), ["a::S", "a::S::Impl", "a::E", "b::c::T1", "Global"])

    def test_each_is_in_one_file(self):
        files = [path for folder in FOLDERS for path in sorted((ROOT / folder).rglob("*")) if path.suffix in (".h", ".cc", ".inc")]
        found = places({str(path.relative_to(ROOT)): path.read_text(encoding="utf-8") for path in files})
        self.assertGreater(len(found), 200)
        self.assertEqual({name: where for name, where in found.items() if len(where) > 1}, {})


if __name__ == "__main__":
    unittest.main()
