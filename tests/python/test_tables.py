"""Tests of the numbers that follow from the tables of a crack."""
import csv

import numpy as np
import pytest

from latcon.study.outcome import path_growth, table_values

D = 0.625e-3


def path(rate, wavenumber, amplitude, seed, noise=0.3 * D):
    random = np.random.default_rng(seed)
    X = np.sort(random.uniform(0.03, 0.1, 150))
    return X, amplitude * np.exp(rate * (X - X[0])) * np.cos(wavenumber * X + 0.3) + random.normal(0, noise, len(X))


@pytest.mark.parametrize("rate, wavelength, amplitude", [(-30, None, 2e-3), (20, 0.024, 3e-4), (-25, 0.024, 2e-3), (0, 0.024, 1.5e-3),
                                                         (15, None, 5e-4)])
def test_growth_has_the_scatter_that_it_states(rate, wavelength, amplitude):
    fits = [path_growth(*path(rate, 2 * np.pi / wavelength if wavelength else 0.0, amplitude, seed), D) for seed in range(12)]
    deviations = np.array([(found - rate) / uncertainty for found, uncertainty in fits])
    assert np.sqrt(np.mean(deviations**2)) < 2
    assert max(uncertainty for _, uncertainty in fits) < 10


def test_path_on_the_middle_or_too_short_has_no_growth():
    X = np.linspace(0.03, 0.1, 100)
    assert path_growth(X, 0 * X, D) is None
    for columns in (9, 10):  # of two spacings
        X = 0.03 + D * np.linspace(0, 2 * columns - 0.1, 100)
        assert (path_growth(X, X - 0.03, D) is None) == (columns < 10)


def test_energies_per_area_are_those_of_the_window(tmp_path):
    def write(name, columns):
        with open(tmp_path / name, "w", newline="") as file:
            csv.writer(file).writerows([columns, *np.transpose(list(columns.values()))])
    t = np.linspace(0, 1, 101)
    write("crack.csv", {"t": t, "X": 0.01 + 0.1 * t, "Y": np.where(np.arange(101) % 2, 1e-3, -1e-3)})
    t = np.linspace(0, 1, 38)  # not those of the tip
    # Another law before and after the window.
    write("energy.csv", {"t": t, "viscous": 7.0 * t, "broken": np.where((t > 0.25) & (t < 0.75), 2.0 * t, 9.0)})
    values = table_values(str(tmp_path), 1e-3, 0.04, 0.08)
    assert values["viscous_per_area"] == pytest.approx(70.0) and values["broken_per_area"] == pytest.approx(20.0)
    assert values["path_rms"] == pytest.approx(1e-3, rel=0.01)
    assert table_values(str(tmp_path), 1e-3, 0.2, 0.3) == {}
