"""Quantities and entries that a study shows: the units a reader is used to, and their names in tables and on axes."""

# Columns of tables of runs: quantity, scale to the unit shown, head.
MEASURED = (("speed_lagrangian", 1, "speed<br>[m/s]"), ("wavelength", 100, "wavelength<br>[cm]"),
            ("amplitude", 100, "amplitude of<br>sinusoid [cm]"),
            ("crest_amplitude", 100, "half trough<br>to crest [cm]"),
            ("bridged_length", 100, "bridged<br>length [cm]"), ("detached_sites", 1, "detached<br>sites"))
NEAR_TIP = (("speed_over_shear", 1, "speed over<br>shear speed"),
            ("negative_zone_area", 1e6, "area moving<br>back [mm²]"),
            ("negative_zone_depth", 1, "most negative<br>v_x [m/s]"),
            ("velocity_asymmetry", 1, "asymmetry<br>of velocity"),
            ("process_zone_length", 1e3, "process<br>zone [mm]"),
            ("opening_stress_ratio_4d", 1, "σ_yy at 4 d:<br>peak / ahead"),
            ("opening_stress_angle_4d", 1, "angle of<br>the peak [°]"), ("wedge_angle", 1, "wedge<br>angle [°]"))
# What the shape of a path is judged by.
PATH = ("wavelength", "amplitude", "crest_amplitude")
# Abscissas: scale to the unit shown, label.
AGAINST = {"zeta": (1, "ζ = (η/a) / (d √(ρ/a))"), "Sheet/spacing": (1e3, "d [mm]"),
           "Sheet/height": (100, "height of the sheet, undeformed [cm]"),
           "Sheet/length": (100, "length of the sheet, undeformed [cm]"),
           "Lattice/noise amplitude": (1, "noise amplitude / d")}
# Of quantities that are in no table: SI unit to scale and unit shown.
SHOWN = {"m": (100, "cm"), "m^2": (1e6, "mm²"), "s": (1e3, "ms"), "degrees": (1, "°")}


def quantity_axis(quantity, unit):
    """(scale to the unit shown, label) of a quantity that has an SI unit."""
    for name, scale, head in MEASURED + NEAR_TIP:
        if name == quantity:
            return scale, head.replace("<br>", " ")
    scale, shown = SHOWN.get(unit, (1, unit))
    return scale, f"{quantity.replace('_', ' ')} [{shown}]"


def against_axis(row):
    """(scale to the unit shown, label) of what a row varies, an entry of a case or zeta."""
    return AGAINST.get(row["against"], (1, f"{row['against']} [{row['against_unit']}]"))


def asked_quantities(rows):
    """What rows along one abscissa are about: their quantities, and for the pattern what it is judged by."""
    names = [name for row in rows for name in (PATH if row["quantity"] == "pattern" else (row["quantity"],))]
    return list(dict.fromkeys(names))


def sweeps_of(rows):
    """Rows that vary something, those along one abscissa of the same runs together: [[row, ...], ...]."""
    sweeps = {}
    for row in rows:
        if row["against"]:
            sweeps.setdefault((row["against"], tuple(row["runs"])), []).append(row)
    return list(sweeps.values())
