"""The parts of tests/clean/run and the programs that each runs."""
import dataclasses
import pathlib
import platform
import shutil

ROOT = pathlib.Path(__file__).resolve().parents[2]
LOGS = ROOT / "build" / "clean"
SOURCES = ("support", "lattice", "continuum", "verification", "tests")
CASES = ROOT / "verification" / "cases"
HERE = ROOT / "tests" / "clean"
# Format of the messages of clang, clang-tidy and cppcheck.
MESSAGE = r"^\S+:\d+:\d+: (warning|error|style|performance|portability)"


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


def program(preset, path):
    return ROOT / "build" / preset / path


def cppcheck():
    folder = LOGS / "cppcheck" / "analysis"
    folder.mkdir(parents=True, exist_ok=True)
    return [Job("sources", [
        "cppcheck", "--quiet", "--enable=warning,style,performance,portability", "--inline-suppr", "--std=c++17",
        "--language=c++", "--library=googletest", "--library=openmp", f"--suppressions-list={HERE / 'cppcheck.supp'}",
        f"--cppcheck-build-dir={folder}", "--template={file}:{line}:{column}: {severity}: {message} [{id}]",
        "--error-exitcode=1", "-I", ".", *SOURCES])]


def tidy():
    return [Job(folder, ["run-clang-tidy", "-p", "build/clang", "-quiet", "-j", "1", f"^{ROOT}/{folder}/"]) for folder in SOURCES]


def latcon(preset, name, *arguments, **environment):
    return Job(name, [program(preset, "verification/latcon"), *arguments, "--quiet",
                      "--output-dir", LOGS / "output" / f"{preset}-{name}"], environment)


def crack(preset, **environment):
    return latcon(preset, "crack", "fracture", CASES / "quick.prm", "--skip-verification", "--set", "Time/end=0.1 ms",
                  "--set", "Output/frame interval=0.05 ms", **environment)


# Minutes each under valgrind, or without optimisation.
SLOW = ("Contact.LedgerCloses*", "*BitsDoNotDependOn*", "CrackMeasurement.*",
        "EnergyBalance.*", "Cutout.Relaxed*", "RungeKuttaChebyshev.Is*",
        "RungeKuttaChebyshev/*", "TimeStepLimits.*", "Fracture/*", "EndLoads/*", "LinkCells.Show*", "CorrelatedNoise.*")


def tests_of(preset, environment, *names):
    """Programs of tests, given as folder/name."""
    return [Job(name.split("/")[-1], [program(preset, f"tests/{name}"), "--gtest_brief=1"], environment) for name in names]


# Programs of tests that do not start MPI.
SERIAL = ("lattice/lattice_tests", "verification/analysis_tests")


def lto():
    return [*(Job(pathlib.Path(name).name, [program("lto", f"tests/{name}"), "--gtest_brief=1",
                                            "--gtest_filter=-" + ":".join(SLOW)]) for name in SERIAL),
            *tests_of("lto", {}, "continuum/continuum_tests", "verification/verification_tests",
                      "verification/claims_tests"),
            Job("study", [program("lto", "verification/latcon"), "study", "patterns", "--dry-run"]),
            crack("lto")]


def asan():
    leaks = {"ASAN_OPTIONS": "detect_leaks=1"}
    # MPI keeps memory until the process ends, some of it in unloaded modules, which no suppression can name.
    no_leaks = {"ASAN_OPTIONS": "detect_leaks=0"}
    tests = [*tests_of("debug", leaks, *SERIAL),
             *tests_of("debug", no_leaks, "verification/verification_tests", "continuum/continuum_tests")]
    ranks = [Job(name, ["mpirun", "--oversubscribe", "-np", "2", program("debug", f"tests/{folder}/{name}"),
                        "--gtest_brief=1"], dict(no_leaks, LATCON_RANKS="2"))
             for folder, name in (("lattice", "lattice_ranks_tests"), ("continuum", "continuum_tests"))]
    runs = [crack("debug", **no_leaks),
            latcon("debug", "relaxed", "lattice", CASES / "quick.prm", **no_leaks),
            latcon("debug", "hole", "continuum", CASES / "hole.prm", "--set", "Continuum/adaptive cycles=1",
                   "--set", "Continuum/degree=2", "--set", "Continuum/reaction tolerance=1", **no_leaks),
            latcon("debug", "shear-layer", "continuum", CASES / "shear_layer.prm", "--set", "Continuum/cells y=4",
                   **no_leaks)]
    return tests + ranks + runs


def tsan():
    archer = pathlib.Path(shutil.which("clang++")).resolve().parents[1] / "lib" / "libarcher.so"
    environment = {"OMP_NUM_THREADS": "3", "OMP_TOOL_LIBRARIES": str(archer),
                   "TSAN_OPTIONS": "ignore_noninstrumented_modules=1 report_signal_unsafe=0"}
    if platform.machine() == "x86_64":
        # Loads and stores of more than 16 bytes are not instrumented.
        environment["LATCON_INSTRUCTION_SET"] = "SSSE3"
    # Where the system places memory at random over a wide range, ThreadSanitizer cannot start.
    fixed = ["setarch", "--addr-no-randomize"]
    jobs = [*tests_of("clang", environment, *SERIAL),
            Job("motions", [program("clang", "tests/arm64/motion_bits")], environment),
            crack("clang", **environment)]
    for job in jobs:
        job.command = fixed + job.command
    return jobs


def valgrind():
    return [Job(pathlib.Path(name).name, ["valgrind", "--quiet", "--error-exitcode=1", "--leak-check=full",
                                          "--errors-for-leak-kinds=definite", f"--suppressions={HERE / 'valgrind.supp'}",
                                          program("release", f"tests/{name}"), "--gtest_brief=1",
                                          "--gtest_filter=-" + ":".join(SLOW)]) for name in SERIAL]


PARTS = {
    "lto": Part(lto, r"\[-Werror=(odr|lto-type-mismatch)\]|: Assertion '|^\[  FAILED  \] [^0-9]", "lto"),
    "clang": Part(lambda: [Job("built", ["true"])], MESSAGE, "clang"),
    "cppcheck": Part(cppcheck, MESSAGE),
    "tidy": Part(tidy, MESSAGE, "clang", ("verification/latcon_git_commit", *(f"{folder}/CMakeFiles/latcon_{folder}.dir/cmake_pch.hxx.pch"
                                          for folder in ("continuum", "verification")))),
    "asan": Part(asan, r"ERROR: (AddressSanitizer|LeakSanitizer)|runtime error:|^\[  FAILED  \] [^0-9]", "debug"),
    "tsan": Part(tsan, r"WARNING: ThreadSanitizer|^\[  FAILED  \] [^0-9]", "clang",
                 ("lattice_tests", "analysis_tests", "motion_bits", "latcon")),
    "valgrind": Part(valgrind, r"^==\d+== [A-Z]|^\[  FAILED  \] [^0-9]", "release", ("lattice_tests", "analysis_tests")),
}
