"""Table of the quantities measured near the tip of a running crack."""
from dataclasses import dataclass

from ..quantities import number_text
from .pages import plain_row, superscripts


@dataclass(frozen=True)
class Quantity:
    """Row of the table: a number of near_tip.json."""

    name: str  # in near_tip.json
    label: str
    unit: str  # shown
    scale: float  # of `unit` over the unit of near_tip.json
    meaning: str


QUANTITIES = (
    Quantity("negative_zone_area", "negative velocity, area", "mm^2", 1e6,
             "region ahead of the tip that moves backwards at more than 1 % of the crack speed"),
    Quantity("negative_zone_length", "negative velocity, length", "mm", 1e3, "extent of this region along the crack"),
    Quantity("negative_zone_depth", "negative velocity, largest", "m/s", 1, "fastest backward motion ahead of the tip"),
    Quantity("velocity_asymmetry", "asymmetry", "1", 1,
             "of the mean velocity, with samples of a descending path mirrored: 0 symmetric, 2 antisymmetric"),
    Quantity("samples_with_vortex", "samples with a vortex", "%", 100,
             "share of single samples in which material rotates around a point near the tip"),
    Quantity("process_zone_length", "process zone, length", "mm", 1e3,
             "extent of the material that follows the tip at more than half the speed of relaxed rubber"),
    Quantity("process_zone_share", "process zone, share", "%", 100,
             "share of such material just behind the tip: 3 to 14 d behind it, up to 3 d to either side"),
    Quantity("opening_stress_angle_4d", "opening stress, angle", "degrees", 1,
             "of the peak at 4 d from the tip, from the direction of the crack"),
    Quantity("opening_stress_ratio_4d", "opening stress, ratio", "1", 1,
             "of the peak to the stress straight ahead; above 1 there is a lobe on either side"),
    Quantity("opening_stress_concentration_4d", "opening stress, concentration", "1", 1,
             "peak at 4 d from the tip over the stress of the loaded sheet"),
    Quantity("opening_stress_peak_4d", "opening stress, peak", "MPa", 1e-6, "at 4 d from the tip, Cauchy"),
    Quantity("wedge_angle", "wedge angle", "degrees", 1, "between the flanks, mean over samples"),
    Quantity("speed_over_shear", "speed over shear waves", "1", 1,
             "waves along the crack in the loaded sheet; the paper calls cracks above 1 supersonic"),
    Quantity("speed_over_longitudinal", "speed over longitudinal waves", "1", 1,
             "waves along the crack in the loaded sheet"),
)


def near_tip_rows(near_tip):
    """Samples, reason and rows of near_tip.json; no samples if nothing could be measured; None for None."""
    if near_tip is None:
        return None
    rows = [plain_row([("short", quantity.label), ("number", value_text(near_tip, quantity)), ("short", superscripts(quantity.unit)),
                       ("words", quantity.meaning)]) for quantity in QUANTITIES if quantity.name in near_tip]
    return {"samples": near_tip.get("samples") or 0, "reason": near_tip["reason"], "rows": rows}


def value_text(near_tip, quantity):
    """Value and uncertainty in the unit shown."""
    value, uncertainty = near_tip[quantity.name], near_tip.get(f"{quantity.name}_uncertainty")
    return "–" if value is None else number_text(value, uncertainty, scale=quantity.scale)
