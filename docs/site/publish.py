#!/usr/bin/python3
"""Adds the built web site to a folder that a web server shows, below its version: FOLDER/VERSION/index.html.

Usage: publish.py SITE FOLDER VERSION   (sites of other versions stay; that of the same version is replaced)

FOLDER/index.html leads to the latest version, FOLDER/versions.html lists all. The folder may be served from any address: all links
are relative.
"""
import pathlib
import re
import shutil
import sys

VERSION = re.compile(r"\d+(\.\d+)*")
INDEX = """<!DOCTYPE html>
<html lang="en"><head><meta charset="utf-8"><title>latcon</title><meta http-equiv="refresh" content="0; url={latest}/index.html"></head>
<body><a href="{latest}/index.html">latcon {latest}</a>; <a href="versions.html">all versions</a></body></html>
"""
VERSIONS = """<!DOCTYPE html>
<html lang="en"><head><meta charset="utf-8"><title>Versions of latcon</title></head>
<body><h1>Versions of latcon</h1><ul>
{items}
</ul></body></html>
"""


def numbers(version):
    return [int(part) for part in version.split(".")]


def publish(site, folder, version):
    if not VERSION.fullmatch(version):
        sys.exit(f"publish.py: version {version!r}: must be numbers separated by points")
    if not (site / "index.html").is_file():
        sys.exit(f"publish.py: {site} has no index.html; build the site first: cmake --build BUILD --target docs")
    folder.mkdir(parents=True, exist_ok=True)
    part = folder / f"{version}.part"
    shutil.rmtree(part, ignore_errors=True)
    shutil.copytree(site, part)
    shutil.rmtree(folder / version, ignore_errors=True)
    part.rename(folder / version)
    found = sorted((path.name for path in folder.iterdir() if path.is_dir() and VERSION.fullmatch(path.name)), key=numbers, reverse=True)
    items = "\n".join(f'<li><a href="{name}/index.html">{name}</a></li>' for name in found)
    (folder / "versions.html").write_text(VERSIONS.format(items=items))
    (folder / "index.html").write_text(INDEX.format(latest=found[0]))
    return folder / "index.html"


if __name__ == "__main__":
    print(publish(pathlib.Path(sys.argv[1]), pathlib.Path(sys.argv[2]), sys.argv[3]))
