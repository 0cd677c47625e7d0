"""Quantities derived from the raw numbers (times per site, ratios, growth), and their targets."""
import math

from measure import best


def per_site(row):
    """Seconds per site and evaluation of the forces of a row of the part `sizes`."""
    return best(row["seconds"]) / (row["sites"] * row["evaluations"])


def by_size(part, stages):
    """sites -> threads -> row, small to large. @param stages of a step; 0: velocity Verlet"""
    result = {}
    for row in sorted(part["rows"], key=lambda row: row["sites"]):
        if row["stages"] == stages:
            result.setdefault(row["sites"], {})[row["threads"]] = row
    return result


def integrators(part):
    """Numbers of stages and names of the integrators of the part `sizes`."""
    return [(stages, "velocity Verlet" if stages == 0 else f"Runge-Kutta-Chebyshev of {stages} stages")
            for stages in sorted({row["stages"] for row in part["rows"]})]


def bytes_per_site(part, stages):
    """Growth of the peak memory from the second-largest sheet to the largest, on one thread."""
    small, large = [threads[1] for threads in by_size(part, stages).values()][-2:]
    return (large["peak_memory_bytes"] - small["peak_memory_bytes"]) / (large["sites"] - small["sites"])


def growth(part, stages, at_least=9e4):
    """Largest time per site over that of the smallest sheet of 10^5 sites or more, on one thread, minus one [-].
    @return NaN with fewer than two sizes, or where a time is NaN"""
    times = [per_site(threads[1]) for sites, threads in by_size(part, stages).items() if sites >= at_least]
    return max(times) / times[0] - 1. if len(times) > 1 and not any(map(math.isnan, times)) else math.nan


def lammps_row(row):
    """Seconds per site and step of each program, of a row of the part `lammps`."""
    work = row["sites"] * row["steps"]
    return {"lammps": best(row["lammps_seconds"][row["suffix"]]) / work, "linear": best(row["linear_seconds"]) / work,
            "everything": best(row["everything_seconds"]) / work}


def by_command(part):
    """(command, case) -> (ranks, threads) -> seconds."""
    result = {}
    for row in part["rows"]:
        result.setdefault((row["command"], row["case"]), {})[row["ranks"], row["threads"]] = row["seconds"]
    return result


def measured_text(crack, name):
    """A quantity of crack.json with its uncertainty, if it was measured."""
    return "-" if crack.get(name) is None else f"{crack[name]:.4g} ± {crack[name + '_uncertainty']:.1g}"


# Rows of the targets: quantity, value, aim, and whether the value is to be `most` or `least` the aim. Each function takes all
# parts that were measured, and has no rows if one that it needs is missing.


def kernel_rows(parts):
    rows = parts["kernel"]["rows"]
    alone = [best(row["seconds_per_site"]) for row in rows if row["work"] == "formulas" and not row["target"]]
    if not alone:
        return []
    return [(f"step with everything over root, quotient and force law alone, {row['sites']:,} sites",
             best(row["seconds_per_site"]) / alone[0], 2., "most")
            for row in rows if row["work"] == "everything" and not row["target"]]


def sizes_rows(parts):
    rows = []
    for stages, name in integrators(parts["sizes"]):
        rows += [(f"speed-up on 2 threads, {name}, {sites:,} sites", per_site(threads[1]) / per_site(threads[2]), 1.8, "least")
                 for sites, threads in by_size(parts["sizes"], stages).items()]
        rows.append((f"growth of the time per site from 10^5 sites on, {name}", growth(parts["sizes"], stages), 0.15, "most"))
    return rows


def ranks_rows(parts):
    aims = {"lattice": 1.8, "fracture": 1.7}
    return [(f"speed-up on 2 {what}, latcon {command}, {case}", best(times[1, 1]) / best(times[key]), aims[command], "least")
            for (command, case), times in by_command(parts["ranks"]).items()
            for what, key in (("threads", (1, 2)), ("ranks", (2, 1)))]


def fig1_rows(parts):
    aims = {"crack alone": 10., "crack alone, Runge-Kutta-Chebyshev": 6.}
    return [(f"{parts['fig1']['case']}, {row['command']} [s]", best(row["seconds"]), aims[row["command"]], "most")
            for row in parts["fig1"]["rows"] if row["command"] in aims]


def integrator_rows(parts):
    plain, stabilised = (best(row["seconds"]) for row in parts["integrator"]["rows"])
    return [("velocity Verlet over the stabilised integrator", plain / stabilised, 1., "least")]


def time_to_solution(parts):
    """Time of LAMMPS over that of latcon with Runge-Kutta-Chebyshev for the crack of the part `integrator`, if LAMMPS had its bonds
    at the price of linear ones: its time per site and step, in the sheet of the part `lammps` of nearest size, times the sites and
    the steps of velocity Verlet."""
    plain, stabilised = parts["integrator"]["rows"]
    sheet = min(parts["lammps"]["rows"], key=lambda row: abs(row["sites"] - plain["sites"]))
    steps = plain["crack"]["end_time"] / plain["time_step"]
    return lammps_row(sheet)["lammps"] * plain["sites"] * steps / best(stabilised["seconds"])


def solution_rows(parts):
    if "lammps" not in parts or not parts["integrator"]["rows"][0].get("sites"):
        return []
    return [(f"time to solution, LAMMPS-like stepping over latcon, {parts['integrator']['case']}", time_to_solution(parts), 12., "least")]


def fem_rows(parts):
    rows = []
    for problem in parts["fem"]["problems"]:
        if problem.get("dolfinx"):
            rows.append((f"dolfinx over latcon, {problem['unknowns']:,} unknowns", problem["ratio"],
                         3. if problem["unknowns"] < 2e5 else 4., "least"))
        rows.append((f"bytes per unknown, {problem['unknowns']:,} unknowns", problem["latcon"]["bytes_per_unknown"], 1800., "most"))
    return rows


ROWS = (("kernel", kernel_rows), ("sizes", sizes_rows), ("ranks", ranks_rows), ("fig1", fig1_rows),
        ("integrator", integrator_rows), ("integrator", solution_rows), ("fem", fem_rows))


def rows(parts):
    """Rows (quantity, measured, target, "" or "missed") of the measured quantities. A number that is none misses its target."""
    result = []
    for name, of_part in ROWS:
        for quantity, value, aim, sense in of_part(parts) if name in parts else ():
            reached = value <= aim if sense == "most" else value >= aim
            sign = "<=" if sense == "most" else ">="
            result.append([quantity, f"{value:.3g}", f"{sign} {aim:g}", "" if reached else "missed"])
    return result
