#!/usr/bin/python3
"""Plants small faults in the sources, one at a time, and sees whether a test fails.

tests/mutation/run installs and builds what is needed and calls this. Faults are planted in a copy; nothing in the
checkout changes. A fault that no test sees is printed with its place: either a test is missing, or the fault changes
nothing that can be observed, which equivalents.txt says of it with the reason.
"""
import argparse
import collections
import concurrent.futures
import json
import pathlib
import shutil
import signal
import sys
import tempfile
import time

sys.dont_write_bytecode = True

import mutants
from equivalents import Equivalents
from scratch import Scratch
from testing import Failed, GoogleTests, Ranks

ROOT = pathlib.Path(__file__).resolve().parents[2]
EQUIVALENTS = pathlib.Path(__file__).with_name("equivalents.txt")

# What carries the physics, by folder; and the test programs that are to see a fault there.
FILES = {
    "lattice": ["bond_law.h", "bond_force.inc", "chebyshev_stages.cc", "contact.cc", "end_loads.cc", "energy.cc", "energy.h",
                "forces.cc", "fracture.cc", "integrator.cc", "link_cells.cc", "material.cc", "row_kernels.cc",
                "runge_kutta_chebyshev.cc", "simulation.cc", "state.cc", "time_step.cc", "triangular_lattice.cc",
                "velocity_verlet.cc"],
    "continuum": ["cauchy_born.cc", "dynamic_ledger.cc", "dynamic_step.cc", "element_integrals.cc", "element_kernels.cc",
                  "fibres.cc", "gradient_law.cc", "isotropic_gradient.cc", "lattice_gradient.cc", "local_to_global.cc",
                  "material.cc", "mooney_rivlin.cc", "point_density.cc", "sheet_assembly.cc", "viscosity.cc",
                  "viscous_forces.cc"],
    "verification": ["affine_displacement.h", "homogenisation.cc", "order_fit.h", "energy/energy_claim.cc",
                     "energy/wave_energy.cc", "intrinsic_length/dispersion.cc", "intrinsic_length/edge_layer.cc",
                     "intrinsic_length/gradient_positivity.cc", "intrinsic_length/intrinsic_length_claim.cc",
                     "prestretch/cut_claim.cc", "prestretch/cut_comparison.cc", "prestretch/cut_lattice.cc",
                     "prestretch/cut_study.cc", "prestretch/equivalent_sheet.cc", "prestretch/prestretch_claim.cc",
                     "bloch.cc", "wave_speeds/continuum_waves.cc", "wave_speeds/lattice_waves.cc",
                     "wave_speeds/oscillation.cc", "plane_waves.cc", "wave_speeds/wave_speeds_claim.cc"]}
STAGES = {"lattice": ["lattice_tests", "lattice_ranks_tests"], "continuum": ["continuum_tests"],
          "verification": ["claims_tests"]}
PROGRAMS = {"lattice_tests": GoogleTests(), "lattice_ranks_tests": Ranks(3), "continuum_tests": GoogleTests(),
            "claims_tests": GoogleTests(), "verification_tests": GoogleTests()}


def arguments():
    parser = argparse.ArgumentParser(prog="tests/mutation/run", description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--only", nargs="+", metavar="FILE", help="of these sources or folders, relative to the root; by "
                        "default those that carry the physics")
    parser.add_argument("--sample", type=int, metavar="N", help="N faults, in turns from each file; by default all of them")
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
    """Names of the sources to plant faults in. @throws Failed for a name that is none"""
    standard = [f"{folder}/{name}" for folder, names in FILES.items() for name in names]
    if not only:
        return standard
    chosen = []
    for name in only:
        path = (root / name).resolve()
        inside = [f for f in standard if (root / f).is_relative_to(path)]
        if path.is_file() and path.is_relative_to(root) and path.relative_to(root).parts[0] in FILES:
            inside = [str(path.relative_to(root))]
        if not inside:
            raise Failed(f"--only {name}: neither a source of {', '.join(FILES)} nor a folder with some that are listed")
        chosen += inside
    return list(dict.fromkeys(chosen))


class Report:
    """What came out so far, on the screen and in a file."""

    def __init__(self, path, equivalents, chosen):
        self._path, self._equivalents, self._n_mutants = path, equivalents, len(chosen)
        self._records = []
        self.survivors = []
        self.rest = list(chosen)  # still to be planted
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
        """Killed among those that can be seen; None if there are none. Equivalent ones and those that do not compile do
        not count."""
        outcomes = collections.Counter(r["outcome"] for r in self._records if r["file"].startswith(folder))
        seen = outcomes["killed"] + outcomes["survived"]
        return outcomes["killed"] / seen if seen else None

    def text(self):
        """Table of the folders and the survivors in full."""
        lines = [f"{'folder':14}{'killed':>8}{'survived':>10}{'equivalent':>12}{'no program':>12}{'score':>8}"]
        for folder in [*dict.fromkeys(r["file"].split("/")[0] + "/" for r in self._records), ""]:
            outcomes = collections.Counter(r["outcome"] for r in self._records if r["file"].startswith(folder))
            score = self.score(folder)
            lines.append(f"{folder or 'all':14}{outcomes['killed']:8}{outcomes['survived']:10}{outcomes['equivalent']:12}"
                         f"{outcomes['no program']:12}" + (f"{100. * score:6.1f} %" if score is not None else f"{'-':>8}"))
        for mutant in sorted(self.survivors, key=lambda m: (m.file, m.line)):
            lines.append(f"\nsurvived: {mutant}")
        return "\n".join(lines)


def tested(chosen, options, report):
    """Plants the mutants and has the report take note of each."""
    stages = {folder: options.programs or names for folder, names in STAGES.items()}
    names = {name for mutant in chosen for name in stages[mutant.folder]}
    with tempfile.TemporaryDirectory(prefix="mutation-", dir=options.build.parent) as place:
        folder = pathlib.Path(place)
        scratch = Scratch(options.root, options.build, folder, {name: p for name, p in PROGRAMS.items() if name in names})
        print("Running tests without a fault", file=sys.stderr, flush=True)
        scratch.measure(options.build / "test_times")

        def test(number):
            start, own = time.monotonic(), folder / f"mutant-{number}"
            verdict = scratch.test(chosen[number], stages[chosen[number].folder], own)
            shutil.rmtree(own)
            return chosen[number], verdict, time.monotonic() - start

        with concurrent.futures.ThreadPoolExecutor(options.jobs) as pool:
            running = [pool.submit(test, number) for number in range(len(chosen))]
            try:
                for done in concurrent.futures.as_completed(running):
                    report.add(*done.result())
            except BaseException:
                pool.shutdown(cancel_futures=True)
                raise


def main():
    signal.signal(signal.SIGTERM, lambda *_: sys.exit(143))  # so that the copy goes
    options = arguments()
    try:
        chosen = [mutant for file in files(options.root, options.only)
                  for mutant in mutants.of_file(options.root / file, file)]
        if options.sample is not None:
            chosen = mutants.sample(chosen, options.sample, options.seed)
        if options.list:
            print("\n".join(map(str, chosen)))
            return 0
        equivalents = Equivalents.read(EQUIVALENTS)
        report = Report(options.output, equivalents, chosen)
        if report.rest:
            tested(report.rest, options, report)
    except (Failed, OSError, ValueError) as error:
        print(f"tests/mutation/run: {error}", file=sys.stderr)
        return 2
    print(report.text())
    score = report.score()
    return 1 if score is not None and score < options.at_least else 0


if __name__ == "__main__":
    sys.exit(main())
