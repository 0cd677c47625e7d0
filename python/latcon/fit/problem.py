"""Problem of a fit: parameters with bounds, and observations with uncertainties."""
from __future__ import annotations

import dataclasses
import difflib
import math
from collections.abc import Callable, Mapping, Sequence
from typing import Any

import numpy as np

from ..case import Case, Settable
from ..commands import CaseLike, as_case
from ..frames import Floats
from ..quantities import NAMES, Quantities, Value
from ..results import Run
from ..schema import SEED_ENTRY, schema
from ..study.study_file import PATTERNS

COMMANDS = ("fracture", "lattice", "continuum")

Measurement = tuple[float | str | bool, float]
"""Quantity of one run, and its uncertainty; both not-a-number if undetermined."""

Entries = Callable[[Mapping[str, float]], Mapping[str, Settable]]
"""Function that turns the values of all parameters into entries of the case."""


@dataclasses.dataclass(frozen=True)
class Parameter:
    """Entry of the case that the fit varies, or a quantity with a `unit` of which `entries` of :func:`fit_case` makes entries.

    Attributes
    ----------
    key : str
        ``Section/Name`` of a number or an integer; with a `unit` any other name.
    lower, upper : float or str
        Bounds: numbers in the SI unit of the entry, or texts with a unit (``"5 cm"``) with which the program accepts the case.
    logarithmic : bool
        Whether the parameter is searched on a logarithmic scale; then both bounds are positive.
    unit : str, optional
        SI unit of a quantity that is no entry of the case (``"1"`` without dimension); its bounds are numbers.
    """

    key: str
    lower: float | str
    upper: float | str
    logarithmic: bool = False
    unit: str | None = None


@dataclasses.dataclass(frozen=True)
class Observation:
    """Observed value of a quantity of the run.

    Attributes
    ----------
    quantity : str
        ``crack.NAME`` or ``near_tip.NAME``, a quantity of `crack.json` or `near_tip.json`; with `measure` any name.
    value : float or str or bool
        Observed mean in the SI unit of the quantity. A word or truth value, such as ``"oscillating"``, is compared with the
        fraction of seeds that have it.
    uncertainty : float
        One standard deviation of `value`, in its unit; of the fraction for a word. Required for a number.
    measure : callable, optional
        Function that returns the quantity of a :class:`latcon.Run` as a :class:`latcon.Value`, number, word or truth value.
    """

    quantity: str
    value: float | str | bool
    uncertainty: float = 0.0
    measure: Callable[[Run], Any] | None = None

    @property
    def is_word(self) -> bool:
        """True if the quantity is a word or truth value."""
        return isinstance(self.value, (str, bool))

    @property
    def sigma(self) -> float:
        """Uncertainty, or its default for a word: 0.2 of the seeds."""
        return self.uncertainty or 0.2

    def of(self, run: Run) -> Measurement:
        """Quantity of a run, and its uncertainty.

        Raises
        ------
        ValueError
            If the run has no such quantity, or it is of another type than the observation.
        """
        found = self.measure(run) if self.measure else _lookup(run, self.quantity)
        uncertainty = math.nan
        if isinstance(found, Value):
            found, uncertainty = found.value, found.uncertainty
        if isinstance(found, np.generic):
            found = found.item()
        is_word = isinstance(found, (str, bool))
        if is_word != self.is_word or not isinstance(found, (str, int, float)):
            raise ValueError(f"{self.quantity} is {found!r} in {run.directory}, but the observed value is {self.value!r}")
        return (found, math.nan) if is_word else (float(found), uncertainty)


def _lookup(run: Run, quantity: str) -> Any:
    file, _, path = quantity.partition(".")
    found: Any = run.crack if file == "crack" else run.near_tip
    for name in path.split("."):
        if not isinstance(found, Quantities) or name not in found:
            raise ValueError(f"no quantity {quantity!r} in {run.directory}")
        found = found[name]
    return found


@dataclasses.dataclass(frozen=True)
class Axis:
    """Parameter with its bounds in SI units; coordinate 0 at the lower bound, 1 at the upper."""

    key: str
    unit: str
    lower: float
    upper: float
    logarithmic: bool
    integer: bool

    def value(self, coordinate: float) -> float | int:
        """Value at a coordinate."""
        if self.logarithmic:
            found = self.lower * (self.upper / self.lower) ** coordinate
        else:
            found = self.lower + coordinate * (self.upper - self.lower)
        found = min(max(found, self.lower), self.upper)
        return round(found) if self.integer else found

    def coordinate(self, value: float) -> float:
        """Coordinate of a value."""
        if self.logarithmic:
            return math.log(value / self.lower) / math.log(self.upper / self.lower)
        return (value - self.lower) / (self.upper - self.lower)


@dataclasses.dataclass(frozen=True)
class Problem:
    """Resolved problem of a fit."""

    command: str
    case: str  # text of the resolved base case
    axes: tuple[Axis, ...]
    observations: tuple[Observation, ...]
    seeds: tuple[int, ...]
    skip_verification: bool
    entries: Entries | None = None

    def of(self, base: Case, values: Mapping[str, float]) -> Case:
        """Case with the values of a point."""
        case = base
        for axis in self.axes:
            if axis.key in schema():
                case = case.set(axis.key, int(values[axis.key]) if axis.integer else values[axis.key])
        if self.entries:
            for key, value in self.entries(dict(values)).items():
                case = case.set(key, value)
        return case

    def coordinates(self, values: Mapping[str, float]) -> Floats:
        """Coordinates of a set of values."""
        return np.array([axis.coordinate(values[axis.key]) for axis in self.axes])

    def values(self, coordinates: Sequence[float] | Floats) -> dict[str, float | int]:
        """Values at coordinates, by key."""
        return {axis.key: axis.value(float(at)) for axis, at in zip(self.axes, coordinates)}

    def identity(self) -> dict[str, Any]:
        """Everything that the evaluated points of a fit depend on, except the base case."""
        found = {"command": self.command, "skip_verification": self.skip_verification, "seeds": list(self.seeds),
                 "parameters": [dataclasses.asdict(axis) for axis in self.axes],
                 "quantities": [observation.quantity for observation in self.observations]}
        if self.entries:
            # A function cannot be compared; its entries at two points can.
            found["entries"] = [{key: repr(value) for key, value in self.entries(self.values([at] * len(self.axes))).items()}
                                for at in (0.3, 0.7)]
        return found


