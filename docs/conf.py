"""Web site of the documentation: `cmake --build BUILD --target docs`, then BUILD/docs/html/index.html.

Pages are Markdown as a git host shows it, read by MyST; directives are added here. References to equations, "(L.2)", are links, in pages and in docstrings;
a reference without its target is a warning, and the target `docs` makes warnings errors. A paragraph that is a link to a .csv file becomes its table.
"""
import csv
import pathlib
import re
import shutil
import sys

from docutils import nodes
from pygments.lexers.shell import BashLexer
from sphinx import addnodes
from sphinx.transforms import SphinxTransform
from sphinx.util.nodes import make_refnode

ROOT = pathlib.Path(__file__).resolve().parents[1]
sys.path.insert(0, str(ROOT / "python"))
sys.dont_write_bytecode = True

project = "latcon"
release = re.search(r"project\(latcon VERSION ([\d.]+)", (ROOT / "CMakeLists.txt").read_text(encoding="utf-8"))[1]
extensions = ["myst_parser", "nbsphinx", "sphinx.ext.autodoc", "sphinx.ext.mathjax", "sphinx.ext.napoleon"]
exclude_patterns = ["pictures", "images"]
nitpicky = True
# Types of other packages, aliases that interfaces.md explains, the parts of a fit, and what a started run is made of.
nitpick_ignore_regex = [("py:.*", r"(?!latcon\.).*|latcon\.fit\.(misfit|problem|record)\..*|latcon\.program\.Process")]

myst_enable_extensions = ["dollarmath", "colon_fence"]
myst_heading_anchors = 4

autodoc_member_order = "bysource"
autodoc_typehints_format = "short"
autodoc_preserve_defaults = True
napoleon_use_rtype = False

nbsphinx_execute = "never"
nbsphinx_requirejs_path = ""  # of a network

html_theme = "furo"
html_title = f"latcon {release}"
# Debian's furo has no colours for dark pages.
html_theme_options = {"dark_css_variables": {f"color-{name}": colour for name, colour in {
    "foreground-primary": "#d8d8d8", "foreground-secondary": "#a3a7ac", "foreground-muted": "#8b9097", "foreground-border": "#6a6a6a",
    "background-primary": "#141414", "background-secondary": "#1b1d1f", "background-hover": "#24282b",
    "background-hover--transparent": "#24282b00", "background-border": "#34373a", "background-item": "#444444",
    "brand-primary": "#5aa7f5", "brand-content": "#5aa7f5", "problematic": "#f08080", "highlighted-background": "#0b3a6b",
    "highlight-on-target": "#3a3a10"}.items()}}
html_static_path = ["static"]
html_css_files = ["style.css"]
html_copy_source = False
html_show_copyright = False

# MathJax beside the pages: nothing comes from the network.
mathjax_path = "mathjax/MathJax.js"
mathjax2_config = {
    "extensions": ["tex2jax.js"],
    "jax": ["input/TeX", "output/HTML-CSS"],
    "tex2jax": {"inlineMath": [["\\(", "\\)"]], "displayMath": [["\\[", "\\]"]], "processClass": "math",
                "ignoreClass": "tex2jax_ignore"},
    "TeX": {"extensions": ["AMSmath.js", "AMSsymbols.js"]},
    "HTML-CSS": {"availableFonts": ["TeX"], "imageFont": None, "linebreaks": {"automatic": False}},
}
MATHJAX = pathlib.Path("/usr/share/javascript/mathjax")
MATHJAX_UNUSED = ("unpacked", "test", "docs", "config", "localization", "SVG", "CommonHTML", "NativeMML", "PreviewHTML",
                  "PlainSource", "otf", "svg", "AsciiMath")

EQUATION = re.compile(r"\(([A-Z]\.\d+)\)")
TAG = re.compile(r"\\tag\{([^}]+)\}")


