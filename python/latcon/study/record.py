"""Record of a command in its output directory: `run.json`, `log.txt`, `results.json`, `results.csv`; what is printed."""
from __future__ import annotations

import contextlib
import json
import math
import os
import pathlib
import resource
import select
import shutil
import signal
import subprocess
import time
from collections.abc import Mapping, Sequence
from typing import Any

from ..errors import BAD_INPUT, CLAIM_FAILED, DONE, INTERRUPTED, OUTPUT_FAILED, PACKAGES_MISSING
from ..files import object_in, read_json, read_text
from ..folder import FolderLock, add_to_list, archive, is_listed, write_atomically, write_file
from ..program import page_command
from ..rows import text_table
from .program import Ended, InputError, Program, end_of, require_access
from .pool import start_child
from .output import csv_text


class Printed:
    """Standard output of this process, of which a log keeps a copy."""

    def __init__(self, is_quiet: bool) -> None:
        self.is_quiet = is_quiet
        self.text = ""
        self.is_complete = True
        self.record: Record | None = None  # with the log

    def say(self, text: str) -> None:
        """Prints lines unless --quiet is given."""
        if not self.is_quiet:
            self.print(text + "\n")

    def print(self, text: str) -> None:
        """Prints a text."""
        self.text += text
        data = text.encode("utf-8", "surrogateescape")
        try:
            while data:
                data = data[os.write(1, data):]
        except BrokenPipeError:
            pass  # the reader does not want more
        except OSError:
            self.is_complete = False


def json_text(document: Any) -> str:
    """Returns a document as the program writes it, with a final line break."""
    text = json.dumps(document, indent=2, ensure_ascii=False) + "\n"
    return text.encode("utf-8", "surrogateescape").decode("utf-8", "replace")  # paths need not be UTF-8


