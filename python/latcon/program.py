"""Finds the program ``latcon`` and runs it as a child process."""
from __future__ import annotations

import contextlib
import importlib.util
import json
import os
import pathlib
import re
import shutil
import signal
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable, Iterator, Sequence

from .errors import OUTPUT_FAILED, PACKAGES_MISSING, Interrupted, ProgramNotFound, error_of

Progress = bool | Callable[[str], None]

# Largest part of the program's standard output in an error message [bytes].
_TAIL = 4000
_COLOUR = re.compile(r"\x1b\[[0-9;]*m")
# Seconds between progress lines where standard error is neither a terminal nor a notebook.
_LOG_INTERVAL = 60.0


def find_program() -> pathlib.Path:
    """Returns the path of the program.

    The program is searched for in this order: the environment variable ``LATCON``, the prefix below which this package is
    installed, ``PATH``, and the build folder of the source tree that contains this package or the current directory.

    Returns
    -------
    pathlib.Path
        Absolute path of the executable.

    Raises
    ------
    ProgramNotFound
        If it is in none of these places, or if ``LATCON`` is not an executable file.
    """
    if named := os.environ.get("LATCON"):
        found = shutil.which(named)
        if found is None:
            raise ProgramNotFound(f"the environment variable LATCON is {named!r}, which is not an executable file")
        return pathlib.Path(found).resolve()
    here, current = pathlib.Path(__file__).resolve(), pathlib.Path.cwd()
    installed = next((folder for folder in here.parents if folder.name in ("dist-packages", "site-packages")), None)
    beside = [str(folder / "bin" / "latcon") for folder in installed.parents] if installed else []
    for name in (*beside, "latcon"):
        if found := shutil.which(name):
            return pathlib.Path(found).resolve()
    for root in (*here.parents, current, *current.parents):
        if not (root / "python" / "latcon").is_dir():
            continue
        for built in sorted((root / "build" / "release").glob("*/latcon")):
            if built.is_file() and os.access(built, os.X_OK):
                return built
    raise ProgramNotFound("the program latcon was not found; install it, build it with ./run in its source folder, or set the "
                          "environment variable LATCON to its path")


def ask(*arguments: str) -> str:
    """Returns the standard output of a short command of the program; raises ProgramError if it ends with an error."""
    return output_of([find_program(), *arguments])


def output_of(command: Sequence[str | os.PathLike[str]]) -> str:
    """Returns the standard output of a short process; raises ProgramError if it fails, with exit code 5 if a package is missing."""
    ended = subprocess.run(command, capture_output=True, text=True, encoding="utf-8", errors="replace", stdin=subprocess.DEVNULL,
                           check=False)
    if ended.returncode != 0:
        code = OUTPUT_FAILED if ended.returncode == PACKAGES_MISSING else ended.returncode
        raise error_of(code, _message(ended.stderr.strip(), ended.stdout))
    return ended.stdout


def page_command(kind: str, directory: str | os.PathLike[str]) -> list[str | os.PathLike[str]]:
    """Returns the command that draws a page, see `report/__main__.py`, without modules of the user."""
    return [sys.executable, "-sPu", pathlib.Path(__file__).parent / "report" / "__main__.py", kind, directory, "--quiet"]


def run(arguments: Sequence[str], directory: pathlib.Path, progress: Progress) -> None:
    """Runs a command of the program to its end; raises ProgramError or Interrupted if its exit code is not 0.

    Ctrl-C sends SIGINT to the program, which writes a checkpoint and all results, and waits for its end; a second Ctrl-C kills
    it. The program runs in a separate session, so that a signal from the terminal reaches it only once.

    `directory` is the output directory, for messages. With `progress` True an indicator is shown on standard error, a function
    is called with each progress line.
    """
    with progress_indicator(progress) as show:
        job = Process(arguments, directory)
        _running.append(job)
        try:
            job.follow(show)
        finally:
            _running.remove(job)
            if job.is_running:  # an exception of the progress function
                job.interrupt()
                job.child.wait()
    job.end()


_running: list[Process] = []  # by run


def interrupt_runs(directory: pathlib.Path) -> None:
    """Interrupts the runs that threads of this process have begun for a directory; a Ctrl-C reaches the main thread alone."""
    for job in list(_running):
        if job.directory == directory and job.is_running:
            job.interrupt()


