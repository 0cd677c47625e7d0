"""LAMMPS input of a sheet, and parsing of LAMMPS's log."""
import pathlib
import re

from measure import Failed, run

INPUT = pathlib.Path(__file__).with_name("sheet.lammps").read_text(encoding="utf-8")
DUMP = "dump positions all custom {steps} {file} id x y\ndump_modify positions sort id format float %.17g\n"


def input_text(data, time_step, steps, repetitions, positions=None):
    """Input for `steps` untimed steps and `repetitions` timed runs of as many. @param positions file for the positions
    before and after each run"""
    return INPUT.format(data=data, time_step=time_step, steps=steps,
                        dump="" if positions is None else DUMP.format(steps=steps, file=positions),
                        runs="\n".join([f"run {steps}"] * (repetitions + 1)))


def read_positions(text):
    """{step: [(x, y) of each site, by number]} [m] from the file of positions of `input_text`."""
    frames = {}
    for part in text.split("ITEM: TIMESTEP\n")[1:]:
        header, rows = part.split("ITEM: ATOMS id x y")
        frames[int(header.split("\n")[0])] = [tuple(map(float, row.split()[1:])) for row in rows.strip().split("\n")]
    return frames


def read_log(text):
    """Results of each run in a log: {"steps", "seconds", "potential_energy", "kinetic_energy"} at its end."""
    runs = []
    pattern = re.compile(r"^Step PotEng KinEng\s*\n((?:[ \t]*\d+[ \t]+\S+[ \t]+\S+[ \t]*\n)+)"
                         r"Loop time of (\S+) on (\d+) procs for (\d+) steps", re.MULTILINE)
    for rows, seconds, processes, steps in pattern.findall(text):
        if processes != "1":
            raise Failed(f"LAMMPS ran on {processes} processes")
        _, potential, kinetic = rows.split("\n")[-2].split()
        runs.append({"steps": int(steps), "seconds": float(seconds), "potential_energy": float(potential),
                     "kinetic_energy": float(kinetic)})
    if not runs or "Total wall time" not in text:
        raise Failed("the log of LAMMPS has no whole run")
    return runs


def suffixes(help_text):
    """Suffixes of the accelerated harmonic bonds listed by `lmp -h`; "none" is the plain version."""
    match = re.search(r"\* Bond styles:\s*\n(.*?)\n\s*\n?\* ", help_text, re.DOTALL)
    if not match:
        raise Failed("`lmp -h` lists no bond styles")
    names = re.findall(r"\bharmonic(?:/(\w+))?(?=\s|$)", match.group(1))
    return ["none" if name == "" else name for name in names if name in ("", "omp", "intel", "opt")]


def version(help_text):
    """Version in the first line of `lmp -h`."""
    match = re.search(r"Massively Parallel Simulator - (.+)", help_text)
    return match.group(1).strip() if match else "unknown"


def move(folder, suffix):
    """Runs the input `in.sheet` of a folder on one core. @return result of read_log()"""
    version_of_bonds = "off" if suffix == "none" else suffix
    run(["lmp", "-in", "in.sheet", "-log", "log.sheet", "-screen", "none", "-suffix", version_of_bonds], folder=folder)
    return read_log((folder / "log.sheet").read_text(encoding="utf-8"))


def energy_tolerance(sites, columns, steps):
    """Bound on the relative difference of energies due to round-off: one rounding per term of a sum over six bonds per site,
    and two per step and end of a bond, whose position is up to `columns` bond lengths."""
    return 2.**-53 * (6. * sites + 4. * columns * steps)
