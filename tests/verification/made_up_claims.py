"""Synthetic tables of claims for the tests of the report: closed forms with known orders, factors and errors."""
import csv
import itertools

import numpy as np

STATES = (("NN+NNN", 1.0, 1.0), ("NN+NNN", 2.3, 2.8), ("NN", 1.0, 1.0))
ANGLES = (0.0, 30.0)
K = np.array([0.1, 0.2, 0.3, 0.4, 0.5, 0.7, 1.0])  # k d
DECAY, FIRST_ROW = -0.2177, -8.67e-3  # of the edge layer
RUN_ERROR = 3e-4  # of a speed measured in a run
NAN = float("nan")


def alpha(shells, angle, wave):
    """Softening of a wave, about as large as the lattice's."""
    return {"L": 0.147, "S": 0.126}[wave] * (0.5 if shells == "NN" else 1) * (1 + 0.1 * np.cos(np.radians(6 * angle)))


def write(folder, name, header, rows):
    """A CSV file, numbers in full precision."""
    with open(folder / f"{name}.csv", "w", newline="", encoding="utf-8") as file:
        writer = csv.writer(file, lineterminator="\n")
        writer.writerow(header)
        writer.writerows([[repr(float(cell)) if not isinstance(cell, str) else cell for cell in row] for row in rows])


def waves():
    """(shells, F_xx, F_yy, angle, wave, k d) of every wave."""
    return [(*state, angle, wave, k) for state, angle, wave, k in itertools.product(STATES, ANGLES, "LS", K)]


def write_claims(folder):
    """All tables that the report draws."""
    wave_columns = ["shells", "F_xx", "F_yy", "angle [deg]", "wave", "k d"]
    speeds, energies, travelling, attenuation = [], [], [], []
    for key in waves():
        shells, F_xx, F_yy, angle, wave, k = key
        a = alpha(shells, angle, wave)
        c = {"L": 40.0, "S": 23.0}[wave]
        bloch = c * (1 - a * k**2 / 2)
        gradient = bloch * (1 + 0.02 * k**4)
        computed = F_xx == 1.0 and shells != "NN"
        speeds.append([*key, c, bloch, bloch * (1 + RUN_ERROR) if k in (0.3, 0.5) else NAN, gradient,
                       bloch * (1 + 0.02 * k**2), gradient * (1 + 1e-5) if computed else NAN, NAN])
        with_gradient = (1 - a * k**2) * (1 + 0.03 * k**4)
        energies.append([*key, 1 - a * k**2, 1.0, with_gradient * (1 + 0.25 * k**2), with_gradient,
                         with_gradient * (1 + 0.25 * k**2) * (1 + 2e-6) if computed else NAN])
        theory = 100.0 * k**2
        travelling.append([*key, theory * (1 + 1e-3 * k**2), theory * (1 - 1e-3 * k**2), theory * (1 + 2e-3 * k**2),
                           theory * (1 - 0.25 * k**2), theory * 0.25 * k**2, theory])
        decay, frequency = 2e4 * k**2, c * k / 6e-4
        attenuation.append([*key, frequency, decay, frequency * 1.001, decay * 1.002, frequency * 1.0001,
                            decay * 1.0001, *((frequency, decay * 1.0005) if computed else (NAN, NAN))])
    write(folder, "wave_speeds", [*wave_columns, "local [m/s]", "bloch [m/s]", "lattice [m/s]", "gradient [m/s]",
                                  "isotropic [m/s]", "fem [m/s]", "fem_isotropic [m/s]"], speeds)
    write(folder, "sinusoidal_energy", [*wave_columns, "lattice", "local", "gradient", "filtered", "fem"], energies)
    write(folder, "travelling_waves", [*wave_columns, "lattice_elastic [J/m^3]", "lattice_kinetic [J/m^3]",
                                       "fem_elastic [J/m^3]", "fem_kinetic [J/m^3]", "fem_micro_inertia [J/m^3]",
                                       "theory [J/m^3]"], travelling)
    write(folder, "attenuation", [*wave_columns, *(
        f"{side}_{what}" for side in ("theory", "lattice", "continuum", "fem")
        for what in ("frequency [rad/s]", "decay [1/s]"))], attenuation)
    write_dispersion(folder)
    rows = range(12)
    write(folder, "edge_layer", ["shells", "row", "deviation", "theory"],
          [["NN+NNN", j, FIRST_ROW * DECAY**j * (1 + 1e-3), FIRST_ROW * DECAY**j] for j in rows]
          + [["NN", j, 3e-16 * (-1) ** j, 0.0] for j in rows])
    write_running_crack(folder)
    write_branches(folder)
    write_disorder(folder)
    write_steady_crack(folder)
    for name, size in (("hole", "R/d"), ("notch", "length/d")):
        write_cut(folder, name, size)


