#!/usr/bin/python3
"""Kills, full disks, damaged and forged checkpoints: no results are lost, and resumed runs reach the same results.

Every run is stopped repeatedly and resumed with --resume on other numbers of threads and ranks. After each stop every file
is read with VTK, h5py, and Python's readers; at the end all files are compared with those of the uninterrupted run, byte for
byte.
"""
import argparse
import json
import pathlib
import random
import sys
import tempfile

sys.dont_write_bytecode = True
import damage
import hostile
import kills
import moments
import victims
sys.path.append(str(pathlib.Path(__file__).resolve().parents[1] / "verification"))
from forked import Forked


FAULTS = ("random", "kill", "full", "damage", "contents")


def parsed():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("latcon", type=pathlib.Path, help="the program")
    parser.add_argument("library", type=pathlib.Path, help="the library of file faults")
    parser.add_argument("server", type=pathlib.Path, help="the program behind a fork, see tests/verification/fork_server.cc")
    parser.add_argument("--damages", type=int, default=500, help="damaged checkpoints, in all [%(default)s]")
    parser.add_argument("--contents", type=int, default=1000, help="made-up checkpoints of each run, at most [%(default)s]")
    parser.add_argument("--kills", type=int, default=500, help="at random moments, in all [%(default)s]")
    parser.add_argument("--seed", type=int, default=1, help="of the moments [%(default)s]")
    parser.add_argument("--every", type=int, default=1, help="faults at every n-th call that changes a file [%(default)s]")
    parser.add_argument("--only", nargs="+", choices=FAULTS, default=FAULTS)
    parser.add_argument("--output", type=pathlib.Path, help="figures, as JSON")
    return parser.parse_args()


def main():
    chosen = parsed()
    program = victims.Program(chosen.latcon, chosen.library)
    forked = Forked(chosen.server)
    rng = random.Random(chosen.seed)
    figures = {}
    names = [*victims.VICTIMS, *victims.WITHOUT_CHECKPOINTS]
    with tempfile.TemporaryDirectory() as temporary:
        folder = pathlib.Path(temporary)
        for i, name in enumerate(names):
            share, damages = ((n * (i + 1)) // of - (n * i) // of
                               for n, of in ((chosen.kills, len(names)), (chosen.damages, len(victims.VICTIMS))))
            place = folder / str(i)
            place.mkdir()
            if "random" in chosen.only:
                ranks = (1, 1, 1, 1, 2, 3) if name in victims.ON_RANKS else (1,)
                figures[f"{name}, killed at random"] = kills.kill_at_random(program, name, folder / str(i), rng, share,
                                                                            ranks)
            if name in victims.VICTIMS and "damage" in chosen.only:
                figures[f"{name}, checkpoints damaged"] = damage.damage_at_random(forked, name, place, rng, damages)
            if name in victims.VICTIMS and "contents" in chosen.only:
                left, checkpoint = hostile.prepared(forked, name, place)
                variants = hostile.variants(checkpoint)
                n = hostile.require_refused(forked, name, left, checkpoint,
                                            rng.sample(variants, min(len(variants), chosen.contents)))
                figures[f"{name}, contents of checkpoints made up"] = {"refused": n}
            for fault in ("kill", "full"):
                if name in victims.VICTIMS and fault in chosen.only:
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
