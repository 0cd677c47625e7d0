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
import sys
import time

sys.dont_write_bytecode = True

from checks import LOGS, Failed, examine
from parts import PARTS


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
        try:
            jobs, findings = examine(part, PARTS[part], options.jobs, options.only)
        except Failed as failure:
            jobs, findings = 0, [str(failure)]
        print(f"{part:10}{jobs:6}{len(findings):10}{time.monotonic() - start:9.0f}", flush=True)
        for finding in findings[:20]:
            print("  " + finding)
        if len(findings) > 20:
            print(f"  and {len(findings) - 20} more in {LOGS / part}")
        total += len(findings)
    return 1 if total > 0 else 0


if __name__ == "__main__":
    sys.exit(main())
