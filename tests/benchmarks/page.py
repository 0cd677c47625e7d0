"""Tables of measurements, for the terminal and for docs/performance.txt."""
import dataclasses
import math

import summary
from measure import best, spread


@dataclasses.dataclass(frozen=True)
class Table:
    title: str
    header: list
    rows: list
    note: str = ""

    def text(self):
        """Text for a terminal: the first column left-aligned, the others right-aligned."""
        lines = [self.header, *self.rows]
        widths = [max(len(line[i]) for line in lines) for i in range(len(self.header))]
        cells = ["  ".join([line[0].ljust(widths[0]), *(c.rjust(w) for c, w in zip(line[1:], widths[1:]))]).rstrip()
                 for line in lines]
        return "\n".join([self.title, "", cells[0], "-" * max(map(len, cells)), *cells[1:],
                          *(["", self.note] if self.note else [])]) + "\n"


def number(value):
    return f"{value:,}"


def ns(seconds):
    return f"{1e9 * seconds:.1f}"


def per_cent(value):
    return f"{100. * value:.0f} %"


def seconds_text(seconds):
    return f"{seconds:.2f}" if seconds < 100 else f"{seconds:.0f}"


def kernel_table(part):
    rows = [[row["work"], row["target"], number(row["sites"]), ns(best(row["seconds_per_site"])),
             per_cent(spread(row["seconds_per_site"]))] for row in part["rows"]]
    note = ("`everything`: Mooney-Rivlin bonds to twelve neighbours, dashpots, breaking and toughening; `nearest`: the same "
            "with six neighbours; `one_branch`, `three_branches`: `everything` with Maxwell branches in all bonds; "
            "`linear`: only linear bonds to twelve neighbours; `formulas`: root, quotient and force law of six bonds per site "
            "alone, in the first-level cache.")
    return [Table("Kernel, one core", ["bonds", "instruction set", "sites", "ns per site and step", "spread"], rows, note)]


def lammps_table(part):
    rows = []
    for row in part["rows"]:
        numbers = summary.lammps_row(row)
        energy = max(row[name]["difference"] for name in ("potential_energy", "kinetic_energy"))
        rows.append([number(row["sites"]), number(row["steps"]), ns(numbers["lammps"]), ns(numbers["linear"]),
                     ns(numbers["everything"]), f"{numbers['lammps'] / numbers['linear']:.1f}",
                     f"{numbers['lammps'] / numbers['everything']:.1f}", f"{energy:.0e}", f"{row['tolerance']:.0e}"])
    suffixes = ", ".join("plain" if suffix == "none" else f"`-suffix {suffix}`" for suffix in part["suffixes"])
    header = ["sites", "steps", "LAMMPS", "linear", "everything", "LAMMPS / linear", "LAMMPS / everything",
              "energies differ", "allowed"]
    note = (f"LAMMPS {part['version']}; its versions of harmonic bonds: {suffixes}. Times in ns per site and step. "
            "Energies agree within round-off.")
    return [Table("Against LAMMPS, one core", header, rows, note)]


def sizes_table(part):
    rows = []
    for stages, name in summary.integrators(part):
        for sites, threads in summary.by_size(part, stages).items():
            one, two = threads[1], threads[2]
            rows.append([name, number(sites), ns(summary.per_site(one)), ns(summary.per_site(two)),
                         f"{summary.per_site(one) / summary.per_site(two):.2f}", per_cent(spread(one["seconds"])),
                         per_cent(spread(two["seconds"])), f"{one['peak_memory_bytes'] / 2**20:.0f}"])
    header = ["integrator", "sites", "1 thread [ns]", "2 threads [ns]", "speed-up", "spread, 1", "spread, 2", "peak memory [MiB]"]
    memory = " and ".join(f"{summary.bytes_per_site(part, stages):.0f} ({name})" for stages, name in summary.integrators(part))
    note = (f"All features on; times per site and evaluation of the forces. Bytes per site: {memory}, from the growth of the peak "
            "memory between the two largest sheets.")
    return [Table("Sizes and threads", header, rows, note)]


def ranks_table(part):
    one, two = map(best, part["seconds"])
    return [Table("A sheet on two ranks", ["`latcon lattice`", "1 core [s]", "speed-up, 2 ranks", "largest spread"],
                  [[part["what"], seconds_text(one), f"{one / two:.2f}", per_cent(max(map(spread, part["seconds"])))]],
                  "Time of the motion, without setup.")]


def crack_table(part):
    rows = []
    for name, row in part["rows"].items():
        evaluations = round(row["end_time"] / row["time_step"] * row["stages"])
        rows.append([name, seconds_text(best(row["seconds"])), per_cent(spread(row["seconds"])), seconds_text(best(row["motion"])),
                     f"{row['time_step']:.3g}", number(evaluations),
                     ", ".join(f"{phase} {seconds_text(value)}" for phase, value in row["phases"].items())])
    header = ["run", "[s]", "spread", "motion [s]", "time step [s]", "evaluations", "phases of the last run [s]"]
    return [Table(f"The crack of {part['case']}", header, rows)]


