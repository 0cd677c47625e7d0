"""Tests of the page of a made-up study: checks, pictures of runs, numbers, maps. The gallery: tests/docs/gallery_test.py."""
import json
import pathlib
import re
from unittest import mock

import numpy as np
import pytest
from matplotlib.collections import LineCollection
from PIL import Image

from near_tip_plots_test import write_field
from made_up_runs import drawn, read_page, write_fracture

from latcon.report import phase_map, study, study_plots
from latcon.report.study_plots import MEASURED, NEAR_TIP, PATH, asked_quantities, draw_sweep
from latcon.report.study_runs import read_study

QUANTITIES = {quantity: None for quantity, *_ in MEASURED + NEAR_TIP} | {"speed_laboratory": 40.0, "end_time": 3e-3}


def made_up_seed(run, seed, pattern, state="measured", **values):
    """A seed in the format of study.json."""
    return {"run": run, "seed": seed, "folder": f"runs/{run}-{seed}", "state": state, "problem": "", "exit_code": 0,
            "pattern": pattern, "reason": "", "sites": 96, "values": {**QUANTITIES, **values}}


def made_up_row(runs, quantity, verdict="reported", against=None, **more):
    """A row of a claim."""
    values = [{"run": run, "against": place} for place, run in enumerate(runs, start=1)] if against else []
    return {"runs": runs, "quantity": quantity, "against": against, "against_unit": "1" if against else None, "expected": "", "measured": "", "note": "",
            "verdict": verdict, "values": values, **more}


def made_up_study():
    """study.json: an oscillating crack, a straight one, and two without next-nearest neighbours."""
    return json.loads(pathlib.Path(__file__).with_name("made_up_study.json").read_text()) | {
        "seeds": [
            made_up_seed("wavy", 1, None, state="failed"),
            made_up_seed("wavy", 2, "oscillating", wavelength=0.021, amplitude=1e-3, crest_amplitude=1.5e-3,
                         negative_zone_area=13e-6, bridged_length=0.0175),
            made_up_seed("wavy", 3, "oscillating", wavelength=0.023, negative_zone_area=15e-6),
            made_up_seed("calm", 1, "straight", opening_stress_ratio_4d=1.07),
            made_up_seed("along", 1, "oscillating"), made_up_seed("across", 1, "straight", wedge_angle=33.0)],
        "claims": [{"claim": "It winds", "paper": "It does.", "note": "", "verdict": "holds", "rows": [
            made_up_row(["wavy"], "pattern", "holds"),
            made_up_row(["calm", "wavy"], "wavelength", "holds", "zeta", measured="exponent 0.77")]}]}


class MadeUpStudy:
    @pytest.fixture(autouse=True)
    def set_up(self, tmp_path):
        self.folder = tmp_path
        self.document = made_up_study()
        for name in ("wavy-2", "calm-1", "along-1", "across-1"):
            write_fracture(self.folder / "runs" / name, [])
            write_field(self.folder / "runs" / name / "near_tip_folded.vti")

    def read(self):
        (self.folder / "study.json").write_text(json.dumps(self.document))
        return read_study(self.folder)

    def page(self, pictures=()):
        """The parsed page with the pictures of some runs, and its HTML."""
        self.document["pictures"] = list(pictures)
        self.read()
        drawn(self.folder, "--quiet", kind="study")
        html, page = read_page(self.folder, "study.html")
        return page, html


