"""The program, which resolves the cases of a study; exit codes, messages and signals as its own."""
from __future__ import annotations

import contextlib
import dataclasses
import json
import os
import re
import signal
import subprocess
from collections.abc import Mapping, Sequence
from types import FrameType
from typing import Any

from ..errors import INTERNAL_ERROR, LatconError
from ..quantities import RECORDED
from ..schema import Schema
from .pool import start_child

_ENDING_SIGNALS = (signal.SIGINT, signal.SIGTERM, signal.SIGHUP, signal.SIGUSR1, signal.SIGUSR2, signal.SIGALRM, signal.SIGXCPU)


class InputError(LatconError):
    """Invalid input, with all problems that were found."""

    def __str__(self) -> str:
        return "\n".join(self.args)


@dataclasses.dataclass(eq=False)
class Ended(Exception):
    """End with an exit code; what is wrong has been printed, and `message` is for the log."""

    exit_code: int
    message: str = ""


def end_of(status: int) -> Ended:
    """Returns the end for the status of a child, which has printed what is wrong unless a signal killed it."""
    return Ended(status or INTERNAL_ERROR) if status >= 0 else Ended(INTERNAL_ERROR, f"a child process was killed by signal {-status}")


class Interrupted(BaseException):
    """A signal that ends the program; its number is the argument."""


class Signals:
    """Signals that end the program: raise Interrupted, or are only recorded while they are deferred."""

    def __init__(self) -> None:
        self.deferred = False
        self.pending: int | None = None
        for number in _ENDING_SIGNALS:
            if number != signal.SIGHUP or signal.getsignal(number) != signal.SIG_IGN:
                signal.signal(number, self._receive)

    def unblock(self) -> None:
        """Receives signals, which are blocked since before the interpreter started."""
        signal.pthread_sigmask(signal.SIG_SETMASK, ())

    def resume(self) -> None:
        """Ends the deferral."""
        self.deferred = False
        if self.pending is not None:
            self._receive(self.pending, None)

    def _receive(self, number: int, _frame: FrameType | None) -> None:
        self.pending = number
        if not self.deferred:
            self.deferred = True  # a second signal does not interrupt the end
            raise Interrupted(number)


def printable(text: str, longest: int = 80) -> str:
    """Returns a text for a message: on one line, what does not show as ``\\xNN``, the middle omitted if it is longer."""
    if len(text) > longest:
        text = text[:longest - 20] + " ... " + text[-20:]
    # Control characters, a no-break space, and U+200B to U+200F and U+FEFF, which do not show.
    return re.sub("[\0-\x1f\x7f-\xa0\u200b-\u200f\ufeff\ud800-\udfff]",
                  lambda letter: "".join(f"\\x{byte:02x}" for byte in letter[0].encode("utf-8", "surrogateescape")), text)


def require_access(folder: str) -> None:
    """Raises InputError if the system denies access to a folder, so that it seems to be absent or empty."""
    try:
        os.close(os.open(os.path.join(folder, "."), os.O_RDONLY))
    except PermissionError as error:
        raise InputError(f"{printable(folder)} cannot be read: {error.strerror}") from None
    except OSError:
        pass


def read_input(path: str) -> tuple[bytes, str]:
    """Returns the content of a file of the user, and why it cannot be used."""
    largest = 1 << 24
    if os.path.isdir(path):
        return b"", "it is a folder"
    try:
        with open(path, "rb") as file:
            content = file.read(largest + 1)
    except OSError as error:
        return b"", error.strerror or str(error)
    return content, "it is larger than 16 MiB" if len(content) > largest else ""


class Program:
    """The program: facts about it and about the entries of a case, and ``latcon resolve``, which answers questions about cases.

    `options` are those of the command line.
    """

    def __init__(self, options: Mapping[str, Any]) -> None:
        self.data: str = options["data"]
        # This program, even if its file is replaced.
        self.executable = f"/proc/{os.getpid()}/fd/{os.open(options['program'], os.O_RDONLY)}"
        words = ["--yes"] * options["yes"] + (["--threads", str(options["threads"])] if options["threads"] else [])
        # A group of its own: Ctrl-C reaches this process, which decides.
        self._resolver = start_child([self.executable, "resolve", *words], signal.SIGKILL, stdin=subprocess.PIPE,
                                     stdout=subprocess.PIPE, process_group=0)
        facts = self._answer()
        self.entries = Schema(facts)
        self.sorted_entries = sorted(self.entries)
        self.units = RECORDED
        self.cores: int = facts["cores"]
        self.facts: dict[str, Any] = facts["record"] | {"command_line": options["arguments"]}

    def ask(self, **question: Any) -> Any:
        """Returns the answer to a question (``latcon resolve``); raises InputError with the problems of a case, or if the
        machine has too little memory.
        """
        assert self._resolver.stdin
        with contextlib.suppress(BrokenPipeError):  # it has ended: no answer
            self._resolver.stdin.write(json.dumps(question).encode("ascii") + b"\n")
            self._resolver.stdin.flush()
        answer = self._answer()
        if isinstance(answer, dict) and "problems" in answer:
            raise InputError(*answer["problems"])
        return answer

    def _answer(self) -> Any:
        assert self._resolver.stdout
        if line := self._resolver.stdout.readline():
            return json.loads(line)
        raise end_of(self._resolver.wait())

    def close(self) -> None:
        """Ends the process that answers."""
        self._resolver.kill()
        self._resolver.wait()

    def hint(self, given: str, known: Sequence[str]) -> str:
        """Returns ``; nearest: WORD`` for a mistyped word; empty if no known word is similar."""
        nearest = self.ask(nearest=printable(given, 200), known=list(known))
        return f"; nearest: {nearest}" if nearest else ""

    def shipped(self, folder: str, ending: str) -> dict[str, str]:
        """Returns the files of the shipped cases or studies by name."""
        place = os.path.join(self.data, folder)
        names = sorted(name for name in os.listdir(place) if name.endswith(ending)) if os.path.isdir(place) else []
        return {name.removesuffix(ending): os.path.join(place, name) for name in names}
