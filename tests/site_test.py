"""Checks that the web site of the documentation is built without warnings, has no dead links and contains the Python interface."""
import html.parser
import importlib
import importlib.util
import inspect
import os
import pathlib
import re
import subprocess
import sys
import tempfile
import urllib.parse

import pytest

ROOT = pathlib.Path(__file__).resolve().parents[1]
DOXYFILE, SITE = (pathlib.Path(os.environ["LATCON_BUILD"]) / "docs" / path for path in ("site/Doxyfile", "html"))
BUILD = ROOT / "docs" / "site" / "build.py"


def module(path):
    spec = importlib.util.spec_from_file_location(path.stem, path)
    loaded = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(loaded)
    return loaded


# Script that writes to the title of a page, once its formulas are typeset, the number of equation and code boxes, and those
# whose text is cut off.
MEASURE = """<script>addEventListener("load", () => MathJax.Hub.Queue(() => {
  const boxes = [...document.querySelectorAll("div.fragment, pre.fragment, .MathJax_Display")];
  const cut = boxes.filter(box => box.scrollWidth > box.clientWidth + 1);
  document.title = [boxes.length, ...cut.map(box => box.textContent.slice(0, 60))].join("|");
}));</script>"""


class Page(html.parser.HTMLParser):
    """Anchors, links, pictures, text and formulas of a page."""

    def __init__(self, text):
        super().__init__()
        self.anchors, self.links, self.text, self.within = set(), [], [], ""
        self.feed(text)
        self.formulas = re.findall(r"\\\[(.*?)\\\]|\\\((.*?)\\\)", "".join(self.text), re.DOTALL)

    def handle_starttag(self, tag, attributes):
        self.within = tag
        for name, value in attributes:
            if name in ("id", "name"):
                self.anchors.add(value)
            elif name in ("href", "src", "data") and value:
                self.links.append(value)

    def handle_endtag(self, tag):
        self.within = ""

    def handle_data(self, data):
        if self.within != "script":
            self.text.append(data)


def read_site():
    return {path.name: Page(path.read_text()) for path in SITE.glob("*.html")}


def dead_links(pages):
    dead = []
    for name, page in pages.items():
        for link in page.links:
            target = urllib.parse.urlsplit(link)
            if target.scheme:
                continue
            file, anchor = urllib.parse.unquote(target.path) or name, urllib.parse.unquote(target.fragment)
            if not (SITE / file).is_file() or (anchor and file in pages and anchor not in pages[file].anchors):
                dead.append(f"{name}: {link}")
    return dead


@pytest.fixture(scope="module")
def pages():
    run = subprocess.run([sys.executable, BUILD, DOXYFILE, SITE], capture_output=True, text=True, check=False)
    assert run.returncode == 0, run.stdout + run.stderr
    pages = read_site()
    return pages


def test_links_and_pictures_are_there(pages):
    assert sum(len(page.links) for page in pages.values()) > 5000
    assert dead_links(pages) == []


def test_every_page_is_in_the_tree(pages):
    tree = {link for link in pages["pages.html"].links if link.endswith(".html")}
    name = module(ROOT / "docs" / "site" / "filter.py").page_name
    for path in sorted((ROOT / "docs").rglob("*.md")):
        assert name(path.relative_to(ROOT).as_posix()) + ".html" in tree


def test_python_names_have_signatures_and_docstrings(pages):
    sys.path[:0] = [str(ROOT / "python"), str(BUILD.parent)]
    page = pages["python-api.html"]
    shown = " ".join("".join(page.text).split())
    count = 0
    for module in map(importlib.import_module, ("latcon", "latcon.fit")):
        for name in (*module.__all__, *["open"] * (module.__name__ == "latcon")):
            thing = getattr(module, name)
            own = [] if not inspect.isclass(thing) else [
                (f"{name}.{key}", getattr(value, "func", getattr(value, "fget", value))) for key, value in vars(thing).items()
                if not key.startswith("_")]
            for full, documented in [(f"{module.__name__}.{name}", thing), *own]:
                text = inspect.getdoc(documented)
                if not text or not callable(documented):
                    continue
                count += 1
                assert "python-" + full.replace(".", "-") in page.anchors
                plain = re.sub(r":\w+:`~?([^`]+)`", r"\1", text.split("\n\n")[0]).replace("`", "")
                assert " ".join(plain.split()) in shown, full
                if inspect.isfunction(documented) and (thing is documented or documented in vars(thing).values()):
                    assert f"{full}(" in shown
                    for key, parameter in inspect.signature(documented).parameters.items():
                        assert key == "self" or f"{key}: {parameter.annotation}" in shown, f"{full}: {key}"
    assert count > 60


def test_interfaces_of_the_libraries_are_in_a_group_of_their_own():
    menu = (SITE / "menudata.js").read_text()
    top = re.findall(r'^(?:var menudata=\{children:\[|)\{text:"([^"]+)"', menu, re.MULTILINE)
    assert top[:3] == ["Main Page", "Pages", "C++ interface"], menu[:500]


