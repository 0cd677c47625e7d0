#!/usr/bin/python3
"""Mutates the shipped cases and studies and command-line options, and checks the outcome of latcon.

Usage: mutate.py FORK_SERVER [--inputs N] [--seed S] [--only NUMBER] [--failures DIR]

Exit codes 0, 2, 3 and 4 are allowed; 1 (a defect), 5 (a file that cannot be written), signals, reports of sanitizers and
timeouts are findings, as is any file after exit code 2 or a dry run. Inputs are determined by the seed alone. Failing inputs
are saved in DIR, with the command that repeats them.
"""
import argparse
import collections
import json
import os
import pathlib
import random
import shlex
import shutil
import sys
import tempfile
import time

sys.path.append(str(pathlib.Path(__file__).resolve().parents[1] / "verification"))
from forked import ForkServer

ROOT = pathlib.Path(__file__).resolve().parents[2]
CASES = sorted((ROOT / "verification" / "cases").glob("*.prm"))
STUDIES = sorted((ROOT / "verification" / "studies").glob("*.json"))
ALLOWED = {"exit 0", "exit 2", "exit 3", "exit 4"}
ALARMS = ("internal error", "runtime error:", "AddressSanitizer", "terminate called")

# Sizes small enough to run any case; larger cases are only run dry.
TINY = ["Sheet/length=9 mm", "Sheet/height=7 mm", "Time/end=0.02 ms", "Continuum/cells x=2", "Continuum/cells y=2",
        "Continuum/degree=2", "Fracture/seed sites=2", "Fracture/seed position=0.2"]
SHORT = 2.  # largest estimated time of a run [s]

NUMBERS = ["0", "1", "-1", "2", "0.5", "1e-3", "1e3", "1e9", "1e12", "1e20", "1e-20", "1e21", "1e-300", "1e300", "4.9e-324",
           "1.7976931348623157e308", "1e400", "1e-400", "-0", "nan", "inf", "-inf", "0x10", "1,5", "1.5.2", "1e", "--1", "+3",
           "2147483647", "2147483648", "4294967295", "4294967296", "18446744073709551615", "18446744073709551616", "1/0",
           "0.1 + 0.2", "auto", "true", "false", "none", "loading", "free", "", " ", "0.999999", "1.000001", "65536", "12"]
EXPRESSIONS = ["1/0", "0/0", "x", "y*0.01", "1/x", "1/(x-x)", "sqrt(-1)", "sqrt(x)", "log(0)", "sin(pi*x)", "1e300*x", "rand()",
               "x=3", "x,y", "((((", "if(x>0,1,0)", "x?1:0", "x ? 1/0 : 0", "2^2^2^2", "exp(1000)", "1e-6*(y>0)", "tan(y)", "\"",
               "min(1)", "x y", "0*x/0", "pi", "e", "_pi", "atan2(y,x)", "-x", "!x", "1e-4*cos(100*x)"]
WORDS = ["true", "false", "auto", "held", "free", "periodic", "loading", "clamped", "relaxed", "motion", "none", "isotropic", "lattice",
         "linear", "mooney-rivlin", "cauchy-born", "sites", "slit", "absorbing", "behind-tip", "retraction", "velocity-verlet",
         "runge-kutta-chebyshev", "rows-across-crack", "undeformed", "equilibrium", "generalised-alpha"]
UNITS = ["m", "mm", "um", "km", "Pa", "MPa", "s", "ms", "kg/m^3", "g/cm^3", "N s/m", "%", "deg", "1", "m/s", "furlong", "mm^-1",
         "m^99", "m/", "/s", "Pa s", "", "\xb5m"]
BYTES = [b"\0", b"\xff", b"\xef\xbb\xbf", b"\r", b"\r\n", b"\\\n", b"#", b"=", b"/", b"\x1b[2J", b"\xc3\x28", b"{", b"}", b"[", b"\"",
         b"end\n", b"subsection ", b"set ", b"include x\n", b"\t", b" " * 300, b"A" * 70000]


def case_lines(text):
    """[(section, name, value)] of a case."""
    entries, section = [], None
    for line in text.splitlines():
        words = line.split("#")[0].strip()
        if words.startswith("subsection "):
            section = words[len("subsection "):].strip()
        elif words.startswith("set ") and "=" in words:
            name, value = words[4:].split("=", 1)
            entries.append((section, name.strip(), value.strip()))
    return entries


def prm(entries):
    sections = collections.OrderedDict()
    for section, name, value in entries:
        sections.setdefault(section, []).append(f"  set {name} = {value}\n")
    return "".join(f"subsection {section}\n{''.join(lines)}end\n" for section, lines in sections.items())


