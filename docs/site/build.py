#!/usr/bin/python3
"""Builds the documentation as a web site and fails if Doxygen prints a warning.

Usage: build.py DOXYFILE SITE   (the first page is SITE/index.html; previous contents of SITE are removed)

Everything in a namespace needs a docstring; members of a class may be explained by their names alone.
"""
import pathlib
import re
import shutil
import subprocess
import sys

MATHJAX = pathlib.Path("/usr/share/javascript/mathjax")
# Unused parts of MathJax: sources, other loaders, translations, output formats that the pages do not use.
MATHJAX_UNUSED = ("unpacked", "test", "docs", "config", "localization", "SVG", "CommonHTML", "NativeMML", "PreviewHTML",
                  "PlainSource", "otf", "svg", "AsciiMath")
SILENT = re.compile(r"warning: Member .* of (class|struct|union) .* is not documented\.$")


def warnings(log):
    """Warnings of Doxygen, except those about class members without a docstring."""
    return [line for line in log.splitlines() if line.strip() and not SILENT.search(line)]


def drop_links_to_nothing(page):
    """Removes links to the list of nested classes of a class whose nested classes are all private."""
    text = page.read_text()
    if '"#nested-classes"' in text and 'name="nested-classes"' not in text:
        page.write_text(re.sub(r'<a href="#nested-classes">[^<]*</a>( &#124;)?', "", text))


def main():
    doxyfile, site = (pathlib.Path(argument) for argument in sys.argv[1:3])
    shutil.rmtree(site, ignore_errors=True)
    site.mkdir(parents=True)
    run = subprocess.run(["doxygen", doxyfile], stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True, check=False)
    found = warnings(run.stderr)
    if run.returncode or found:
        sys.exit("\n".join(found) or f"doxygen ended with {run.returncode}")
    for page in site.glob("class*.html"):
        drop_links_to_nothing(page)
    shutil.copytree(MATHJAX, site / "mathjax", ignore=shutil.ignore_patterns(*MATHJAX_UNUSED))
    print(site / "index.html")


if __name__ == "__main__":
    main()
