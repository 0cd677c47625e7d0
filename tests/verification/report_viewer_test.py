"""Tests of the report in Chromium: the viewer shows the values of the files, and plots and page respond to the reader."""
import hashlib
import json
import re
from dataclasses import replace
from unittest import mock

import numpy as np
import pytest

from browser import Browser
from made_up_sheet import FRAMES, SPACING, write_torn_sheet
from made_up_runs import HOLDS, REPORTED, main, write_verification

from latcon.files import read_series
from latcon.frames import read_frame
from latcon.report import sheet_data
from latcon.report.runs import read_motion, read_run

SCREEN = 800  # height of a window [pixels]
# Half of the last digit shown, and half of the step stored (sheet_data.py).
PLACE = (0.5e-6, SPACING / 2000 / 2)  # [m]
SPEED = 0.5e-2  # [m/s]
STRETCH = (0.5e-3, 2**0.5 / 2000)
VALUES = re.compile(r"site (\d+): X (\S+) cm, Y (\S+) cm, x (\S+) cm, y (\S+) cm, speed (\S+) m/s, damage (\S+?)"
                    r"(?:; bond (\d+)–(\d+): stretch (\S+))?$")


class File:
    """A frame, values by the number of the site."""

    def __init__(self, path, site=None):
        frame = read_frame(path, 0.0)
        self.reference, self.place, self.damage = frame.reference, frame.position, frame.fields.get("damage")
        self.speed = np.linalg.norm(frame.fields["velocity"], axis=1)
        self.site = frame.fields["site"] if site is None else site
        self.point = {int(number): point for point, number in enumerate(self.site)}
        self.stretch = {frozenset(pair): value for pair, value in zip(self.site[frame.bonds].tolist(), frame.stretch)}


@pytest.fixture(scope="module")
def browser():
    """A browser, which takes seconds to start."""
    with Browser(1280, SCREEN) as browser:
        yield browser