class Mutator:
    def __init__(self, generator, full):
        self.pick = generator.choice
        self.random = generator
        self.full = full  # every entry with its default

    def typo(self, word):
        at = self.random.randrange(len(word) + 1)
        return self.pick([word[:at] + self.pick("abcxyz /=#-_é") + word[at:], word[:at] + word[at + 1:], word.upper(), word + " ", word[::-1], ""])

    def value(self, old):
        number, *unit = old.split() or ["1"]
        if self.random.random() < 0.5:  # a plausible value
            try:
                changed = float(number) * self.pick([0.5, 0.9, 0.99, 1., 1.01, 1.1, 1.5, 2.])
            except ValueError:
                return self.pick([old, self.pick(WORDS), self.pick(["true", "false", "0", "0.01*x", "1e-4*cos(100*y)"])])
            return " ".join([f"{changed:.6g}" if "." in number or "e" in number else str(round(changed)), *unit])
        number_of_any_kind = self.pick(NUMBERS)
        return self.pick([number_of_any_kind, number_of_any_kind, self.pick(EXPRESSIONS), f"{number} {self.pick(UNITS)}",
                          f"{number_of_any_kind} {self.pick(UNITS)}", self.pick(self.full)[2], self.typo(old), "-" + old, f"{old}, {old}",
                          old + "0", old.replace(".", ","), "1" + old])

    def entries(self, entries):
        """A mutation that respects the structure of a case."""
        entries = list(entries) or [self.pick(self.full)]
        at, other = self.random.randrange(len(entries)), self.random.randrange(len(entries))
        (section, name, old), own = entries[at], self.pick(self.full)
        kind = self.random.randrange(9)
        if kind == 0:
            entries.append((*own[:2], self.value(own[2])))
        elif kind == 4:
            del entries[at]
        elif kind == 5:
            entries.insert(other, entries[at])
        elif kind == 6:
            entries[at], entries[other] = (section, name, entries[other][2]), (*entries[other][:2], old)
        else:
            entries[at] = {7: (own[0], name, old), 8: self.pick([(self.typo(section), name, old), (section, self.typo(name), old)])}.get(
                kind, (section, name, self.value(old)))
        return entries

    def bytes(self, data):
        """A mutation of arbitrary bytes."""
        at = self.random.randrange(len(data) + 1)
        end = min(len(data), at + self.pick([1, 1, 2, 10, 100]))
        return self.pick([data[:at] + self.pick(BYTES) + data[at:], data[:at] + data[end:], data[:at],
                          data[:at] + bytes([self.random.randrange(256)]) + data[end:], data[:end] + data[at:],
                          data.replace(b"\n", b"\r\n"), data.replace(b"=", b" = = ", 1)])

    def tree(self, value):
        """A JSON tree with a value changed, removed, renamed or repeated somewhere in it."""
        if isinstance(value, (dict, list)) and value and self.random.random() < 0.85:
            value = value.copy()
            key = self.pick(list(value) if isinstance(value, dict) else range(len(value)))
            kind = self.random.random()
            if kind < 0.8:
                value[key] = self.tree(value[key])
            elif isinstance(value, list):
                value.insert(key, self.pick(value))
            elif kind < 0.9:
                del value[key]
            else:
                value[self.typo(key)] = value.pop(key)
            return value
        text = str(value)
        return self.pick([self.value(text), None, True, [], {}, [value, value], {"a": value}, [text, 1, [2]], text, [1, 2, 3],
                          self.pick([0, -1, 1e300, 1e-300, 2**63, 2**64, 0.1, -0.0])])

    def overrides(self, number):
        """Options that set entries, some of them misspelt."""
        for _ in range(number):
            section, name, old = self.pick(self.full)
            good = f"{section}/{name}={self.value(old)}"
            yield "--set"
            yield good if self.random.random() < 0.7 else self.pick(
                [f"{section}/{name}", f"{section}={old}", f"{name}={old}", self.typo(good), "/", "=", "/=",
                 f"{section}/{self.typo(name)}={old}", "A/B=C", f" {section} / {name} = {old} "])

    def repeat(self, step, what, likely):
        """Applies `step` a random number of times, mostly once."""
        for _ in range(self.pick(likely)):
            what = step(what)
        return what


def encoded(text):
    return text.encode("utf8", "surrogateescape")


