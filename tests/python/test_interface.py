"""Checks that every public name has a docstring that describes its parameters, and is on the page of the package."""
import inspect
import pathlib
import re
import subprocess
import sys

import latcon
import latcon.fit

PAGE = (pathlib.Path(__file__).resolve().parents[2] / "docs" / "python.md").read_text(encoding="utf-8")
PUBLIC = {**{name: getattr(latcon, name) for name in (*latcon.__all__, "open")},
          **{name: getattr(latcon.fit, name) for name in latcon.fit.__all__}}


def members():
    """(name, object) of public functions, classes and their own public members."""
    for name, thing in PUBLIC.items():
        yield name, thing
        if inspect.isclass(thing):
            for member, value in vars(thing).items():
                value = getattr(value, "func", getattr(value, "fget", value))  # of properties
                if not member.startswith("_") and inspect.isfunction(value):
                    yield f"{name}.{member}", value


def test_docstrings_describe_all_parameters():
    seen = dict(members())
    assert len(seen) > 40
    for name, thing in seen.items():
        text = inspect.getdoc(thing) or ""
        assert re.match(r"[A-Z`].*[.:]$", text.splitlines()[0] if text else ""), f"{name}: {text[:60]!r}"
        if not inspect.isfunction(thing):
            continue
        parameters = [key for key in inspect.signature(thing).parameters if key != "self"]
        elsewhere = "are those of :func:`fracture`" in text
        # A single parameter that the first sentence explains needs no section.
        if len(parameters) > 1 and not elsewhere:
            section = text.partition("Parameters\n----------\n")[2]
            for parameter in parameters:
                assert re.search(rf"^(?:.*, )?\**{parameter}\b", section.replace("\\*", "*"), re.M), f"{name}: {parameter}"


def test_page_has_every_name():
    known = set(re.findall(r"\w+", PAGE))
    assert not set(PUBLIC) - known


def test_the_package_and_studies_do_without_packages_that_only_tables_and_pages_need():
    absent = "import sys; sys.modules.update(dict.fromkeys(['pandas', 'jinja2', 'matplotlib', 'vtkmodules']))"
    done = subprocess.run([sys.executable, "-c", f"{absent}; import latcon, latcon.study.command, latcon.compare"],
                          capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr
