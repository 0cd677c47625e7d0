"""The program as a service of a study: resolves cases, verifies them, and writes files and records."""
from __future__ import annotations

import dataclasses
import json
import os
import signal
import socket
import subprocess
from collections.abc import Iterator, Mapping, Sequence
from types import FrameType
from typing import Any

DONE, INTERNAL_ERROR, BAD_INPUT, CLAIM_FAILED, SOLVER_FAILED, OUTPUT_FAILED, INTERRUPTED = 0, 1, 2, 3, 4, 5, 130

_ENDING_SIGNALS = (signal.SIGINT, signal.SIGTERM, signal.SIGHUP, signal.SIGUSR1, signal.SIGUSR2, signal.SIGALRM, signal.SIGXCPU)


class InputError(Exception):
    """Invalid input, with all problems that were found."""

    def __init__(self, *problems: str) -> None:
        super().__init__("\n".join(problems))
        self.problems = problems


class ServiceEnded(Exception):
    """The service has reported an error and ended."""


class Interrupted(BaseException):
    """A signal that ends the program."""

    def __init__(self, number: int) -> None:
        super().__init__(number)
        self.number = number


class Signals:
    """Signals that end the program: raise Interrupted, or are only recorded while they are deferred."""

    def __init__(self) -> None:
        self.deferred = False
        self.pending: int | None = None
        for number in _ENDING_SIGNALS:
            if number != signal.SIGHUP or signal.getsignal(number) != signal.SIG_IGN:
                signal.signal(number, self._receive)

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


@dataclasses.dataclass(frozen=True)
class Entry:
    """Entry of a case; `unit` is empty for entries that are not quantities, `number_unit` then "1"."""

    key: str
    unit: str
    number_unit: str
    is_number: bool
    is_whole: bool
    is_list: bool


@dataclasses.dataclass(frozen=True)
class Quantity:
    """Quantity that a study records of each run; `source` is the file without its ending, or ``derived``."""

    name: str
    unit: str
    source: str


class Service:
    """Child process that answers requests, a line of JSON each.

    Parameters
    ----------
    options
        Options of the command line.
    """

    def __init__(self, options: Mapping[str, Any]) -> None:
        self._socket, other = socket.socketpair()
        environment = {name: value for name, value in os.environ.items() if name != "PYTHONPATH"}
        # A group of its own: Ctrl-C reaches this process, which decides when the service ends.
        self.process = subprocess.Popen([options["program"], "study-service"], stdin=other.fileno(), env=environment, process_group=0)
        other.close()
        self._replies = self._socket.makefile("rb")
        self._send({name: options[name] for name in ("arguments", "output_dir", "threads", "quiet", "verbose", "yes")})
        facts = self.ask("describe")
        self.entries = {entry["key"]: Entry(**entry) for entry in facts["entries"]}
        self.sorted_entries: list[str] = facts["sorted"]
        self.quantities = [Quantity(**quantity) for quantity in facts["quantities"]]
        self.units = {quantity.name: quantity.unit for quantity in self.quantities}
        self.cores: int = facts["cores"]
        self.version: str = facts["version"]
        self.git_commit: str = facts["git_commit"]
        self.program_hash: str = facts["program_hash"]

    def ask(self, do: str, **data: Any) -> Any:
        """Sends a request and returns the reply.

        Raises
        ------
        ServiceEnded
            If the request failed. The service has then printed the message and recorded the exit code.
        """
        self._send({"do": do, **data})
        line = self._replies.readline()
        if not line:
            raise ServiceEnded
        return json.loads(line)

    def ask_in_parts(self, do: str, cases: Sequence[Any], **data: Any) -> Iterator[Any]:
        """Sends a request about many cases in parts, so that neither side keeps all of them; yields the replies."""
        for begin in range(0, len(cases), 200):
            yield self.ask(do, cases=cases[begin:begin + 200], **data)

    def printable(self, text: str, longest: int | None = None) -> str:
        """Returns a text without control characters, shortened."""
        return self.ask("printable", text=text, **({} if longest is None else {"longest": longest}))

    def hint(self, given: str, known: Sequence[str]) -> str:
        """Returns ``; nearest: WORD`` for a mistyped word; empty if no known word is similar."""
        nearest = self.ask("nearest", given=given, known=list(known))
        return f"; nearest: {nearest}" if nearest else ""

    def print(self, text: str) -> None:
        """Prints a text to standard output, and to the log of the study."""
        self.ask("print", text=text)

    def finish(self, exit_code: int, message: str | None = None) -> None:
        """Ends the service, which prints the message and records the exit code."""
        try:
            self._send({"do": "exit", "code": exit_code} | ({} if message is None else {"message": message}))
        except OSError:
            pass  # it has ended

    def wait(self) -> int:
        """Waits for the end of the service and returns its exit code."""
        self._socket.shutdown(socket.SHUT_WR)
        code = self.process.wait()
        return INTERNAL_ERROR if code < 0 else code

    def _send(self, request: Mapping[str, Any]) -> None:
        try:
            self._socket.sendall(json.dumps(request, allow_nan=False).encode("utf-8", "replace") + b"\n")
        except BrokenPipeError:
            raise ServiceEnded from None
