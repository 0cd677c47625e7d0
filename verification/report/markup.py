"""Pieces of HTML that the sections of the page share."""
import base64
import re
from html import escape

MARKS = {"holds": "✓", "fails": "✗", "reported": "·", "warns": "!", "interrupted": "!", "unfinished": "!"}


def verb(count, one, many):
    """The form that goes with a count."""
    return one if count == 1 else many


def table(head, rows, kind=""):
    """A table; columns whose head begins with # hold numbers. On a phone each row is a block, its cells under their heads.

    rows: of `row` and `plain_row`.
    """
    cells = "".join(f'<th scope="col" class="{"number" if name[0] == "#" else "words"}">{name.lstrip("#")}</th>'
                    for name in head)
    labels = [escape(name.lstrip("#"), quote=True) for name in head]
    body = "".join(row_text(kind, row_cells, labels) for kind, row_cells in rows)
    return (f'<div class="scroll {kind}" tabindex="0"><table><thead><tr>{cells}</tr></thead>'
            f"<tbody>{body}</tbody></table></div>")


def row(verdict, cells, word=None):
    """A table row in the colour of its verdict, which comes first, or `word` for it; cells are (class, HTML)."""
    cells = [("verdict", f"{MARKS[verdict]} {word or verdict}"), *cells]
    return verdict, cells


def plain_row(cells):
    """A table row without a verdict; cells are (class, HTML)."""
    return "", list(cells)


def row_text(verdict, cells, labels):
    """The HTML of a row."""
    names = ["" if kind == "verdict" else f' data-label="{label}"' for (kind, _), label in zip(cells, labels)]
    text = "".join(f'<td class="{kind}"{name}>{text}</td>' for (kind, text), name in zip(cells, names))
    return f'<tr class="{verdict}">{text}</tr>' if verdict else f"<tr>{text}</tr>"


def data_url(path):
    """A picture, in the page itself."""
    return f"data:image/{path.suffix[1:]};base64,{base64.b64encode(path.read_bytes()).decode('ascii')}"


def folded(summary, text):
    """Preformatted text behind a line."""
    return (f'<details><summary>{escape(summary)}</summary><div class="scroll" tabindex="0">'
            f"<pre>{escape(text)}</pre></div></details>")


def first_sentence(text):
    """What a picture shows, for those who do not see it."""
    return re.split(r"(?<=[.:])\s", text, maxsplit=1)[0]


def figure(picture, alt, caption, still=None):
    """A picture with its caption, which is HTML.

    alt: what it shows, in words. still: what stands for an animation in print, and where readers asked for less motion.
    """
    image = f'<img alt="{escape(alt)}" src="{data_url(picture)}">'
    if still is not None:
        image = (f'<picture><source media="print, (prefers-reduced-motion: reduce)" srcset="{data_url(still)}">'
                 f"{image}</picture>")
    return f'<figure><div class="picture" tabindex="0">{image}</div><figcaption>{caption}</figcaption></figure>'


def number(value, form):
    """A number, or a dash for none."""
    return "–" if value is None else format(value, form)


def raised(text):
    """Text with its exponents raised."""
    return escape(text).replace("^2", "²").replace("^3", "³")
