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

Each tool ends with another code than 0 where it finds something. Builds its prerequisites with cmake/set-up.sh, with the packages of
cmake/packages-clean.txt. Logs go to build/clean/PART/.
"""
import argparse
import concurrent.futures
import os
import pathlib
import platform
import shutil
import subprocess
import sys

ROOT = pathlib.Path(__file__).resolve().parents[2]
LOGS = ROOT / "build" / "clean"
SOURCES = ("support", "lattice", "continuum", "verification", "tests")
CASES = ROOT / "verification" / "cases"
# Open MPI refuses root, and more ranks than cores, by default.
ENVIRONMENT = dict(os.environ, OMPI_ALLOW_RUN_AS_ROOT="1", OMPI_ALLOW_RUN_AS_ROOT_CONFIRM="1", OMPI_MCA_rmaps_base_oversubscribe="1",
                   OMP_NUM_THREADS="1", UBSAN_OPTIONS="halt_on_error=1:print_stacktrace=1")
# Minutes each under valgrind, or without optimisation.
SLOW = "--gtest_filter=-*BitsDoNotDependOn*:CrackMeasurement.*:EnergyBalance.*:TimeStepLimits.*:Fracture/*:EndLoads/*:CorrelatedNoise.*"
# Programs of tests that do not start MPI.
SERIAL = ("lattice/lattice_tests", "verification/analysis_tests")
# MPI keeps memory until the process ends, some of it in unloaded modules, which no suppression can name.
NO_LEAKS = {"ASAN_OPTIONS": "detect_leaks=0"}


def program(preset, path):
    return ROOT / "build" / preset / path


def tests(preset, names, *options, before=(), **environment):
    """Jobs, (name, command, environment), for programs of tests, given as folder/name."""
    return [(name.split("/")[-1], [*before, program(preset, f"tests/{name}"), "--gtest_brief=1", *options], environment) for name in names]


def latcon(preset, name, *arguments, before=(), **environment):
    return name, [*before, program(preset, "verification/latcon"), *arguments, "--quiet",
                  "--output-dir", LOGS / "output" / f"{preset}-{name}"], environment


def crack(preset, **how):
    return latcon(preset, "crack", "fracture", CASES / "quick.prm", "--skip-verification", "--set", "Time/end=0.1 ms",
                  "--set", "Output/frame interval=0.05 ms", **how)


def lto():
    return [*tests("lto", SERIAL, SLOW), *tests("lto", ("continuum/continuum_tests", "verification/verification_tests", "verification/claims_tests")),
            ("study", [program("lto", "verification/latcon"), "study", "patterns", "--dry-run"], {}), crack("lto")]


def cppcheck():
    folder = LOGS / "cppcheck" / "analysis"
    folder.mkdir(parents=True, exist_ok=True)
    return [("sources", [
        "cppcheck", "--quiet", "--enable=warning,style,performance,portability", "--inline-suppr", "--std=c++17",
        "--language=c++", "--library=googletest", "--library=openmp", f"--suppressions-list={ROOT / 'tests/clean/cppcheck.supp'}",
        f"--cppcheck-build-dir={folder}", "--template={file}:{line}:{column}: {severity}: {message} [{id}]",
        "--error-exitcode=1", "-I", ".", *SOURCES], {})]


def tidy():
    return [(folder, ["run-clang-tidy", "-p", "build/clang", "-quiet", "-j", "1", f"^{ROOT}/{folder}/"], {}) for folder in SOURCES]


def asan():
    on_ranks = ["mpirun", "--oversubscribe", "-np", "2"]
    return [*tests("debug", SERIAL, ASAN_OPTIONS="detect_leaks=1"),
            *tests("debug", ("verification/verification_tests", "continuum/continuum_tests"), **NO_LEAKS),
            *((f"{name}, shared", *job) for name, *job in tests("debug", ("lattice/lattice_ranks_tests", "continuum/continuum_tests"), before=on_ranks,
                                                                LATCON_RANKS="2", **NO_LEAKS)),
            crack("debug", **NO_LEAKS), latcon("debug", "relaxed", "lattice", CASES / "quick.prm", **NO_LEAKS),
            latcon("debug", "hole", "continuum", CASES / "hole.prm", "--set", "Continuum/adaptive cycles=1",
                   "--set", "Continuum/degree=2", "--set", "Continuum/reaction tolerance=1", **NO_LEAKS),
            latcon("debug", "shear-layer", "continuum", CASES / "shear_layer.prm", "--set", "Continuum/cells y=4", **NO_LEAKS)]


def tsan():
    archer = pathlib.Path(shutil.which("clang++")).resolve().parents[1] / "lib" / "libarcher.so"
    how = {"OMP_NUM_THREADS": "3", "OMP_TOOL_LIBRARIES": str(archer), "TSAN_OPTIONS": "ignore_noninstrumented_modules=1 report_signal_unsafe=0"}
    fixed = ["setarch", "--addr-no-randomize"]  # where memory is placed at random over a wide range, ThreadSanitizer cannot start
    if platform.machine() == "x86_64":
        how["LATCON_INSTRUCTION_SET"] = "SSSE3"  # loads and stores of more than 16 bytes are not instrumented
    return [*tests("clang", SERIAL, before=fixed, **how), crack("clang", before=fixed, **how)]


def valgrind():
    return tests("release", SERIAL, SLOW, before=["valgrind", "--quiet", "--error-exitcode=1", "--leak-check=full",
                                                  "--errors-for-leak-kinds=definite"])


# Jobs of a part, preset, and targets to build, by default all.
PARTS = {"lto": (lto, "lto"), "clang": (list, "clang"), "cppcheck": (cppcheck,),
         "tidy": (tidy, "clang", "verification/latcon_git_commit"),
         "asan": (asan, "debug"), "tsan": (tsan, "clang", "lattice_tests", "analysis_tests", "latcon"),
         "valgrind": (valgrind, "release", "lattice_tests", "analysis_tests")}


def succeeds(part, name, command, environment):
    """Runs a program with a log. @return whether it finds nothing"""
    (LOGS / part).mkdir(parents=True, exist_ok=True)
    path = LOGS / part / f"{name}.log"
    with path.open("w", encoding="utf-8") as log:
        status = subprocess.run(list(map(str, command)), stdout=log, stderr=subprocess.STDOUT, cwd=ROOT, env=dict(ENVIRONMENT, **environment)).returncode
    print(f"{part} {name}: " + (f"status {status}, {path}\n{path.read_text(errors='replace')[-3000:]}" if status else "nothing"), flush=True)
    return not status


def main():
    parser = argparse.ArgumentParser(prog="tests/clean/run", description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("parts", nargs="*", metavar="PART", help="of " + " ".join(PARTS) + "; default: all")
    options = parser.parse_args()
    if unknown := set(options.parts) - set(PARTS):
        parser.error(f"no part {' '.join(unknown)}; there are {' '.join(PARTS)}")
    is_clean = True
    for part in options.parts or PARTS:
        jobs, *build = PARTS[part]
        # Programs list their tests when they are linked; memory that MPI never frees is not their error.
        if not succeeds(part, "build", [ROOT / "cmake" / "set-up.sh", "--with", "tests", "--with", "clean", *build], NO_LEAKS):
            is_clean = False
            continue
        with concurrent.futures.ThreadPoolExecutor(2) as pool:
            is_clean &= all(list(pool.map(lambda job: succeeds(part, *job), jobs())))
    return 0 if is_clean else 1


if __name__ == "__main__":
    sys.exit(main())
