"""Tests of the views of a crack in ParaView, verification/paraview/, on a virtual display."""
import json

import numpy as np
from PIL import Image

from near_tip_plots_test import write_field
from paraview_display import ParaView
from report_test import write_frame, write_series

BREAKING = 3.0
RED, GREEN = (213, 94, 0), (0, 158, 115)  # bonds beyond the breaking stretch; outline of the zone of backward motion
YELLOW = (253, 231, 37)  # the upper end of the scale


def near(pixels, colour):
    """Number of pixels with a colour."""
    return np.count_nonzero(np.abs(pixels - colour).max(axis=2) < 12)


def write_run(folder):
    """A sheet of 40 by 30 sites, stretched 2 by 1.5 times, its bonds ever more stretched to the right, and at the last
    time torn between two rows; fields around a tip."""
    columns, rows = np.meshgrid(np.arange(40), np.arange(30))
    reference = np.column_stack((columns.ravel(), rows.ravel() - 14.5, np.zeros(1200))) * 1e-3
    number = np.arange(1200).reshape(30, 40)
    along = np.column_stack((number[:, :-1].ravel(), number[:, 1:].ravel()))
    across = np.column_stack((number[:-1].ravel(), number[1:].ravel()))
    for name, torn in (("lattice-0000.vtp", 0), ("lattice-0001.vtp", 30)):
        holds = ~((across[:, 0] // 40 == 14) & (across[:, 0] % 40 < torn))
        bonds = np.concatenate((along, across[holds]))
        stretch = 1.0 + 2.4 * reference[bonds[:, 0], 0] / 0.04  # up to 3.34
        stretch = np.concatenate((np.ones(1200), stretch))
        speed = np.linspace(0, 40, 1200)
        fields = {"displacement": reference * (1.0, 0.5, 0.0),
                  "velocity": np.column_stack((speed, 0 * speed, 0 * speed)),
                  "cauchy_stress": np.outer(1e4 * speed, np.eye(9)[4]), "damage": speed / 40}
        write_frame(folder / name, reference, fields, bonds, stretch)
    write_series(folder / "lattice.pvd", {"lattice-0000.vtp": 0.0, "lattice-0001.vtp": 2e-3})
    (folder / "run.json").write_text(json.dumps({"entries": {"Fracture/breaking stretch": str(BREAKING)}}))
    (folder / "crack.csv").write_text("t,X,Y,x,y\n0,0.001,0,0.002,0\n0.001,0.03,0,0.06,0\n")
    (folder / "crack.json").write_text('{"pattern": "straight", "speed_laboratory": 50.0}')
    (folder / "near_tip.json").write_text('{"samples": 7, "sampled_to": 0.031}')
    write_field(folder / "near_tip_folded.vti")


class Looks(ParaView):
    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        write_run(cls.folder)

    def picture(self, script, *arguments):
        """Colours of a screenshot."""
        path = self.folder / "picture.png"
        path.unlink(missing_ok=True)
        run = self.script(script, self.folder, "--screenshot", path, *arguments)
        self.assertEqual(run.returncode, 0, run.stderr)
        return np.asarray(Image.open(path).convert("RGB")).astype(int)

    def test_sheet_shows_bonds_beyond_the_breaking_stretch_and_the_crack(self):
        torn, whole = (self.picture("deformed_sheet.py", "--time", time) for time in ("2", "0"))
        for pixels in (torn, whole):
            self.assertGreater(near(pixels, RED), 300)
            # The sheet is 78 by 43.5 mm as deformed, with bonds of 2 mm along x.
            shown = np.abs(pixels[40:-100] - 255).max(axis=2) > 60
            rows, columns = np.flatnonzero(shown.mean(axis=1) > 0.3), np.flatnonzero(shown.mean(axis=0) > 0.2)
            self.assertAlmostEqual(np.ptp(columns) / np.ptp(rows), 78 / 43.5, delta=0.05)
        # A quarter of the bonds between two rows in the middle remain.
        shown = [np.count_nonzero(np.abs(pixels - 255).max(axis=2) > 60, axis=1) for pixels in (torn, whole)]
        middle = int(np.argmax(shown[1] - shown[0]))
        self.assertLess(shown[0][middle], 0.5 * shown[1][middle])

    def test_sheet_shows_other_fields(self):
        pictures = [self.picture("deformed_sheet.py", "--field", field)
                    for field in ("speed", "opening-stress", "damage")]
        for pixels in pictures:
            self.assertEqual(near(pixels, RED), 0)
            self.assertGreater(pixels.std(), 10)
        self.assertGreater(np.abs(pictures[0] - pictures[1]).max(axis=2).astype(bool).mean(), 0.05)

    def test_near_the_tip_what_moves_back_is_outlined(self):
        pixels = self.picture("near_tip.py")
        left, right = np.split(pixels, 2, axis=1)
        self.assertGreater(near(right, GREEN), 200)
        self.assertEqual(near(left, GREEN), 0)
        self.assertGreater(near(left, RED), 100)

    def test_near_the_tip_stress_is_highest_there(self):
        right = np.split(self.picture("near_tip.py", "--field", "opening-stress"), 2, axis=1)[1]
        rows, columns = np.nonzero(np.abs(right[:-180] - YELLOW).max(axis=2) < 25)
        self.assertGreater(len(rows), 20)
        # The tip is 20 of 36 pitches from the left end of the sheet, which fills nine tenths of the view.
        self.assertAlmostEqual(np.median(columns) / right.shape[1], 0.05 + 0.9 * 20 / 36, delta=0.06)

    def test_refuse_what_they_cannot_show(self):
        for words, part in ((["deformed_sheet.py", self.folder / "none"], "lattice.pvd"),
                            (["near_tip.py", self.folder / "none"], "near_tip_folded.vti"),
                            (["near_tip.py", self.folder, "--unfolded"], "near_tip.vti"),
                            (["deformed_sheet.py", self.folder, "--field", "colour"], "opening-stress")):
            run = self.script(*words)
            self.assertEqual(run.returncode, 2)
            self.assertIn(part, run.stderr)
