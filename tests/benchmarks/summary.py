"""Quantities derived from the raw numbers (times per site, ratios, growth), and their targets."""
from measure import best


def per_site(row):
    """Seconds per site and step of a row of the part `sizes`."""
    return best(row["seconds"]) / (row["sites"] * row["steps"])


def by_size(part):
    """sites -> threads -> row, small to large."""
    result = {}
    for row in sorted(part["rows"], key=lambda row: row["sites"]):
        result.setdefault(row["sites"], {})[row["threads"]] = row
    return result


def bytes_per_site(part):
    """Growth of the peak memory from the second-largest sheet to the largest, on one thread."""
    small, large = [threads[1] for threads in by_size(part).values()][-2:]
    return (large["peak_memory_bytes"] - small["peak_memory_bytes"]) / (large["sites"] - small["sites"])


def growth(part, at_least=9e4):
    """Largest time per site over that of the smallest sheet of 10^5 sites or more, on one thread, minus one [-]."""
    times = [per_site(threads[1]) for sites, threads in by_size(part).items() if sites >= at_least]
    return max(times) / times[0] - 1.


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


def kernel_rows(part):
    return [(f"ns per site and step, everything on, {row['sites']:,} sites", 1e9 * best(row["seconds_per_site"]), 10., "most")
            for row in part["rows"] if row["work"] == "everything" and not row["target"]]


def lammps_rows(part):
    rows = []
    for row in part["rows"]:
        times = lammps_row(row)
        ratio = times["lammps"] / times["linear"]
        rows.append((f"LAMMPS over latcon, linear bonds, {row['sites']:,} sites", ratio, 10., "least"))
    return rows


def sizes_rows(part):
    rows = [(f"speed-up on 2 threads, {sites:,} sites", per_site(threads[1]) / per_site(threads[2]), 1.8, "least")
            for sites, threads in by_size(part).items()]
    return rows + [("growth of the time per site from 10^5 sites on", growth(part), 0.15, "most")]


def ranks_rows(part):
    return [(f"speed-up on 2 ranks, latcon {command}, {case}", best(times[1, 1]) / best(times[2, 1]), 1.8, "least")
            for (command, case), times in by_command(part).items()]


def fig1_rows(part):
    return [(f"{part['case']}, {row['command']} [s]", best(row["seconds"]), 15., "most") for row in part["rows"]]


def integrator_rows(part):
    plain, stabilised = (best(row["seconds"]) for row in part["rows"])
    return [("velocity Verlet over the stabilised integrator", plain / stabilised, 1., "least")]


def fem_rows(part):
    return [(f"dolfinx over latcon, {problem['unknowns']:,} unknowns", problem["ratio"], 3., "least")
            for problem in part["problems"] if problem.get("dolfinx")]


ROWS = {"kernel": kernel_rows, "lammps": lammps_rows, "sizes": sizes_rows, "ranks": ranks_rows, "fig1": fig1_rows,
        "integrator": integrator_rows, "fem": fem_rows}


def rows(parts):
    """Rows (quantity, measured, target, "" or "missed") of the measured quantities."""
    result = []
    for name in (name for name in ROWS if name in parts):
        for quantity, value, aim, sense in ROWS[name](parts[name]):
            reached = value <= aim if sense == "most" else value >= aim
            sign = "<=" if sense == "most" else ">="
            result.append([quantity, f"{value:.3g}", f"{sign} {aim:g}", "" if reached else "missed"])
    return result