def case_input(mutator):
    """@return files and arguments"""
    chance = mutator.random.random
    case = mutator.pick(CASES)
    base = list(mutator.full) if chance() < 0.25 else case_lines(case.read_text())
    entries = mutator.repeat(mutator.entries, base, [0, 1, 1, 1, 2, 3])
    name, data = "case.prm", encoded(prm(entries))
    if chance() < 0.25:
        document = collections.defaultdict(dict)
        for section, entry, value in entries:
            document[section][entry] = value
        name = mutator.pick(["case.json", "case.json", "case.JSON"])
        data = encoded(json.dumps(mutator.repeat(mutator.tree, dict(document), [0, 1])))
    if chance() < 0.1:
        data = mutator.repeat(mutator.bytes, data, [1, 1, 2, 4])
    # Mostly a command for which the case is intended.
    command = mutator.pick(["lattice", "continuum", "fracture", "verify"] if chance() < 0.2 else
                           {"hole": ["lattice", "continuum"], "shear_layer": ["continuum"]}.get(case.stem, ["lattice", "continuum", "fracture"]))
    arguments = [command, *["--case"] * (command == "verify"), name, *mutator.overrides(mutator.pick([0, 0, 0, 1, 1, 2]))]
    if command in ("lattice", "continuum") and chance() < 0.4:
        arguments += ["--set", command.capitalize() + "/solution=motion", "--set", "Time/end=0.01 ms"]
    if command == "fracture" and chance() < 0.5:
        arguments.append("--skip-verification")
    return {name: data}, arguments


def study_input(mutator):
    """@return files and arguments"""
    document = json.loads(mutator.pick(STUDIES).read_text())
    if mutator.random.random() < 0.7:  # short, so that the runs are planned soon
        if "sweep" in document:
            document["sweep"] = document["sweep"][:1]
        else:
            kept = set(mutator.random.sample(list(document["runs"]), min(3, len(document["runs"]))))
            document["runs"] = {name: run for name, run in document["runs"].items() if name in kept}
            document["claims"] = [dict(claim, rows=rows) for claim in document["claims"]
                                  if (rows := [row for row in claim["rows"] if set(row.get("runs", [row.get("run")])) <= kept])]
            document["pictures"] = [name for name in document.get("pictures", []) if name in kept] or sorted(kept)[:1]
    document.update(base="case.prm", seeds=[1])
    data = encoded(json.dumps(mutator.repeat(mutator.tree, document, [0, 1, 1, 1, 2, 3])))
    if mutator.random.random() < 0.2:
        data = mutator.repeat(mutator.bytes, data, [1, 1, 2])
    return {"study.json": data, "case.prm": mutator.pick(CASES[:1] + CASES[2:3]).read_bytes()}, [
        "study", "study.json", "--dry-run", *mutator.pick([[], ["--quick"]]), *mutator.overrides(mutator.pick([0, 0, 0, 1]))]


def odd_input(mutator):
    """Options and files that do not exist. @return files and arguments"""
    words = ["", "-", "--", "--set", "--set=", "--threads", "0", "-1", "1e9", "--threads=0", "--output-dir", "--output-dir=", "--quiet",
             "--dry-run", "--case", ".", "/", "/dev/null", "none.prm", "case.prm", "lattice", "continuum", "fracture", "verify", "study",
             "compare", "paper", "energy", "--quick", "--help", "--version", "--tolerance", "displacement=1", "--time", "nan",
             "\xff", "a" * 5000, "--resume", "--skip-verification", "--no-report"]
    return {"case.prm": CASES[0].read_bytes()}, [*mutator.random.choices(words, k=mutator.pick([1, 2, 3, 4, 6])), "--dry-run"]


def started(program, folder):
    """A fork server with verdicts of its own in `folder`, and settings for sanitizers."""
    suppressions = pathlib.Path(__file__).with_name("ubsan-suppressions.txt")
    return ForkServer(program, dict(os.environ, XDG_CACHE_HOME=str(folder / "cache"),
                                    ASAN_OPTIONS="detect_leaks=0:abort_on_error=0",
                                    UBSAN_OPTIONS=f"print_stacktrace=1:suppressions={suppressions}"))


class Subject:
    """Program that is given inputs, and the findings."""

    def __init__(self, options):
        self.options = options
        self.work = pathlib.Path(tempfile.mkdtemp(prefix="latcon-fuzz-"))
        self.server = started(options.server, self.work)
        self.counts = collections.Counter()
        self.failures = []

    def run(self, arguments, files=()):
        """@return outcome, standard error, standard output, names of files that are left"""
        folder = self.work / "input"
        shutil.rmtree(folder, ignore_errors=True)
        folder.mkdir()
        for name, data in dict(files).items():
            (folder / name).write_bytes(data)
        outcome = self.server.run(arguments, folder, self.options.limit)
        return outcome, self.server.stderr(), self.server.stdout(), sorted({path.name for path in folder.iterdir()} - set(files))

    def save(self, number, finding, arguments, files=()):
        folder = pathlib.Path(self.options.failures) / f"{type(self).__name__.lower()}-{self.options.seed}-{number}"
        shutil.rmtree(folder, ignore_errors=True)
        folder.mkdir(parents=True)
        for name, data in dict(files).items():
            (folder / name).write_bytes(data)
        (folder / "stdout").write_text(self.server.stdout())
        (folder / "stderr").write_text(self.server.stderr())
        (folder / "command.txt").write_text(f"{finding}\ncd {folder.resolve()} && latcon {shlex.join(arguments)}\n", errors="surrogateescape")
        self.failures.append(number)
        print(f"{number}: {finding}: {self.server.stderr().strip()[:200]}; see {folder}", flush=True)

    def close(self):
        self.server.close()
        shutil.rmtree(self.work, ignore_errors=True)