class TestViewer:
    @pytest.fixture(scope="class")
    def shown(self, module_path, browser):
        """The folder of a page, and a browser."""
        runs = module_path / "runs"
        write_verification(runs / "verify", [HOLDS, REPORTED])
        write_torn_sheet(runs / "torn")
        assert main(["report", str(runs), "--quiet"]) == 0
        return runs, browser

    @pytest.fixture(autouse=True)
    def opened(self, shown):
        """Opens the page, which asks for nothing outside of it and prints no error."""
        self.runs, self.browser = shown
        self.browser.open(self.runs / "report.html")
        yield
        assert self.browser.said() == []
        assert [url for url in self.browser.requested() if not url.startswith(("data:", "blob:"))] == []

    def canvas(self, name="sheet"):
        """Digest of what a canvas shows."""
        url = self.browser.value(f"document.querySelector('.viewer .{name}').toDataURL()")
        return hashlib.sha256(url.encode()).hexdigest()

    def text(self, name):
        return self.browser.value(f"document.querySelector('.viewer .{name}').textContent")

    def place(self, selector):
        """Left, top, width and height of an element in the window, which shows it."""
        return self.browser.value(f"(() => {{ const e = document.querySelector('{selector}');"
                                  "e.scrollIntoView({block: 'center'}); "
                                  "const r = e.getBoundingClientRect(); return [r.left, r.top, r.width, r.height]; })()")

    def key(self, key):
        codes = {"Home": 36, "End": 35, "ArrowLeft": 37, "ArrowRight": 39}
        for kind in ("keyDown", "keyUp"):
            self.browser.call("Input.dispatchKeyEvent", type=kind, key=key, code=key, windowsVirtualKeyCode=codes[key])

    def choose(self, name, value):
        self.browser.value(f"(() => {{ const s = document.querySelector('.viewer .{name}'); s.value = '{value}';"
                           "s.dispatchEvent(new Event('change', {bubbles: true})); })()")

    def test_the_slider_moves_the_sheet(self):
        times = [time for time, _ in read_series(self.runs / "torn" / "motion.pvd")]
        assert self.text("time") == f"{1e3 * times[-1]:.3f} ms"
        self.browser.value("document.querySelector('.viewer .slider').focus()")
        shown = {"sheet": [self.canvas()], "near-tip": [self.canvas("near-tip")]}
        self.key("Home")
        for number in range(3):
            assert self.text("time") == f"{1e3 * times[number]:.3f} ms"
            for name, digests in shown.items():
                digests.append(self.canvas(name))
            self.key("ArrowRight")
        self.key("End")
        for name, digests in shown.items():
            assert len(set(digests)) == 4, name
            assert self.canvas(name) == digests[0], name

    def hover(self, canvas):
        """Values below points of a canvas: [(pointer, match of VALUES), ...]. A mouse would take a frame at each point."""
        left, top, width, height = self.place(f".viewer .{canvas}")
        pointers = [[left + u * width, top + v * height] for u in np.linspace(0.05, 0.95, 12) for v in np.linspace(0.08, 0.92, 7)]
        texts = self.browser.value(f"""{pointers}.map(([clientX, clientY]) => {{
            document.querySelector('.viewer .{canvas}').dispatchEvent(new PointerEvent('pointermove', {{clientX, clientY}}));
            return document.querySelector('.viewer .values').textContent; }})""")
        found = [(pointer, match) for pointer, match in zip(pointers, map(VALUES.match, texts)) if match]
        assert len(found) > 10
        self.browser.mouse("mouseMoved", *found[0][0])
        assert self.text("values") == found[0][1].string
        self.browser.mouse("mouseMoved", 1, 1)
        assert "Point at the sheet" in self.text("values")
        return found

    def check_values(self, file, full, found, configuration):
        """Checks that each number is that of the file, and that sites are at the pointer, on one scale for x and y."""
        fastest = max(File(path, file.site).speed.max() for _, path in read_series(self.runs / "torn" / "motion.pvd"))
        speed_step = fastest / 65535 / 2
        pointers, places = [], []
        for pointer, match in found:
            site, *numbers, first, second, stretch = match.groups()
            X, Y, x, y, speed, damage = map(float, numbers)
            point = file.point[int(site)]
            assert (X / 100, Y / 100) == pytest.approx(tuple(file.reference[point]), abs=1.001 * PLACE[0])
            assert (x / 100, y / 100) == pytest.approx(tuple(file.place[point]), abs=1.001 * sum(PLACE))
            assert speed == pytest.approx(file.speed[point], abs=1.001 * (SPEED + speed_step))
            pointers.append(pointer)
            places.append((file.reference if configuration == "undeformed" else file.place)[point])
            if first is not None:
                a, b = file.point[int(first)], file.point[int(second)]
                expected = np.hypot(*(file.place[a] - file.place[b])) / np.hypot(*(file.reference[a] - file.reference[b]))
                assert float(stretch) == pytest.approx(expected, abs=1.001 * sum(STRETCH))
            if full is not None:
                assert damage == pytest.approx(full.damage[point], abs=0.51e-3)
                if first is not None:  # fails for a bond that has broken
                    assert float(stretch) == pytest.approx(full.stretch[frozenset((int(first), int(second)))], abs=1.001 * sum(STRETCH))
        pointers, places = np.array(pointers), np.array(places)
        x, y = (np.polyfit(places[:, axis], pointers[:, axis], 1) for axis in (0, 1))
        assert x[0] / -y[0] == pytest.approx(1, abs=0.02)
        away = np.hypot(np.polyval(x, places[:, 0]) - pointers[:, 0], np.polyval(y, places[:, 1]) - pointers[:, 1])
        assert np.median(away) < 0.6 * x[0] * SPACING * 1.8  # of a spacing, stretched

    @pytest.mark.parametrize("number, configuration, canvas", [
        (FRAMES - 1, "deformed", "sheet"), (FRAMES - 1, "deformed", "near-tip"), (5, "undeformed", "sheet"), (0, "deformed", "sheet")])
    def test_values_below_the_pointer_are_those_of_the_file(self, number, configuration, canvas):
        whole = File(self.runs / "torn" / "lattice-0001.vtp")
        self.choose("configuration", configuration)
        self.browser.value(f"document.querySelector('.viewer').viewer.show({number})")
        file = File(read_series(self.runs / "torn" / "motion.pvd")[number][1], whole.site)
        self.check_values(file, whole if number == FRAMES - 1 else None, self.hover(canvas), configuration)

    def test_colours_and_configurations_differ(self):
        shown = set()
        for configuration in ("deformed", "undeformed"):
            self.choose("configuration", configuration)
            for colour, words in (("speed", "[m/s]"), ("stretch", "stretch of bonds"), ("damage", "fraction of bonds broken")):
                self.choose("colour", colour)
                shown.add(self.canvas())
                assert words in self.text("colour-name")
        assert len(shown) == 6
        self.browser.value("(() => { const s = document.querySelector('.viewer .sheet'); s.width = s.width; })()")  # wipes it
        assert self.canvas() not in shown

    def test_plots_give_the_values_below_the_pointer(self):
        for name, columns in (("path", ("X", "Y")), ("energy", ("t", "broken"))):
            folder = self.runs / "torn"
            table = np.genfromtxt(folder / ("crack.csv" if name == "path" else "energy.csv"), delimiter=",", names=True)
            left, top, width, height = self.place(f".plot.{name}")
            self.browser.mouse("mouseMoved", left + 0.6 * width, top + 0.4 * height)
            shown = self.browser.value(f"[...document.querySelectorAll('[data-plot^={name}] .legend b')]"
                                       ".map((b) => b.textContent)")
            scale = (100, 1e3) if name == "path" else (1e3, 1)
            first, second = (scale[i] * table[column] for i, column in enumerate(columns))
            row = np.abs(first - float(shown[0])).argmin()
            assert float(shown[0]) / first[row] == pytest.approx(1, abs=0.5e-4)
            value = second[row] - (second[0] if name == "energy" else 0)
            assert float(shown[1 if name == "path" else 2]) / value == pytest.approx(1, abs=0.5e-4)


