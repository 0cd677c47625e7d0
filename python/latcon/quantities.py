"""Measured numbers with uncertainties and units."""
from __future__ import annotations

import dataclasses
import math
import re
from collections.abc import Iterator, Mapping
from typing import Any

_UNCERTAINTY = "_uncertainty"

_TABLE = (
    ("1", "zeta"), ("m/s", "speed_lagrangian+ speed_laboratory+"), ("m", "wavelength+"), ("1", "wavelength_over_d+"), ("m", "amplitude+"),
    ("1", "amplitude_over_d+"), ("m", "crest_amplitude+"), ("1", "crest_amplitude_over_d+ periods"), ("m", "path_rms window_begin window_end"),
    ("1/m", "path_growth+"), ("J/m^2", "viscous_per_area broken_per_area"),
    ("1", "branched_fraction bonds_broken detached_sites detached_fragments largest_fragment overstretched_bonds"),
    ("m", "bridged_length flank_damage_depth"), ("1", "flank_damage_share"), ("s", "end_time"), ("1", "energy_imbalance samples"),
    ("m^2", "negative_zone_area+ negative_zone_area_of_samples+"), ("m", "negative_zone_length+ negative_zone_distance+"),
    ("m/s", "negative_zone_depth+ negative_zone_depth_of_samples+"), ("m", "negative_zone_depth_X+ negative_zone_depth_Y+"),
    ("1", "velocity_asymmetry+ velocity_asymmetry_of_samples+ vortices+ vortices_of_samples+ samples_with_vortex+"),
    ("m", "vortex_distance+"), ("m^2/s", "vortex_circulation+ tip_circulation+"), ("m", "process_zone_length+"),
    ("1", "process_zone_share+ process_zone_share_of_samples+"), ("m/s", "process_zone_fastest+"),
    ("degrees", "opening_stress_angle_4d+"), ("1", "opening_stress_ratio_4d+"), ("Pa", "opening_stress_peak_4d+"),
    ("1", "opening_stress_concentration_4d+"), ("degrees", "opening_stress_angle_8d+"), ("1", "opening_stress_ratio_8d+"),
    ("Pa", "opening_stress_peak_8d+"), ("1", "opening_stress_concentration_8d+"), ("degrees", "wedge_angle+"),
    ("1", "speed_over_shear+ speed_over_longitudinal+"), ("m/s", "shear_speed longitudinal_speed process_zone_speed"),
    ("Pa", "far_opening_stress"))
# A name that ends with + has an uncertainty, one standard deviation.
RECORDED: dict[str, str] = {name: unit for unit, words in _TABLE for word in words.split()
                            for name in ((word[:-1], word[:-1] + _UNCERTAINTY) if word[-1] == "+" else (word,))}
"""SI units of the quantities that a study records of a run, in the order of `study.csv`: numbers in `crack.json` and
`near_tip.json`, and those that follow from these, the case and the tables: zeta, lengths over d, numbers of the path, energies per area."""
UNITS: dict[str, str] = RECORDED | dict.fromkeys(("X", "Y", "sampled_from", "sampled_to", "sinusoid_offset"), "m")
"""SI units of the numbers in `crack.json` and `near_tip.json`; all others are pure numbers."""
_IN_FILES = [name for name in RECORDED if not re.search(f"^zeta|_over_d|^path_|_per_area|{_UNCERTAINTY}$", name)]
NAMES = {"crack": [*_IN_FILES[:_IN_FILES.index("samples")], "sinusoid_offset", "sinusoid_slope", "sinusoid_phase", "pattern", "reason",
                   "side", "thresholds", "nearest_to_breaking", "skip_verification"],
         "near_tip": [*_IN_FILES[_IN_FILES.index("samples"):], "reason", "sampled_from", "sampled_to"]}
"""Names of the quantities in `crack.json` and `near_tip.json`."""

