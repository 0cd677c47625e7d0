"""Runs test programs on a mutant: in stages, beginning with the tests of the mutated file, within limits."""
import dataclasses
import json
import os
import re
import resource
import shutil
import signal
import subprocess
import time

MEMORY = 6 << 30  # address space of a test [bytes], since a fault may allocate without end


class Failed(Exception):
    """The harness itself failed."""


@dataclasses.dataclass(frozen=True)
class Verdict:
    outcome: str  # killed, survived, or no program: the fault does not compile
    by: str = ""  # test that failed, signal, limit


@dataclasses.dataclass(frozen=True)
class Limits:
    """Limits of the time of a test, relative to its time without a fault. Processor time is limited, which is independent of
    other load; a test that sleeps for ever is ended by wall time."""
    factor: float = 4.
    seconds: float = 20.  # in addition
    wall: float = 20.     # factor for wall time


def run_limited(command, folder, seconds, limits=Limits()):
    """Runs tests that take `seconds` without a fault. @return killed if they fail, crash or do not end"""
    allowed = limits.factor * seconds + limits.seconds

    def limit():
        resource.setrlimit(resource.RLIMIT_CPU, (int(allowed) + 1, int(allowed) + 2))
        resource.setrlimit(resource.RLIMIT_AS, (MEMORY, MEMORY))
        resource.setrlimit(resource.RLIMIT_CORE, (0, 0))
        resource.setrlimit(resource.RLIMIT_FSIZE, (1 << 28, 1 << 28))

    environment = {**os.environ, "OMP_NUM_THREADS": "1", "OMPI_ALLOW_RUN_AS_ROOT": "1",
                   "OMPI_ALLOW_RUN_AS_ROOT_CONFIRM": "1", "OMPI_MCA_rmaps_base_oversubscribe": "1",
                   "OMPI_MCA_mpi_yield_when_idle": "1"}
    log = folder / "log"
    with open(log, "wb") as out:
        process = subprocess.Popen(command, cwd=folder, env=environment, stdin=subprocess.DEVNULL, stdout=out,
                                   stderr=subprocess.STDOUT, preexec_fn=limit, start_new_session=True)
        try:
            status = process.wait(limits.wall * allowed)
        except subprocess.TimeoutExpired:
            status = None
        finally:
            try:
                os.killpg(process.pid, signal.SIGKILL)  # with its children
            except ProcessLookupError:
                pass
            process.wait()
    if status == 0:
        return Verdict("survived")
    if status is None or -status in (signal.SIGXCPU, signal.SIGKILL):
        return Verdict("killed", "time limit")
    text = log.read_text(encoding="utf-8", errors="replace")
    failed = re.search(r"^\[  FAILED  \] ([\w./]+)", text, re.MULTILINE)
    return Verdict("killed", failed.group(1) if failed else f"signal {-status}" if status < 0 else f"exit {status}")


def is_newer(record, path):
    return record.exists() and record.stat().st_mtime > path.stat().st_mtime


class GoogleTests:
    """A program of GoogleTest on one rank."""

    def __init__(self):
        self._seconds = {}  # test: time without a fault

    def measure(self, path, record):
        """Runs the program without a fault, unless it was run since it was built. @param record file that stores the
        times @throws Failed if it fails"""
        if not is_newer(record, path):
            written = path.parent / "times.json"
            verdict = run_limited([str(path), "--gtest_brief=1", f"--gtest_output=json:{written}"], path.parent, 600.)
            if verdict.outcome != "survived":
                raise Failed(f"{path.name} fails without a fault: {verdict.by}")
            shutil.copyfile(written, record)
        for suite in json.loads(record.read_text(encoding="utf-8"))["testsuites"]:
            for test in suite["testsuite"]:
                self._seconds[f"{suite['name']}.{test['name']}"] = float(test["time"].rstrip("s"))

    def _parts(self, suites):
        """Order of the tests: all quick tests, then one test after another, beginning with the given suites."""
        # Names of parametrised tests have prefixes and suffixes.
        named = {t for t in self._seconds if suites.intersection(re.split(r"[/.]", t))}
        quick = {t for t in self._seconds if self._seconds[t] < 0.5}
        slow = sorted(self._seconds.keys() - quick, key=lambda t: (t not in named, self._seconds[t]))
        return [sorted(part) for part in (quick & named, quick - named) if part] + [[test] for test in slow]

    def run(self, path, suites):
        """@param suites names of test suites of the mutated file @return Verdict"""
        for part in self._parts(suites):
            verdict = run_limited([str(path), "--gtest_brief=1", "--gtest_fail_fast", "--gtest_filter=" + ":".join(part)],
                                  path.parent, sum(self._seconds[test] for test in part))
            if verdict.outcome == "killed":
                return verdict
        return Verdict("survived")


class Ranks:
    """A program of GoogleTest on several ranks; starting them takes longer than the tests."""

    def __init__(self, ranks):
        self._start = ["env", f"LATCON_RANKS={ranks}", "mpirun", "--oversubscribe", "-np", str(ranks)]
        self._seconds = 0.

    def measure(self, path, record):
        if not is_newer(record, path):
            start = time.monotonic()
            verdict = run_limited([*self._start, str(path)], path.parent, 600.)
            if verdict.outcome != "survived":
                raise Failed(f"{path.name} fails without a fault: {verdict.by}")
            record.write_text(json.dumps(time.monotonic() - start), encoding="utf-8")
        self._seconds = json.loads(record.read_text(encoding="utf-8"))

    def run(self, path, _):
        return run_limited([*self._start, str(path), "--gtest_brief=1"], path.parent, self._seconds)
