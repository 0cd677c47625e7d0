#!/usr/bin/python3
"""The paper's Fig. 1 at full size: an oscillating crack for every seed of the noise, whose numbers are the published ones
within the case's tolerance, and more closely in the mean of ten; a report below 8 MB; a zone of backward motion ahead of it.
With --full also: without next-nearest neighbours, in a lattice rotated by 30 degrees, it runs straight and has no such zone. docs/limits.md describes how the
constants of the case were chosen.

Usage: fig1_test.py PATH_OF_LATCON [--full]     --full: ten seeds by velocity Verlet, not one by Runge-Kutta-Chebyshev
Prints the measured numbers, one line per seed.
"""
import json
import os
import pathlib
import subprocess
import sys
import tempfile
from concurrent.futures import ThreadPoolExecutor

# Published values, and tolerances of the means. The paper does not state whether its amplitude is that of a sinusoid or half
# the height from trough to crest; the path is a zigzag, which is higher than its best-fitting sinusoid.
PAPER = {"wavelength": (2.3e-2, 0.1), "amplitude": (0.17e-2, 0.15), "crest_amplitude": (0.17e-2, 0.1),
         "speed_lagrangian": (20.9, 0.1)}
BRIDGED = 1e-2  # largest mean bridged length [m]
TOLERANCE = 0.2  # of each seed
FULL = "--full" in sys.argv
SEEDS = range(6, 16) if FULL else [6]
INTEGRATOR = "velocity-verlet" if FULL else "runge-kutta-chebyshev"
LARGEST_IMBALANCE = 2e-4 if FULL else 5e-3  # of the energy spent, as latcon fracture requires
ZONE = 5e-6  # smallest mean area of the zone of backward motion in single samples [m^2]
NO_ZONE = 1e-6  # largest area without next-nearest neighbours: three sites [m^2]
LARGEST_REPORT = 8_000_000  # [bytes]
LOCAL = ["Next-nearest neighbours/present=false", "Sheet/orientation=rows-across-crack"]


def run(latcon, case, seed, *settings):
    """Runs one seed on one thread. @return exit code, crack.json with the area of near_tip.json and the bytes of a report"""
    with tempfile.TemporaryDirectory() as folder:
        environment = dict(os.environ, XDG_CACHE_HOME=f"{folder}/cache")  # no verdicts of an earlier run
        # Seeds differ only in the noise: the material is verified with the first, and by the page of the tutorial.
        first = seed == SEEDS[0] and not settings
        skip = [] if first and FULL else ["--skip-verification"]
        report = pathlib.Path(folder) / "report.html"  # of the first
        if not first:
            skip = [*skip, "--no-report"]
        words = [latcon, "fracture", str(case), "--quiet", "--threads", "1", "--output-dir", folder, *skip]
        for setting in (f"Lattice/noise seed={seed}", "Output/frame interval=0", f"Time/integrator={INTEGRATOR}", *settings):
            words += ["--set", setting]
        exit_code = subprocess.run(words, env=environment, check=False).returncode
        crack, near = (json.loads((pathlib.Path(folder) / name).read_text(encoding="utf-8"))
                       for name in ("crack.json", "near_tip.json"))
        return exit_code, {**crack, "zone": near["negative_zone_area_of_samples"],
                           "report": report.stat().st_size if report.exists() else None}


def main():
    latcon = sys.argv[1]
    case = pathlib.Path(__file__).resolve().parents[2] / "verification" / "cases" / "fig1.prm"
    failures = []
    largest_report = 0
    found = {name: [] for name in (*PAPER, "bridged_length", "zone")}
    with ThreadPoolExecutor(2) as pool:
        runs = pool.map(lambda seed: run(latcon, case, seed), SEEDS)
        local = pool.submit(run, latcon, case, SEEDS[0], *LOCAL).result()[1] if FULL else None
    for seed, (exit_code, crack) in zip(SEEDS, runs):
        print(f"seed {seed}: exit {exit_code}, {crack['pattern']}, imbalance {crack['energy_imbalance']:.1e}, " +
              ", ".join(f"{name} {crack[name]} (paper {published})" for name, (published, _) in PAPER.items()))
        largest_report = max(largest_report, crack["report"] or 0)
        for name, values in found.items():
            values.append(crack[name] or 0.)
        if exit_code != 0 or crack["pattern"] != "oscillating" or crack["energy_imbalance"] > LARGEST_IMBALANCE:
            failures.append(seed)
        elif any(abs(crack[name] / published - 1) > TOLERANCE for name, (published, _) in PAPER.items()):
            failures.append(seed)
    if failures:
        sys.exit(f"seeds {failures} do not reproduce the published crack")
    means = {name: sum(values) / len(SEEDS) for name, values in found.items()}
    print(means)
    for name, (published, tolerance) in PAPER.items():
        print(f"{name}: {means[name] / published - 1:+.1%} off the paper")
        if FULL and abs(means[name] / published - 1) > tolerance:
            failures.append(name)
    if FULL and not means["bridged_length"] < BRIDGED:
        failures.append("bridged_length")
    if not means["zone"] > (ZONE if FULL else NO_ZONE):
        failures.append("zone")
    print(f"report: {largest_report} bytes")
    if not 0 < largest_report < LARGEST_REPORT:
        failures.append("size of the report")
    if FULL:
        print(f"without next-nearest neighbours: {local['pattern']}, zone {local['zone']}")
        if local["pattern"] != "straight" or not local["zone"] < NO_ZONE:
            failures.append("pattern or zone without next-nearest neighbours")
    if failures:
        sys.exit(f"the mean {', '.join(failures)} is not the published one")


if __name__ == "__main__":
    main()
