"""Output directories as the program keeps them: locked, written file by file at once, with a list of what is in them."""
from __future__ import annotations

import contextlib
import fcntl
import os
import pathlib
import re
import secrets
import shutil
import socket
import stat
import sys
import time
from collections.abc import Callable, Iterator

from .errors import BAD_INPUT, BadInput
from .study.program import InputError

EARLIER = "earlier-run"  # folder of the files of the run before
_LOCK, _LIST = ".latcon.lock", ".latcon-files"
# Runs of a killed process get SIGTERM, and write a checkpoint before they end [s].
_PATIENCE_WITH_ORPHANS = 10.0
_held: dict[str, FolderLock] = {}  # by absolute path


class FolderLock(contextlib.AbstractContextManager["FolderLock"]):
    """Exclusive lock on an existing folder, that of the program; see support/folder_lock.h.

    Waits for another process to end with `patience` [s]; raises InputError if it still holds the lock then.
    """

    def __init__(self, folder: str, patience: float = 1.0) -> None:
        self._folder, self._path = os.path.abspath(folder), os.path.join(folder, _LOCK)
        deadline = time.monotonic() + patience
        while True:
            # O_NONBLOCK: opening a pipe at this path must not block.
            self._file = os.open(self._path, os.O_RDWR | os.O_CREAT | os.O_NOFOLLOW | os.O_NONBLOCK, 0o666)
            if not stat.S_ISREG(os.fstat(self._file).st_mode):
                raise OSError(0, "it is not a regular file", self._path)
            try:
                fcntl.flock(self._file, fcntl.LOCK_EX | fcntl.LOCK_NB)
                owner = ""
            except BlockingIOError:
                owner = re.split(r"[^0-9A-Za-z._ -]", os.pread(self._file, 300, 0).decode("ascii", "replace"))[0] or "?"
            except OSError:
                break  # no locks on this file system
            # The file may have been replaced between the two calls.
            if not owner and self.is_in_place():
                break
            os.close(self._file)
            if time.monotonic() >= deadline:
                raise InputError(f"{folder} is in use by " + ("another process" if owner in ("", "?") else f"process {owner}")
                                 + "; wait until it has ended, or choose another folder (--output-dir)")
            time.sleep(0.02)
        self._write_owner(f"{os.getpid()} on {socket.gethostname()}\n")
        _held[self._folder] = self
        for place in (folder, os.path.join(folder, "checkpoints")):
            for name in os.listdir(place) if os.path.isdir(place) else ():
                if re.search(r"\.[0-9a-f]{16}\.part$", name) and not os.path.islink(os.path.join(place, name)):
                    with contextlib.suppress(OSError):  # of a killed process
                        os.remove(os.path.join(place, name))

    def __exit__(self, *_: object) -> None:
        self.release()

    def is_in_place(self) -> bool:
        """Returns whether the path still refers to the locked folder."""
        try:
            return os.path.samestat(os.fstat(self._file), os.lstat(self._path))
        except FileNotFoundError:
            return False

    def release(self) -> None:
        """Ends the lock; its file remains."""
        if _held.pop(self._folder, None) is self:
            self._write_owner("")
        os.close(self._file)

    def _write_owner(self, owner: str) -> None:
        with contextlib.suppress(OSError):  # informative only
            if os.fstat(self._file).st_nlink == 1:
                os.ftruncate(self._file, 0)
                os.pwrite(self._file, os.fsencode(owner), 0)


def absolute(path: str | os.PathLike[str]) -> pathlib.Path:
    """Returns a path that is of use after a change of folder, with the home in place of a leading ``~``, as in a shell.

    Raises BadInput if it is empty, which Python would take for the current folder.
    """
    if not os.fspath(path):
        raise BadInput("the name of the folder is empty; that of the current folder is '.'", BAD_INPUT)
    return pathlib.Path(path).expanduser().absolute()


def prepare_run(folder: str, is_begun: Callable[[], bool]) -> bool:
    """Prepares the output directory of a run: keeps one in which a run has begun, which continues, and removes any other.

    Returns whether it continues. A run that a killed process left there is waited for.
    """
    if os.path.exists(folder):  # released at once: the run locks it for itself
        FolderLock(folder, _PATIENCE_WITH_ORPHANS).release()
    continues = os.path.exists(folder) and is_begun()
    if not continues:
        remove(folder)
    os.makedirs(folder, exist_ok=True)
    return continues


def remove(path: str) -> None:
    """Removes a folder with all that is in it, a file or a link, if it exists."""
    if os.path.islink(path) or os.path.isfile(path):
        os.remove(path)
    elif os.path.exists(path):
        shutil.rmtree(path)