def test_can_be_published_with_its_version():
    publish = module(BUILD.with_name("publish.py")).publish
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        small = folder / "site"
        small.mkdir()
        for version in ("0.2.0", "0.10.0", "0.9.1", "0.2.0"):
            (small / "index.html").write_text(f"{version} {len(list(folder.rglob('*')))}")
            publish(small, folder / "www", version)
        www = folder / "www"
        assert re.findall(r'href="([^"]+)"', (www / "versions.html").read_text()) == (
            [f"{version}/index.html" for version in ("0.10.0", "0.9.1", "0.2.0")])
        assert "url=0.10.0/index.html" in (www / "index.html").read_text()
        for link in re.findall(r'(?:href="|url=)([^"]+)"', (www / "versions.html").read_text() + (www / "index.html").read_text()):
            assert (www / link).is_file(), link
        for version in ("latest", "../x"):
            with pytest.raises(SystemExit):
                publish(small, www, version)
        with pytest.raises(SystemExit):
            publish(folder / "nothing", www, "1.0")
    # The site names its version, and no folder of this machine.
    assert re.search(r"project\(latcon VERSION ([\d.]+)", (ROOT / "CMakeLists.txt").read_text())[1] in (
        (SITE / "index.html").read_text())
    local = [path.name for path in SITE.rglob("*") if path.suffix in (".html", ".js", ".txt") and "mathjax" not in path.parts
             and str(ROOT) in path.read_text(errors="replace")]
    assert local == []


def test_equations_are_formulas_with_anchors(pages):
    for path in sorted((ROOT / "docs").glob("theory*.md")):
        page = pages[path.stem + ".html"]
        text = path.read_text()
        shown = "".join(display for display, _ in page.formulas)
        for number in re.findall(r"\\tag\{([^}]+)\}", text):
            assert "eq-" + number.replace(".", "-") in page.anchors
            assert f"\\tag{{{number}}}" in shown
        inline = len(re.findall(r"\$[^$\n]+\$", text))
        assert sum(1 for display, _ in page.formulas if not display) == inline
        assert "$" not in "".join(page.text)


def test_formulas_are_what_mathjax_knows(pages):
    """MathJax shows unknown commands in red, and does not show formulas with unbalanced braces."""
    tex = SITE / "mathjax"
    files = [tex / "jax/input/TeX/jax.js", *(tex / "extensions/TeX" / f"{n}.js" for n in ("AMSmath", "AMSsymbols"))]
    known = "".join(path.read_text() for path in files)
    checked = set()
    for name, page in pages.items():
        for formula in ("".join(pair) for pair in page.formulas):
            bare = re.sub(r"\\[{}]", "", formula)
            assert bare.count("{") == bare.count("}"), f"{name}: {formula}"
            assert re.findall(r"\\begin\{(\w+)\}", formula) == re.findall(r"\\end\{(\w+)\}", formula)[::-1]
            checked.update(re.findall(r"\\([A-Za-z]+)", formula))
    assert len(checked) > 50
    assert [c for c in sorted(checked) if not re.search(rf"[\s,{{\"'\\]{c}[\"']?\s*:", known)] == []


def test_nothing_comes_from_the_network(pages):
    for page in pages.values():
        assert [link for link in page.links if re.match(r"(https?:)?//.*\.(js|css|png|woff)", link)] == []


def test_mathjax_has_what_it_loads():
    """Files listed by a browser; if any is missing, formulas are replaced by error messages."""
    loads = [*(f"extensions/{n}.js" for n in ("MathEvents", "TeX/AMSmath", "TeX/AMSsymbols", "tex2jax")),
             "jax/input/TeX/config.js", "jax/input/TeX/jax.js", "jax/element/mml/jax.js",
             *(f"jax/element/mml/optable/{n}.js" for n in ("Arrows", "BasicLatin", "GeneralPunctuation")),
             *(f"jax/output/HTML-CSS/{n}.js" for n in ("autoload/mtable", "config", "jax", "fonts/TeX/fontdata",
                                                       "fonts/TeX/AMS/Regular/Main")),
             "fonts/HTML-CSS/TeX/woff/MathJax_Main-Regular.woff", "MathJax.js"]
    assert [file for file in loads if not (SITE / "mathjax" / file).is_file()] == []


@pytest.mark.skipif("LATCON_FULL" not in os.environ, reason="in full only")
def test_equations_and_the_front_page_s_code_fit_a_laptop():
    for name in ("index.html", *(f"{path.stem}.html" for path in sorted((ROOT / "docs").glob("theory*.md")))):
        assert cut_off(name, 1280) == [], name
    assert cut_off("theory.html", 700) != []  # boxes that do not fit are detected


def cut_off(name, width):
    """Equations and code of a page that are wider than their boxes in a Chromium window of `width` pixels."""
    measured = SITE / f"measured-{name}"
    measured.write_text((SITE / name).read_text().replace("</body>", MEASURE + "</body>"))
    try:
        with tempfile.TemporaryDirectory() as folder:
            shown = subprocess.run(["chromium", "--headless", "--no-sandbox", "--disable-gpu",
                                    "--allow-file-access-from-files", f"--user-data-dir={folder}",
                                    f"--window-size={width},2000", "--virtual-time-budget=60000", "--dump-dom",
                                    measured.as_uri()], capture_output=True, text=True, timeout=200, check=True,
                                   stdin=subprocess.DEVNULL).stdout
    finally:
        measured.unlink()
    count, *found = re.search(r"<title>(.*?)</title>", shown, re.DOTALL)[1].split("|")
    assert int(count) > 1, name  # boxes there are
    return found


def test_warnings_are_seen():
    judged = module(BUILD).warnings
    assert judged("a.h:3: warning: Member f() (function) of class lattice::A is not documented.\n") == []
    assert len(judged("a.h:3: warning: Member f() (function) of namespace lattice is not documented.\n"
                                "a.h:5: warning: Compound lattice::B is not documented.\n"
                                "b.md:7: warning: unable to resolve reference to 'x' for \\ref command\n")) == 3
