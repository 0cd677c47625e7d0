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
        letter = self.pick("abcxyz /=#-_é")
        return self.pick([word[:at] + letter + word[at:], word[:at] + word[at + 1:], word.upper(), word + " ", word[::-1], ""])

    def value(self, old):
        words = old.split()
        number = words[0] if words else "1"
        if self.random.random() < 0.5:  # a plausible value
            try:
                changed = float(number) * self.pick([0.5, 0.9, 0.99, 1., 1.01, 1.1, 1.5, 2.])
                return " ".join([f"{changed:.6g}" if "." in number or "e" in number else str(round(changed)), *words[1:]])
            except ValueError:
                return self.pick([old, self.pick(WORDS), self.pick(["true", "false", "0", "0.01*x", "1e-4*cos(100*y)"])])
        return self.pick([lambda: self.pick(NUMBERS), lambda: self.pick(NUMBERS), lambda: self.pick(EXPRESSIONS),
                          lambda: number + " " + self.pick(UNITS), lambda: self.pick(NUMBERS) + " " + self.pick(UNITS),
                          lambda: self.pick(self.full)[2], lambda: self.typo(old), lambda: "-" + old, lambda: old + ", " + old,
                          lambda: old + "0", lambda: old.replace(".", ","), lambda: "1" + old])()

    def entries(self, entries):
        """A mutation that respects the structure of a case."""
        entries = list(entries)
        at = self.random.randrange(len(entries)) if entries else 0
        kind = self.random.randrange(9)
        if kind == 0 or not entries:
            section, name, old = self.pick(self.full)
            entries.append((section, name, self.value(old)))
        elif kind <= 3:
            section, name, old = entries[at]
            entries[at] = (section, name, self.value(old))
        elif kind == 4:
            del entries[at]
        elif kind == 5:
            entries.insert(self.random.randrange(len(entries)), entries[at])
        elif kind == 6:
            other = self.random.randrange(len(entries))
            (s, n, v), (s2, n2, v2) = entries[at], entries[other]
            entries[at], entries[other] = (s, n, v2), (s2, n2, v)
        elif kind == 7:
            entries[at] = (self.pick(self.full)[0],) + entries[at][1:]
        else:
            section, name, old = entries[at]
            entries[at] = self.pick([(self.typo(section), name, old), (section, self.typo(name), old)])
        return entries

    def bytes(self, data):
        """A mutation of arbitrary bytes."""
        at = self.random.randrange(len(data) + 1)
        end = min(len(data), at + self.pick([1, 1, 2, 10, 100]))
        return self.pick([lambda: data[:at] + self.pick(BYTES) + data[at:], lambda: data[:at] + data[end:], lambda: data[:at],
                          lambda: data[:at] + bytes([self.random.randrange(256)]) + data[end:], lambda: data[:end] + data[at:],
                          lambda: data.replace(b"\n", b"\r\n"), lambda: data.replace(b"=", b" = = ", 1)])()

    def json_value(self, value):
        """A JSON value of any kind that replaces another."""
        text = str(value)
        return self.pick([lambda: self.value(text), lambda: None, lambda: True, lambda: [], lambda: {}, lambda: [value, value],
                          lambda: {"a": value}, lambda: self.pick([0, -1, 1e300, 1e-300, 2**63, 2**64, 0.1, -0.0]),
                          lambda: [text, 1, [2]], lambda: text, lambda: [1, 2, 3]])()

    def json_of_case(self, entries):
        document = {}
        for section, name, value in entries:
            document.setdefault(section, {})[name] = value
        if self.random.random() < 0.5:
            section = self.pick(list(document) or ["Sheet"])
            if self.random.random() < 0.2:
                document[section] = self.json_value(document.get(section))
            elif document.get(section):
                name = self.pick(list(document[section]))
                document[section][name] = self.json_value(document[section][name])
        return json.dumps(document)

    def tree(self, value):
        """A JSON tree with a value changed, removed, renamed or moved somewhere in it."""
        if isinstance(value, dict) and value and self.random.random() < 0.85:
            value = dict(value)
            key = self.pick(list(value))
            kind = self.random.random()
            if kind < 0.8:
                value[key] = self.tree(value[key])
            elif kind < 0.9:
                del value[key]
            else:
                value[self.typo(key)] = value.pop(key)
            return value
        if isinstance(value, list) and value and self.random.random() < 0.85:
            value = list(value)
            at = self.random.randrange(len(value))
            if self.random.random() < 0.85:
                value[at] = self.tree(value[at])
            else:
                value.insert(at, value[self.random.randrange(len(value))])
            return value
        return self.json_value(value)

    def override(self):
        section, name, old = self.pick(self.full)
        good = f"{section}/{name}={self.value(old)}"
        if self.random.random() < 0.7:
            return good
        return self.pick([f"{section}/{name}", f"{section}={old}", f"{name}={old}", self.typo(good), "/", "=", "/=",
                          f"{section}/{self.typo(name)}={old}", "A/B=C", f" {section} / {name} = {old} "])

    def steps(self, step, what, likely):
        """Applies `step` a random number of times, mostly once."""
        for _ in range(self.pick(likely)):
            what = step(what)
        return what