def write_branches(folder):
    """Waves with one branch and with those of the case, and relaxation of one."""
    rows = []
    for state, wave in itertools.product(STATES, "LS"):
        for x in (0.1, 0.3, 1.0, 3.0, 10.0):
            frequency, decay = 1e4 * (1 + 0.22 * x**2 / (1 + x**2)), 2e3 * x / (1 + x**2)
            rows.append([*state, "one branch", wave, 0.25, x, 1e4, 1.22e4, frequency, decay, frequency * 1.0001, decay])
        rows.append([*state, "own branches", wave, 0.5, NAN, 1e4, 1.3e4, 1.1e4, 1e3, 1.1e4, 1e3])
    for name, sides in (("viscoelastic_waves", ("theory", "lattice")), ("viscoelastic_elements", ("continuum", "fem"))):
        write(folder, name, ["shells", "F_xx", "F_yy", "part", "wave", "k d", "w tau", "rubbery [rad/s]", "glassy [rad/s]", *(
            f"{side}_{what}" for side in sides for what in ("frequency [rad/s]", "decay [1/s]"))], rows)
    rows = []
    for shells, integrator in itertools.product(("NN+NNN", "NN"), ("velocity Verlet", "Runge-Kutta-Chebyshev")):
        for t in np.linspace(0, 1e-3, 9):
            q, stored = 1e5 * np.exp(-t / 3e-4), 0.2 * np.exp(-2 * t / 3e-4)
            rows.append([shells, integrator, t, q, q, stored, stored, 0.2 - stored, 0.2 - stored])
    write(folder, "relaxation", ["shells", "integrator", "t [s]", *(
        f"{side}_{what}" for what in ("overstress [Pa]", "stored [J/m]", "dissipated [J/m]")
        for side in ("lattice", "theory"))], rows)


def write_steady_crack(folder):
    """Speeds 1e-4 off the exact solution, and the curve of one viscosity."""
    write(folder, "steady_crack", ["beta", "driving", "breaking elongation", "lattice speed", "exact speed"],
          [[beta, driving, 1.01, 0.1 * driving / beta * (1 + 1e-4), 0.1 * driving / beta]
           for beta in (0.5, 3.0) for driving in (1.6, 1.9)])
    write(folder, "steady_crack_curve", ["beta", "speed", "driving", "exists"],
          [[0.5, v / 50, 1.2 + v / 50, "yes" if v < 30 else "no"] for v in range(5, 40)])


def write_disorder(folder):
    """Moduli of sheets about their effective medium."""
    rows = [[shells, modulus, i, 0.9933 + 1e-4 * (-1) ** i, 0.99, 0.9933, 0.1]
            for shells, modulus, i in itertools.product(("NN+NNN", "NN"), ("bulk modulus", "shear modulus"), range(10))]
    write(folder, "disorder", ["shells", "modulus", "sheet", "ratio [1]", "reuss [1]", "effective_medium [1]", "width [1]"], rows)


def write_dispersion(folder):
    """alpha against direction, and some runs."""
    rows = []
    for shells in ("NN+NNN", "NN"):
        for angle in np.arange(0.0, 61.0, 2.5):
            L, S = (alpha(shells, angle, wave) for wave in "LS")
            rows.append([shells, angle, L, S, 0.4 * L, 0.3 * S, 0.14, 0.12])
    write(folder, "dispersion", ["shells", "angle [deg]", "alpha_L", "alpha_S", "nearest_L", "nearest_S", "isotropic_L",
                                 "isotropic_S"], rows)
    write(folder, "dispersion_runs", ["shells", "angle [deg]", "alpha_L", "alpha_S"],
          [[shells, angle, *(1.01 * alpha(shells, angle, wave) for wave in "LS")]
           for shells in ("NN+NNN", "NN") for angle in ANGLES])


def write_running_crack(folder):
    """Fields whose most negative velocity ahead of the tip is -1 on the lattice, half of that in the continua.

    Without next-nearest bonds the continua with gradient energy are not computed.
    """
    rows = []
    for shells, (side, scale) in itertools.product(
            ("NN+NNN", "NN"), (("lattice", 1.0), ("local", 0.5), ("gradient", 0.5), ("viscous-gradient", 0.5))):
        if shells == "NN" and "gradient" in side:
            continue
        for X, Y in itertools.product(np.arange(-12.0, 12.5, 0.5), np.arange(0.25, 12.5, 0.5)):
            if np.hypot(X, Y) <= 12:
                rows.append([shells, side, X, Y, -scale * np.exp(-((X - 2) ** 2) - (Y - 0.25) ** 2), 0.0,
                             1e6 * (1 + X / 12), 0.0])
    write(folder, "running_crack", ["shells", "side", "X/d", "Y/d", "v_x [m/s]", "v_y [m/s]", "opening_stress [Pa]",
                                    "excess_y [m]"], rows)


def write_cut(folder, name, size):
    """Errors of order 1 for the local law, of order 2 for the gradient law."""
    rows = []
    for state in STATES[:2]:
        for law, order, scale in (("local", 1, 0.3), ("gradient", 2, 0.5)):
            for R in (4.0, 8.0, 16.0, 32.0):
                rows.append([*state, law, R, *(factor * scale * R**-order for factor in (1.0, 2.0, 0.5, 0.2)),
                             NAN if name == "notch" else 0.7 * scale * R**-order])
    header = ["shells", "F_xx", "F_yy", "law", size, "displacement", "stress", "energy", "reaction", "shape"]
    write(folder, name, header, rows)
