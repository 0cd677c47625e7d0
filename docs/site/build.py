#!/usr/bin/python3
"""Builds the documentation as a web site and fails if Doxygen has anything to say.

Usage: build.py DOXYFILE SITE   (SITE/index.html is where it begins; what was in SITE before is gone)

What stands in a namespace needs a docstring; members of a class may speak for themselves by their names.
"""
import pathlib
import re
import shutil
import subprocess
import sys

MATHJAX = pathlib.Path("/usr/share/javascript/mathjax")
# Sources, other ways of loading it, words of other languages, other outputs than the one the pages ask for.
MATHJAX_UNUSED = ("unpacked", "test", "docs", "config", "localization", "SVG", "CommonHTML", "NativeMML", "PreviewHTML",
                  "PlainSource", "otf", "svg", "AsciiMath")
SILENT = re.compile(r"warning: Member .* of (class|struct|union) .* is not documented\.$")


def warnings(log):
    """What Doxygen said, without members of classes that have no docstring."""
    return [line for line in log.splitlines() if line.strip() and not SILENT.search(line)]


def drop_links_to_nothing(page):
    """A class whose nested classes are all private gets a link to the list of them, and no list."""
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
