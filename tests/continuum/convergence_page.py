#!/usr/bin/python3
"""docs/convergence.md, its pictures and convergence.csv, from the manufactured solutions of convergence_test.cc.

Usage: convergence_page.py FROM DOCS

FROM: the program continuum_convergence_tests, which is run (minutes), or a folder with the tables that a run of this
program wrote to the folder LATCON_TABLES. DOCS: the folder of the page; its pictures are written to DOCS/images.
"""
import os
import pathlib
import re
import subprocess
import sys
import tempfile

sys.dont_write_bytecode = True
sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[2] / "python"))

import numpy as np
import pandas
from matplotlib.lines import Line2D

from latcon.report.pictures import BLACK, BLUE, GREEN, GREY, RED, Page, save

NORMS = ("L2", "H1", "H2")  # columns of a table
TITLES = {"L2": "displacement, $L_2$ [m$^2$]", "H1": "gradient, $H_1$ [m]", "H2": "second gradient, broken $H_2$ [1]"}
LOCAL = {"network": "network of fibres (C.11)", "mooney_rivlin": "Mooney-Rivlin (C.4)"}
GRADIENT = {"local": "without gradient law", "isotropic": "isotropic gradient law (C.21)",
            "lattice": "gradient law of the lattice (C.22)"}
MESH = {"uniform": "uniform, clamped", "hanging": "hanging nodes, clamped", "uniform_loaded": "uniform, loaded above"}
COLOURS = {2: BLUE, 3: RED, 4: GREEN}
TOLERANCE = 0.2  # of an order, as convergence_test.cc asserts it
SERIES = re.compile(rf"({'|'.join(LOCAL)})_({'|'.join(GRADIENT)})_(uniform|hanging)(_loaded)?_p([0-9])")


def theory(gradient, degree):
    """Orders of the three norms for a smooth solution and h < l."""
    return {"L2": 2 if degree == 2 and gradient != "local" else degree + 1, "H1": degree, "H2": degree - 1}


def read_series(folder):
    """Errors of all tables of a folder, a row for each mesh in the order of the page, coarse to fine. "order of NORM" is
    from the coarser mesh to this one, `last` marks the finest of a series."""
    tables = []
    for path in folder.glob("*.csv"):
        table = pandas.read_csv(path, header=0, names=["h", *NORMS], index_col=False, dtype=float)
        match = SERIES.fullmatch(path.stem)
        if not match or len(table) < 2 or not (table > 0.).all(axis=None):
            raise ValueError(f"{path}: no table of a convergence series")
        local, gradient, mesh, loaded, degree = match.groups()
        table = table.sort_values("h", ascending=False, ignore_index=True)
        steps = np.log(table).diff()
        tables.append(table.assign(local=local, gradient=gradient, mesh=mesh + (loaded or ""), p=int(degree),
                                   last=table.index == len(table) - 1,
                                   **{f"order of {norm}": steps[norm] / steps["h"] for norm in NORMS}))
    if not tables:
        raise ValueError(f"{folder}: no tables")
    series = pandas.concat(tables)
    for column, names in (("local", LOCAL), ("gradient", GRADIENT), ("mesh", MESH)):
        series[column] = pandas.Categorical(series[column], list(names))
    return series.sort_values(["gradient", "local", "mesh", "p"], kind="stable", ignore_index=True)


def table_of(header, rows):
    """A table in Markdown."""
    lines = [header, [":--"] + ["--:"] * (len(header) - 1), *rows]
    return "\n".join("| " + " | ".join(line) + " |" for line in lines) + "\n"


def summary_table(series):
    """Observed orders between the two finest meshes and theoretical orders, one row per gradient law and degree."""
    rows = []
    for (gradient, degree), alike in series[series["last"]].groupby(["gradient", "p"], observed=True):
        orders = [(str(theory(gradient, degree)[norm]), alike[f"order of {norm}"]) for norm in NORMS]
        rows.append([GRADIENT[gradient], str(degree), str(len(alike)),
                     *(text for order, found in orders for text in (order, f"{found.min():.2f} … {found.max():.2f}"))])
    header = ["", "p", "series"] + [text for norm in NORMS for text in (f"{norm}: theory", "observed")]
    return table_of(header, rows)


def write_errors(series, path):
    """Errors on every mesh and the orders between them."""
    columns = {"gradient law": series["gradient"].map(GRADIENT), "law": series["local"].map(LOCAL),
               "mesh and edges": series["mesh"].map(MESH), "p": series["p"],
               "h [m]": series["h"].map(lambda h: f"1/{1. / h:.4g}")}
    for norm in NORMS:
        orders = series[f"order of {norm}"].map("{:.2f}".format, na_action="ignore")
        columns |= {norm: series[norm].map("{:.2e}".format), f"order of {norm}": orders}
    pandas.DataFrame(columns).to_csv(path, index=False)


