#!/usr/bin/python3
"""Doxygen input filter: converts pages from GitHub's Markdown to Doxygen's, and headers.

Usage: filter.py ROOT SITE FILE   (to standard output; files that a page links to are copied into SITE/files)

Pages: `$...$` and blocks ```math become formulas, headings and numbered equations get anchors, and links between pages, to
headings and to files of the project lead there. In pages and in docstrings "(L.2)" leads to that equation. Headers: see
header(). In contents.dox
"\\subpages GLOB..." becomes a list of all pages that match and are not in an earlier list; in python.dox "\\pythonapi" becomes the
interface of the Python package.
"""
import pathlib
import posixpath
import re
import shutil
import sys

EQUATION = re.compile(r"\(([A-Z]\.\d+)\)")
TAG = re.compile(r"\\tag\{([^}]+)\}")
FENCE = re.compile(r"(^ *```.*?^ *```$)", re.DOTALL | re.MULTILINE)
MATHS = re.compile(r"^\$(?! )([^$]+)(?<! )\$$")
LINK = re.compile(r"^(!?)\[([^\]]*)\]\(([^)\s]+)\)$")
# Parts of a line that are not prose: code, formulas, links, pictures.
VERBATIM = re.compile(r"(`[^`]+`|\$[^$]+\$|!?\[[^\]]*\]\([^)\s]+\))")


def page_name(path):
    """Identifier of the page of a Markdown file, given relative to the root: its path below docs/ with dashes."""
    if path == "README.md":
        return "mainpage"
    return re.sub(r"[^a-z0-9]+", "-", path.removeprefix("docs/").removesuffix(".md").lower())


def heading_name(text):
    """The anchor that GitHub gives to a heading."""
    plain = re.sub(r"\[([^\]]*)\]\([^)]*\)", r"\1", text).strip().lower()
    return re.sub(r"[^\w\- ]", "", plain).replace(" ", "-")


def equation_name(number):
    return "eq-" + number.replace(".", "-")


class Page:
    def __init__(self, root, site, path):
        self.root, self.site, self.path = root, site, path
        self.name = page_name(path)
        self.seen = {}

    def target(self, link):
        """Target of a link of the page in the documentation, or None if only its text is kept."""
        if re.match(r"\w+:", link):
            return link
        file, _, heading = link.partition("#")
        path = posixpath.normpath(posixpath.join(posixpath.dirname(self.path), file)) if file else self.path
        if path.endswith(".md") and (self.root / path).is_file():
            name = page_name(path)
            return f"@ref {name}-{heading}" if heading else f"@ref {name}"
        if not (self.root / path).is_file():
            return None if (self.root / path).is_dir() else link
        # Text, which browsers should display and not download.
        copy = "files/" + path + ("" if path.endswith((".html", ".png", ".svg", ".webm", ".mp4", ".gif")) else ".txt")
        (self.site / copy).parent.mkdir(parents=True, exist_ok=True)
        shutil.copyfile(self.root / path, self.site / copy)
        return copy

    def link(self, match):
        image, text, link = match.groups()
        if image:  # with a path that Doxygen finds from any folder
            path = posixpath.normpath(posixpath.join(posixpath.dirname(self.path), link))
            return f"![{text}]({path})"
        target = self.target(link)
        return text if target is None else f"[{text}]({target})"

    def heading(self, marks, text):
        name = heading_name(text)
        count = self.seen[name] = self.seen.get(name, -1) + 1
        text = text.replace("`", "")  # which would appear in Doxygen's tables of contents
        if len(marks) == 1 and len(self.seen) == 1:
            return f"{marks} {text} {{#{self.name}}}\n[TOC]"
        return f"{marks} {text} {{#{self.name}-{name}" + (f"-{count}" if count else "") + "}"

    def prose(self, text):
        """Consecutive lines of running text."""
        pieces = VERBATIM.split(text)
        for i, piece in enumerate(pieces):
            if i % 2 == 0:
                pieces[i] = link_equations(piece)
            elif not piece.startswith("`"):
                pieces[i] = LINK.sub(self.link, MATHS.sub(r"\\f$\1\\f$", piece))
        return "".join(pieces)

    def lines(self, text):
        """Lines outside of fences: headings, code that is indented after an empty line, running text."""
        done, prose, code = [], [], False
        for line in text.split("\n"):
            heading = re.match(r"(#+) (.*)$", line)
            code = line.startswith("    ") and not prose and (code or not done or not done[-1].strip())
            if line.strip() and not heading and not code:
                prose.append(line)
                continue
            if prose:
                done.append(self.prose("\n".join(prose)))
                prose = []
            done.append(self.heading(*heading.groups()) if heading else line)
        return "\n".join(done + ([self.prose("\n".join(prose))] if prose else []))

    def block(self, text):
        fence = text.lstrip()
        if not fence.startswith("```"):
            return self.lines(text)
        if not fence.startswith("```math\n"):
            return text
        formula = fence.removeprefix("```math").removesuffix("```").strip()
        anchors = "".join(f"\\anchor {equation_name(n)}\n" for n in TAG.findall(formula))
        return f"{anchors}\\f[\n{formula}\n\\f]\n"

    def text(self):
        return "".join(map(self.block, FENCE.split((self.root / self.path).read_text())))


def link_equations(text):
    return EQUATION.sub(lambda m: f"[({m.group(1)})](@ref {equation_name(m.group(1))})", text)


def without_stops(text):
    """Text without full stops inside sentences, since the first full stop ends the brief description."""
    text = re.sub(r"\beq(s?)\.(?= |$)", r"equation\1", text)
    return text.replace(" . ", " \u00b7 ").replace("...", "\u2026")


def header(text):
    """A header. Formulas on lines of their own, three spaces from the slashes, stay on these; lines keep their numbers."""
    lines = text.split("\n")
    formula = [re.match(r"( *///)   (\S.*)$", line) for line in lines]
    for i, line in enumerate(lines):
        if formula[i]:
            slashes, words = formula[i].groups()
            lines[i] = f"{slashes} \\n&emsp;`{without_stops(words).rstrip('.')}`" + ("" if formula[i + 1] else " \\n")
        else:
            lines[i] = re.sub(r"///.*$", lambda m: link_equations(without_stops(m.group(0))), line)
    return "\n".join(lines)


def contents(root, text):
    listed = set()

    def lines(match):
        names = []
        for pattern in match.group(1).split():
            paths = sorted(path.relative_to(root).as_posix() for path in root.glob(pattern))
            names += [page_name(path) for path in paths if path not in listed]
            listed.update(paths)
        return "\n".join(f"- \\subpage {name}" for name in names)

    text = re.sub(r"^\\subpages (.*)$", lines, text, flags=re.MULTILINE)
    if "\\pythonapi\n" in text:
        import python_api  # only here, since it imports the package
        text = text.replace("\\pythonapi\n", python_api.page(root) + "\n")
    return text


def main():
    root, site, file = (pathlib.Path(argument).resolve() for argument in sys.argv[1:4])
    if file.suffix == ".md":
        print(Page(root, site, file.relative_to(root).as_posix()).text())
    elif file.suffix == ".dox":
        print(contents(root, file.read_text()))
    else:
        sys.stdout.write(header(file.read_text()))


if __name__ == "__main__":
    main()