def report_ranges(folder):
    """Ranges of the colours of a run by itself."""
    run = read_run(folder)
    return sheet_data.sheet_data(run, read_motion(run), 10**9).contents["ranges"]


def test_both_sheets_show_the_same_time(tmp_path, browser):
    folder = tmp_path
    first = "<b>one<!--<script>"
    for run in (first, "other"):
        write_torn_sheet(folder / run)
    record = folder / "other" / "run.json"
    record.write_text(record.read_text().replace('"3"', '"3.5"'))  # the breaking stretch
    listed = folder / "other" / "motion.pvd"
    frames = re.findall(r"<DataSet[^>]*>", listed.read_text())
    fewer = [frame for i, frame in enumerate(frames) if i % 3 != 1]
    listed.write_text("<VTKFile><Collection>" + "".join(fewer) + "</Collection></VTKFile>")
    times = [[time for time, _ in read_series(folder / run / "motion.pvd")] for run in (first, "other")]
    document = {"first": first, "second": "other", "first_folder": f"../{first}", "second_folder": "../other",
                "failed_checks": {"first": "", "second": ""}, "pattern": {"first": "oscillating", "second": "straight"},
                "quantities": [], "entries": [], "paths": None}
    (folder / "compare").mkdir()
    (folder / "compare" / "compare.json").write_text(json.dumps(document))
    assert main(["compare", str(folder / "compare"), "--quiet"]) == 0
    browser.open(folder / "compare" / "compare.html")
    browser.wait("document.querySelectorAll('.viewer.ready').length === 2")

    def shown():
        return browser.value("[...document.querySelectorAll('.viewer')].map((v) => v.viewer.frame)")
    for moved in (0, 1):
        for frame, time in enumerate(times[moved]):
            browser.value(f"(() => {{ const s = document.querySelectorAll('.viewer .slider')[{moved}];"
                          f"s.value = {frame}; s.dispatchEvent(new Event('input', {{bubbles: true}})); }})()")
            nearest = [int(np.abs(np.array(all_times) - time).argmin()) for all_times in times]
            assert shown() == nearest
    browser.value("(() => { const s = document.querySelectorAll('.viewer .colour')[1]; s.value = 'damage';"
                  "s.dispatchEvent(new Event('change', {bubbles: true})); })()")
    assert browser.value("[...document.querySelectorAll('.viewer')].map((v) => v.viewer.quantity)") == ["damage", "damage"]
    ranges = browser.value("[...document.querySelectorAll('.viewer')].map((v) => v.viewer.sheet.ranges)")
    own = [report_ranges(folder / run) for run in (first, "other")]
    assert own[0] != own[1]
    for name, (low, high) in ranges[0].items():
        assert [low, high] == [min(one[name][0] for one in own), max(one[name][1] for one in own)]
        assert ranges[1][name] == [low, high]
    assert f"{len(fewer)} frames" in browser.value("document.body.innerText")
    assert f"Y of {first} [mm]" in browser.value("document.querySelector('.legend').textContent")
    assert browser.said() == []


def test_a_damaged_comparison_is_bad_input(tmp_path):
    for text in ("", '{"first": "one"}'):
        (tmp_path / "compare.json").write_text(text)
        assert main(["compare", str(tmp_path)]) == 2
    assert not (tmp_path / "compare.html").exists()


def test_a_sheet_takes_no_more_than_it_may(tmp_path):
    """Random displacements do not compress: frames are dropped until they fit."""
    write_torn_sheet(tmp_path / "run")
    run = read_run(tmp_path / "run")
    motion = read_motion(run)
    generator, step = np.random.default_rng(5), SPACING / sheet_data.STEPS_PER_SPACING
    motion = replace(motion, frames=[
        replace(frame, time=frame.time + 1e-6 * copy,
                position=frame.position + step * generator.integers(-512, 512, frame.position.shape))
        for frame in motion.frames for copy in range(4)])
    all_frames = sheet_data.sheet_data(run, motion, 10**9)
    sites = len(motion.whole.reference)
    # At least the 10 random bits of a coordinate; base64 has 4 letters for 3 bytes.
    assert len(all_frames.text) > len(motion.frames) * 2 * sites * 10 / 8 * 4 / 3
    most = len(all_frames.text) // 3
    fewer = sheet_data.sheet_data(run, motion, most)
    assert len(fewer.text) <= most
    with mock.patch.object(sheet_data, "contents", wraps=sheet_data.contents) as built:
        assert sheet_data.sheet_data(run, motion, 9 * sites) is None  # without a try of more frames than there are bytes
    assert [len(call.args[2]) for call in built.call_args_list] == [len(motion.frames) // 4]
    assert len(fewer.contents["times"]) >= sheet_data.FEWEST_FRAMES
    assert [fewer.contents["times"][end] for end in (0, -1)] == [motion.frames[end].time for end in (0, -1)]
    assert sheet_data.sheet_data(run, motion, most // 20) is None
