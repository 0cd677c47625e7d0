"""Checks the web site of the documentation: it is built without warnings, its references resolve, its formulas are typeset."""
import importlib
import os
import pathlib
import re
import subprocess
import sys
import urllib.parse

import pytest

from browser import Browser

ROOT = pathlib.Path(__file__).resolve().parents[2]
BUILD = pathlib.Path(os.environ["LATCON_BUILD"])
SITE = BUILD / "docs" / "html"
THEORY = sorted((ROOT / "docs").glob("theory*.md"))

# Number of typeset formulas, those that MathJax does not know, equations and code that are wider than their boxes, and a page that is
# wider than the window.
MEASURE = """(() => {
  const wrong = [...document.querySelectorAll(".merror, .MathJax_Error, .MathJax [mathcolor='red']")];
  const cut = [...document.querySelectorAll("div.math, div.highlight pre")].filter(box => box.scrollWidth > box.clientWidth + 1);
  if (document.documentElement.scrollWidth > innerWidth + 1) cut.push(document.querySelector("h1"));
  return [document.querySelectorAll(".MathJax_Display").length, [...wrong, ...cut].map(box => box.textContent.slice(0, 60))];
})()"""


@pytest.fixture(scope="module")
def pages():
    """Text of every page that Sphinx made, by its path in the site."""
    run = subprocess.run(["cmake", "--build", BUILD, "--target", "docs"], capture_output=True, text=True, check=False)
    assert run.returncode == 0, run.stdout + run.stderr
    paths = [path for path in SITE.rglob("*.html") if path.relative_to(SITE).parts[0] not in ("_static", "cpp")]
    assert len(paths) > 50
    return {path.relative_to(SITE).as_posix(): path.read_text(encoding="utf-8") for path in paths}


def test_links_lead_to_files_and_equations_to_targets(pages):
    for name, text in pages.items():
        for link in re.findall(r'(?:href|src)="([^"]*)"', text):
            target = urllib.parse.urlsplit(link)
            assert target.scheme or (SITE / name).parent.joinpath(urllib.parse.unquote(target.path)).exists(), f"{name}: {link}"
    for path in THEORY:
        for number in re.findall(r"\\tag\{([^}]+)\}", path.read_text(encoding="utf-8")):
            assert f'id="eq-{number.lower().replace(".", "-")}"' in pages[f"{path.stem}.html"], number
    assert '<a class="reference internal" href="theory.html#eq-l-5">' in pages["glossary.html"]


def test_public_names_of_the_python_package_are_documented(pages):
    sys.path.insert(0, str(ROOT / "python"))
    for module in map(importlib.import_module, ("latcon", "latcon.fit")):
        for name in (*module.__all__, *["open"] * (module.__name__ == "latcon")):
            thing = getattr(module, name)
            full = {f"{module.__name__}.{name}", f"{thing.__module__}.{thing.__qualname__}"}
            assert any(f'id="{identifier}"' in pages["interfaces.html"] for identifier in full), full


def test_nothing_comes_from_the_network_and_names_a_folder_of_this_machine(pages):
    for name, text in pages.items():
        assert re.findall(r'<(?:link|script|img)[^>]*(?:href|src)="(?:https?:)?//[^"]*', text) == [], name
        assert str(ROOT) not in text, name


def test_dead_references_are_warnings(tmp_path):
    source, site = tmp_path / "source", tmp_path / "site"
    source.mkdir()

    def warnings(text):
        (source / "index.md").write_text("# A page\n\n## A part\n\n```math\nm = \\rho V \\tag{L.1}\n```\n\n" + text)
        run = subprocess.run(["sphinx-build", "-n", "-q", "-c", ROOT / "docs", source, site, "-D", "html_static_path="],
                             capture_output=True, text=True, check=True)
        return [line for line in run.stderr.splitlines() if "WARNING" in line]
    assert warnings("By (L.1), but not by `(L.9)` and $(L.9)$, [here](#a-part).\n") == []
    assert 'href="#eq-l-1"' in (site / "index.html").read_text()
    dead = ["(L.2)", "[a page](none.md)", "[a part](#none)", "[a part](index.md#none)", "![a picture](none.png)"]
    assert len(warnings("\n\n".join(dead))) == len(dead)


def shown(name, width):
    """Number of formulas that Chromium typesets on a page at `width` pixels, and texts that are wrong or cut off."""
    with Browser(width, 2000) as browser:
        browser.open(SITE / name)
        browser.value("MathJax.Hub.Queue(() => document.body.classList.add('typeset'))")
        browser.wait("document.body.classList.contains('typeset')")
        return browser.value(MEASURE)


@pytest.mark.skipif("LATCON_FULL" not in os.environ, reason="in full only")
def test_equations_are_typeset_and_fit_a_laptop(pages):
    for path in THEORY:
        count, found = shown(f"{path.stem}.html", 1280)
        assert count == pages[f"{path.stem}.html"].count("math notranslate nohighlight\"") - len(
            re.findall(r'<span class="math', pages[f"{path.stem}.html"])) and found == [], path.stem
    assert shown("model.html", 1100)[1] == []  # beside the narrowest sidebar
    assert shown("theory.html", 600)[1] != []  # boxes that do not fit are detected
    (SITE / "wrong.html").write_text(pages["theory.html"].replace(r"\rho", r"\rhoo"), encoding="utf-8")
    try:
        assert shown("wrong.html", 1280)[1] != []
    finally:
        (SITE / "wrong.html").unlink()