Input = collections.namedtuple("Input", "files arguments")


def case_input(mutator):
    random_ = mutator.random
    case = mutator.pick(CASES)
    base = case_lines(case.read_text())
    if random_.random() < 0.25:
        base = list(mutator.full)
    entries = mutator.steps(mutator.entries, base, [0, 1, 1, 1, 2, 3])
    name = "case.prm"
    data = prm(entries).encode("utf8", "surrogateescape")
    if random_.random() < 0.25:
        name = mutator.pick(["case.json", "case.json", "case.JSON"])
        data = mutator.json_of_case(entries).encode("utf8", "surrogateescape")
    if random_.random() < 0.1:
        data = mutator.steps(mutator.bytes, data, [1, 1, 2, 4])
    # Mostly a command for which the case is intended.
    command = mutator.pick(["lattice", "continuum", "fracture", "verify"] if random_.random() < 0.2 else
                           {"hole": ["lattice", "continuum"], "shear_layer": ["continuum"]}.get(case.stem, ["lattice", "continuum", "fracture"]))
    arguments = [command, "case.prm"] if command != "verify" else [command, "--case", "case.prm"]
    arguments[-1] = name
    for _ in range(mutator.pick([0, 0, 0, 1, 1, 2])):
        arguments += ["--set", mutator.override()]
    if command in ("lattice", "continuum") and random_.random() < 0.4:
        arguments += ["--set", ("Lattice" if command == "lattice" else "Continuum") + "/solution=motion", "--set", "Time/end=0.01 ms"]
    if command == "fracture" and random_.random() < 0.5:
        arguments.append("--skip-verification")
    return Input({name: data}, arguments)


def study_input(mutator):
    document = json.loads(mutator.pick(STUDIES).read_text())
    sweeps = "sweep" in document
    names = [] if sweeps else list(document["runs"])
    kept = set(mutator.random.sample(names, min(3, len(names))))
    is_short = mutator.random.random() < 0.7  # so that the runs are planned soon
    if is_short and sweeps:
        document["sweep"] = document["sweep"][:1]
    elif is_short:
        document["runs"] = {name: run for name, run in document["runs"].items() if name in kept}
        document["claims"] = [dict(claim, rows=rows) for claim in document["claims"]
                              if (rows := [row for row in claim["rows"] if set(row.get("runs", [row.get("run")])) <= kept])]
        document["pictures"] = [name for name in document.get("pictures", []) if name in kept] or list(kept)[:1]
    document["base"] = "case.prm"
    document["seeds"] = [1]
    document = mutator.steps(mutator.tree, document, [0, 1, 1, 1, 2, 3])
    data = json.dumps(document).encode("utf8", "surrogateescape")
    if mutator.random.random() < 0.2:
        data = mutator.steps(mutator.bytes, data, [1, 1, 2])
    arguments = ["study", "study.json", "--dry-run"] + mutator.pick([[], ["--quick"]])
    for _ in range(mutator.pick([0, 0, 0, 1])):
        arguments += ["--set", mutator.override()]
    return Input({"study.json": data, "case.prm": mutator.pick(CASES[:1] + CASES[2:3]).read_bytes()}, arguments)


def odd_input(mutator):
    """Options and files that do not exist."""
    words = ["", "-", "--", "--set", "--set=", "--threads", "0", "-1", "1e9", "--threads=0", "--output-dir", "--output-dir=", "--quiet",
             "--dry-run", "--case", ".", "/", "/dev/null", "none.prm", "case.prm", "lattice", "continuum", "fracture", "verify", "study",
             "compare", "paper", "energy", "--quick", "--help", "--version", "--tolerance", "displacement=1", "--time", "nan",
             "\xff", "a" * 5000, "--resume", "--skip-verification", "--no-report"]
    files = {"case.prm": CASES[0].read_bytes()}
    return Input(files, [mutator.pick(words) for _ in range(mutator.pick([1, 2, 3, 4, 6]))] + ["--dry-run"])


def make_input(seed, number, full):
    random_ = random.Random(f"{seed}/{number}")
    mutator = Mutator(random_, full)
    kind = random_.random()
    if kind < 0.05:
        return odd_input(mutator), False
    if kind < 0.17:
        return study_input(mutator), False
    return case_input(mutator), random_.random() < 0.2