def draw(series, path):
    """Plots errors over h, one panel per norm, with the theoretical slope below the lines of each degree."""
    page = Page(4.1)
    for panel, norm in enumerate(NORMS):
        axes = page.axes(0.62 + panel * 3.2, 0.35, 2.62, 2.75)
        for (local, mesh, degree), s in series.groupby(["local", "mesh", "p"], observed=True):
            colour = COLOURS[degree]
            # The local laws nearly coincide: one as a dot, the other as a cross on it.
            style = dict(marker="x", markersize=4, markeredgecolor=BLACK, zorder=3)
            if local == "network":
                style = dict(marker="^" if mesh == "uniform_loaded" else "o", markersize=6,
                             markerfacecolor="white" if mesh == "hanging" else colour)
            axes.loglog(s["h"], s[norm], color=colour, linewidth=1.0, **style)
        for degree, s in series.groupby("p"):
            # Below the lowest of the solid lines, so that it hides none.
            lowest = s.loc[s.loc[s["last"], norm].idxmin()]
            h = np.array([s["h"].max(), lowest["h"]])
            order = theory(lowest["gradient"], degree)[norm]
            error = 0.55 * lowest[norm] * (h / h[1])**order
            axes.loglog(h, error, "--", color=COLOURS[degree], linewidth=1.0)
            axes.annotate(f"{order}", (h[1], error[1]), xytext=(-3, -2), textcoords="offset points", ha="right",
                          va="center", color=COLOURS[degree])
        steps = np.unique(series["h"])
        axes.set_xticks(steps, [f"1/{1. / h:.3g}" for h in steps])
        axes.minorticks_off()
        axes.set(xlim=(0.75 * steps[0], 1.2 * steps[-1]), xlabel="largest side h of a cell [m]", title=TITLES[norm])

    degrees = [Line2D([], [], color=COLOURS[d], label=f"p = {d}") for d in np.unique(series["p"])]
    kinds = [("o", GREY, "uniform"), ("o", "white", "hanging nodes"), ("^", GREY, "loaded above"),
             ("x", BLACK, "Mooney-Rivlin")]
    kinds = [Line2D([], [], color=BLACK if mark == "x" else GREY, marker=mark, markersize=4 if mark == "x" else 6,
                    markerfacecolor=fill, linewidth=0, label=label)
             for mark, fill, label in kinds if mark != "^" or (series["mesh"] == "uniform_loaded").any()]
    slope = Line2D([], [], color=BLACK, linestyle="--", linewidth=1.0, label="slope of theory")
    page.figure.legend(handles=[*degrees, slope, *kinds], loc="lower center", ncol=8, columnspacing=1.2,
                       handletextpad=0.4, bbox_to_anchor=(0.5, 0.))
    save(page.figure, path)


def page_text(series):
    """The whole page."""
    template = pathlib.Path(__file__).with_suffix(".txt").read_text(encoding="utf-8")
    parts = [template.format(series=series["last"].sum(), tolerance=TOLERANCE, summary=summary_table(series))]
    shown = list(series["gradient"].unique())
    parts += [f"![Errors over h, {GRADIENT[gradient]}](images/convergence-{gradient}.png)\n" for gradient in shown]
    parts.append(f"*From above: {', '.join(GRADIENT[gradient] for gradient in shown)}.*\n")
    return "\n".join(parts)


def write_page(folder, docs):
    """Page and pictures from the tables of a folder."""
    series = read_series(folder)
    (docs / "images").mkdir(parents=True, exist_ok=True)
    for gradient, of_gradient in series.groupby("gradient", observed=True):
        draw(of_gradient, docs / "images" / f"convergence-{gradient}.png")
    (docs / "convergence.md").write_text(page_text(series), encoding="utf-8")
    write_errors(series, docs / "convergence.csv")


def main(source, docs):
    if source.is_dir():
        write_page(source, docs)
        return 0
    with tempfile.TemporaryDirectory() as folder:
        run = subprocess.run([str(source.resolve()), "--gtest_filter=*/Convergence.*"], env=dict(os.environ, LATCON_TABLES=folder))
        # A page with orders that fail the tests would be wrong.
        if run.returncode != 0:
            return run.returncode
        write_page(pathlib.Path(folder), docs)
    return 0


if __name__ == "__main__":
    if len(sys.argv) != 3:
        sys.exit(__doc__)
    sys.exit(main(*map(pathlib.Path, sys.argv[1:])))