class Equations(SphinxTransform):
    """Makes formulas of blocks ```math, targets of their tags, and links of references to them."""
    default_priority = 400

    def apply(self):
        for block in list(self.document.findall(nodes.literal_block)):
            if block.get("language") == "math":
                block.replace_self(self.formula(block))
        for text in list(self.document.findall(nodes.Text)):
            if EQUATION.search(text) and not self.is_verbatim(text.parent):
                text.parent.replace(text, self.linked(text))

    def formula(self, block):
        formula = block.astext().strip()
        shown = nodes.math_block("", f"\\[{formula}\\]", nowrap=True, number=None, classes=["math"])
        shown.source, shown.line = block.source, block.line
        targets = []
        for number in TAG.findall(formula):
            target = nodes.target("", "", names=[f"eq-{number.lower()}"], ids=[nodes.make_id(f"eq-{number}")])
            self.document.note_explicit_target(target)
            targets.append(target)
        return [*targets, shown]

    @staticmethod
    def is_verbatim(node):
        while node is not None:
            if isinstance(node, (nodes.literal, nodes.literal_block, nodes.math, nodes.math_block, nodes.reference,
                                 nodes.raw, nodes.comment, addnodes.pending_xref, addnodes.download_reference)):
                return True
            node = node.parent
        return False

    def linked(self, text):
        pieces = EQUATION.split(str(text))
        for i in range(1, len(pieces), 2):
            number = pieces[i]
            pieces[i] = addnodes.pending_xref(
                "", nodes.inline("", f"({number})"), refdomain="std", reftype="ref", reftarget=f"eq-{number.lower()}",
                refexplicit=True, refwarn=True, refdoc=self.env.docname)
        return [piece if i % 2 else nodes.Text(piece) for i, piece in enumerate(pieces) if piece]


class Tables(SphinxTransform):
    """Shows the tables of .csv files to which a paragraph of its own links."""
    default_priority = 400

    def apply(self):
        for paragraph in list(self.document.findall(nodes.paragraph)):
            link = paragraph.children[0] if len(paragraph.children) == 1 else None
            if isinstance(link, addnodes.download_reference) and link["reftarget"].endswith(".csv"):
                path = pathlib.Path(self.env.doc2path(self.env.docname)).parent / link["reftarget"]
                self.env.note_dependency(str(path))
                with path.open(encoding="utf-8", newline="") as file:
                    paragraph.parent.insert(paragraph.parent.index(paragraph) + 1, self.table(*csv.reader(file)))

    @staticmethod
    def table(header, *lines):
        def row(cells):
            return nodes.row("", *(nodes.entry("", nodes.paragraph("", cell)) for cell in cells))
        group = nodes.tgroup("", *(nodes.colspec(colwidth=1) for _ in header), nodes.thead("", row(header)),
                             nodes.tbody("", *map(row, lines)), cols=len(header))
        return nodes.table("", group)


# Files of the root folder, and the pages that they become.
INCLUDED = {"README.md": "index", "CONTRIBUTING.md": "contributing", "CHANGELOG.md": "changelog"}
INCLUDE = ":::{include} ../%s\n:relative-docs: docs/\n:relative-images:\n:::\n"

CONTENTS = {
    "Using latcon": "installation model tutorial parameters python reference reference-* troubleshooting glossary limits library interfaces",
    "Cookbook, how-to pages and notebooks": "cookbook/README cookbook/* how-to/README how-to/* notebooks/*",
    "Theory": "theory*",
    "Verification and results": "verification running-crack continuum-crack nonlocal-crack fit-fig1 patterns convergence gallery performance "
                                "reliability security",
    "Inside latcon": "architecture contributing changelog",
}
TREE = ":::{toctree}\n:hidden:\n:glob:\n:caption: %s\n\n%s\n:::\n"

INTERFACES = """
<a href="cpp/index.html">Interface in C++</a>

:::{eval-rst}
.. automodule:: latcon
   :members:

.. autofunction:: latcon.open

.. autoclass:: latcon.frames.Frames
   :members:

.. autofunction:: latcon.frames.read_near_tip

.. automodule:: latcon.fit
   :members:
:::
"""


def add_directives(app, page, source):
    """Replaces pages by the files that they link, and adds the navigation and the docstrings."""
    if pathlib.Path(app.srcdir) != ROOT / "docs":
        return
    for file, name in INCLUDED.items():
        if page == name:
            source[0] = INCLUDE % file
    if page == "index":
        source[0] += "".join(TREE % (caption, "\n".join(pages.split())) for caption, pages in CONTENTS.items())
    if page == "interfaces":
        source[0] += INTERFACES


def link_included(app, _env, node, shown):
    """Resolves links to files that a page includes."""
    page = INCLUDED.get(pathlib.PurePosixPath(node["reftarget"]).name)
    return page and make_refnode(app.builder, node["refdoc"], page, None, shown)


def copy_mathjax(app, error):
    if error is None and app.builder.format == "html":
        shutil.copytree(MATHJAX, pathlib.Path(app.outdir) / "_static" / "mathjax", dirs_exist_ok=True,
                        ignore=shutil.ignore_patterns(*MATHJAX_UNUSED))


def setup(app):
    app.add_transform(Equations)
    app.add_transform(Tables)
    app.add_lexer("prm", BashLexer)  # `set` and # comments
    app.connect("source-read", add_directives)
    app.connect("missing-reference", link_included)
    app.connect("build-finished", copy_mathjax)
    return {"parallel_read_safe": True}
