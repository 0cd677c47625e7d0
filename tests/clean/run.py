#!/usr/bin/python3
"""Runs static analysers, sanitizers and valgrind.

  lto       without optimisation, with checks of the standard library: gcc links whole programs at once and compares all types
            (one definition rule), then tests and a crack run
  clang     clang++ builds everything with the warnings that gcc gets, as errors
  cppcheck  all sources
  tidy      clang-tidy over all sources, tests included, as .clang-tidy says
  asan      tests and short runs of the program under AddressSanitizer and UndefinedBehaviorSanitizer, with the debug
            libraries of deal.II; leaks are detected where MPI is not started
  tsan      tests of the lattice and a crack on three threads under ThreadSanitizer, with clang++ and LLVM's OpenMP, which
            reports its synchronisation to the sanitizer; with gcc's every barrier would be a finding
  valgrind  tests of the lattice that are quick enough, in the release build

Builds its prerequisites with cmake/set-up.sh, with the packages of cmake/packages-clean.txt. Logs go to build/clean/PART/.
"""
import argparse
import concurrent.futures
import os
import re
import subprocess
import sys
import time

sys.dont_write_bytecode = True

from parts import LOGS, PARTS, ROOT

# Open MPI refuses root, and more ranks than cores, by default.
ENVIRONMENT = dict(os.environ, OMPI_ALLOW_RUN_AS_ROOT="1", OMPI_ALLOW_RUN_AS_ROOT_CONFIRM="1",
                   OMPI_MCA_rmaps_base_oversubscribe="1", OMP_NUM_THREADS="1")


def output(command, environment):
    """@return exit status, standard output and error"""
    done = subprocess.run(list(map(str, command)), stdout=subprocess.PIPE, stderr=subprocess.STDOUT, cwd=ROOT, errors="replace", env=environment)
    return done.returncode, done.stdout


def findings(name, part, job):
    """Runs a job. @return the lines of its log that are findings; a program that fails without such a line is one too"""
    status, log = output(job.command, dict(ENVIRONMENT, **job.environment))
    (LOGS / name / f"{job.name}.log").write_text(f"{log}\nstatus {status}\n", encoding="utf-8")
    found = [line for line in log.splitlines() if re.search(part.finding, line)]
    return found or ([f"{job.name} ended with {status}"] if status else [])


def examine(name, part, jobs_at_once, only):
    """Builds and runs a part. @return number of jobs, findings without repetition"""
    # Programs list their tests when they are linked; memory that MPI never frees is not their error.
    status, said = output([ROOT / "cmake" / "set-up.sh", "--with", "tests", "--with", "clean", *([part.preset] if part.preset else []), *part.targets],
                          dict(os.environ, ASAN_OPTIONS="detect_leaks=0"))
    if status:
        return 0, ["cannot be built: " + said[-3000:]]
    (LOGS / name).mkdir(parents=True, exist_ok=True)
    jobs = [job for job in part.jobs() if only in job.name]
    with concurrent.futures.ThreadPoolExecutor(jobs_at_once) as pool:
        found = [line for lines in pool.map(lambda job: findings(name, part, job), jobs) for line in lines]
    return len(jobs), list(dict.fromkeys(found)) if jobs else [f"no job with {only!r} in its name"]


def arguments():
    parser = argparse.ArgumentParser(prog="tests/clean/run", description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("parts", nargs="*", metavar="PART", help="of " + " ".join(PARTS) + "; default: all")
    parser.add_argument("--jobs", type=int, default=2, help="programs at once; default: 2")
    parser.add_argument("--only", default="", metavar="TEXT", help="only jobs with this in their name, such as a folder")
    options = parser.parse_args()
    for part in options.parts:
        if part not in PARTS:
            parser.error(f"no part {part!r}; there are {' '.join(PARTS)}")
    return options


def main():
    options = arguments()
    print(f"{'part':10}{'jobs':>6}{'findings':>10}{'seconds':>9}", flush=True)
    total = 0
    for part in options.parts or PARTS:
        start = time.monotonic()
        jobs, found = examine(part, PARTS[part], options.jobs, options.only)
        print(f"{part:10}{jobs:6}{len(found):10}{time.monotonic() - start:9.0f}", flush=True)
        for finding in found[:20]:
            print("  " + finding)
        if len(found) > 20:
            print(f"  and {len(found) - 20} more in {LOGS / part}")
        total += len(found)
    return 1 if total > 0 else 0


if __name__ == "__main__":
    sys.exit(main())