class Record:
    """Locked output directory of a command; `run.json` has the exit code however the command ends.

    With `resume` earlier files of a study stay; otherwise they are moved to a subfolder. `facts` are further entries of `run.json`.
    """

    def __init__(self, program: Program, printed: Printed, directory: str, options: Mapping[str, Any], resume: bool,
                 **facts: Any) -> None:
        self.directory, self._printed, self._options = directory, printed, options
        os.makedirs(directory, exist_ok=True)
        self._lock = FolderLock(directory)
        begun = object_in(f"{directory}/run.json")
        resume = resume and (not begun or "study" in begun)  # not the run of another command
        if not resume and (aside := archive(directory)):
            printed.say(f"The files of an earlier run in {directory} are now in {aside}")
        add_to_list(directory, [])
        log = f"{directory}/log.txt"
        # A log.txt that latcon did not write belongs to the user, who may have redirected the output of this program to it.
        streams = [os.fstat(stream) for stream in (1, 2)]
        self._keeps_log = not os.path.isfile(log) or is_listed(directory, "log.txt") and not any(
            os.path.samestat(os.stat(log), stream) for stream in streams)
        self._log = ""
        if resume and os.path.isfile(log):
            with open(log, encoding="utf-8", errors="surrogateescape") as file:
                self._log = file.read()
        self._log += "$ " + " ".join(options["arguments"]) + "\n"
        self._document: dict[str, Any] = program.facts | {"wall_time_s": {}} | facts
        printed.record = self
        self.write(None)

    def add(self, **facts: Any) -> None:
        """Adds facts to `run.json`."""
        self._document.update(facts)

    def add_time(self, phase: str, seconds: float) -> None:
        """Adds wall time to that of a phase."""
        times = self._document["wall_time_s"]
        times[phase] = times.get(phase, 0.0) + seconds

    def write(self, exit_code: int | None, message: str = "") -> None:
        """Writes `run.json` and the log, which ends with the message."""
        usage = resource.getrusage(resource.RUSAGE_SELF)
        self._document |= {"wall_time_total_s": time.monotonic() - BEGIN, "peak_memory_bytes": usage.ru_maxrss * 1024,
                           "exit_code": exit_code}
        write_file(f"{self.directory}/run.json", json_text(self._document))
        if self._keeps_log:
            write_file(f"{self.directory}/log.txt", self._log + self._printed.text + message)

    def release(self) -> None:
        """Releases the directory."""
        self._lock.release()

    def end(self, rows: Sequence[Mapping[str, Any]], exit_code: int) -> int:
        """Writes the rows, and the record with the exit code, which is returned: CLAIM_FAILED instead of DONE if a row fails."""
        verdicts = {row["verdict"] for row in rows}
        verdict = next((word for word in ("fails", "holds") if word in verdicts), "reported")
        write_file(f"{self.directory}/results.json", json_text({"claims": rows, "verdict": verdict}))
        write_file(f"{self.directory}/results.csv", csv_text(
            ["claim", "quantity", "unit", "lattice", "continuum", "theory", "error", "tolerance", "verdict", "reason", "gate", "kind"],
            [["false" if value is False else value for value in row.values()] for row in rows]))
        if exit_code == DONE and verdict == "fails":
            exit_code = CLAIM_FAILED
        self.add(verdict=verdict, failed_rows={f"{row['claim']}: {row['quantity']}": "claim" for row in rows if row["verdict"] == "fails"})
        message = f"latcon: interrupted; --resume continues from what is in {self.directory}\n" if exit_code == INTERRUPTED else ""
        self.write(exit_code, message)
        say_error(message)
        return exit_code

    def verify(self, program: Program, case: str, on_continuum: bool) -> None:
        """Checks the claims that cracks of a case wait for, in a folder of their own, and takes over what is found. Raises
        Ended if one does not hold.
        """
        folder = f"{self.directory}/.latcon-gate"
        shutil.rmtree(folder, ignore_errors=True)  # of a killed study
        os.mkdir(folder)
        write_atomically(f"{folder}/base.prm", case)
        options = self._options
        words = [program.executable, "gate", f"{folder}/base.prm", "--side", "continuum" if on_continuum else "lattice",
                 "--output-dir", folder, *["--quiet"] * options["quiet"]]
        words += ["--threads", str(options["threads"])] if options["threads"] else []
        with start_child(words, signal.SIGKILL, stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, process_group=0) as child:
            try:
                assert child.stdout
                printed = child.stdout.read()
            except BaseException:
                child.kill()
                child.wait()
                shutil.rmtree(folder, ignore_errors=True)
                raise
        self._printed.print(printed.decode("utf-8", "surrogateescape"))
        if child.returncode not in (DONE, CLAIM_FAILED):
            raise end_of(child.returncode)
        found = read_json(pathlib.Path(folder, "run.json"))
        self.add(**{key: found[key] for key in ("verification", "verification_of_program", "failed_rows", "verdict") if key in found})
        self._document["wall_time_s"] |= found["wall_time_s"]
        message = read_text(pathlib.Path(folder, "log.txt")).partition("\nlatcon: ")[2]
        for name in os.listdir(folder):
            if name not in ("run.json", "log.txt", "base.prm") and not name.startswith("."):
                add_to_list(self.directory, [name])
                os.replace(f"{folder}/{name}", f"{self.directory}/{name}")
        shutil.rmtree(folder)
        if child.returncode != DONE:
            raise Ended(CLAIM_FAILED, "latcon: " + message)


def table_of_rows(rows: Sequence[Mapping[str, Any]]) -> str:
    """Returns the rows as a table, at most 120 columns wide, and below it those that fail."""
    def number(row: Mapping[str, Any], key: str, digits: int) -> str:
        return "" if row[key] is None else f"{float(row[key]):.{digits}g}"

    header = ["claim", "quantity [unit]", "lattice", "continuum", "theory", "error", "tolerance", "verdict"]
    cells = [[row["claim"], f"{row['quantity']} [{row['unit']}]", *(number(row, key, 7) for key in header[2:5]),
              *(number(row, key, 3) for key in header[5:7]), row["verdict"]] for row in rows]
    lines = [text_table(header, cells, range(2, 7))]
    failing, judged = [row for row in rows if row["verdict"] == "fails"], sum(row["verdict"] != "reported" for row in rows)
    if failing:
        lines += ["", f"{len(failing)} of {judged} check{'s' * (judged > 1)} fail{'s' * (len(failing) == 1)}:"]
        lines += [f"  {row['claim']}: {row['quantity']}: error {number(row, 'error', 3)}, tolerance {number(row, 'tolerance', 3)}"
                  for row in failing]
    return "\n".join(lines)


