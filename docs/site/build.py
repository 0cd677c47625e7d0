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
MATHJAX_PARTS = ("MathJax.js", "extensions", "jax/element", "jax/input/TeX", "jax/output/HTML-CSS/autoload",
                 "jax/output/HTML-CSS/fonts/TeX", "jax/output/HTML-CSS/imageFonts.js", "jax/output/HTML-CSS/jax.js",
                 "fonts/HTML-CSS/TeX/woff")
SILENT = re.compile(r"warning: Member .* of (class|struct|union) .* is not documented\.$")


def warnings(log):
    """What Doxygen said, without members of classes that have no docstring."""
    return [line for line in log.splitlines() if line.strip() and not SILENT.search(line)]


def main():
    doxyfile, site = (pathlib.Path(argument) for argument in sys.argv[1:3])
    shutil.rmtree(site, ignore_errors=True)
    site.mkdir(parents=True)
    run = subprocess.run(["doxygen", doxyfile], stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True, check=False)
    found = warnings(run.stderr)
    if run.returncode or found:
        sys.exit("\n".join(found) or f"doxygen ended with {run.returncode}")
    for part in MATHJAX_PARTS:
        (site / "mathjax" / part).parent.mkdir(parents=True, exist_ok=True)
        if (MATHJAX / part).is_dir():
            shutil.copytree(MATHJAX / part, site / "mathjax" / part)
        else:
            shutil.copyfile(MATHJAX / part, site / "mathjax" / part)
    print(site / "index.html")


if __name__ == "__main__":
    main()
