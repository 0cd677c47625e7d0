"""The same sheet in LAMMPS: its input, and what its log says."""
import re

from measure import Failed, run

# Neighbour lists are not built: there are no pair forces, and bonds never change. Sites stay in the order of the rows.
INPUT = """units si
dimension 2
boundary f f p
newton on
atom_style bond
atom_modify map array sort 0 0
special_bonds lj/coul 1 1 1
bond_style harmonic
pair_style none
comm_modify cutoff 0.01
neighbor 0.0 bin
neigh_modify once yes
read_data {data}
group free type 1
fix motion free nve
timestep {time_step!r}
thermo_style custom step pe ke
thermo_modify norm no format float %.17g
thermo {steps}
{dump}{runs}
"""
DUMP = """dump positions all custom {steps} {file} id x y
dump_modify positions sort id format float %.17g
"""


def input_text(data, time_step, steps, repetitions, positions=None):
    """`steps` steps that are not timed, and `repetitions` times as many that are. @param positions file that gets them
    before and after each of these times"""
    return INPUT.format(data=data, time_step=time_step, steps=steps,
                        dump="" if positions is None else DUMP.format(steps=steps, file=positions),
                        runs="\n".join([f"run {steps}"] * (repetitions + 1)))


def read_positions(text):
    """{step: [(x, y) of each site, in the order of their numbers]} [m] of the file that `input_text` asks for."""
    frames = {}
    for part in text.split("ITEM: TIMESTEP\n")[1:]:
        header, rows = part.split("ITEM: ATOMS id x y")
        frames[int(header.split("\n")[0])] = [tuple(map(float, row.split()[1:])) for row in rows.strip().split("\n")]
    return frames


def read_log(text):
    """A run after another: {"steps", "seconds", "potential_energy", "kinetic_energy"} at its end."""
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
    """Accelerated versions of harmonic bonds that `lmp -h` lists, as -suffix wants them; "none" is the plain one."""
    match = re.search(r"\* Bond styles:\s*\n(.*?)\n\s*\n?\* ", help_text, re.DOTALL)
    if not match:
        raise Failed("`lmp -h` lists no bond styles")
    names = re.findall(r"\bharmonic(?:/(\w+))?(?=\s|$)", match.group(1))
    return ["none" if name == "" else name for name in names if name in ("", "omp", "intel", "opt")]


def version(help_text):
    """As `lmp -h` begins."""
    match = re.search(r"Massively Parallel Simulator - (.+)", help_text)
    return match.group(1).strip() if match else "unknown"


def move(folder, suffix):
    """Runs the input `in.sheet` of a folder on one core. @return what read_log() says"""
    version_of_bonds = "off" if suffix == "none" else suffix
    run(["lmp", "-in", "in.sheet", "-log", "log.sheet", "-screen", "none", "-suffix", version_of_bonds], folder=folder)
    return read_log((folder / "log.sheet").read_text(encoding="utf-8"))


def energy_tolerance(sites, columns, steps):
    """Relative difference of energies that round-off alone may make: one in each term of a sum over six bonds a site,
    and in each step two in each end of a bond, whose position is up to `columns` bond lengths."""
    return 2.**-53 * (6. * sites + 4. * columns * steps)