BEGIN = time.monotonic()


def say_error(text: str) -> None:
    """Prints to standard error, at once."""
    with contextlib.suppress(OSError):
        os.write(2, text.encode("utf-8", "surrogateescape"))


def draw_page(kind: str, directory: str, page: str, repeat: str) -> bool:
    """Draws a page by :mod:`latcon.report`. Nodes of a cluster may have no packages for it; then says so, since all results are
    written, and how to draw it."""
    status = subprocess.run(page_command(kind, directory), check=False).returncode
    if status == PACKAGES_MISSING:
        say_error(f"latcon: cannot draw {directory}/{page} without these packages; every other file is complete. To draw the page, "
                  f"{repeat} on a machine with Python and the packages of the report\n")
    elif status:
        raise OSError(0, "the report script failed", f"{directory}/{page}")
    return status == 0


def report(_: Program, __: Printed, options: Mapping[str, Any]) -> int:
    """Draws pictures and page of a run, or of a folder of several; a dry run lists the runs."""
    folder, out = options["word"], options["output_dir"]
    require_access(folder)
    if not os.path.isdir(folder):
        raise InputError(f"{folder} is not a directory")
    command = page_command("report", folder) + ["--animation"] * options["animation"]
    if not options["quiet"]:
        command.remove("--quiet")
    if out:
        command += ["--output-dir", out]
    with contextlib.ExitStack() as held:
        if options["dry_run"]:
            command.append("--dry-run")
        else:
            os.makedirs(out or folder, exist_ok=True)
            held.enter_context(FolderLock(out or folder))
        status = subprocess.run(command, check=False).returncode
    if status == PACKAGES_MISSING:
        say_error(f"latcon: no report; every other file is complete. With these packages, draw it by: latcon report {folder}\n")
        return OUTPUT_FAILED
    if status not in (DONE, BAD_INPUT, CLAIM_FAILED, OUTPUT_FAILED):
        raise OSError(0, "the report script failed", f"{folder}/report.html")
    return status


def output_is_lost(printed: Printed) -> bool:
    """True if standard output is closed or full; a reader that closed its end of a pipe loses nothing."""
    poll = select.poll()
    poll.register(1, 0)
    return not printed.is_complete and not any(event & select.POLLERR for _, event in poll.poll(0))


class Progress:
    """Progress line on standard error: in place in a terminal, otherwise a line per minute; or JSON to LATCON_PROGRESS."""

    def __init__(self, is_wanted: bool) -> None:
        self._in_place = os.isatty(2) and os.environ.get("TERM") != "dumb"
        given = os.environ.get("LATCON_PROGRESS", "")
        self._descriptor = int(given) if given.isdecimal() and len(given) < 10 else -1
        self._interval = (0.2 if self._in_place or self._descriptor >= 0 else 60.0) if is_wanted else math.inf
        self._begin = self._shown = time.monotonic()

    def is_due(self) -> bool:
        """True if it is time to show a line."""
        return time.monotonic() - self._shown >= self._interval

    def show(self, text: str, done: float) -> None:
        """Shows a line, and the time that is left if a fraction is done."""
        self._shown = time.monotonic()
        left = (self._shown - self._begin) * (1 / done - 1) if done > 0.01 else None
        if left is not None:
            text += f", {round(left)} s left"
        if self._descriptor >= 0:
            with contextlib.suppress(OSError):  # nobody reads any more
                os.write(self._descriptor, json.dumps({"text": text, "seconds_left": left}).encode() + b"\n")
            return
        say_error(f"\r\x1b[K{text}" if self._in_place else text + "\n")

    def clear(self) -> None:
        """Removes the line."""
        if self._in_place and self._interval < math.inf:
            say_error("\r\x1b[K")
