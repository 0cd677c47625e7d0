"""Measured numbers with uncertainties and units."""
from __future__ import annotations

import dataclasses
import math
from collections.abc import Iterator, Mapping
from typing import Any

_UNCERTAINTY = "_uncertainty"

_NAMES_BY_UNIT = {
    "m": "wavelength amplitude crest_amplitude window_begin window_end flank_damage_depth bridged_length X Y sampled_from "
         "sampled_to negative_zone_length negative_zone_distance negative_zone_depth_X negative_zone_depth_Y vortex_distance "
         "process_zone_length",
    "m^2": "negative_zone_area negative_zone_area_of_samples",
    "m^2/s": "vortex_circulation tip_circulation",
    "m/s": "speed_lagrangian speed_laboratory negative_zone_depth negative_zone_depth_of_samples process_zone_speed "
           "process_zone_fastest longitudinal_speed shear_speed",
    "s": "end_time",
    "Pa": "opening_stress_peak_4d opening_stress_peak_8d far_opening_stress",
    "degrees": "opening_stress_angle_4d opening_stress_angle_8d wedge_angle",
}
UNITS: dict[str, str] = {name: unit for unit, names in _NAMES_BY_UNIT.items() for name in names.split()}
"""SI units of the numbers in `crack.json` and `near_tip.json`; all others are pure numbers."""


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


def number_text(value: float, uncertainty: float | None, sign: str = "±") -> str:
    """Formats a number to the digits that its uncertainty justifies, "20.06 ± 0.23"; four digits if there is none."""
    if uncertainty is None or not 1e-12 * abs(value) < uncertainty < math.inf:  # of equal values it is round-off
        return f"{value:.4g}"
    digits = min(max(1 - math.floor(math.log10(uncertainty)), 0), 12)
    if digits > 6 and abs(value) < 1e-3:
        return f"{value:.1e} {sign} {uncertainty:.1e}"
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
            raise AttributeError(f"no quantity {name!r}") from None

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