def require_in_place(place: str) -> None:
    """Raises OSError if a path is in a folder that this process has locked and that was removed or replaced since."""
    for folder, lock in _held.items():
        if os.path.abspath(place).startswith(folder + "/") and not lock.is_in_place():
            raise OSError(0, f"the folder {folder} was removed or replaced during the run", place)


def write_atomically(place: str, text: str | bytes) -> None:
    """Replaces a file, which is at any moment, also on a full disk, the old one or complete, and synchronises it with the disk."""
    if os.path.exists(place) and not os.path.isfile(place):
        raise OSError(0, "it is a folder" if os.path.isdir(place) else "it is not a regular file", place)
    part = f"{place}.{secrets.token_hex(8)}.part"
    with _errors_of(place):
        file = os.open(part, os.O_RDWR | os.O_CREAT | os.O_EXCL | os.O_NOFOLLOW, 0o666)
    try:
        require_in_place(place)
        with _errors_of(place):
            with open(file, "wb") as stream:
                stream.write(text if isinstance(text, bytes) else text.encode("utf-8", "surrogateescape"))
                stream.flush()
                os.fsync(file)
            os.rename(part, place)
    except BaseException:
        with contextlib.suppress(OSError):
            os.remove(part)
        raise
    with contextlib.suppress(OSError):
        folder = os.open(os.path.dirname(place) or ".", os.O_RDONLY | os.O_DIRECTORY)
        os.fsync(folder)
        os.close(folder)


@contextlib.contextmanager
def _errors_of(place: str) -> Iterator[None]:
    try:
        yield
    except OSError as error:
        raise OSError(error.errno, error.strerror, place) from None


def write_file(place: str, text: str | bytes) -> None:
    """Replaces a file as :func:`write_atomically` does, and adds it to the list of its folder, if it has one."""
    folder, name = os.path.split(place)
    list_files(folder, [name])
    write_atomically(place, text)


def list_files(folder: str, names: list[str]) -> None:
    """Adds files to the list of a folder, if it has one: before several processes write them at once."""
    if os.path.exists(os.path.join(folder, _LIST)):
        add_to_list(folder, names)


def _listed(folder: str) -> set[str]:
    try:
        with open(os.path.join(folder, _LIST), encoding="utf-8", errors="surrogateescape") as file:
            return set(file.read().split("\n")) - {""}
    except FileNotFoundError:
        return set()


def _write_list(folder: str, names: set[str]) -> None:
    write_atomically(os.path.join(folder, _LIST), "".join(f"{name}\n" for name in sorted(names)))


def add_to_list(folder: str, names: list[str]) -> None:
    """Adds files to the list of a folder, or creates it. Files of names that were not listed are moved aside."""
    listed = _listed(folder)
    further = set(names) - listed
    if aside := _move_aside(folder, further):
        print(f"latcon: files in {folder} that latcon did not write are now in {aside}", file=sys.stderr, flush=True)
    if further or not os.path.exists(os.path.join(folder, _LIST)):
        _write_list(folder, listed | further)


def _is_in(names: set[str], name: str) -> bool:
    return any(re.fullmatch(re.escape(listed).replace(r"\*", "[0-9.]+", 1), name) for listed in names)


def is_listed(folder: str, name: str) -> bool:
    """True if a file is in the list of its folder, where ``*`` is the number of a frame."""
    return _is_in(_listed(folder), name)


def archive(folder: str) -> str:
    """Moves the listed files of a folder to its subfolder ``earlier-run``, ``earlier-run-2``, ...; empty if there are none.

    First moves checkpoints to ``checkpoints.old``, so that none is ever without the frames before it.
    """
    checkpoints = os.path.join(folder, "checkpoints")
    if any(pathlib.Path(checkpoints).glob("*.h5")):
        remove(checkpoints + ".old")
        os.rename(checkpoints, checkpoints + ".old")
    return _move_aside(folder, _listed(folder))


def _move_aside(folder: str, names: set[str]) -> str:
    files = [entry.name for entry in os.scandir(folder) if entry.is_file(follow_symlinks=False) and _is_in(names, entry.name)]
    if not files:
        return ""
    aside, number = os.path.join(folder, EARLIER), 1
    while os.path.lexists(aside):
        number += 1
        aside = os.path.join(folder, f"{EARLIER}-{number}")
    os.mkdir(aside)
    for name in sorted(files, key="run.json".__eq__):  # last, since it tells whose the others are
        os.rename(os.path.join(folder, name), os.path.join(aside, name))
    _write_list(aside, names)
    return aside
