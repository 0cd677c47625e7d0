"""Pieces of HTML that the sections of the page share."""
import base64
from html import escape

MARKS = {"holds": "✓", "fails": "✗", "reported": "·", "interrupted": "!", "unfinished": "!"}


def verb(count, one, many):
    """The form that goes with a count."""
    return one if count == 1 else many


def table(head, rows, kind=""):
    """A table that scrolls in its own box; columns whose head begins with # hold numbers."""
    cells = "".join(f'<th class="number">{name[1:]}</th>' if name[0] == "#" else f"<th>{name}</th>" for name in head)
    body = "".join(rows)
    return f'<div class="scroll {kind}"><table><thead><tr>{cells}</tr></thead><tbody>{body}</tbody></table></div>'


def row(verdict, cells, word=None):
    """A table row in the colour of its verdict, which comes first, or `word` for it; cells are (class, HTML)."""
    cells = [("verdict", f"{MARKS[verdict]} {word or verdict}"), *cells]
    return f'<tr class="{verdict}">' + "".join(f'<td class="{kind}">{text}</td>' for kind, text in cells) + "</tr>"


def plain_row(cells):
    """A table row without a verdict; cells are (class, HTML)."""
    return "<tr>" + "".join(f'<td class="{kind}">{text}</td>' for kind, text in cells) + "</tr>"


def figure(png, alt, caption):
    """A PNG file, in the page itself; the caption is HTML."""
    data = base64.b64encode(png.read_bytes()).decode("ascii")
    return (f'<figure><div class="picture"><img alt="{escape(alt)}" src="data:image/png;base64,{data}"></div>'
            f"<figcaption>{caption}</figcaption></figure>")


def number(value, form):
    """A number, or a dash for none."""
    return "–" if value is None else format(value, form)


def raised(text):
    """Text with its exponents raised."""
    return escape(text).replace("^2", "²").replace("^3", "³")
