"""Quantities and entries shown for a study: customary units, and names in tables and on axes."""
from ..quantities import shown_unit

# Columns of the tables of runs: quantity, scale to the unit shown, head.
MEASURED = (("speed_lagrangian", 1, "speed\n[m/s]"), ("wavelength", 100, "wavelength\n[cm]"),
            ("amplitude", 100, "amplitude of\nsinusoid [cm]"),
            ("crest_amplitude", 100, "half trough\nto crest [cm]"),
            ("bridged_length", 100, "bridged\nlength [cm]"), ("detached_sites", 1, "detached\nsites"))
NEAR_TIP = (("speed_over_shear", 1, "speed over\nshear speed"),
            ("negative_zone_area", 1e6, "area of negative\nvelocity [mm²]"),
            ("negative_zone_depth", 1, "most negative\nv_x [m/s]"),
            ("velocity_asymmetry", 1, "asymmetry\nof velocity"),
            ("process_zone_length", 1e3, "process\nzone [mm]"),
            ("opening_stress_ratio_4d", 1, "σ_yy at 4 d:\npeak / ahead"),
            ("opening_stress_angle_4d", 1, "angle of\nthe peak [°]"), ("wedge_angle", 1, "wedge\nangle [°]"))
# Quantities that describe the shape of a path.
PATH = ("wavelength", "amplitude", "crest_amplitude")
# Abscissas: scale to the unit shown, label.
AGAINST = {"zeta": (1, "ζ = (η/a) / (d √(ρ/a))"), "Sheet/spacing": (1e3, "d [mm]"),
           "Sheet/height": (100, "height of the sheet, undeformed [cm]"),
           "Sheet/length": (100, "length of the sheet, undeformed [cm]"),
           "Lattice/noise amplitude": (1, "noise amplitude / d"),
           "Loading/strain x": (1, "strain x, along the crack"), "Loading/strain y": (1, "strain y, across the crack")}


def quantity_axis(quantity, unit):
    """(scale to the unit shown, label) of a quantity with an SI unit."""
    for name, scale, head in MEASURED + NEAR_TIP:
        if name == quantity:
            return scale, head.replace("\n", " ")
    scale, shown = shown_unit(unit)
    return scale, f"{quantity.replace('_', ' ')} [{shown or '1'}]"


def entry_axis(name, unit):
    """(scale to the unit shown, label) of an entry of a case with an SI unit, or of zeta."""
    if name in AGAINST:
        return AGAINST[name]
    scale, shown = shown_unit(unit)
    return scale, f"{name} [{shown}]" if shown else name


def against_axis(row):
    """(scale to the unit shown, label) of the abscissa of a row."""
    return entry_axis(row["against"], row["against_unit"])


def asked_quantities(rows):
    """Quantities of rows along one abscissa; those that describe the path in place of the pattern."""
    names = [name for row in rows for name in (PATH if row["quantity"] == "pattern" else (row["quantity"],))]
    return list(dict.fromkeys(names))


def sweeps_of(rows):
    """Rows with an abscissa, grouped by abscissa and runs: [[row, ...], ...]."""
    sweeps = {}
    for row in rows:
        if row["against"]:
            sweeps.setdefault((row["against"], tuple(row["runs"])), []).append(row)
    return list(sweeps.values())
