"""Finds the program ``latcon`` and runs it as a child process."""
from __future__ import annotations

import importlib.util
import os
import pathlib
import re
import shutil
import signal
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable, Sequence
from typing import IO

from .errors import ProgramNotFound, error_of

Progress = bool | Callable[[str], None]

# Largest part of the program's standard output in an error message [bytes].
_TAIL = 4000
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
    """Returns the standard output of a short command of the program.

    Raises
    ------
    ProgramError
        If the program ends with an error.
    """
    ended = subprocess.run([find_program(), *arguments], capture_output=True, text=True, encoding="utf-8", errors="replace",
                           stdin=subprocess.DEVNULL, check=False)
    if ended.returncode != 0:
        raise error_of(ended.returncode, _message([ended.stderr], ended.stdout))
    return ended.stdout


def run(arguments: Sequence[str], directory: pathlib.Path, progress: Progress) -> None:
    """Runs a command of the program to its end.

    Ctrl-C sends SIGINT to the program, which writes a checkpoint and all results, and waits for its end; a second Ctrl-C
    kills it. The program runs in a separate session, so that a signal from the terminal reaches it only once.

    Parameters
    ----------
    arguments
        Command and options.
    directory
        Output directory, for error messages.
    progress
        True: progress indicator on standard error. False: none. A function: called with each progress line.

    Raises
    ------
    ProgramError, Interrupted
        If the exit code of the program is not 0.
    """
    # The program updates its progress line in place only if its standard error is a terminal.
    try:
        terminal, end_of_child = os.openpty()
    except OSError:  # no /dev/pts, as in some containers: progress lines end with line ends
        terminal, end_of_child = os.pipe()
    try:
        with tempfile.TemporaryFile() as output:
            child = subprocess.Popen([find_program(), *arguments], stdin=subprocess.DEVNULL, stdout=output,
                                     stderr=end_of_child, start_new_session=True)
            os.close(end_of_child)
            end_of_child = -1
            lines = _Lines(progress_indicator(progress))
            try:
                _follow(child, terminal, lines)
            finally:
                if child.poll() is None:  # an exception of the progress function
                    child.send_signal(signal.SIGINT)
                    _drain(terminal)
                    child.wait()
                lines.close()
            if child.returncode != 0:
                raise error_of(child.returncode, _message(lines.messages, _tail(output)), directory)
    finally:
        os.close(terminal)
        if end_of_child >= 0:
            os.close(end_of_child)
    for message in lines.messages:
        print(message, file=sys.stderr)


def _follow(child: subprocess.Popen[bytes], terminal: int, lines: _Lines) -> None:
    """Forwards the standard error of the program until it has ended."""
    interrupted = False
    while True:
        try:
            data = _read(terminal)
            if not data:
                child.wait()
                return
            lines.feed(data.decode("utf-8", "replace"))
        except KeyboardInterrupt:
            if interrupted:
                child.kill()
            elif child.poll() is None:
                child.send_signal(signal.SIGINT)
            interrupted = True


def _read(terminal: int) -> bytes:
    """Returns the next bytes; none after every writer has closed its end."""
    try:
        return os.read(terminal, 65536)
    except OSError:  # EIO: end of a pseudo-terminal
        return b""


def _drain(terminal: int) -> None:
    while _read(terminal):
        pass


def _tail(output: IO[bytes]) -> str:
    size = output.seek(0, os.SEEK_END)
    output.seek(max(0, size - _TAIL))
    return output.read().decode("utf-8", "replace")


def _message(errors: Sequence[str], output: str) -> str:
    """Returns the message of an error: standard error, or the end of standard output if that is empty."""
    text = "\n".join(errors).strip() or output.strip()[-_TAIL:] or "the program ended without a message"
    return re.sub(r"^latcon: ", "", text, flags=re.MULTILINE)


class _Lines:
    """Splits the standard error of the program into progress lines and messages.

    A progress line follows ``\\r ESC [K`` and has no line end; a message ends with one. A message of the scripts of the report may
    follow a progress line directly. Escape sequences for colours are removed.
    """

    _SEPARATOR = re.compile(r"(\r\x1b\[K|\r*\n)")
    _PROGRESS = re.compile(r".*?, \d+ s (?:left|so far)")
    _COLOUR = re.compile(r"\x1b\[[0-9;]*m")

    def __init__(self, show: _Shower) -> None:
        self.messages: list[str] = []
        self._show = show
        self._pending = ""
        self._in_progress = False  # whether the pending text belongs to a progress line

    def feed(self, text: str) -> None:
        pieces = self._SEPARATOR.split(self._pending + text)
        for piece, separator in zip(pieces[::2], pieces[1::2]):
            if separator.endswith("\n"):
                self._add(self._PROGRESS.sub("", piece, count=1) if self._in_progress else piece)
            self._in_progress = not separator.endswith("\n")
        self._pending = pieces[-1]
        # Without a partial separator at the end.
        line = self._pending.partition("\r")[0]
        if self._in_progress and line:
            self._show.line(line)

    def close(self) -> None:
        if not self._in_progress:
            self._add(self._pending)
        self._pending = ""
        self._show.close()

    def _add(self, message: str) -> None:
        message = self._COLOUR.sub("", message)
        if message.strip():
            self.messages.append(message.rstrip())


class _Shower:
    """Progress indicator; the base class shows nothing."""

    def line(self, text: str) -> None:
        """Shows a progress line."""

    def close(self) -> None:
        """Ends the indicator."""


class _Function(_Shower):
    def __init__(self, function: Callable[[str], None]) -> None:
        self._function = function

    def line(self, text: str) -> None:
        self._function(text)


class _Stream(_Shower):
    """Shows the lines of the program: in place in a terminal or notebook, otherwise one per minute."""

    def __init__(self) -> None:
        self._in_place = sys.stderr.isatty() or "ipykernel" in sys.modules
        self._width = 0
        self._last = time.monotonic()

    def line(self, text: str) -> None:
        if self._in_place:
            print("\r" + text.ljust(self._width), end="", file=sys.stderr, flush=True)
            self._width = max(self._width, len(text))
        elif time.monotonic() - self._last >= _LOG_INTERVAL:
            print(text, file=sys.stderr, flush=True)
            self._last = time.monotonic()

    def close(self) -> None:
        if self._in_place and self._width:
            print("\r" + " " * self._width + "\r", end="", file=sys.stderr, flush=True)


class _Bar(_Shower):
    """Progress bar of tqdm, in percent of the estimated wall time."""

    def __init__(self) -> None:
        from tqdm.auto import tqdm
        self._bar = tqdm(total=100, bar_format="{l_bar}{bar}| {postfix}", leave=False)
        self._begin = time.monotonic()

    def line(self, text: str) -> None:
        if left := re.search(r", (\d+) s left$", text):
            elapsed = time.monotonic() - self._begin
            self._bar.n = round(100 * elapsed / max(elapsed + float(left[1]), 1e-9))
        self._bar.set_postfix_str(text)

    def close(self) -> None:
        self._bar.close()


def progress_indicator(progress: Progress) -> _Shower:
    """Indicator of progress lines: a bar of tqdm if it is installed, a function's, or none."""
    if callable(progress):
        return _Function(progress)
    if not progress:
        return _Shower()
    return _Bar() if importlib.util.find_spec("tqdm") else _Stream()
