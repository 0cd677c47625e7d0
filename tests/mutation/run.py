#!/usr/bin/python3
"""Introduces small faults into the sources, one at a time, and checks whether a test fails.

tests/mutation/run installs and builds the prerequisites and calls this script. Faults are introduced into a copy; the
checkout is not changed. A fault that no test detects is printed with its position: either a test is missing, or the fault has
no observable effect, which equivalents.txt then records with the reason.
"""
import argparse
import collections
import concurrent.futures
import json
import math
import pathlib
import shutil
import signal
import sys
import tempfile
import time

sys.dont_write_bytecode = True

import mutants
from equivalents import Equivalents
from scratch import SOURCE_NAMES, Scratch
from testing import Failed, GoogleTests, Ranks

ROOT = pathlib.Path(__file__).resolve().parents[2]
EQUIVALENTS = pathlib.Path(__file__).with_name("equivalents.txt")

# Sources to mutate, by the longest matching prefix, and the test programs that should detect the faults.
PLACES = {
    "support/": ["support_tests"],
    "lattice/": ["lattice_tests", "lattice_ranks_tests"],
    "continuum/": ["continuum_tests"],
    "continuum/damage/": ["continuum_damage_tests"],
    "continuum/stiffness_factor.h": ["continuum_damage_tests"],
    "verification/": ["verification_tests", "claims_tests"],
    "verification/analysis/": ["analysis_tests"],
    **dict.fromkeys(["verification/bridge/affine_displacement.h", "verification/bridge/bloch.", "verification/bridge/equivalent_sheet.",
                     "verification/bridge/homogenisation.cc", "verification/bridge/plane_waves.",
                     "verification/claims/continuum_waves.", "verification/claims/lattice_waves.", "verification/claims/order_fit.h",
                     "verification/claims/oscillation.", "verification/claims/damage/", "verification/claims/energy/",
                     "verification/claims/intrinsic_length/",
                     "verification/claims/prestretch/", "verification/claims/steady_crack/",
                     "verification/claims/wave_speeds/"], ["claims_tests", "verification_tests"]),
    "verification/compare/": ["compare_tests"],
    # Tested by scripts: commands, result files, messages.
    **dict.fromkeys(["support/child_process.", "support/mpi_session.", "verification/bridge/continuum_model.",
                     "verification/commands/", "verification/compare/difference_writer.", "verification/compare/quiet_vtk.",
                     "verification/main.cc", "verification/output/continuum_record.", "verification/output/crack_film.",
                     "verification/output/crack_record.", "verification/output/field_units.h", "verification/output/field_writer.",
                     "verification/output/frame_series.", "verification/output/motion_writer.", "verification/output/near_tip_record.",
                     "verification/output/near_tip_writer.", "verification/output/vtk_file.", "verification/linked.cc",
                     "verification/module.cc", "verification/elements/"], []),
}
PROGRAMS = {"support_tests": GoogleTests(), "lattice_tests": GoogleTests(), "lattice_ranks_tests": Ranks(3),
            "continuum_tests": GoogleTests(), "continuum_damage_tests": GoogleTests(), "analysis_tests": GoogleTests(),
            "claims_tests": GoogleTests(), "compare_tests": GoogleTests(), "verification_tests": GoogleTests()}


def programs_for(file):
    """Names of the test programs that should detect faults of a source."""
    return PLACES[max(filter(file.startswith, PLACES), key=len)]


