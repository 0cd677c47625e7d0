#!/usr/bin/python3
"""Kills, full disks: nothing that was computed is lost, and the run goes on to what it would have found.

Every run is stopped again and again and goes on with --resume, on other numbers of threads and ranks. After each stop
every file is read with VTK, h5py, and the readers of Python; at the end all files are compared with those of the
undisturbed run, byte for byte.
"""
import argparse
import json
import pathlib
import random
import sys
import tempfile

sys.dont_write_bytecode = True
import kills
import moments
import victims


def parsed():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("latcon", type=pathlib.Path, help="the program")
    parser.add_argument("library", type=pathlib.Path, help="the library of file faults")
    parser.add_argument("--kills", type=int, default=500, help="at random moments, in all [%(default)s]")
    parser.add_argument("--seed", type=int, default=1, help="of the moments [%(default)s]")
    parser.add_argument("--every", type=int, default=1, help="faults at every n-th call that changes a file [%(default)s]")
    parser.add_argument("--only", nargs="+", choices=("random", "kill", "full"), default=("random", "kill", "full"))
    parser.add_argument("--output", type=pathlib.Path, help="figures, as JSON")
    return parser.parse_args()


def main():
    chosen = parsed()
    program = victims.Program(chosen.latcon, chosen.library)
    rng = random.Random(chosen.seed)
    figures = {}
    names = list(victims.VICTIMS)
    with tempfile.TemporaryDirectory() as temporary:
        folder = pathlib.Path(temporary)
        for i, name in enumerate(names):
            share = (chosen.kills * (i + 1)) // len(names) - (chosen.kills * i) // len(names)
            if "random" in chosen.only:
                ranks = (1, 1, 1, 1, 2, 3) if name in victims.ON_RANKS else (1,)
                figures[f"{name}, killed at random"] = kills.kill_at_random(program, name, folder / str(i), rng, share,
                                                                            ranks)
            for fault in ("kill", "full"):
                if fault in chosen.only:
                    first = rng.randrange(chosen.every) + 1
                    figures[f"{name}, {fault} at a call"] = moments.at_moments(
                        program, name, folder / str(i), fault, lambda n, first=first: range(first, n + 1, chosen.every))
            for title, numbers in figures.items():
                if title.startswith(f"{name},"):
                    print(f"{title}: " + ", ".join(f"{key} {value}" for key, value in numbers.items()), flush=True)
    if chosen.output:
        chosen.output.write_text(json.dumps(figures, indent=2) + "\n")


if __name__ == "__main__":
    main()
