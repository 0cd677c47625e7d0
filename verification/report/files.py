"""Reading and writing of single files: errors name the file, and files are written atomically."""
import csv
import json
import os
import pathlib
import secrets
import sys

import numpy as np


class DamagedFile(Exception):
    """A file of a run is damaged."""

    def __init__(self, path, problem):
        super().__init__(f"{path}: {problem}")


class UnwritableFile(Exception):
    """A file of the report cannot be written."""

    def __init__(self, path, problem):
        super().__init__(f"cannot write {path}: {problem}")


# Name of the list of files that latcon wrote into an output directory, and of the folder with the files of the previous run.
OUTPUT_LIST, EARLIER = ".latcon-files", "earlier-run"
# Exit codes, those of latcon.
DONE, BAD_INPUT, CLAIM_FAILS, IO_FAILED = 0, 2, 3, 5


def exit_code_of(action, hint=""):
    """Runs the action of a script. @return its exit code, or the exit code for a damaged or unwritable file

    hint: text appended to the message about a damaged file.
    """
    try:
        return action()
    except DamagedFile as error:
        print(f"error: {error}{hint}", file=sys.stderr)
        return BAD_INPUT
    except UnwritableFile as error:
        print(f"error: {error}", file=sys.stderr)
        return IO_FAILED


def read_text(path):
    """Text of a file; None if there is no such file."""
    try:
        return path.read_text(encoding="utf-8")
    except FileNotFoundError:
        return None
    except OSError as error:
        raise DamagedFile(path, error.strerror) from error
    except UnicodeDecodeError as error:
        raise DamagedFile(path, f"not UTF-8 text (byte {error.start})") from error


def read_json(path):
    """Object in a JSON file; None if there is no such file."""
    text = read_text(path)
    if text is None:
        return None
    try:
        value = json.loads(text)
    except ValueError as error:
        raise DamagedFile(path, f"not JSON: {error}") from error
    if not isinstance(value, dict):
        raise DamagedFile(path, "not a JSON object")
    return value


def read_table(path, columns, texts=(), finite=True):
    """Reads columns of a CSV file, {name: array}; None if there is no such file. Other columns are ignored.

    columns: columns of numbers, all finite if `finite`. texts: columns of words.
    """
    text = read_text(path)
    if text is None:
        return None
    rows = list(csv.reader(text.splitlines()))
    header = rows[0] if rows else []
    missing = [name for name in (*texts, *columns) if name not in header]
    if missing:
        raise DamagedFile(path, f"has no column {missing[0]!r}")
    places = [header.index(name) for name in columns]
    words = [[] for _ in texts]
    values = np.empty((len(rows) - 1, len(columns)))
    for line, row in enumerate(rows[1:], start=2):
        if len(row) != len(header):
            raise DamagedFile(path, f"line {line} has {len(row)} fields, the header has {len(header)}")
        try:
            values[line - 2] = [float(row[place]) for place in places]
        except ValueError as error:
            raise DamagedFile(path, f"line {line}: {error}") from error
        if finite and not np.isfinite(values[line - 2]).all():
            raise DamagedFile(path, f"line {line} holds a number that is not finite")
        for column, name in zip(words, texts):
            column.append(row[header.index(name)])
    return {**dict(zip(texts, (np.array(column, dtype=object) for column in words))), **dict(zip(columns, values.T))}


def write_file(path, write):
    """Calls `write` with the name of a temporary file, which then replaces `path`. In the output directory of a run the
    file is added to the list of output files (output_list.h)."""
    try:
        list_output(path)
        replace_file(path, write)
    except OSError as error:
        raise UnwritableFile(path, error.strerror or error) from error


def write_page(path, html):
    """Writes an HTML page. Names of files that are no UTF-8 text, whose other bytes Python keeps as lone surrogates, are shown with
    question marks."""
    write_file(path, lambda beside: beside.write_text(html, encoding="utf-8", errors="replace"))


def replace_file(path, write):
    """Replaces a file like write_file(), without listing it.

    As in support/atomic_file.h, the temporary file has a random name in the same folder, must not exist before, and is
    written through its descriptor, so that links placed there by others are not followed.
    """
    part = path.with_name(f"{path.name}.{secrets.token_hex(8)}.part")
    descriptor = os.open(part, os.O_RDWR | os.O_CREAT | os.O_EXCL | os.O_NOFOLLOW, 0o666)
    try:
        write(pathlib.Path(f"/proc/self/fd/{descriptor}"))
        os.replace(part, path)
    except BaseException:
        part.unlink(missing_ok=True)
        raise
    finally:
        os.close(descriptor)


def list_output(path):
    """Adds a file to the list of its folder, if the folder has one."""
    listing = path.with_name(OUTPUT_LIST)
    if not listing.exists():
        return
    names = listing.read_text(encoding="utf-8").splitlines()
    if path.name not in names:
        text = "".join(f"{name}\n" for name in sorted([*names, path.name]))
        replace_file(listing, lambda beside: beside.write_text(text, encoding="utf-8"))
