"""Fits parameters of a case to observations.

Examples
--------
>>> from latcon.fit import Observation, Parameter, fit_case
>>> result = fit_case("quick.prm", [Parameter("Fracture/breaking stretch", 2.8, 3.3)],
...                   [Observation("crack.speed_lagrangian", 13.7, 0.3)], "output/fit", evaluations=24)
>>> print(result)
"""
from .problem import Observation, Parameter
from .result import Fit
from .search import fit_case

__all__ = ["Fit", "Observation", "Parameter", "fit_case"]