def started(program, folder):
    """A fork server with verdicts of its own in `folder`, and settings for sanitizers."""
    suppressions = pathlib.Path(__file__).with_name("ubsan-suppressions.txt")
    return ForkServer(program, dict(os.environ, XDG_CACHE_HOME=str(folder / "cache"),
                                    ASAN_OPTIONS="detect_leaks=0:abort_on_error=0",
                                    UBSAN_OPTIONS=f"print_stacktrace=1:suppressions={suppressions}"))


class Fuzzer:
    def __init__(self, options):
        self.options = options
        self.work = pathlib.Path(tempfile.mkdtemp(prefix="latcon-fuzz-"))
        self.server = started(options.server, self.work)
        self.limit = options.limit
        self.counts = collections.Counter()
        self.failures = []
        self.full = self.all_entries()

    def all_entries(self):
        folder = self.folder_of({"case.prm": CASES[0].read_bytes()})
        self.server.run(["verify", "--case", "case.prm", "--dry-run"], folder, 10 * self.limit)
        entries = case_lines(self.server.stdout())
        if len(entries) < 50:
            raise SystemExit("no resolved case:\n" + self.server.stderr())
        return entries

    def folder_of(self, files):
        folder = self.work / "input"
        shutil.rmtree(folder, ignore_errors=True)
        folder.mkdir()
        for name, data in files.items():
            (folder / name).write_bytes(data)
        return folder

    def run_once(self, files, arguments):
        """(outcome, finding or "", what it printed)"""
        folder = self.folder_of(files)
        outcome = self.server.run(arguments, folder, self.limit)
        printed, error = self.server.stdout(), self.server.stderr()
        left = sorted(path.name for path in folder.iterdir() if path.name not in files)
        finding = ""
        if outcome not in ALLOWED:
            finding = outcome
        elif any(alarm in error for alarm in ALARMS):
            finding = "alarm"
        elif left and (outcome == "exit 2" or "--dry-run" in arguments):
            finding = "files: " + " ".join(left)
        elif outcome != "exit 0" and not error.strip() and outcome != "exit 3":
            finding = "no word of what is wrong"
        self.counts[outcome] += 1
        return outcome, finding, printed

    def check(self, number):
        made, really = make_input(self.options.seed, number, self.full)
        arguments = made.arguments
        if really:
            command = arguments + [word for entry in TINY if not any(entry.split("=")[0] in word for word in arguments)
                                   for word in ("--set", entry)] + ([word for word in ["--no-report", "--skip-verification"] if word not in arguments] if arguments[0] == "fracture" else [])
            if arguments[0] in ("verify",):
                command = arguments + ["--dry-run"]
            outcome, finding, printed = self.run_once(made.files, command + ["--dry-run"])
            if not finding and outcome == "exit 0" and self.is_short(printed) and arguments[0] != "verify":
                arguments = command
                self.counts["real runs"] += 1
                _, finding, _ = self.run_once(made.files, arguments)
            else:
                arguments = command + ["--dry-run"]
        else:
            arguments = arguments + [word for word in ["--dry-run", "--quiet"] if word not in arguments]
            _, finding, _ = self.run_once(made.files, arguments)
        if finding:
            self.save(number, made.files, arguments, finding)

    @staticmethod
    def is_short(printed):
        """Returns whether a dry run estimates at most a few seconds and frames."""
        words = [line.split() for line in printed.splitlines() if line.startswith("# time: about ")]
        steps = [float(line.split(" steps")[0].split()[-1]) for line in printed.splitlines() if " steps" in line and line[0] == "#"]
        frames = [line.split("=")[1].split("#")[0].strip() for line in printed.splitlines() if "set frame interval" in line]
        return bool(words) and float(words[0][3]) <= SHORT and max(steps, default=0.) < 1e5 and (not frames or float(frames[0]) == 0. or
                                                                                              float(frames[0]) > 1e-6)

    def save(self, number, files, arguments, finding):
        folder = pathlib.Path(self.options.failures) / f"{self.options.seed}-{number}"
        shutil.rmtree(folder, ignore_errors=True)
        folder.mkdir(parents=True)
        for name, data in files.items():
            (folder / name).write_bytes(data)
        (folder / "stdout").write_text(self.server.stdout())
        (folder / "stderr").write_text(self.server.stderr())
        (folder / "command.txt").write_text(f"{finding}\ncd {folder.resolve()} && latcon " +
                                            " ".join("'" + word.replace("'", "'\\''") + "'" for word in arguments) + "\n",
                                            errors="surrogateescape")
        self.failures.append((number, finding))
        print(f"input {number}: {finding}; see {folder}", flush=True)

    def close(self):
        self.server.close()
        shutil.rmtree(self.work, ignore_errors=True)


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