def arguments():
    parser = argparse.ArgumentParser(prog="tests/mutation/run", description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--only", nargs="+", metavar="FILE", help="of these sources or folders, relative to the root; by "
                        "default all that test programs, and not scripts alone, are to see")
    parser.add_argument("--sample", type=int, metavar="N", help="N faults, drawn at random; by default all of them")
    parser.add_argument("--hours", type=float, metavar="H", help="begin no further fault after H hours, those without faults included")
    parser.add_argument("--seed", default="1", metavar="S", help="what the sample depends on (1)")
    parser.add_argument("--list", action="store_true", help="show the faults, plant none")
    parser.add_argument("--programs", nargs="+", choices=PROGRAMS, metavar="NAME", help="test programs to run instead of "
                        "those of the folder that a fault is in, of " + ", ".join(PROGRAMS))
    parser.add_argument("--jobs", type=int, default=1, metavar="N", help="faults planted at once (1)")
    parser.add_argument("--output", type=pathlib.Path, metavar="FILE", help="JSON file that gets every fault with its "
                        "verdict; what it says was killed before is not planted again")
    parser.add_argument("--at-least", type=float, default=0.9, metavar="SHARE", help="killed, or the exit status is 1 (0.9)")
    parser.add_argument("--root", type=pathlib.Path, default=ROOT, help="folder of the sources")
    parser.add_argument("--build", type=pathlib.Path, help="folder of the test programs (ROOT/build/release)")
    options = parser.parse_args()
    options.root = options.root.resolve()
    options.build = options.build or options.root / "build" / "release"
    return options


def files(root, only):
    """Names of the sources to mutate. @throws Failed for an unknown name"""
    known = [str(path.relative_to(root)) for folder in sorted({place.split("/")[0] for place in PLACES})
             for path in sorted((root / folder).rglob("*")) if path.suffix in SOURCE_NAMES]
    if not only:
        return [file for file in known if programs_for(file)]
    chosen = []
    for name in only:
        inside = [file for file in known if (root / file).is_relative_to((root / name).resolve())]
        if not inside:
            raise Failed(f"--only {name}: neither a source of the program nor a folder with some")
        chosen += inside
    return list(dict.fromkeys(chosen))


class Report:
    """Results so far, on the terminal and in a file."""

    def __init__(self, path, equivalents, chosen, n_all):
        self._path, self._equivalents, self._n_mutants, self._n_all = path, equivalents, len(chosen), n_all
        self._records = []
        self.survivors = []
        self.rest = list(chosen)  # mutants not yet tested
        if path and path.exists():
            known = {(r["file"], r["line"], r["before"], r["after"]): r
                     for r in json.loads(path.read_text(encoding="utf-8"))["mutants"] if r["outcome"] in ("killed", "no program")}
            for mutant in chosen:
                record = known.get((mutant.file, mutant.line, mutant.before.strip(), mutant.after.strip()))
                if record:
                    self._records.append(record)
                    self.rest.remove(mutant)

    def add(self, mutant, verdict, seconds):
        outcome = verdict.outcome
        reason = self._equivalents.reason(mutant) if outcome == "survived" else None
        if reason:
            outcome = "equivalent"
        elif outcome == "survived":
            self.survivors.append(mutant)
        self._records.append({"file": mutant.file, "line": mutant.line, "kind": mutant.kind, "before": mutant.before.strip(),
                              "after": mutant.after.strip(), "outcome": outcome, "by": reason or verdict.by,
                              "seconds": round(seconds, 1)})
        print(f"[{len(self._records)}/{self._n_mutants}] {outcome:10} {seconds:4.0f} s  {mutant.file}:{mutant.line} "
              f"{mutant.kind}  {verdict.by}", file=sys.stderr, flush=True)
        if self._path:
            self._path.parent.mkdir(parents=True, exist_ok=True)
            self._path.write_text(json.dumps({"score": self.score(), "mutants": self._records}, indent=1) + "\n",
                                  encoding="utf-8")

    def score(self, folder=""):
        """Killed mutants over detectable ones; None if there are none. Equivalent mutants and those that do not compile are
        excluded."""
        outcomes = collections.Counter(r["outcome"] for r in self._records if r["file"].startswith(folder))
        seen = outcomes["killed"] + outcomes["survived"]
        return outcomes["killed"] / seen if seen else None

    def uncertainty(self):
        """Wilson's 95 % interval for the score of the population of which these mutants are a sample."""
        n, p, z = sum(r["outcome"] in ("killed", "survived") for r in self._records), self.score(), 1.96
        centre, half = p + z**2 / (2 * n), z * math.sqrt(p * (1 - p) / n + z**2 / (4 * n**2))
        return [(centre + sign * half) / (1 + z**2 / n) for sign in (-1, 1)]

    def text(self):
        """Table of the folders and the survivors in full."""
        lines = [f"{'folder':14}{'killed':>8}{'survived':>10}{'equivalent':>12}{'no program':>12}{'score':>8}"]
        for folder in [*dict.fromkeys(r["file"].split("/")[0] + "/" for r in self._records), ""]:
            outcomes = collections.Counter(r["outcome"] for r in self._records if r["file"].startswith(folder))
            score = self.score(folder)
            lines.append(f"{folder or 'all':14}{outcomes['killed']:8}{outcomes['survived']:10}{outcomes['equivalent']:12}"
                         f"{outcomes['no program']:12}" + (f"{100. * score:6.1f} %" if score is not None else f"{'-':>8}"))
        if self.score() is not None and len(self._records) < self._n_all:
            low, high = self.uncertainty()
            lines.append(f"{len(self._records)} of {self._n_all} faults were planted; with 95 % confidence the score of all is between "
                         f"{100. * low:.1f} % and {100. * high:.1f} %")
        for mutant in sorted(self.survivors, key=lambda m: (m.file, m.line)):
            lines.append(f"\nsurvived: {mutant}")
        return "\n".join(lines)


