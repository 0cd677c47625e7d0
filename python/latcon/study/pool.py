"""Pool of child processes."""
from __future__ import annotations

import contextlib
import ctypes
import os
import signal
import subprocess
import threading
import time
from collections.abc import Callable, Iterator, Sequence
from types import FrameType
from typing import Any

_POLL_INTERVAL = 0.02  # [s]
_PATIENCE = 60.0  # [s] until a child that does not end is killed
_NOT_STARTED = 127
_PR_SET_PDEATHSIG = 1
_LIBC = ctypes.CDLL(None)
# Variables of a launcher, with which a child would be a rank of another job, and of this process alone.
_LAUNCHER = ("OMPI_", "PMIX_", "PMI_")


def run_processes(n_jobs: int, limit: int, start: Callable[[int], tuple[Sequence[str], str]],
                  ended: Callable[[int, int], None], waiting: Callable[[Sequence[int]], None],
                  stop: Callable[[], bool]) -> bool:
    """Runs jobs in their order, at most `limit` at a time, and waits for all of them; returns whether all ended by themselves.

    Children have no standard input and no variables of MPI launchers, so that each is a separate job of MPI. They ignore
    SIGINT: this process handles it. They get SIGTERM if this process dies. A failed job does not stop the others.

    `start` returns command and log file of a job, called just before it starts; the log gets standard output and error. `ended`
    is called when a job has ended by itself, with its exit status: 128 + the signal that killed it, or 127 if it could not
    start. `waiting` is called several times per second with the running jobs, and equally often `stop`, which returns True to
    end early: then no more jobs start, and running jobs get SIGTERM, and SIGKILL a minute later.
    """
    running: dict[int, subprocess.Popen[bytes] | None] = {}
    following = 0
    try:
        while following < n_jobs or running:
            if stop():
                return False
            while following < n_jobs and len(running) < limit:
                command, log = start(following)
                running[following] = None  # unless it starts
                with (open(log, "wb", opener=lambda path, flags: os.open(path, flags | os.O_NOFOLLOW, 0o666)) as output,
                      contextlib.suppress(FileNotFoundError), _deferred_interrupt()):
                    running[following] = start_child(command, signal.SIGTERM, stdin=subprocess.DEVNULL, stdout=output, stderr=output)
                following += 1
            waiting(list(running))
            time.sleep(_POLL_INTERVAL)
            for job, child in list(running.items()):
                status = _NOT_STARTED if child is None else child.poll()
                if status is None:
                    continue
                del running[job]
                # A signal from a terminal goes to all processes, so a child may have received it before this process.
                if stop():
                    return False
                ended(job, status if status >= 0 else 128 - status)
        return True
    finally:
        children = [child for child in running.values() if child is not None]
        for child in children:
            child.terminate()
        last = time.monotonic() + _PATIENCE
        for child in children:
            try:
                child.wait(max(0.0, last - time.monotonic()))
            except subprocess.TimeoutExpired:
                child.kill()
                child.wait()


@contextlib.contextmanager
def _deferred_interrupt() -> Iterator[None]:
    """Handles Ctrl-C afterwards: an exception in what Python calls at a fork would be lost."""
    handler = signal.getsignal(signal.SIGINT)
    if not callable(handler) or threading.current_thread() is not threading.main_thread():
        yield
        return
    received: list[tuple[int, FrameType | None]] = []
    signal.signal(signal.SIGINT, lambda number, frame: received.append((number, frame)))
    try:
        yield
    finally:
        signal.signal(signal.SIGINT, handler)
        for number, frame in received:
            handler(number, frame)


def start_child(command: Sequence[str], last_signal: int, **streams: Any) -> subprocess.Popen[bytes]:
    """Starts a child, which gets a signal when this process dies, without the variables that would make it a rank of another job."""
    parent = os.getpid()

    def prepare() -> None:
        end_with(parent, last_signal)
        signal.signal(signal.SIGINT, signal.SIG_IGN)

    environment = {name: value for name, value in os.environ.items()
                   if not name.startswith(_LAUNCHER) and name not in ("FLUX_JOB_ID", "LATCON_PROGRESS", "PYTHONPATH")}
    return subprocess.Popen(command, env=environment, preexec_fn=prepare, **streams)


def end_with(parent: int, last_signal: int) -> None:
    """Has a signal sent to this process, a child, when its parent dies; ends it if that is dead already."""
    _LIBC.prctl(_PR_SET_PDEATHSIG, last_signal)
    if os.getppid() != parent:
        os._exit(_NOT_STARTED)
