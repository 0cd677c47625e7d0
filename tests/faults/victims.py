"""Small runs of every kind that writes checkpoints, on which the fault harness acts."""
import json
import os
import pathlib
import shutil
import signal
import subprocess
import time

from program import latcon, settings

HERE = pathlib.Path(__file__).parent
# The last have no checkpoints: after a kill they start from the beginning, and a study with its incomplete runs.
RUNS = {name: [*words, "--quiet", *settings(*(f"{key}={value}" for key, value in entries.items()))]
        for name, (words, entries) in json.loads((HERE / "victims.json").read_text()).items()}
RUNS["study"][1] = str(HERE / "study.json")
RUNS["report"] = ["report"]  # of a crack that has run before
WITHOUT_CHECKPOINTS = {name: RUNS[name] for name in ("relaxation", "study", "verify", "report")}
VICTIMS = {name: words for name, words in RUNS.items() if name not in WITHOUT_CHECKPOINTS}
# Runs that are bitwise identical for any number of ranks.
ON_RANKS = [name for name in VICTIMS if name != "sheet in motion"]
# Files that record the circumstances of a run.
NOT_RESULTS = ("run.json", "log.txt", ".latcon.lock", "study.json", "study.html")
DONE = (0, 3)  # 3: the energy balance of such small strips may exceed the tolerance


def on_threads(arguments, threads):
    return arguments if arguments[0] == "report" else [*arguments, "--threads", str(threads)]


def descendants(process):
    """A process and all its descendants."""
    found = [process]
    for started in found:
        for task in pathlib.Path(f"/proc/{started}/task").glob("*/children"):
            try:
                found += [int(word) for word in task.read_text().split()]
            except OSError:
                pass  # it has ended
    return found


class Program:
    """latcon and the command that starts it."""

    def __init__(self, latcon, preloaded=None):
        self.latcon, self.preloaded = str(latcon), preloaded

    def start(self, arguments, out, *, ranks=1, fault=None):
        variables = {} if fault is None else {"LD_PRELOAD": str(self.preloaded), "LATCON_FAULT_IN": str(out), **fault}
        launcher = [] if ranks == 1 else ["mpirun", "--oversubscribe", "-n", str(ranks)]
        to = [str(out)] if arguments[0] == "report" else ["--output-dir", str(out)]
        return subprocess.Popen([*launcher, self.latcon, *arguments, *to], env=os.environ | variables,
                                stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True)

    def run(self, arguments, out, timeout=600, **how):
        """@return exit status, "hangs" past the timeout [s]; standard error"""
        process = self.start(arguments, out, **how)
        try:
            _, said = process.communicate(timeout=timeout)
        except subprocess.TimeoutExpired:
            kill(process)
            return "hangs", ""
        return process.returncode, said


def run(arguments, out, timeout=600):
    """Like Program.run, in a fork, for uninterrupted runs on one thread."""
    try:
        ended = latcon(*arguments, "--output-dir", out, timeout=timeout, expect=None)
    except subprocess.TimeoutExpired:
        return "hangs", ""
    return ended.returncode, ended.stderr


def run_to_end(arguments, out):
    status, said = run(arguments, out)
    if status not in DONE:
        raise RuntimeError(f"exit {status}: {said}")


def renew(name, out):
    """Creates the folder in its state before a run."""
    shutil.rmtree(out, ignore_errors=True)
    if name != "report":
        return
    kept = out.parent / "crack"
    if not kept.exists():
        run_to_end(VICTIMS["crack"], kept)
        shutil.rmtree(kept / "checkpoints")
    shutil.copytree(kept, out)


def resumed(arguments):
    """The arguments that resume a run."""
    return arguments if arguments[0] in ("verify", "report") else [*arguments, "--resume"]


def kill(process):
    for victim in reversed(descendants(process.pid)):
        try:
            os.kill(victim, signal.SIGKILL)
        except ProcessLookupError:
            pass
    process.communicate()


def contents(folder):
    """Results of a run by file name, without the files that record its circumstances."""
    return {str(path.relative_to(folder)): path.read_bytes() for path in sorted(folder.rglob("*"))
            if path.is_file() and path.suffix != ".part" and path.name not in NOT_RESULTS
            and not any(part.startswith(("checkpoints", "earlier-run")) for part in path.relative_to(folder).parts)}


def differences(found, expected):
    """Names of files that differ."""
    return sorted(name for name in found.keys() | expected.keys() if found.get(name) != expected.get(name))


def wait_until_it_runs(process, out, before):
    """Waits until a program has read its input and writes run.json. @return whether it did
    @param before modification time of that file when the program was started; 0 if it did not exist"""
    while process.poll() is None:
        if time_of_change(out / "run.json") != before:
            return True
        time.sleep(0.002)
    return False


def time_of_change(path):
    return path.stat().st_mtime_ns if path.exists() else 0


def undisturbed(program, arguments, out, name=None):
    """@return the contents of the folder, the wall time after the start of the program [s]"""
    renew(name, out)
    process = program.start(on_threads(arguments, 1), out)
    if name != "report":
        wait_until_it_runs(process, out, 0)
    start = time.monotonic()
    _, said = process.communicate(timeout=600)
    if process.returncode not in DONE:
        raise RuntimeError(f"exit {process.returncode}: {said}")
    return contents(out), time.monotonic() - start
