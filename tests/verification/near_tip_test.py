"""Tests of the fields near the tip written by `latcon fracture`, on a strip of a few thousand sites."""
import math
import shutil

import numpy as np
import pytest

from lattice_states import SECTIONS, Lattice, rod
from program import CASES, latcon, read, read_csv, read_json, settings

LOADED = Lattice(rod(1e5, 1.5e5), "NN+NNN", 2.3, 2.8)  # the sheet ahead of the crack
STRIP = ["--skip-verification", "--quiet", "--threads", "1", *settings(
    f"Nearest neighbours/area factor={SECTIONS['nearest']}", f"Next-nearest neighbours/area factor={SECTIONS['next']}", "Sheet/length=4 cm",
    "Sheet/height=2.5 cm", "Output/frame interval=0", "Near tip/ahead=8 mm", "Near tip/behind=10 mm", "Near tip/half height=9 mm")]
COMPONENTS = {"displacement": 3, "excess_displacement": 3, "velocity": 3, "deformation_gradient": 9, "first_piola_stress": 9,
              "cauchy_stress": 9, "strain_gradient_x": 9, "strain_gradient_y": 9, "occupancy": 1}


def fracture(folder, *options):
    """A crack in the strip. Its numbers need not be the paper's, so the verdict may be 3."""
    latcon("fracture", CASES / "fig1.prm", "--output-dir", folder, *STRIP, *options, expect=(0, 3))
    return read_json(folder / "near_tip.json")


@pytest.fixture(scope="module")
def found(module_path):
    return fracture(module_path / "out")


def test_writes_numbers_and_fields(module_path, found):
    out = module_path / "out"
    assert found["samples"] > 10 and found["reason"] == ""
    for name, value in found.items():
        if not name.endswith("_uncertainty") and name + "_uncertainty" in found and "vortex" not in name:
            assert value is not None, name
    assert 0 <= found["samples_with_vortex"] <= found["vortices_of_samples"] and found["samples_with_vortex"] <= 1
    crack = read_json(out / "crack.json")
    ratio = crack["speed_lagrangian"] / found["shear_speed"]
    assert found["speed_over_shear"] == pytest.approx(ratio, abs=5e-13)
    # The speed of long shear waves along x, from the bonds (theory-comparison.md, eqs. (W.1) and (W.2)).
    stiffness = (LOADED.weight * LOADED.N[:, 0]**2 * LOADED.h[:, 1, 1]).sum()
    assert found["shear_speed"] / math.sqrt(stiffness / 944) == pytest.approx(1, abs=1e-6)
    for name in ("near_tip.vti", "near_tip_folded.vti"):
        image = read(out / name)
        arrays = {name: np.asarray(image.PointData[name]) for name in image.PointData.keys()}
        assert {n: a.size // len(arrays["occupancy"]) for n, a in arrays.items()} == COMPONENTS
        assert image.FieldData["Samples"][0] == found["samples"]
        columns, rows, _ = image.GetDimensions()
        assert (columns, rows) == (16 + 1 + 12, 2 * 16 + 1)
        d, height = 0.625e-3, math.sqrt(0.75) * 0.625e-3
        assert (*image.GetSpacing()[:2], *image.GetOrigin()[:2]) == pytest.approx((d, height, -16 * d, -16 * height), abs=1e-12)
        # From 2 d to 7 d ahead of the tip, which the strip always reaches, the sheet is whole, and F is the
        # gradient of the mean position: both are averages over a spacing or two.
        whole = arrays["occupancy"].reshape(rows, columns)[:, 18:24]
        assert abs(whole - 1).max() < 1e-12
        u = arrays["displacement"].reshape(rows, columns, 3)[:, 18:24, 0]
        F = arrays["deformation_gradient"].reshape(rows, columns, 9)[:, 19:23, 0]
        assert abs((u[:, 2:] - u[:, :-2]) / (2 * d) + 1 - F).max() < 0.1
        assert F.min() > 1.5
        # A steady crack has v_x / c = 1 - F_xX / F0_xX (theory.md, eq. (N.1)), with c = 2.3 C. This one oscillates, and
        # its mean over samples is steady up to a fraction of the deviation from the loaded sheet.
        steady = 1 - arrays["deformation_gradient"].reshape(rows, columns, 9)[:, 18:24, 0] / 2.3
        speed = arrays["velocity"].reshape(rows, columns, 3)[:, 18:24, 0] / (2.3 * crack["speed_lagrangian"])
        assert ((speed - steady)**2).mean() < 0.5**2 * (steady**2).mean()
    assert {"near_tip_velocity.png", "near_tip_stress.png"} <= {path.name for path in out.iterdir()}


def test_measures_of_samples_and_of_their_mean_agree_in_kind(found):
    for name in ("process_zone_share", "process_zone_share_of_samples"):
        assert 0 <= found[name] <= 1
        assert 0 < found[f"{name}_uncertainty"] < found[name]
    assert found["negative_zone_depth_of_samples"] < 0
    assert found["negative_zone_area_of_samples"] > 0
    # Cauchy sigma_yy of the loaded sheet, from the bonds: P_yY F_yy / det F.
    stress = (LOADED.weight * LOADED.pull * LOADED.N[:, 1]**2).sum() * 2.8 / 2.3
    assert found["far_opening_stress"] / stress == pytest.approx(1, abs=1e-12)
    for radius in ("4d", "8d"):
        assert found[f"opening_stress_concentration_{radius}"] * stress == (
            pytest.approx(found[f"opening_stress_peak_{radius}"], abs=1e-9 * stress))


def test_samples_as_often_whatever_the_time_step(tmp_path):
    interval = 2e-5
    for integrator in ("velocity-verlet", "runge-kutta-chebyshev"):
        folder = tmp_path / integrator
        found = fracture(folder, "--set", f"Near tip/interval={interval}", "--set", f"Time/integrator={integrator}", "--no-report")
        tips = read_csv(folder / "crack.csv")
        entry = [float(tip["t"]) for tip in tips if float(tip["X"]) >= found["sampled_from"]][0]
        last = [float(tip["t"]) for tip in tips if float(tip["X"]) > found["sampled_to"]]
        end = last[0] if last else read_json(folder / "crack.json")["end_time"]
        # One sample in each interval, of which the first and the last are incomplete.
        assert found["samples"] == pytest.approx((end - entry) / interval, abs=1.01), integrator
        assert found["samples"] > 10


def test_says_when_there_was_no_running_crack(out):
    found = fracture(out, "--set", "Time/end=0.05 ms", "--no-report")
    assert (found["samples"], found["negative_zone_area"], found["wedge_angle"]) == (0, None, None)
    assert "the crack did not run" in found["reason"]
    assert found["shear_speed"] > 0
    assert not (out / "near_tip.vti").exists()
    shutil.rmtree(out)
    latcon("fracture", CASES / "fig1.prm", "--output-dir", out, *STRIP, "--set", "Time/end=0.05 ms",
           "--set", "Near tip/interval=0", "--no-report", expect=(0, 3))
    assert [path.name for path in out.glob("near_tip*")] == []
