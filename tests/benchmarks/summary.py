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


# Rows of the targets: quantity, value, aim, and whether the value is to be `most` or `least` the aim. Each function takes all
# parts that were measured, and has no rows if one that it needs is missing.


def kernel_rows(parts):
    seconds = {(row["work"], row["sites"]): best(row["seconds_per_site"]) for row in parts["kernel"]["rows"] if row["is_best"]}
    return [(f"step with everything over root, quotient and force law alone, {sites:,} sites",
             value / seconds["formulas", 64], 2., "most") for (work, sites), value in seconds.items() if work == "everything"]


def sizes_rows(parts):
    rows = []
    for stages, name in integrators(parts["sizes"]):
        rows += [(f"speed-up on 2 threads, {name}, {sites:,} sites", per_site(threads[1]) / per_site(threads[2]), 1.8, "least")
                 for sites, threads in by_size(parts["sizes"], stages).items()]
        rows.append((f"growth of the time per site from 10^5 sites on, {name}", growth(parts["sizes"], stages), 0.15, "most"))
    return rows


def ranks_rows(parts):
    one, two = map(best, parts["ranks"]["seconds"])
    return [(f"speed-up on 2 ranks, latcon lattice, {parts['ranks']['what']}", one / two, 1.8, "least")]


def time_to_solution(parts):
    """Time of LAMMPS over that of latcon with Runge-Kutta-Chebyshev for the crack of the part `crack`, if LAMMPS had its bonds at
    the price of linear ones: its time per site and step, in the sheet of the part `lammps` of nearest size, times the sites and the
    steps of velocity Verlet."""
    plain, stabilised = (parts["crack"]["rows"][name] for name in ("velocity Verlet", "Runge-Kutta-Chebyshev"))
    sheet = min(parts["lammps"]["rows"], key=lambda row: abs(row["sites"] - plain["sites"]))
    steps = plain["end_time"] / plain["time_step"]
    return lammps_row(sheet)["lammps"] * plain["sites"] * steps / best(stabilised["motion"])


def crack_rows(parts):
    case, rows = parts["crack"]["case"], parts["crack"]["rows"]
    motion = {name: best(row["motion"]) for name, row in rows.items()}
    result = [(f"speed-up on 2 {what}, {case}", motion["velocity Verlet"] / motion[f"velocity Verlet, 2 {what}"], 1.7, "least")
              for what in ("threads", "ranks")]
    result += [(f"{case}, {name}, 2 threads [s]", best(rows[f"{name}, 2 threads"]["seconds"]), aim, "most")
               for name, aim in (("velocity Verlet", 10.), ("Runge-Kutta-Chebyshev", 6.))]
    result.append((f"velocity Verlet over Runge-Kutta-Chebyshev, {case}",
                   motion["velocity Verlet"] / motion["Runge-Kutta-Chebyshev"], 1., "least"))
    if "lammps" in parts:
        result.append((f"time to solution, LAMMPS-like stepping over latcon, {case}", time_to_solution(parts), 12., "least"))
    return result


def fem_rows(parts):
    rows = []
    for problem in parts["fem"]["problems"]:
        case = f"degree {problem['degree']}, {problem['unknowns']:,} unknowns"
        is_quadratic = problem["degree"] == 2
        rows.append((f"dolfinx over latcon, {case}", problem["ratio"],
                     (3.2 if is_quadratic else 3.5) if problem["unknowns"] < 2e5 else 4.5 if is_quadratic else 5., "least"))
        rows.append((f"bytes per further unknown, {case}", problem["bytes_of_increase"], 1500. if is_quadratic else 2200., "most"))
    return rows


ROWS = {"kernel": kernel_rows, "sizes": sizes_rows, "ranks": ranks_rows, "crack": crack_rows, "fem": fem_rows}


def rows(parts):
    """Rows (quantity, measured, target, "" or "missed") of the measured quantities. A number that is none misses its target."""
    result = []
    for name, of_part in ROWS.items():
        for quantity, value, aim, sense in of_part(parts) if name in parts else ():
            reached = value <= aim if sense == "most" else value >= aim
            sign = "<=" if sense == "most" else ">="
            result.append([quantity, f"{value:.3g}", f"{sign} {aim:g}", "" if reached else "missed"])
    return result
