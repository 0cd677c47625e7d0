"""Made-up runs and the pages drawn of them, for the tests of the report."""
import base64
import contextlib
import io
import json
import re
from html.parser import HTMLParser

import numpy as np
from PIL import Image

from latcon.frames import Frame, write_frame
from latcon.report.__main__ import main

# The crack of the made-up run [m].
WAVELENGTH, AMPLITUDE, PHASE, OFFSET, SLOPE = 0.02, 0.0012, 0.7, 0.0003, 0.004
BEGIN, END = 0.03, 0.09
MOTION_FRAMES = 5
VOID = {"meta", "br", "hr", "img", "link", "input", "source"}


def path_of_tip(X):
    """The sinusoid of the made-up run about the middle of the window."""
    return OFFSET + SLOPE * X + AMPLITUDE * np.sin(2 * np.pi * X / WAVELENGTH + PHASE)


def check_row(claim, quantity, verdict, **numbers):
    """A row of results.json."""
    empty = dict.fromkeys(("lattice", "continuum", "theory", "error", "tolerance"))
    return {"claim": claim, "quantity": quantity, "unit": "m", **empty, **numbers, "verdict": verdict}


HOLDS = check_row("energy", "c^2 <of> a wave", "holds", lattice=1.25, error=2e-3, tolerance=1e-2)
FAILS = check_row("prestretch", "traction", "fails", lattice=3.5, continuum=3.0, error=0.17, tolerance=1e-2)
REPORTED = check_row("energy", "residual", "reported", continuum=0.042, error=0.042)
PUBLISHED = check_row("fracture", "wavelength, undeformed", "holds", lattice=WAVELENGTH, theory=0.021, error=0.048, tolerance=0.2)


def write_verification(folder, rows, **info):
    """A run without a crack."""
    folder.mkdir(parents=True, exist_ok=True)
    (folder / "results.json").write_text(json.dumps({"claims": rows, "verdict": "holds"}))
    (folder / "run.json").write_text(json.dumps({"version": "1.2.3", "exit_code": 0, "entries": {"Fracture/breaking stretch": "3"}, **info}))
    (folder / "case.prm").write_text("subsection Fracture\n  set breaking stretch = 3 # default: auto\nend\n")


def write_table(path, header, columns):
    """A CSV file."""
    np.savetxt(path, np.column_stack(columns), delimiter=",", header=header, comments="", fmt="%.17g")


def write_fracture(folder, rows, has_sheet=True, **info):
    """A run with an oscillating crack; its sheet takes most of the time of a page."""
    write_verification(folder, rows, **info)
    X = np.linspace(0.01, 0.095, 300)
    t = X / 20
    Y = path_of_tip(X)
    write_table(folder / "crack.csv", "t,X,Y,x,y,speed,bonds_broken", (t, X, Y, 2 * X, 3 * Y, 0 * t + 20, 10 * X))
    write_table(folder / "broken_bonds.csv", "t,site,other_site,X,Y,stretch", (t, 0 * t, 0 * t + 1, X, Y, 0 * t + 3))
    write_table(folder / "energy.csv", "t,elastic,kinetic,viscous,broken,boundary_work,contact,imbalance",
                (t, 100 - 1e4 * t, 2e3 * t, 5e3 * t, 3e3 * t, 0 * t, 0 * t, 1e-6 * t))
    crack = {"pattern": "oscillating", "reason": "it winds", "window_begin": BEGIN,
             "window_end": END, "speed_lagrangian": 20.0, "speed_lagrangian_uncertainty": 0.2,
             "wavelength": WAVELENGTH, "wavelength_uncertainty": 1.5e-4, "amplitude": AMPLITUDE,
             "amplitude_uncertainty": 1e-4, "sinusoid_offset": OFFSET, "sinusoid_slope": SLOPE, "sinusoid_phase": PHASE}
    (folder / "crack.json").write_text(json.dumps(crack))
    near_tip = {"samples": 84, "reason": "", "negative_zone_area": 1.4546e-5, "negative_zone_area_uncertainty": 1.88e-6,
                "samples_with_vortex": 0.25, "samples_with_vortex_uncertainty": 0.13,
                "opening_stress_peak_4d": 660930.0, "opening_stress_peak_4d_uncertainty": None, "wedge_angle": None,
                "wedge_angle_uncertainty": None, "units": "SI"}
    (folder / "near_tip.json").write_text(json.dumps(near_tip))
    if has_sheet:
        write_sheet(folder)


