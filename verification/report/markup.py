"""HTML elements shared by the sections of the page."""
import base64
import re
from html import escape
from pathlib import Path

MARKS = {"holds": "✓", "fails": "✗", "reported": "·", "warns": "!", "interrupted": "!", "unfinished": "!"}


def whole_page(title, body, styles="", scripts=""):
    """A self-contained page.

    title: text; body: HTML from the heading on; styles: CSS before that of all pages; scripts: script elements at the end.
    """
    style = (Path(__file__).parent / "style.css").read_text(encoding="utf-8")
    return f"""<!DOCTYPE html>
<html lang="en">
<head>
<meta charset="utf-8">
<meta name="viewport" content="width=device-width, initial-scale=1">
<title>latcon: {escape(title)}</title>
<style>
{styles}{style}</style>
</head>
<body id="top">
{body}
{scripts}</body>
</html>
"""


def plural(count, one, many):
    """Singular or plural form, depending on a count."""
    return one if count == 1 else many


def table(head, rows, kind=""):
    """A table; columns whose head begins with # contain numbers. On a phone each row is a block of cells under their heads.

    rows: results of `row` and `plain_row`.
    """
    cells = "".join(f'<th scope="col" class="{"number" if name[0] == "#" else "words"}">{name.lstrip("#")}</th>'
                    for name in head)
    labels = [escape(name.lstrip("#"), quote=True) for name in head]
    body = "".join(row_text(kind, row_cells, labels) for kind, row_cells in rows)
    return (f'<div class="scroll {kind}" tabindex="0"><table><thead><tr>{cells}</tr></thead>'
            f"<tbody>{body}</tbody></table></div>")


def row(verdict, cells, word=None):
    """A table row in the colour of its verdict. The first cell is the verdict, or `word`; cells are (class, HTML)."""
    cells = [("verdict", f"{MARKS[verdict]} {word or verdict}"), *cells]
    return verdict, cells


def plain_row(cells):
    """A table row without a verdict; cells are (class, HTML)."""
    return "", list(cells)


def row_text(verdict, cells, labels):
    """HTML of a row."""
    names = ["" if kind == "verdict" else f' data-label="{label}"' for (kind, _), label in zip(cells, labels)]
    text = "".join(f'<td class="{kind}"{name}>{text}</td>' for (kind, text), name in zip(cells, names))
    return f'<tr class="{verdict}">{text}</tr>' if verdict else f"<tr>{text}</tr>"


def data_url(path):
    """Data URL that embeds a picture in the page."""
    return f"data:image/{path.suffix[1:]};base64,{base64.b64encode(path.read_bytes()).decode('ascii')}"


def details(summary, text):
    """Preformatted text that expands below a summary."""
    return (f'<details><summary>{escape(summary)}</summary><div class="scroll" tabindex="0">'
            f"<pre>{escape(text)}</pre></div></details>")


def first_sentence(text):
    """First sentence of a caption, as alternative text of the picture."""
    return re.split(r"(?<=[.:])\s", text, maxsplit=1)[0]


def figure(picture, alt, caption, still=None):
    """A picture with its caption, which is HTML.

    alt: description of the picture. still: picture that replaces an animation in print and for readers who prefer reduced
    motion.
    """
    image = f'<img alt="{escape(alt)}" src="{data_url(picture)}">'
    if still is not None:
        image = (f'<picture><source media="print, (prefers-reduced-motion: reduce)" srcset="{data_url(still)}">'
                 f"{image}</picture>")
    return f'<figure><div class="picture" tabindex="0">{image}</div><figcaption>{caption}</figcaption></figure>'


def number(value, form):
    """A formatted number, or a dash for None."""
    return "–" if value is None else format(value, form)


def superscripts(text):
    """HTML text with exponents as superscripts."""
    return escape(text).replace("^2", "²").replace("^3", "³")