class Process:
    """Command of the program that runs in a session of its own; `progress` is its last progress line, empty before the first."""

    def __init__(self, arguments: Sequence[str], directory: pathlib.Path) -> None:
        self.directory, self.progress, self._interrupted = directory, "", False
        reading, writing = os.pipe()
        self._updates, self._output, self._errors = open(reading, "rb"), tempfile.TemporaryFile(), tempfile.TemporaryFile()
        try:
            self.child = subprocess.Popen(
                [find_program(), *arguments], stdin=subprocess.DEVNULL, stdout=self._output, stderr=self._errors,
                env=os.environ | {"LATCON_PROGRESS": str(writing)}, pass_fds=[writing], start_new_session=True)
        finally:
            os.close(writing)

    @property
    def is_running(self) -> bool:
        """True if the program has not ended."""
        return self.child.poll() is None

    def interrupt(self) -> None:
        """Sends SIGINT, on which the program writes a checkpoint and all results, and ends."""
        self._interrupted = True
        self.child.send_signal(signal.SIGINT)

    def follow(self, show: Callable[..., None]) -> None:
        """Shows the progress of the program until it has ended."""
        while True:
            try:
                if not (line := self._updates.readline()):
                    self.child.wait()
                    return
                update = json.loads(line)
                self.progress = update["text"]
                show(**update)
            except KeyboardInterrupt:
                if self._interrupted:
                    self.child.kill()
                elif self.is_running:
                    self.interrupt()

    def end(self) -> None:
        """Prints the messages of the program that has ended, or raises the error."""
        self._errors.seek(0)
        lines = _COLOUR.sub("", self._errors.read().decode("utf-8", "replace")).splitlines()
        messages = "\n".join(line.rstrip() for line in lines if line.strip())
        if self.child.returncode != 0:
            self._output.seek(max(0, self._output.seek(0, os.SEEK_END) - _TAIL))
            printed = self._output.read().decode("utf-8", "replace")
            message = _message(messages, printed)
            if self._interrupted and self.child.returncode < 0:  # before it could end by itself
                raise Interrupted(message, self.child.returncode, self.directory)
            raise error_of(self.child.returncode, message, self.directory)
        if messages:
            print(messages, file=sys.stderr)


def _message(errors: str, output: str) -> str:
    """Returns the message of an error: standard error, or the end of standard output if that is empty."""
    text = errors or output.strip()[-_TAIL:] or "the program ended without a message"
    return re.sub(r"^latcon: ", "", text, flags=re.MULTILINE)


@contextlib.contextmanager
def progress_indicator(progress: Progress) -> Iterator[Callable[..., None]]:
    """Yields a function that shows a progress line, given as `text` and, where it is known, `seconds_left`.

    It calls a function of the user, or does nothing; otherwise it moves a bar of tqdm, if that is installed, in percent of the
    estimated wall time, or writes lines: in place in a terminal or notebook, elsewhere one per minute.
    """
    begin = last = time.monotonic()
    width, in_place = 0, sys.stderr.isatty() or "ipykernel" in sys.modules

    def call(text: str, seconds_left: float | None = None) -> None:
        if callable(progress):
            progress(text)

    def write(text: str, seconds_left: float | None = None) -> None:
        nonlocal last, width
        if in_place:
            print("\r" + text.ljust(width), end="", file=sys.stderr, flush=True)
            width = max(width, len(text))
        elif time.monotonic() - last >= _LOG_INTERVAL:
            print(text, file=sys.stderr, flush=True)
            last = time.monotonic()

    if callable(progress) or not progress:
        yield call
    elif importlib.util.find_spec("tqdm"):
        from tqdm.auto import tqdm
        with tqdm(total=100, bar_format="{l_bar}{bar}| {postfix}", leave=False) as bar:
            def move(text: str, seconds_left: float | None = None) -> None:
                if seconds_left is not None:
                    elapsed = time.monotonic() - begin
                    bar.n = round(100 * elapsed / max(elapsed + seconds_left, 1e-9))
                bar.set_postfix_str(text)
            yield move
    else:
        try:
            yield write
        finally:
            if width:
                print("\r" + " " * width + "\r", end="", file=sys.stderr, flush=True)
