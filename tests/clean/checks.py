"""Runs the programs of a part and collects the findings in their logs."""
import concurrent.futures
import dataclasses
import os
import pathlib
import re
import subprocess

ROOT = pathlib.Path(__file__).resolve().parents[2]
LOGS = ROOT / "build" / "clean"
# Open MPI refuses root, and more ranks than cores, unless told otherwise.
ENVIRONMENT = dict(os.environ, OMPI_ALLOW_RUN_AS_ROOT="1", OMPI_ALLOW_RUN_AS_ROOT_CONFIRM="1",
                   OMPI_MCA_rmaps_base_oversubscribe="1", OMP_NUM_THREADS="1")


class Failed(Exception):
    """A prerequisite of a part is not available."""


@dataclasses.dataclass
class Job:
    """A program to run."""
    name: str
    command: list
    environment: dict = dataclasses.field(default_factory=dict)


@dataclasses.dataclass
class Part:
    """Targets to build, jobs to run, and the pattern of log lines that are findings."""
    jobs: object  # a function without arguments
    finding: str
    preset: str = ""
    targets: tuple = ()


def build(part):
    """Calls cmake/set-up.sh to install packages and build. @return its output; raises Failed with the end of it"""
    command = [ROOT / "cmake" / "set-up.sh", "--with", "tests", "--with", "clean"]
    if part.preset:
        command += [part.preset, *part.targets]
    # Programs list their tests when they are linked; memory that MPI never frees is not their error.
    environment = dict(os.environ, ASAN_OPTIONS="detect_leaks=0")
    done = subprocess.run(command, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, cwd=ROOT, env=environment)
    if done.returncode != 0:
        raise Failed("cannot be built: " + done.stdout[-3000:])
    return done.stdout


def run(part, job):
    """@return the job's log"""
    done = subprocess.run(list(map(str, job.command)), stdout=subprocess.PIPE, stderr=subprocess.STDOUT, cwd=ROOT,
                          env=dict(ENVIRONMENT, **job.environment))
    text = f"{done.stdout.decode(errors='replace')}\nstatus {done.returncode}\n"
    (LOGS / part / f"{job.name}.log").write_text(text, encoding="utf-8")
    return text


def findings_in(log, pattern, name):
    """Matching lines without repetition; a program that fails without such a line is a finding too."""
    found = list(dict.fromkeys(line for line in log.splitlines() if re.search(pattern, line)))
    status = int(re.findall(r"^status (-?\d+)$", log, re.MULTILINE)[-1])
    if status != 0 and not found:
        found = [f"{name} ended with {status}"]
    return found


def examine(name, part, jobs_at_once, only=""):
    """Builds and runs a part. @return number of jobs, findings without repetition"""
    build(part)
    (LOGS / name).mkdir(parents=True, exist_ok=True)
    jobs = [job for job in part.jobs() if only in job.name]
    if not jobs:
        raise Failed(f"has no job with {only!r} in its name")
    with concurrent.futures.ThreadPoolExecutor(jobs_at_once) as pool:
        logs = list(pool.map(lambda job: run(name, job), jobs))
    found = {}
    for job, log in zip(jobs, logs):
        found.update(dict.fromkeys(findings_in(log, part.finding, job.name)))
    return len(jobs), list(found)
