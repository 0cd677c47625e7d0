"""The parts of tests/clean/run: which programs each runs."""
import hashlib
import pathlib
import re
import shutil

from checks import LOGS, ROOT, Job, Part

SOURCES = ("support", "lattice", "continuum", "verification", "tests")
CASES = ROOT / "verification" / "cases"
HERE = ROOT / "tests" / "clean"
# What clang, clang-tidy and cppcheck print.
MESSAGE = r"^\S+:\d+:\d+: (warning|error|style|performance|portability)"


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


def with_headers(path, known):
    """The files of the project that a source is made of."""
    if path not in known:
        known[path] = {path}
        for name in re.findall(r'^\s*#\s*include "([^"]+)"', path.read_text(encoding="utf-8"), re.MULTILINE):
            for place in (ROOT / name, path.parent / name):
                if place.exists():
                    known[path] = known[path] | with_headers(place, known)
                    break
    return known[path]


def tidy():
    known = {}
    settings = (ROOT / ".clang-tidy").read_bytes()
    files = sorted(path for folder in ("support", "lattice", "continuum", "verification", "tests/lattice")
                   for path in (ROOT / folder).rglob("*.cc"))
    jobs = []
    for path in files:
        key = hashlib.sha256(settings)
        for part in sorted(with_headers(path, known)):
            key.update(part.read_bytes())
        name = path.relative_to(ROOT)
        jobs.append(Job(str(name), ["clang-tidy", "-p", "build/clang", "--quiet", name], key=key.hexdigest()))
    return jobs


def latcon(preset, name, *arguments, **environment):
    return Job(name, [program(preset, "verification/latcon"), *arguments, "--quiet",
                      "--output-dir", LOGS / "output" / f"{preset}-{name}"], environment)


def crack(preset, **environment):
    return latcon(preset, "crack", "fracture", CASES / "quick.prm", "--skip-verification", "--set", "Time/end=0.1 ms",
                  "--set", "Output/frame interval=0.05 ms", **environment)


def asan():
    leaks = {"ASAN_OPTIONS": "detect_leaks=1"}
    # MPI keeps memory until the process ends, some of it in modules unloaded by then, which no suppression can name.
    no_leaks = {"ASAN_OPTIONS": "detect_leaks=0"}
    tests = [Job(name, [program("debug", f"tests/{folder}/{name}"), "--gtest_brief=1"], environment)
             for folder, name, environment in (("lattice", "lattice_tests", leaks),
                                               ("verification", "verification_tests", no_leaks),
                                               ("verification", "compare_tests", no_leaks),
                                               ("continuum", "continuum_tests", no_leaks))]
    ranks = [Job(name, ["mpirun", "--oversubscribe", "-np", "2", program("debug", f"tests/{folder}/{name}"),
                        "--gtest_brief=1"], dict(no_leaks, LATCON_RANKS="2"))
             for folder, name in (("lattice", "lattice_ranks_tests"), ("continuum", "continuum_ranks_tests"))]
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
    # Where the system places memory at random over a wide range, ThreadSanitizer cannot start.
    fixed = ["setarch", "--addr-no-randomize"]
    jobs = [Job("lattice_tests", [program("clang", "tests/lattice/lattice_tests"), "--gtest_brief=1"], environment),
            crack("clang", **environment)]
    for job in jobs:
        job.command = fixed + job.command
    return jobs


# Minutes each under valgrind.
SLOW = ("Contact.LedgerCloses*", "Contact.GivesTheSameBits*", "*BitsDoNotDependOn*", "CrackMeasurement.*",
        "EnergyBalance.*", "Cutout.Relaxed*", "RungeKuttaChebyshev.Is*", "RungeKuttaChebyshev.ComesTo*",
        "RungeKuttaChebyshev/*", "TimeStepLimits.*", "Fracture/*", "EndLoads/*", "LinkCells.Show*", "CorrelatedNoise.*")


def valgrind():
    return [Job("lattice_tests", ["valgrind", "--quiet", "--error-exitcode=1", "--leak-check=full",
                                  "--errors-for-leak-kinds=definite", f"--suppressions={HERE / 'valgrind.supp'}",
                                  program("release", "tests/lattice/lattice_tests"), "--gtest_brief=1",
                                  "--gtest_filter=-" + ":".join(SLOW)])]


PARTS = {
    "clang": Part(lambda: [Job("built", ["true"])], MESSAGE, "clang"),
    "cppcheck": Part(cppcheck, MESSAGE),
    "tidy": Part(tidy, MESSAGE, "clang", ("latcon",)),
    "asan": Part(asan, r"ERROR: (AddressSanitizer|LeakSanitizer)|runtime error:|^\[  FAILED  \] [^0-9]", "debug"),
    "tsan": Part(tsan, r"WARNING: ThreadSanitizer|^\[  FAILED  \] [^0-9]", "clang", ("lattice_tests", "latcon")),
    "valgrind": Part(valgrind, r"^==\d+== [A-Z]|^\[  FAILED  \] [^0-9]", "release", ("lattice_tests",)),
}
