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
from measure import ENVIRONMENT, ROOT, Failed, Skipped, interleaved, on_ranks, run, run_json

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


def motion(plan, work, sites, steps, threads, *data, stages=0):
    """One repetition of a motion of the sheet by lattice_motion."""
    return run_json([plan.program("lattice_motion"), work, sites, steps, 1, threads, stages, *data])


def kernel(plan):
    """Steps on one thread for each kind of bonds and instruction set, and a force evaluation bond by bond."""
    program = plan.program("lattice_kernel")
    filters = {"": "^(formulas|reference/.*|step/.*/(10000|25000))$" if plan.quick else "."}
    for target in run([program, "--targets"]).split():
        filters[target] = "^(formulas|step/everything/25000)$" if plan.quick else "^(formulas|step/.*/(25000|1000000))$"
    rows = []
    for target, expression in filters.items():
        path = plan.folder("kernel") / "kernel.json"
        run([program, *([f"--target={target}"] if target else []), f"--benchmark_filter={expression}",
             f"--benchmark_repetitions={plan.rounds}", "--benchmark_enable_random_interleaving=true",
             f"--benchmark_min_time={0.02 if plan.quick else 0.3}", f"--benchmark_out={path}",
             "--benchmark_out_format=json"])
        rows += kernel_rows(json.loads(path.read_text(encoding="utf-8")), target)
    order = ("formulas", "everything", "nearest", "one_branch", "three_branches", "linear", "reference")
    return {"rows": sorted(rows, key=lambda row: (order.index(row["work"]), row["target"], row["sites"]))}


def kernel_rows(document, target):
    """Rows of Google Benchmark's output, one per kind of bonds and size, with repetitions in seconds per site and step.
    @param target requested instruction set; "" for the one chosen by the program"""
    rows = {}
    for entry in document["benchmarks"]:
        if entry["run_type"] != "iteration":
            continue
        if entry.get("error_occurred"):
            raise Failed(f"{entry['name']}: {entry['error_message']}")
        row = rows.setdefault(entry["run_name"], {
            "work": entry["run_name"].rsplit("/", 1)[0].removeprefix("step/"), "sites": round(entry["sites"]),
            "target": target, "used": document["context"].get("instruction_set", ""), "seconds_per_site": []})
        row["seconds_per_site"].append(entry["s/site"])
    return list(rows.values())


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


def latcon(plan, command, case, folder, *arguments, ranks=1, cache=None):
    """Runs latcon on a case. @return its run.json"""
    words = [plan.program("latcon"), command, case, "--quiet", "--output-dir", folder, *arguments]
    run(words if ranks == 1 else on_ranks(ranks, words), environment=cache and dict(ENVIRONMENT, XDG_CACHE_HOME=str(cache)))
    return json.loads((folder / "run.json").read_text(encoding="utf-8"))


def moving_sheet(plan):
    """Arguments of `latcon lattice` for a moving sheet, and its description."""
    side, steps = (100, 4) if plan.quick else (1000, 20)
    entries = {"Sheet/length": f"{0.625 * side} mm", "Sheet/height": f"{0.625 * 0.866 * side} mm",
               "Lattice/solution": "motion", "Time/integrator": "runge-kutta-chebyshev", "Time/step": "3e-6 s", "Time/end": f"{3e-6 * steps} s",
               "Output/frame interval": "0 s", "Output/energy interval": "1000000"}
    return [word for entry in entries.items() for word in ("--set", "=".join(entry))], f"{steps} steps of {side**2:,} sites"


def ranks(plan):
    """latcon on one core, on two threads and on two ranks: a moving sheet and a crack."""
    folder = plan.folder("ranks")
    sheet, what = moving_sheet(plan)
    crack = "quick.prm" if plan.quick else "fig1.prm"
    rows = []
    for command, case, name, phase, arguments in (
            ("lattice", "quick.prm", what, "motion", sheet),
            ("fracture", crack, crack, "fracture", ["--skip-verification", "--no-report"])):
        def once(n_ranks, threads):
            info = latcon(plan, command, CASES / case, folder / "run", *arguments, "--threads", threads, ranks=n_ranks)
            return info["wall_time_s"][phase]

        variants = {key: lambda key=key: once(*key) for key in ((1, 1), (1, 2), (2, 1))}
        for (n_ranks, threads), seconds in interleaved(variants, plan.rounds).items():
            rows.append({"command": command, "case": name, "ranks": n_ranks, "threads": threads, "seconds": seconds})
    shutil.rmtree(folder)
    return {"rows": rows}


def fig1(plan):
    """The crack of Fig. 1 from the command line: alone, with the preceding claims, and with its report."""
    folder = plan.folder("fig1")
    case = CASES / ("quick.prm" if plan.quick else "fig1.prm")
    words = {"crack alone": ["--skip-verification", "--no-report"],
             "crack alone, Runge-Kutta-Chebyshev": ["--skip-verification", "--no-report", *choice("runge-kutta-chebyshev")]}
    if not plan.quick:
        words.update({"with the claims": ["--no-report"], "with the claims and the report": []})

    def once(name):
        shutil.rmtree(folder / "cache", ignore_errors=True)  # cached verdicts would be reused
        start = time.perf_counter()
        info = latcon(plan, "fracture", case, folder / "run", "--threads", 2, *words[name], cache=folder / "cache")
        return {"seconds": time.perf_counter() - start, "phases": info["wall_time_s"]}

    results = interleaved({name: lambda name=name: once(name) for name in words}, plan.rounds)
    return {"case": case.name, "rows": [{"command": name, "seconds": [run["seconds"] for run in runs], "phases": runs[-1]["phases"]}
                                        for name, runs in results.items()]}


def integrator(plan):
    """The crack of Fig. 1 with velocity Verlet and with the stabilised integrator, on one thread."""
    case = CASES / ("quick.prm" if plan.quick else "fig1.prm")
    folder = plan.folder("integrator")
    names = ("velocity-verlet", "runge-kutta-chebyshev")
    try:
        stepping = {name: time_stepping(run([plan.program("latcon"), "fracture", case, "--dry-run", *choice(name)]))
                    for name in names}
    except Failed as error:
        raise Skipped("latcon has no entry `Time/integrator`") from error

    def once(name):
        info = latcon(plan, "fracture", case, folder, "--skip-verification", "--no-report", "--threads", "1", *choice(name))
        crack = json.loads((folder / "crack.json").read_text(encoding="utf-8"))
        return {"seconds": info["wall_time_s"]["fracture"],
                "crack": {key: value for key, value in crack.items() if not isinstance(value, (list, dict))}}

    results = interleaved({name: lambda name=name: once(name) for name in names}, plan.rounds)
    return {"case": case.name,
            "rows": [{"integrator": name, **stepping[name], "crack": runs[0]["crack"],
                      "seconds": [r["seconds"] for r in runs]} for name, runs in results.items()]}


def choice(name):
    return "--set", f"Time/integrator={name}"


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


PARTS = {"kernel": kernel, "lammps": against_lammps, "sizes": sizes, "ranks": ranks, "fig1": fig1,
         "integrator": integrator, "fem": fem, "messages": messages}