def resolve_problem(case: CaseLike, parameters: Sequence[Parameter], observations: Sequence[Observation], command: str,
                    seeds: Sequence[int] | None, skip_verification: bool, entries: Entries | None = None) -> Problem:
    """Checks a problem of a fit and converts its bounds; raises ValueError if parameters, observations, seeds or the command
    are wrong, BadInput if the case or a bound is.
    """
    base = as_case(case)
    if command not in COMMANDS:
        raise ValueError(f"command {command!r}: must be one of {', '.join(COMMANDS)}")
    for what, names in (("parameter", [parameter.key for parameter in parameters]),
                        ("observation", [observation.quantity for observation in observations])):
        if not names:
            raise ValueError(f"a fit needs at least one {what}")
        if twice := {name for name in names if names.count(name) > 1}:
            raise ValueError(f"{what} {min(twice)!r} is given twice")
    if SEED_ENTRY in [parameter.key for parameter in parameters]:
        raise ValueError(f"{SEED_ENTRY} cannot be a parameter: the means are over seeds")
    for observation in observations:
        name = observation.quantity
        file, _, path = name.partition(".")
        if observation.measure is None and (file not in ("crack", "near_tip") or not path or command != "fracture"):
            raise ValueError(f"observation {name!r}: must be crack.NAME or near_tip.NAME of a crack, or have the function "
                             "`measure`")
        if observation.measure is None:
            _require_known(name, "quantity", path.partition(".")[0], NAMES[file])
            if name == "crack.pattern" and observation.is_word:
                _require_known(name, "pattern", str(observation.value), [*PATTERNS, "undecided"])
        if not math.isfinite(observation.uncertainty) or observation.uncertainty < 0:
            raise ValueError(f"observation {name!r}: the uncertainty {observation.uncertainty} must be positive")
        if not observation.is_word and not (math.isfinite(float(observation.value)) and observation.uncertainty > 0):
            raise ValueError(f"observation {name!r}: needs a finite value and a positive uncertainty")
    own_seed = base[SEED_ENTRY]
    chosen = [own_seed] if seeds is None else list(seeds)
    if not chosen or len(set(chosen)) < len(chosen) or not all(isinstance(seed, (int, np.integer)) for seed in chosen):
        raise ValueError("seeds must be different integers, at least one")
    axes = tuple(_axis(base, parameter) for parameter in parameters)
    problem = Problem(command, base.text(), axes, tuple(observations),
                      tuple(int(seed) for seed in chosen if isinstance(seed, (int, np.integer))), skip_verification, entries)
    if entries is None:
        if derived := [axis.key for axis in axes if axis.key not in schema()]:
            raise ValueError(f"parameter {derived[0]}: is no entry of the case; `entries` must make entries of it")
    else:
        problem.of(base, problem.values([0.5] * len(axes))).resolved()
    return problem


def _require_known(observation: str, what: str, given: str, known: Sequence[str]) -> None:
    if given not in known:
        nearest = difflib.get_close_matches(given, known, 1)
        raise ValueError(f"observation {observation!r}: no {what} {given!r}; "
                         + (f"nearest: {nearest[0]}" if nearest else f"known: {', '.join(known)}"))


def _axis(base: Case, parameter: Parameter) -> Axis:
    unit, integer = parameter.unit, False
    if unit is None:
        base = base.set(parameter.key, parameter.lower)  # raises UnknownEntry
        entry = schema()[parameter.key]
        if entry.type not in ("number", "integer"):
            raise ValueError(f"parameter {parameter.key}: is of the type {entry.type}; only numbers and integers can be fitted")
        unit, integer = entry.unit or "1", entry.type == "integer"
    elif parameter.key in schema():
        raise ValueError(f"parameter {parameter.key}: is an entry of the case, which has its unit; leave out `unit`")
    elif isinstance(parameter.lower, str) or isinstance(parameter.upper, str):
        raise ValueError(f"parameter {parameter.key}: is no entry of the case; its bounds must be numbers in {unit}")
    bounds = []
    for bound in (parameter.lower, parameter.upper):
        value = base.set(parameter.key, bound)[parameter.key] if isinstance(bound, str) else bound
        if isinstance(value, bool) or not isinstance(value, (int, float, np.integer, np.floating)) or not math.isfinite(value):
            raise ValueError(f"parameter {parameter.key}: the bound {bound!r} is no finite number")
        bounds.append(float(value))
    lower, upper = bounds
    if not lower < upper or (parameter.logarithmic and lower <= 0):
        raise ValueError(f"parameter {parameter.key}: the bounds {lower} and {upper} must increase"
                         + (" and be positive" if parameter.logarithmic else ""))
    return Axis(parameter.key, unit, lower, upper, parameter.logarithmic, integer)
