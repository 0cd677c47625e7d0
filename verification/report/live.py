"""Interactive parts of the report: the viewer of the sheet, the plots of the path and of the energies, and their scripts."""
import json
from html import escape
from pathlib import Path

import numpy as np

from crack_path import measured_sinusoid
from pictures import SHARES, energy_shares
from runs import has_rows

HERE = Path(__file__).parent
# dygraphs (MIT licence), from Debian's libjs-dygraphs. Without it the plots are pictures.
DYGRAPHS = Path("/usr/share/javascript/dygraphs")
MOST_ROWS = 2000  # per plot


def has_dygraphs():
    """Returns whether the plotting library is installed."""
    return (DYGRAPHS / "dygraph.min.js").exists() and (DYGRAPHS / "dygraph.min.css").exists()


def styles(with_plots):
    """The CSS of the plots."""
    text = (DYGRAPHS / "dygraph.min.css").read_text(encoding="utf-8") if with_plots else ""
    return text.partition("/*# sourceMappingURL")[0]


def scripts(with_viewer, with_plots):
    """The scripts of a page, at its end."""
    files = [HERE / "sheet_reader.js", HERE / "sheet_viewer.js"] if with_viewer or with_plots else []
    files += [DYGRAPHS / "dygraph.min.js", HERE / "plots.js"] if with_plots else []
    texts = [path.read_text(encoding="utf-8").partition("//# sourceMappingURL")[0] for path in files]
    return "".join(f"<script>\n{text}</script>\n" for text in texts)


def data_script(name, text):
    """Script element with JSON data under a name."""
    return f'<script type="application/json" id="{name}">{text}</script>'


def viewer(position, run, sheet):
    """The sheet of a run over time; sheet: Sheet of sheet_data.py."""
    data, frames = sheet.contents, len(sheet.contents["times"])
    hint = ("Point at the sheet to read the values of a site and of a bond. Drag to pan; double-click, or click and "
            "turn the wheel, to zoom in.")
    near_tip = ('<div class="inset"><canvas class="near-tip" role="img" aria-label="the surroundings of the crack tip, bond '
                'by bond"></canvas><span>near the tip</span></div>') if data["tip"] else ""
    return f"""<figure class="viewer" id="viewer-{position}" data-sheet="sheet-{position}">
<div class="controls">
<button type="button" class="play" aria-label="play">▶</button>
<input type="range" class="slider" min="0" max="{frames - 1}" value="{frames - 1}" aria-label="time">
<output class="time"></output>
<label>colour <select class="colour"><option value="speed">speed</option><option value="stretch">stretch</option>
<option value="damage">damage</option></select></label>
<label>sheet <select class="configuration"><option value="deformed">deformed</option>
<option value="undeformed">undeformed</option></select></label>
<span class="zoom"><button type="button" class="closer" aria-label="zoom in">+</button>
<button type="button" class="farther" aria-label="zoom out">−</button>
<button type="button" class="reset">whole sheet</button></span>
</div>
<div class="views"><canvas class="sheet" tabindex="0" role="img"
aria-label="{escape(run.name)}: the sheet over time, coloured by speed, stretch or damage"></canvas>{near_tip}</div>
<div class="scale"><span class="colour-name"></span>
<div><div class="colour-bar"></div><div class="colour-ends"></div></div></div>
<p class="values" aria-live="polite" data-hint="{hint}">{hint}</p>
<figcaption>{frames} frames. Values agree with the files to within {precision(data)}.</figcaption>
</figure>
{data_script(f"sheet-{position}", sheet.text)}"""


def precision(data):
    """Half a quantum of each value, as text. Both ends of a bond may have this error along x and y."""
    return (f"{0.5e6 * data['quantum']:.2g} µm (positions), {0.5 * data['speedQuantum']:.2g} m/s (speeds), "
            f"{2**0.5 * data['quantum'] / data['spacing']:.1g} (stretch)")


def live_plot(position, name, plot, caption, with_viewer):
    """A plot that shows the values below the pointer."""
    linked = f' data-viewer="viewer-{position}"' if with_viewer else ""
    return f"""<figure class="live" data-plot="{name}-data-{position}"{linked}>
<div class="plot {name}" role="img" aria-label="{escape(caption)}"></div>
<div class="legend" aria-live="polite"></div>
<figcaption>{escape(caption)}</figcaption>
</figure>
{data_script(f"{name}-data-{position}", json.dumps(plot, separators=(",", ":")).replace("</", "<" + chr(92) + "/"))}"""


def path_plot(run):
    """The path of the tip, with the sinusoid of an oscillating crack; None without a path."""
    if not has_rows(run.tip, 2):
        return None
    tip = thinned(run.tip)
    curves = {"X [cm]": 100 * tip["X"], "Y of the tip [mm]": 1e3 * tip["Y"]}
    curve = measured_sinusoid(run)
    crack = run.crack or {}
    window = [crack.get("window_begin"), crack.get("window_end")]
    if curve is not None:
        inside = (tip["X"] >= window[0]) & (tip["X"] <= window[1])
        curves["measured sinusoid [mm]"] = np.where(inside, 1e3 * curve(tip["X"]), np.nan)
    return {
        "labels": list(curves), "rows": rows_of(curves), "colours": ["--first", "--second"][:len(curves) - 1],
        "dashed": [False, True][:len(curves) - 1], "x": "X in the undeformed sheet [cm]", "y": "Y [mm]", "follows": "tip",
        "window": None if None in window or window[1] <= window[0] else [100 * end for end in window],
    }


def energy_plot(run):
    """Conversion of the elastic energy; None without energies."""
    if not has_rows(run.energy, 2):
        return None
    energy = thinned(run.energy)
    released, shares = energy_shares(energy)
    curves = {"t [ms]": 1e3 * energy["t"], "released [J/m]": released}
    curves.update({f"{SHARES[name][0]} [J/m]": values for name, values in shares})
    return {
        "labels": list(curves), "rows": rows_of(curves), "colours": ["--text", *(f"--{name}" for name, _ in shares)],
        "dashed": [True] + [False] * len(shares), "stacked": 2, "x": "time [ms]", "y": "energy [J/m]", "follows": "time",
        "window": None,
    }


def thinned(table):
    """A table reduced to at most MOST_ROWS rows, including the first and the last."""
    count = len(table["t"])
    rows = np.unique(np.round(np.linspace(0, count - 1, min(count, MOST_ROWS))).astype(int))
    return {name: values[rows] for name, values in table.items()}


def rows_of(curves):
    """Rows of numbers to seven digits, sorted by the first column without repeated values; None for NaN."""
    values = np.column_stack(list(curves.values()))
    _, first = np.unique(values[:, 0], return_index=True)
    return [[None if not np.isfinite(value) else float(f"{value:.7g}") for value in row] for row in values[first]]