class Fuzzer(Subject):
    def __init__(self, options):
        super().__init__(options)
        _, error, printed, _ = self.run(["verify", "--case", "case.prm", "--dry-run"], {"case.prm": CASES[0].read_bytes()})
        self.full = case_lines(printed)
        if len(self.full) < 50:
            raise SystemExit("no resolved case:\n" + error)

    def judge(self, number, files, arguments):
        """Runs an input. @return its outcome and what it printed, None if that is a finding"""
        outcome, error, printed, left = self.run(arguments, files)
        self.counts[outcome] += 1
        finding = ""
        if outcome not in ALLOWED:
            finding = outcome
        elif any(alarm in error for alarm in ALARMS):
            finding = "alarm"
        elif left and (outcome == "exit 2" or "--dry-run" in arguments):
            finding = "files: " + " ".join(left)
        elif outcome not in ("exit 0", "exit 3") and not error.strip():
            finding = "no word of what is wrong"
        if finding:
            self.save(number, finding, arguments, files)
            return None
        return outcome, printed

    def check(self, number):
        random_ = random.Random(f"{self.options.seed}/{number}")
        mutator, kind = Mutator(random_, self.full), random_.random()
        files, arguments = (odd_input if kind < 0.05 else study_input if kind < 0.17 else case_input)(mutator)
        if kind < 0.17 or arguments[0] == "verify" or random_.random() > 0.2:
            self.judge(number, files, [*arguments, *[word for word in ("--dry-run", "--quiet") if word not in arguments]])
            return
        for entry in TINY:
            if not any(entry.split("=")[0] in word for word in arguments):
                arguments += ["--set", entry]
        if arguments[0] == "fracture":
            arguments += [word for word in ("--no-report", "--skip-verification") if word not in arguments]
        dry = self.judge(number, files, [*arguments, "--dry-run"])
        if dry and dry[0] == "exit 0" and self.is_short(dry[1]):
            self.counts["real runs"] += 1
            self.judge(number, files, arguments)

    @staticmethod
    def is_short(printed):
        """Returns whether a dry run estimates at most a few seconds and frames."""
        words = [line.split() for line in printed.splitlines() if line.startswith("# time: about ")]
        steps = [float(line.split(" steps")[0].split()[-1]) for line in printed.splitlines() if " steps" in line and line[0] == "#"]
        frames = [line.split("=")[1].split("#")[0].strip() for line in printed.splitlines() if "set frame interval" in line]
        return bool(words) and float(words[0][3]) <= SHORT and max(steps, default=0.) < 1e5 and (not frames or float(frames[0]) == 0. or
                                                                                              float(frames[0]) > 1e-6)


def campaign(description, words, default, limit, make):
    """Checks numbered inputs, as options choose. @param words what they are called @param make creates the object that checks one"""
    parser = argparse.ArgumentParser(description=description)
    parser.add_argument("server")
    parser.add_argument(f"--{words}", dest="count", type=int, default=default)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--first", type=int, default=0, help="number of the first")
    parser.add_argument("--only", type=int, help="number of a single one")
    parser.add_argument("--limit", type=float, default=limit, help="seconds that one may take")
    parser.add_argument("--failures", default=str(ROOT / "output" / "fuzz"))
    options = parser.parse_args()
    start = time.time()
    done = 0
    subject = make(options)
    try:
        for number in [options.only] if options.only is not None else range(options.first, options.first + options.count):
            subject.check(number)
            done += 1
            if sys.stdout.isatty() or done % 500 == 0:
                print(f"{done} {words}, {time.time() - start:.0f} s, {len(subject.failures)} findings", flush=True)
    except KeyboardInterrupt:
        print("interrupted")
    finally:
        subject.close()
    print(", ".join(f"{count} {outcome}" for outcome, count in sorted(subject.counts.items())), f"in {time.time() - start:.0f} s")
    print(f"{len(subject.failures)} findings of {done} {words}, seed {options.seed}")
    return 1 if subject.failures else 0


if __name__ == "__main__":
    sys.exit(campaign(__doc__.splitlines()[0], "inputs", 1000, 60., Fuzzer))