def fem_table(part):
    rows = []
    for problem in part["problems"]:
        ours, two, theirs = (problem[name] for name in ("latcon", "latcon_2_ranks", "dolfinx"))
        phases = [seconds_text(ours[name]) for name in ("assembly", "preconditioner", "linear_solve")]
        rows.append([number(problem["unknowns"]), str(problem["degree"]), seconds_text(ours["seconds"]), " + ".join(phases),
                     f"{ours['seconds'] / two['seconds']:.2f}", seconds_text(theirs["seconds"]), f"{problem['ratio']:.1f}",
                     " ".join(map(str, ours["krylov_iterations"])), f"{ours['bytes_per_unknown']:.0f}",
                     f"{theirs['bytes_per_unknown']:.0f}", f"{problem['energy_difference']:.0e}"])
    header = ["unknowns", "degree", "latcon [s]", "assembly + preconditioner + solution [s]", "speed-up, 2 ranks",
              "dolfinx [s]", "dolfinx / latcon", "Krylov iterations", "bytes per unknown", "dolfinx's", "energies differ"]
    return [Table("Finite elements against dolfinx", header, rows)]


def messages_table(part):
    rows = [[number(entry["bytes"]), f"{1e6 * best(entry['seconds']):.2f}",
             f"{1e-9 * entry['bytes'] / best(entry['seconds']):.2f}"] for entry in part["exchanges"]]
    return [Table("Messages between two ranks of this machine", ["bytes each way", "[us]", "[GB/s]"], rows,
                  f"Sum of one number over both ranks: {1e6 * best(part['allreduce_seconds']):.2f} us.")]


def model_tables(parts):
    """Efficiency on many ranks as the model of docs/performance.md predicts, if all that it needs was measured."""
    if "sizes" not in parts or "messages" not in parts:
        return []
    times = {entry["bytes"]: best(entry["seconds"]) for entry in parts["messages"]["exchanges"]}
    # Latency of the shortest message [s], lowest bandwidth of messages as long as two rows [byte/s], sum of two ranks [s].
    here = (times[min(times)], min(size / seconds for size, seconds in times.items() if 2**14 <= size <= 2**20),
            best(parts["messages"]["allreduce_seconds"]))
    network = (2e-6, 5e9, 4e-6)
    # Both cores at work, as on a node of a cluster: they share the memory.
    site_seconds = 2. * summary.per_site(max(summary.by_size(parts["sizes"], 0).items())[1][2])

    def efficiency(latency, bandwidth, reduction, columns, sites, ranks):
        # Two rows of positions and velocities to either neighbour, and a sum over all ranks; nothing overlaps.
        messages = 2. * (latency + 64. * columns / bandwidth) + math.log2(ranks) * reduction
        return sites * site_seconds / (sites * site_seconds + messages)

    rows = [[number(columns), number(sites), *(per_cent(efficiency(*machine, columns, sites, ranks))
                                               for machine in (here, network) for ranks in (16, 1024))]
            for columns in (1_000, 10_000) for sites in (10_000, 100_000, 1_000_000)]
    latency, bandwidth, reduction = here
    note = (f"From the model above with t_site = {ns(site_seconds)} ns (two busy threads, largest sheet), and messages as "
            f"measured here (latency {1e6 * latency:.2f} us, {1e-9 * bandwidth:.2f} GB/s, reduction "
            f"{1e6 * reduction:.2f} us) or as assumed for a network (2 us, 5 GB/s, 4 us).")
    header = ["sites per row", "sites per rank", "16 ranks", "1024 ranks", "16, network", "1024, network"]
    return [Table("Predicted efficiency on many ranks", header, rows, note)]


TABLES = {"kernel": kernel_table, "lammps": lammps_table, "sizes": sizes_table, "ranks": ranks_table,
          "crack": crack_table, "fem": fem_table, "messages": messages_table}


def tables(document):
    """All tables of a document (see run.py), the targets first."""
    parts = document["parts"]
    asked = summary.rows(parts)
    result = [Table("Targets", ["quantity", "measured", "target", ""], asked)] if asked else []
    for name, make in TABLES.items():
        if name in parts:
            result += make(parts[name])
    return result + model_tables(parts)


def machine_text(document):
    machine = document["machine"]
    processor = machine["processor"]
    caches = ", ".join(f"{name} {size}" for name, size in processor["caches"].items())
    size = ", small versions, not representative" if document["quick"] else ""
    return (f"{processor['model']} (family {processor['family']}, {processor['vectors']}), {processor['cores']} cores, "
            f"{caches}, {machine['memory_bytes'] / 2**30:.0f} GiB; {machine['compiler']}, {machine['build_type']}; commit "
            f"{machine['commit']}, {machine['date']}{size}.")


def text(document):
    """Text for the terminal."""
    reasons = document["skipped"] | document["failed"]
    notes = [f"{name}: not measured, {reason}" for name, reason in reasons.items()]
    return "\n".join([machine_text(document) + "\n", *(table.text() for table in tables(document)), *notes])
