"""The tables that claims leave beside results.json: what is in each, and how its rows are taken apart."""
import numpy as np

from files import DamagedFile, read_table

# Errors below this are round-off and say nothing of an order.
ROUND_OFF = 1e-12

STATE = ("F_xx", "F_yy")
WAVE = STATE + ("angle [deg]", "k d")
CUT = STATE + ("displacement", "stress", "energy", "reaction", "shape")

# File name without ".csv": {column of words: words allowed, None for any}, columns of numbers. Further columns may be
# there.
FORMATS = {
    "wave_speeds": ({"shells": None, "wave": ("L", "S")},
                    WAVE + ("local [m/s]", "bloch [m/s]", "lattice [m/s]", "gradient [m/s]", "isotropic [m/s]",
                            "fem [m/s]")),
    "attenuation": ({"shells": None, "wave": ("L", "S")},
                    WAVE + tuple(f"{side}_{what}" for side in ("theory", "lattice", "continuum", "fem")
                                 for what in ("frequency [rad/s]", "decay [1/s]"))),
    "dispersion": ({"shells": None}, ("angle [deg]", "alpha_L", "alpha_S", "nearest_L", "nearest_S", "isotropic_L",
                                      "isotropic_S")),
    "dispersion_runs": ({"shells": None}, ("angle [deg]", "alpha_L", "alpha_S")),
    "edge_layer": ({"shells": None}, ("row", "deviation", "theory")),
    "hole": ({"shells": None, "law": None}, CUT + ("R/d",)),
    "notch": ({"shells": None, "law": None}, CUT + ("length/d",)),
    "running_crack": ({"shells": None, "side": ("lattice", "local", "gradient")},
                      ("X/d", "Y/d", "v_x [m/s]", "v_y [m/s]", "opening_stress [Pa]", "excess_y [m]")),
    "sinusoidal_energy": ({"shells": None, "wave": ("L", "S")},
                          WAVE + ("lattice", "local", "gradient", "filtered", "fem")),
    "travelling_waves": ({"shells": None, "wave": ("L", "S")},
                         WAVE + ("lattice_elastic [J/m^3]", "lattice_kinetic [J/m^3]", "fem_elastic [J/m^3]",
                                 "fem_kinetic [J/m^3]", "fem_micro_inertia [J/m^3]", "theory [J/m^3]")),
}


def read_claim_tables(folder):
    """The tables of a folder that have rows: {name: {column: array}}. Numbers may be nan: not computed."""
    tables = {}
    for name, (texts, numbers) in FORMATS.items():
        path = folder / f"{name}.csv"
        table = read_table(path, numbers, texts=tuple(texts), finite=False)
        if table is None or not len(table["shells"]):
            continue
        for column, allowed in texts.items():
            strange = [word for word in table[column] if allowed is not None and word not in allowed]
            if strange:
                raise DamagedFile(path, f"{column} is {strange[0]!r}, allowed: {', '.join(allowed)}")
        tables[name] = table
    return tables


def groups(table, *columns):
    """Parts of a table in which these columns have one value each, in the order of first rows: [(values, part)]."""
    keys = list(zip(*(table[column] for column in columns)))
    return [(key, {name: values[[k == key for k in keys]] for name, values in table.items()})
            for key in dict.fromkeys(keys)]


def states(table):
    """Groups of one set of shells and one deformation, each with its name: [(name, part)]."""
    return [(state_name(*key), part) for key, part in groups(table, "shells", *STATE)]


def state_name(shells, F_xx, F_yy):
    """Shells and deformation in a few words."""
    return f"{shells}, F = I" if F_xx == F_yy == 1 else f"{shells}, F = diag({F_xx:.4g}, {F_yy:.4g})"


def sorted_by(part, column):
    """A part with its rows in the order of one of its columns."""
    order = np.argsort(part[column], kind="stable")
    return {name: values[order] for name, values in part.items()}


def fitted_order(x, error, share=1.0):
    """Slope of log(error) over log(x), least squares; None with fewer than three errors above round-off.

    share: the part of the points, those of the smallest x, that the fit takes; never fewer than three.
    """
    usable = np.isfinite(error) & (error > ROUND_OFF) & (x > 0)
    x, error = x[usable], error[usable]
    if len(np.unique(x)) < 3:
        return None
    nearest = np.argsort(x)[:max(3, int(np.ceil(share * len(x))))]
    return float(np.polyfit(np.log(x[nearest]), np.log(error[nearest]), 1)[0])


def range_text(values, form=".2f"):
    """Values as one number or as a range, "1.98 to 2.03", with the number of those that are not finite; None for none."""
    values = np.array([value for value in values if value is not None], dtype=float)
    finite = values[np.isfinite(values)]
    if not len(finite):
        return None
    low, high = format(finite.min(), form), format(finite.max(), form)
    return (low if low == high else f"{low} to {high}") + not_computed(values)


def largest(values):
    """The largest finite absolute value; None if there is none."""
    values = np.abs(np.asarray(values, dtype=float))
    values = values[np.isfinite(values)]
    return float(values.max()) if len(values) else None


def largest_text(values):
    """The largest absolute value in words, "up to 1.2e-07", with the number of values that are not finite."""
    worst = largest(values)
    return ("an amount that could not be computed" if worst is None else f"up to {worst:.1e}") + not_computed(values)


def not_computed(values):
    """How many values are not finite: " (1 of 32 not computed)"; nothing if all are."""
    missing = np.count_nonzero(~np.isfinite(values))
    return f" ({missing} of {len(values)} not computed)" if missing else ""
