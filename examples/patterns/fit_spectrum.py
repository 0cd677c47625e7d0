#!/usr/bin/python3
"""Fits a spectrum of two relaxation times to the published numbers of Fig. 1. docs/patterns.md shows the result.

Usage: fit_spectrum.py DIRECTORY   (called again, continues the fit in the directory)

Everything else is that of fig1.prm. Both shells have the same spectrum in units of their viscosity there: the dashpot keeps a
fraction, and each of two Maxwell branches has another fraction as the product of its modulus and its relaxation time.
"""
import argparse
import pathlib
import sys

sys.dont_write_bytecode = True
sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "fit-fig1"))

import latcon
from latcon.fit import Parameter, fit_case

from fit_fig1 import OBSERVATIONS, base_case

VISCOSITIES = {"Nearest neighbours": 65.625, "Next-nearest neighbours": 196.875}  # of fig1.prm [Pa s]

# The strain rate at the tip is about 1 per 20 to 50 us: branches of shorter times are dashpots there, those of longer ones springs.
PARAMETERS = [Parameter("dashpot", 0.1, 1.2, True, "1"),
              Parameter("fast branch", 0.03, 1.0, True, "1"), Parameter("fast time", 1e-5, 1e-4, True, "s"),
              Parameter("slow branch", 0.03, 3.0, True, "1"), Parameter("slow time", 1e-4, 2e-3, True, "s")]
SEEDS = [1]
POINTS = 40


def entries(values):
    """Viscosity and branches of both shells."""
    found = {}
    for shell, viscosity in VISCOSITIES.items():
        found[f"{shell}/viscosity"] = values["dashpot"] * viscosity
        found[f"{shell}/branch moduli"] = [values[f"{name} branch"] * viscosity / values[f"{name} time"] for name in ("fast", "slow")]
        found[f"{shell}/relaxation times"] = [values["fast time"], values["slow time"]]
    return found


def fit(directory, points=POINTS, **options):
    """The fit, continued from the points that the directory holds. Cracks run unverified."""
    return fit_case(base_case(), PARAMETERS, OBSERVATIONS, directory, seeds=SEEDS, entries=entries, evaluations=points,
                    skip_verification=True, **options)


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("directory", type=pathlib.Path)
    parser.add_argument("--points", type=int, default=POINTS, help="points of the fit (default: %(default)s)")
    parser.add_argument("--workers", type=int, help="concurrent runs (default: all cores)")
    given = parser.parse_args()
    result = fit(given.directory, given.points, workers=given.workers)
    print(result)
    print(result.to_html())
    print(result.case.write(given.directory / "best.prm"))


if __name__ == "__main__":
    main()