def tested(chosen, options, report, deadline):
    """Tests the mutants and records each result in the report."""
    stages = {mutant.file: options.programs or programs_for(mutant.file) for mutant in chosen}
    names = {name for programs in stages.values() for name in programs}
    with tempfile.TemporaryDirectory(prefix="mutation-", dir=options.build.parent) as place:
        folder = pathlib.Path(place)
        scratch = Scratch(options.root, options.build, folder, {name: p for name, p in PROGRAMS.items() if name in names})
        print("Running tests without a fault", file=sys.stderr, flush=True)
        scratch.measure(options.build / "test_times")

        def test(number):
            start, own = time.monotonic(), folder / f"mutant-{number}"
            if start > deadline:
                return None
            verdict = scratch.test(chosen[number], stages[chosen[number].file], own)
            shutil.rmtree(own)
            return chosen[number], verdict, time.monotonic() - start

        with concurrent.futures.ThreadPoolExecutor(options.jobs) as pool:
            running = [pool.submit(test, number) for number in range(len(chosen))]
            try:
                for done in concurrent.futures.as_completed(running):
                    if done.result():
                        report.add(*done.result())
            except BaseException:
                pool.shutdown(cancel_futures=True)
                raise


def main():
    signal.signal(signal.SIGTERM, lambda *_: sys.exit(143))  # so that the copy is deleted
    options = arguments()
    deadline = math.inf if options.hours is None else time.monotonic() + 3600. * options.hours
    try:
        chosen = [mutant for file in files(options.root, options.only)
                  for mutant in mutants.of_file(options.root / file, file)]
        n_all = len(chosen)
        if not options.list or options.sample is not None:
            chosen = mutants.in_random_order(chosen, options.seed)[:options.sample]
        if options.list:
            print("\n".join(map(str, chosen)))
            return 0
        equivalents = Equivalents.read(EQUIVALENTS)
        if outdated := equivalents.outdated(lambda file: mutants.of_file(ROOT / file, file)):
            raise ValueError(f"{EQUIVALENTS.name} has entries that are no faults of the sources: {outdated}")
        report = Report(options.output, equivalents, chosen, n_all)
        if report.rest:
            tested(report.rest, options, report, deadline)
    except (Failed, OSError, ValueError) as error:
        print(f"tests/mutation/run: {error}", file=sys.stderr)
        return 2
    print(report.text())
    score = report.score()
    return 1 if score is not None and score < options.at_least else 0


if __name__ == "__main__":
    sys.exit(main())
