"""HTML of the pages: the templates of jinja2 in templates/, and the elements that they share."""
import base64
import json
import re
from pathlib import Path

from jinja2 import Environment, FileSystemLoader, StrictUndefined
from markupsafe import Markup

from ..folder import write_file

TEMPLATES = Path(__file__).parent / "templates"
# dygraphs (MIT licence), from Debian's libjs-dygraphs. Without it the plots are pictures.
DYGRAPHS = Path("/usr/share/javascript/dygraphs")
MARKS = {"holds": "✓", "fails": "✗", "reported": "·", "warns": "!", "interrupted": "!", "unfinished": "!"}
FAILED = Markup('<b class="fails">{}</b>{}')  # by format(), which escapes


def has_dygraphs():
    """Returns whether the plotting library is installed."""
    return (DYGRAPHS / "dygraph.min.js").exists() and (DYGRAPHS / "dygraph.min.css").exists()


def write_page(path, template, **contents):
    """Writes a page. Names of files that are no UTF-8 text, whose other bytes Python keeps as lone surrogates, are shown with
    question marks.

    contents: values of the template; those of base.html are `title`, `with_viewer` and `with_plots`.
    """
    html = _ENVIRONMENT.get_template(template).render(contents)
    write_file(str(path), html.encode("utf-8", "replace"))


def plural(count, one, many):
    """Singular or plural form, depending on a count."""
    return one if count == 1 else many


def row(verdict, cells, word=None):
    """A table row in the colour of its verdict: (verdict, cells). The first cell is the verdict, or `word`."""
    return verdict, [f"{MARKS[verdict]} {word or verdict}", *cells]


def number(value, form):
    """A formatted number, or a dash for None."""
    return "–" if value is None else format(value, form)


def superscripts(text):
    """A unit with exponents as superscripts."""
    return text.replace("^2", "²").replace("^3", "³")


def first_sentence(text):
    """First sentence of a caption, as alternative text of the picture."""
    return re.split(r"(?<=[.:])\s", text, maxsplit=1)[0]


def _data_url(picture):
    """Data URL that embeds a picture, a file or the bytes of a PNG, in the page."""
    kind, data = ("png", picture) if isinstance(picture, bytes) else (picture.suffix[1:], picture.read_bytes())
    return f"data:image/{kind};base64,{base64.b64encode(data).decode('ascii')}"


def _asset(name):
    """Text of a style sheet or script: of templates/, or of dygraphs."""
    path = TEMPLATES / name if (TEMPLATES / name).exists() else DYGRAPHS / name
    return Markup(re.split(r"/[/*]# sourceMappingURL", path.read_text(encoding="utf-8"))[0])


_ENVIRONMENT = Environment(loader=FileSystemLoader(TEMPLATES), autoescape=True, undefined=StrictUndefined, trim_blocks=True,
                           lstrip_blocks=True)
_ENVIRONMENT.globals.update({"asset": _asset, "zip": zip})
_ENVIRONMENT.filters.update({
    "data_url": _data_url, "first_sentence": first_sentence,
    "json": lambda value: Markup(json.dumps(value, separators=(",", ":")).replace("<", "\\u003c")),  # of a script element
    "lines": lambda text: text if isinstance(text, Markup) else Markup("<br>").join(text.split("\n"))})