class TestStudyPage(MadeUpStudy):
    def test_pictures_of_a_run_are_of_its_first_measured_seed_and_small(self):
        page, _ = self.page(["wavy", "calm"])
        pictures = self.folder / "pictures"
        for run in ("wavy", "calm"):
            for kind in ("sheet", "velocity", "stress"):
                assert (pictures / f"{run}-{kind}.png").exists(), run
        assert "wavy, seed 2" in page.text
        largest = max(png.stat().st_size for png in pictures.glob("wavy-*.png"))
        with mock.patch.object(study, "LARGEST_PICTURE", largest // 2):
            self.page(["wavy"])
        for png in pictures.glob("wavy-*.png"):
            assert png.stat().st_size <= largest // 2

    def test_a_picture_shows_so_many_paths_as_a_page_can_have(self):
        with mock.patch.object(study_plots, "MOST_PATHS", 1), mock.patch.object(study_plots, "save") as saved:
            caption = study_plots.draw_paths(self.read(), ["wavy", "calm"], self.folder / "paths.png")
        assert caption.endswith("Shown: the first 1 of 2 runs.") and len(saved.call_args.args[0].axes) == 1

    def test_numbers_of_runs_are_means_over_seeds(self):
        page, _ = self.page()
        for words in ("2.20 ± 0.14 (2 of 3)", "14.0 ± 1.4 (2 of 3)", "1.75 (1 of 3)", "1.07 (1)", "33 (1)", "0.15 (1 of 3)", "verified: none"):
            assert words in page.text

    def sweep(self, row, *quantities):
        """Points drawn for a sweep, and the labels of its panels."""
        labels = []
        with mock.patch.object(study_plots, "save", wraps=study_plots.save) as saved:
            assert draw_sweep(self.read(), row, quantities, self.folder / "sweep.png")
            labels = [(axes.get_xlabel(), axes.get_ylabel()) for axes in saved.call_args.args[0].axes]
        return np.asarray(Image.open(self.folder / "sweep.png").convert("RGB"), dtype=float), labels

    def banner(self):
        """Class and head of the banner of a study whose rows were all judged."""
        self.document["seeds"] = [seed for seed in self.document["seeds"] if seed["state"] == "measured"]
        return re.search(r'<div class="banner (\w+)"><strong>(.*?)</strong>', self.page()[1]).groups()

    def test_is_green_only_if_everything_was_verified_measured_and_holds(self):
        self.document["verified"] = True
        assert self.banner() == ("holds", "✓ Holds: all 2 rows")
        for verified in (False, None, "yes"):
            self.document["verified"] = verified
            assert self.banner() == ("warns", "! Not verified: all 2 rows hold, but not every run was verified")
        del self.document["verified"]
        assert self.banner()[0] == "warns"
        self.document["verified"] = True
        rows = self.document["claims"][0]["rows"]
        rows[0]["verdict"], self.document["claims"][0]["verdict"] = "not measured", "incomplete"
        assert self.banner() == ("warns", "! Incomplete: 1 row holds, but not everything was measured")
        page, html = self.page()
        assert "! incomplete" in page.text
        assert '<tr class="warns"><td class="verdict">! not measured</td>' in html
        for row in rows:
            row["verdict"] = "reported"
        assert self.banner() == ("reported", "· Reported: no row has a rule")

    def test_sweeps_show_what_is_asked_for_with_units(self):
        row = made_up_row(["calm", "wavy"], "speed_lagrangian", against="Near tip/interval", against_unit="s")
        pictures = []
        for speed in (20.0, 10.0):
            self.document["seeds"][1]["values"]["speed_lagrangian"] = speed
            self.document["seeds"][3]["values"]["speed_lagrangian"] = 21.0
            picture, labels = self.sweep(row, "speed_lagrangian", "end_time")
            pictures.append(picture)
        assert labels == [("Near tip/interval [ms]", "speed [m/s]"), ("Near tip/interval [ms]", "end time [ms]")]
        changed = np.nonzero(np.abs(pictures[0] - pictures[1]).max(axis=(0, 2)) > 30)[0]
        assert len(changed) > 5
        assert changed.max() < 0.5 * pictures[0].shape[1]
        assert asked_quantities([row, made_up_row([], "pattern"), made_up_row([], "wavelength")]) == ["speed_lagrangian", *PATH]


class TestMaps(MadeUpStudy):
    """Pages of studies that vary one entry or two: a grid of 3 x 2 cells with two seeds."""

    def vary(self, entries, patterns):
        """Turns the study into one without claims, whose runs have these values of entries and patterns of two seeds."""
        names = [f"r{number}" for number in range(len(patterns))]
        self.document.update(
            claims=[], checks=[], runs=[{"run": name, "about": "", "set": {}} for name in names],
            seeds=[made_up_seed(name, seed, pattern, wavelength=0.02 + 0.001 * place, speed_lagrangian=20.0 + place)
                   for place, (name, both) in enumerate(zip(names, patterns)) for seed, pattern in enumerate(both, start=1)],
            swept=list(entries), varied=[{"entry": entry, "unit": "m", "values": values} for entry, values in entries.items()])

    GRID = {"Sheet/width": [0.01, 0.01, 0.02, 0.02, 0.03, 0.03], "Sheet/depth": [1.0, 2.0] * 3}
    WAVY, CALM = ("oscillating", "oscillating"), ("straight", "straight")

    def test_map_shows_points_of_a_refinement_and_the_boundary(self):
        grid, middle = list(self.GRID.values()), ([0.015, 0.015, 0.02], [1.0, 2.0, 1.5])
        self.vary({name: values + more for name, values, more in zip(self.GRID, grid, middle)},
                  [self.CALM] * 2 + [self.WAVY] * 4 + [self.CALM, ("straight", "oscillating"), self.WAVY])
        for run in self.document["runs"][6:]:
            run["level"] = 1
        with mock.patch.object(phase_map, "save", wraps=phase_map.save) as saved:
            study_plots.draw_map(self.read(), self.folder / "map.png")
        axes = saved.call_args.args[0].axes[0]
        boxes = [tuple(round(number, 9) for number in patch.get_bbox().bounds) for patch in axes.patches]
        # The cells of the grid are those of the map without the refinement; a cell whose seeds disagree is divided.
        assert boxes[:6] == [(x, y, 1, 100) for x in (0.5, 1.5, 2.5) for y in (50, 150)]
        assert boxes[6:] == [(1.25, 75, 0.5, 50), (1.25, 175, 0.25, 50), (1.5, 175, 0.25, 50), (1.75, 125, 0.5, 50)]
        # At the depth of 100 cm between 1.5 and 2 cm, at 200 cm between 1 and 2 cm, since the point between them is mixed.
        bars = [segment for collection in axes.collections if isinstance(collection, LineCollection)
                for segment in collection.get_segments()]
        np.testing.assert_allclose(bars, [[[1.5, 100], [2, 100]], [[1, 200], [2, 200]]])
        assert "boundary" in [text.get_text() for text in axes.figure.legends[0].get_texts()]

    def test_map_over_decades_is_logarithmic(self):
        self.vary({"Sheet/width": [0.01] * 2 + [0.1] * 2 + [1.0] * 2, "Sheet/depth": [1.0, 2.0] * 3}, [self.CALM] * 4 + [self.WAVY] * 2)
        with mock.patch.object(phase_map, "save", wraps=phase_map.save) as saved:
            study_plots.draw_map(self.read(), self.folder / "map.png")
        axes = saved.call_args.args[0].axes[0]
        assert axes.get_xlim() == pytest.approx((-0.5, 2.5)) and axes.get_ylim() == pytest.approx((50, 250))
        assert [axes.xaxis.get_major_formatter()(power, 0) for power in (0, 1, 2)] == ["1", "10", "100"]

    def brackets(self, patterns, values=(0, 1, 2, 3, 4), levels=None):
        cells = [phase_map.Cell(x, 5.0, dict.fromkeys(both, 1), level=level)
                 for x, both, level in zip(values, patterns, levels or [0] * len(patterns))]
        return [(found.low, found.high, *found.patterns) for found in phase_map.brackets(cells)]

    def test_boundary_lies_between_the_nearest_points_that_are_clear(self):
        a, b, mixed, unclear, none = {"straight"}, {"oscillating"}, {"straight", "oscillating"}, {"undecided"}, {}
        assert self.brackets([a, a, b, b]) == [(1, 2, "straight", "oscillating")]
        assert self.brackets([a, mixed, unclear, b, a]) == [(0, 3, "straight", "oscillating"), (3, 4, "oscillating", "straight")]
        assert self.brackets([a, a, mixed, a]) == []
        assert self.brackets([a, none, b]) == []  # nothing was measured in between
        assert self.brackets([a, b, b], (0, 1, 0.5), (0, 0, 1)) == [(0, 0.5, "straight", "oscillating")]

    def test_sweep_shows_the_power_law_of_a_row(self):
        self.vary({"Sheet/width": [0.01, 0.02, 0.03]}, [self.CALM, self.WAVY, self.WAVY])
        fit = {"exponent": {"value": 0.5}, "onset": {"value": 0.01}, "prefactor": 0.2, "p_fit": 0.5}
        row = made_up_row(["r0", "r1", "r2"], "wavelength", against="Sheet/width", onset=fit)
        for value, width in zip(row["values"], (0.01, 0.02, 0.03)):
            value["against"] = width
        row["against_unit"] = "m"
        self.document["claims"] = [{"claim": "It does", "paper": "", "note": "", "verdict": "holds", "rows": [row]}]
        with mock.patch.object(study_plots, "save", wraps=study_plots.save) as saved:
            study.draw_sweeps(self.read(), 0, self.document["claims"][0], self.folder)
        (curve,) = [line for line in saved.call_args.args[0].axes[0].lines if len(line.get_xdata()) == 200]
        np.testing.assert_allclose(curve.get_xdata()[[0, -1]], [1, 3])
        np.testing.assert_allclose(curve.get_ydata()[[0, -1]], [0, 100 * 0.2 * 0.02 ** 0.5], atol=1e-12)

    def test_study_of_two_entries_shows_the_map_and_needs_no_claim(self):
        self.vary(self.GRID, [self.CALM] * 3 + [self.WAVY] * 3)
        page, html = self.page()
        assert "Patterns over Sheet/width and Sheet/depth" in page.text
        assert 'id="summary"' not in html
        assert (self.folder / "pictures" / "map.png").exists()
        first = self.document["varied"][0]["values"]
        for index, value in ((0, "auto"), (0, 0.02), (2, 0.01)):  # not a number; the points of other cells
            self.document["varied"][0]["values"] = first[:index] + [value] + first[index + 1:]
            assert study_plots.draw_map(self.read(), self.folder / "map.png") is None
        self.document["varied"][0]["values"] = first
        assert study_plots.draw_map(self.read(), self.folder / "map.png") is not None
        self.document["varied"].append({"entry": "Sheet/orientation", "unit": "", "values": ["a"] * 5 + ["b"]})
        assert study_plots.draw_map(self.read(), self.folder / "map.png") is None
        del self.document["varied"][2]
        self.document["swept"] = []  # named runs, which happen to vary two entries
        assert "Patterns over" not in self.page()[0].text
