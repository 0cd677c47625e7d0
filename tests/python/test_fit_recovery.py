"""A fit of a small crack finds the parameters that its observations were made with.

How often uncertainties hold: test_fit_statistics.py.
"""
import math

import numpy as np
from scipy.stats import chi2

import latcon
from latcon.fit import Observation, Parameter, fit_case

# A strip so short that a crack runs through it in a second; without the output that no observation needs.
STRIP = {"Sheet/length": "2.5 cm", "Sheet/height": "1.5 cm", "Time/end": "1.5 ms", "Output/frame interval": "5 ms",
         "Near tip/interval": 0}
KNOWN = {"Fracture/breaking stretch": 3.07, "Nearest neighbours/area factor": 0.72}
BOUNDS = {"Fracture/breaking stretch": (2.9, 3.2), "Nearest neighbours/area factor": (0.5, 1.0)}
SPEED, ENERGY = "crack.speed_lagrangian", "elastic energy of the loaded sheet"
NOISE = {SPEED: 0.2, ENERGY: 10.0}  # [m/s], [J/m]


def loaded_energy(run):
    return float(run.energy["elastic"].iloc[0])


def observe(case, directory, seeds):
    """Synthetic observations: means over seeds, with noise, and the uncertainty of both."""
    runs = [latcon.fracture(case.set("Lattice/noise seed", seed), directory / str(seed), threads=1,
                            skip_verification=True, report=False, progress=False) for seed in seeds]
    generator = np.random.default_rng(2026)
    speeds = [run.crack.speed_lagrangian.value for run in runs]
    for name, values in ((SPEED, speeds), (ENERGY, list(map(loaded_energy, runs)))):
        uncertainty = math.hypot(NOISE[name], np.std(values, ddof=1) / math.sqrt(len(values)))
        yield Observation(name, float(np.mean(values) + generator.normal(0, NOISE[name])), uncertainty,
                          measure=loaded_energy if name == ENERGY else None)


def test_known_parameters_are_recovered(tmp_path):
    strip = latcon.Case("quick").set(STRIP)
    observations = list(observe(strip.set(KNOWN), tmp_path / "observed", (300, 301)))
    parameters = [Parameter(key, *bounds) for key, bounds in BOUNDS.items()]
    result = fit_case(strip, parameters, observations, tmp_path / "fit", seeds=[302], evaluations=14,
                      skip_verification=True, search_seed=3, progress=False)
    # In the region of 95 % confidence.
    offset = result.model.center - [(KNOWN[key] - low) / (high - low) for key, (low, high) in BOUNDS.items()]
    assert offset @ result.model.metric @ offset <= chi2.ppf(0.95, 2)
    assert result.parameters["determined"].all()
    assert not list((tmp_path / "fit" / "runs").iterdir())
