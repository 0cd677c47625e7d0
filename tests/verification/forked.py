"""Runs latcon in forks of one process (fork_server.cc): MPI, libraries and Python's packages, which take a second, start once."""
import contextlib
import ctypes
import gc
import importlib
import json
import os
import pathlib
import runpy
import select
import signal
import subprocess
import sys
import tempfile
import traceback

PYTHON = {"study", "batch", "compare", "report", "entries", "help", "init"}  # commands that latcon continues in Python


class ForkServer:
    """A fork server, and the folder of the output of its children."""

    def __init__(self, program):
        self.temporary = tempfile.TemporaryDirectory()
        self.output = pathlib.Path(self.temporary.name)
        self.process = subprocess.Popen([program], stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True)

    def run(self, arguments, folder, limit):
        """Runs latcon in `folder`, for at most `limit` s. @return `exit CODE`, `signal NUMBER` or `limit`"""
        self.process.stdin.write(json.dumps([limit, str(self.output), str(folder), arguments]) + "\n")
        self.process.stdin.flush()
        answer = self.process.stdout.readline().strip()
        if not answer:
            raise SystemExit("the server has ended")
        return answer

    def stdout(self):
        """Standard output of the last run."""
        return (self.output / "stdout").read_text(errors="replace")

    def stderr(self):
        """Standard error of the last run."""
        return (self.output / "stderr").read_text(errors="replace")

    def close(self):
        self.process.stdin.close()
        self.process.wait()
        self.process.stdout.close()
        self.temporary.cleanup()


def serve():
    """Answers the requests of a ForkServer on standard input; runs in the server."""
    subprocess._USE_VFORK = False  # a child would share the memory of its parent
    for line in sys.stdin:
        limit, output, folder, words = json.loads(line)
        prepare(words)
        child = os.fork()
        if child == 0:
            try:
                for number, name in enumerate((os.devnull, f"{output}/stdout", f"{output}/stderr")):
                    os.dup2(os.open(name, os.O_WRONLY | os.O_CREAT | os.O_TRUNC if number else os.O_RDONLY), number)
                os.chdir(folder)
                run_program([b"latcon", *map(os.fsencode, words)])
            finally:
                os._exit(99)
        print(outcome(child, limit), flush=True)


def run_program(words, handles_signals=False):
    """Runs latcon in this process, which ends with it."""
    ctypes.PyDLL(None).run_latcon((ctypes.c_char_p * (len(words) + 1))(*words), handles_signals)


def prepare(words):
    """Loads what the children for a command will need."""
    if {"continuum", "verify"} & set(words) or "fracture" in words and "--skip-verification" not in words:
        ctypes.PyDLL(None).load_elements()
    importlib.import_module("latcon.study.command" if words and words[0] in PYTHON else "latcon.folder")
    if "compare" in words:
        importlib.import_module("latcon.compare_frames")
    if {"fracture", "study", "report", "compare"} & set(words) and not {"--no-report", "--dry-run"} & set(words):
        for module in ("latcon.report.report", "latcon.report.claim_sections", "latcon.report.comparison", "latcon.report.study",
                       "matplotlib.pyplot", "matplotlib._qhull", "vtkmodules.util.numpy_support", "vtkmodules.vtkIOXML", "argparse", "pkgutil"):
            importlib.import_module(module)
        importlib.import_module("PIL.Image").preinit()
    gc.freeze()  # a collection in a child would copy their memory


def outcome(child, limit):
    """Waits for a child, and kills it after `limit` s."""
    descriptor = os.pidfd_open(child)
    is_ended = select.select([descriptor], [], [], limit)[0]
    os.close(descriptor)
    if not is_ended:
        os.kill(child, signal.SIGKILL)
    code = os.waitstatus_to_exitcode(os.waitpid(child, 0)[1])
    return "limit" if not is_ended else f"exit {code}" if code >= 0 else f"signal {-code}"


def replace_process(path, words, variables):
    """Does what execve does for latcon itself, `python3 -sP -m MODULE ...` and `python3 -sP SCRIPT ...`; returns for other programs."""
    is_program = os.path.samefile(path, "/proc/self/exe")
    if not is_program and (not os.path.samefile(path, sys.executable) or words[1] != b"-sP"):
        return
    for file in map(int, os.listdir("/proc/self/fd")):
        with contextlib.suppress(OSError):
            if not os.get_inheritable(file):
                os.close(file)
    os.environb.clear()
    os.environb.update(variable.split(b"=", 1) for variable in variables)
    if is_program:
        run_program(words, handles_signals=True)
    words, code = list(map(os.fsdecode, words[2:])), 1
    for number in signal.valid_signals() - {signal.SIGKILL, signal.SIGSTOP}:
        if signal.getsignal(number) != signal.SIG_IGN:
            signal.signal(number, signal.default_int_handler if number == signal.SIGINT else signal.SIG_DFL)
    signal.signal(signal.SIGPIPE, signal.SIG_IGN)
    sys.modules["latcon.folder"]._held.clear()  # by the parent, which also writes what it has not flushed
    sys.stdout = open(1, "w", closefd=False)
    sys.stderr = open(2, "w", buffering=1, closefd=False, errors="backslashreplace")
    sys.argv = words[words[0] == "-m":]
    try:
        if words[0] == "-m":
            runpy.run_module(words[1], run_name="__main__", alter_sys=True)
        else:
            runpy.run_path(words[0], run_name="__main__")
        code = 0
    except SystemExit as end:
        code = end.code or 0
    except BaseException:
        traceback.print_exc()
    sys.stdout.flush()
    os._exit(code)