def opening(stress):
    """Tensors with this opening stress alone."""
    return np.multiply.outer(stress, np.diag([0.0, 1.0]))


def write_sheet(folder):
    """A frame of 12 by 8 sites with the file that names it and its time, and frames of the motion."""
    columns, rows = np.meshgrid(np.arange(12), np.arange(8))
    reference = np.column_stack((columns.ravel(), rows.ravel())) * 1e-2
    bonds = np.array([(i, i + 1) for i in range(96) if i % 12 < 11])
    speed = np.linspace(0, 30, 96)
    velocity = np.column_stack((speed, 0 * speed))
    write_sites(folder / "lattice-0000.vtp", reference, {
        "displacement": 1.3 * reference, "velocity": velocity, "cauchy_stress": opening(1e4 * speed), "damage": speed / 40,
        "site": np.arange(96)}, bonds, np.linspace(1.5, 4.0, len(bonds)))
    write_series(folder / "lattice.pvd", {"lattice-0000.vtp": 0.004})
    names = {f"motion-{i:04}.vtp": 1e-3 * i for i in range(MOTION_FRAMES)}
    for name, time in names.items():
        write_sites(folder / name, reference, {"displacement": (1.3 + 20 * time) * reference, "velocity": (0.5 + 1e3 * time) * velocity})
    write_series(folder / "motion.pvd", names)


def write_sites(path, reference, fields, bonds=np.empty((0, 2), int), stretch=np.empty(0)):
    """A vtp file of sites, and of bonds with their stretch where there are any."""
    write_frame(path, Frame(0.0, reference, reference, bonds, stretch, fields, {"stretch": stretch} if len(bonds) else {}, {}))


def write_series(path, times):
    """A .pvd: {file name: time}."""
    frames = "".join(f'<DataSet timestep="{time!r}" file="{name}"/>' for name, time in times.items())
    path.write_text(f'<VTKFile type="Collection"><Collection>{frames}</Collection></VTKFile>')


class Page(HTMLParser):
    """Reads a page: its text, its references and pictures, and whether its elements are properly nested."""

    def __init__(self, html):
        super().__init__()
        self.open, self.images, self.references, self.text = [], [], [], ""
        self.kinds = []  # classes of open elements
        self.feed(html)
        self.close()
        assert self.open == []

    def handle_starttag(self, tag, attributes):
        self.references += [value for name, value in attributes if name in ("src", "href", "srcset", "data")]
        if tag == "img":
            self.images.append(base64.b64decode(dict(attributes)["src"].partition(",")[2]))
        if tag in ("table", "pre") and not any("scroll" in (kind or "") for kind in self.kinds):
            raise AssertionError(f"<{tag}> would make the page scroll")
        if tag not in VOID:
            self.open.append(tag)
            self.kinds.append(dict(attributes).get("class"))

    def handle_endtag(self, tag):
        if not self.open or self.open.pop() != tag:
            raise AssertionError(f"</{tag}> closes nothing")
        self.kinds.pop()

    def handle_data(self, data):
        if not {"style", "script"} & set(self.open):
            self.text += " ".join(data.split()) + " "


def drawn(folder, *options, expect=0, kind="report"):
    """Runs the script in this process. @return (stdout, stderr)"""
    streams = [io.TextIOWrapper(io.BytesIO(), encoding="utf-8") for _ in range(2)]
    with contextlib.redirect_stdout(streams[0]), contextlib.redirect_stderr(streams[1]):
        exit_code = main([kind, str(folder), *options])
    texts = []
    for stream in streams:
        stream.seek(0)
        texts.append(stream.read())
    assert exit_code == expect, texts
    return tuple(texts)


def read_page(folder, name="report.html"):
    """@return HTML, and the page as it is read"""
    html = (folder / name).read_text(encoding="utf-8")
    return html, Page(html)


def pixels(png):
    """Colours of a picture, which has the width of all."""
    found = np.asarray(Image.open(io.BytesIO(png)).convert("RGB"), dtype=float)
    assert found.shape[1] == 1600
    return found