SHOWN = {"m": (100.0, "cm"), "m^2": (1e6, "mm²"), "s": (1e3, "ms"), "degrees": (1.0, "°")}
"""Scale and unit shown for SI units."""


@dataclasses.dataclass(frozen=True)
class Value:
    """Measured number.

    Attributes
    ----------
    value : float
        In `unit`; NaN if it could not be determined.
    uncertainty : float
        One standard deviation, in `unit`; NaN if there is none.
    unit : str
        SI unit; ``1`` for a pure number.
    """

    value: float
    uncertainty: float
    unit: str

    def __float__(self) -> float:
        return self.value

    def __str__(self) -> str:
        unit = "" if self.unit == "1" else f" {self.unit}"
        if math.isnan(self.value):
            return "not determined"
        if not self.uncertainty > 0:
            return f"{self.value:.6g}{unit}"
        return number_text(self.value, self.uncertainty) + unit


def quantity_text(value: float, uncertainty: float | None, unit: str) -> str:
    """Formats a number with a readable unit: lengths in cm, areas in mm², times in ms."""
    scale, shown = shown_unit(unit)
    return number_text(value, uncertainty, scale=scale) + ("" if shown in ("", "°") else " ") + shown


def shown_unit(unit: str) -> tuple[float, str]:
    """Returns the readable unit of a quantity, with the factor to it from its SI unit; empty for a pure number."""
    return SHOWN.get(unit, (1.0, "" if unit == "1" else unit))


def number_text(value: float | None, uncertainty: float | None, sign: str = "±", scale: float = 1.0) -> str:
    """Formats a number to the digits that its uncertainty justifies, "20.06 ± 0.23"; four digits if there is none; a dash for None.

    `uncertainty` is one standard deviation, `sign` stands between both, `scale` is a factor for both.
    """
    if value is None:
        return "–"
    value, uncertainty = scale * value, None if uncertainty is None else scale * uncertainty
    if uncertainty is None or not 1e-12 * abs(value) < uncertainty < math.inf:  # of equal values it is round-off
        return f"{value:.4g}"
    digits = max(1 - math.floor(math.log10(uncertainty)), 0)
    if digits > 6 and abs(value) < 1e-3:
        figures = max(digits + math.floor(math.log10(abs(value))), 1) if value else 1
        return f"{value:.{figures}e} {sign} {uncertainty:.1e}"
    return f"{value:.{digits}f} {sign} {uncertainty:.{digits}f}"


class Quantities(Mapping[str, Any]):
    """Measured quantities by name, also as attributes: ``crack["wavelength"]``, ``crack.wavelength``.

    Numbers are :class:`Value`; strings (``pattern``, ``reason``), Booleans and nested quantities are unchanged. Keys of
    uncertainties and ``units`` are omitted.
    """

    def __init__(self, numbers: Mapping[str, Any]) -> None:
        self._values = {name: _quantity(name, value, numbers) for name, value in numbers.items()
                        if not name.endswith(_UNCERTAINTY) and name != "units"}

    def __getitem__(self, name: str) -> Any:
        return self._values[name]

    def __getattr__(self, name: str) -> Any:
        try:
            return self.__dict__["_values"][name]
        except KeyError:
            raise AttributeError(f"no quantity {name!r}", name=name, obj=self) from None

    def __dir__(self) -> list[str]:
        return [*super().__dir__(), *self._values]

    def __iter__(self) -> Iterator[str]:
        return iter(self._values)

    def __len__(self) -> int:
        return len(self._values)

    def __repr__(self) -> str:
        return "\n".join(f"{name}: {value}" for name, value in self._values.items())


def _quantity(name: str, value: Any, numbers: Mapping[str, Any]) -> Any:
    if isinstance(value, Mapping):
        return Quantities(value)
    if isinstance(value, (str, bool)):
        return value
    return Value(_number(value), _number(numbers.get(name + _UNCERTAINTY)), UNITS.get(name, "1"))


def _number(value: float | None) -> float:
    return math.nan if value is None else float(value)
