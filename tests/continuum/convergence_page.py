#!/usr/bin/python3
"""docs/convergence.md, its pictures and convergence.csv, from the manufactured solutions of convergence_test.cc.

Usage: convergence_page.py FROM DOCS

FROM: the program continuum_convergence_tests, which is run (minutes), or a folder with the tables that a run of this
program wrote to the folder LATCON_TABLES. DOCS: the folder of the page; its pictures are written to DOCS/images.
"""
import csv
import dataclasses
import math
import os
import pathlib
import re
import subprocess
import sys
import tempfile

sys.dont_write_bytecode = True
sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[2] / "python"))

from matplotlib.lines import Line2D

from latcon.report.pictures import BLACK, BLUE, GREEN, GREY, RED, WIDTH, Page, save

NORMS = ("L2", "H1", "H2")  # columns of a table
TITLES = {"L2": "displacement, $L_2$ [m$^2$]", "H1": "gradient, $H_1$ [m]", "H2": "second gradient, broken $H_2$ [1]"}
LOCAL = {"network": "network of fibres (C.11)", "mooney_rivlin": "Mooney-Rivlin (C.4)"}
GRADIENT = {"local": "without gradient law", "isotropic": "isotropic gradient law (C.21)",
            "lattice": "gradient law of the lattice (C.22)"}
MESH = {"uniform": "uniform, clamped", "hanging": "hanging nodes, clamped", "uniform_loaded": "uniform, loaded above"}
COLOURS = {2: BLUE, 3: RED, 4: GREEN}
TOLERANCE = 0.2  # of an order, as convergence_test.cc asserts it
SERIES = re.compile(rf"({'|'.join(LOCAL)})_({'|'.join(GRADIENT)})_(uniform|hanging)(_loaded)?_p([0-9])")


@dataclasses.dataclass(frozen=True)
class Series:
    """Errors of one law, mesh family and degree: rows of (h, L2, H1, H2), coarse to fine."""
    local: str
    gradient: str
    mesh: str
    degree: int
    rows: list

    def orders(self, norm):
        """Observed order from each mesh to the next finer one."""
        column = 1 + NORMS.index(norm)
        return [math.log(a[column] / b[column]) / math.log(a[0] / b[0]) for a, b in zip(self.rows, self.rows[1:])]


class BadTable(Exception):
    """A table does not have the format written by convergence_test.cc."""


def theory(gradient, degree):
    """Orders of the three norms for a smooth solution and h < l."""
    return {"L2": 2 if degree == 2 and gradient != "local" else degree + 1, "H1": degree, "H2": degree - 1}


def read_series(folder):
    """Every table of a folder, in the order of the page."""
    series = []
    for path in folder.glob("*.csv"):
        match = SERIES.fullmatch(path.stem)
        with open(path, newline="", encoding="utf-8") as file:
            rows = list(csv.reader(file))
        try:
            numbers = [tuple(map(float, row)) for row in rows[1:]]
        except ValueError as error:
            raise BadTable(f"{path}: {error}") from error
        if not match or len(numbers) < 2 or any(len(row) != 4 or min(row) <= 0. for row in numbers):
            raise BadTable(f"{path}: no table of a convergence series")
        local, gradient, mesh, loaded, degree = match.groups()
        series.append(Series(local, gradient, mesh + (loaded or ""), int(degree), sorted(numbers, reverse=True)))
    if not series:
        raise BadTable(f"{folder}: no tables")
    places = [list(names) for names in (LOCAL, GRADIENT, MESH)]
    return sorted(series, key=lambda s: (places[1].index(s.gradient), places[0].index(s.local), places[2].index(s.mesh),
                                         s.degree))


def table_of(header, rows):
    """A table in Markdown."""
    lines = [header, [":--"] + ["--:"] * (len(header) - 1), *rows]
    return "\n".join("| " + " | ".join(line) + " |" for line in lines) + "\n"


def summary_table(series):
    """Observed orders between the two finest meshes and theoretical orders, one row per gradient law and degree."""
    rows = []
    for gradient in GRADIENT:
        for degree in sorted({s.degree for s in series if s.gradient == gradient}):
            alike = [s for s in series if (s.gradient, s.degree) == (gradient, degree)]
            cells = []
            for norm in NORMS:
                last = [s.orders(norm)[-1] for s in alike]
                cells += [str(theory(gradient, degree)[norm]), f"{min(last):.2f} … {max(last):.2f}"]
            rows.append([GRADIENT[gradient], str(degree), str(len(alike)), *cells])
    header = ["", "p", "series"] + [text for norm in NORMS for text in (f"{norm}: theory", "observed")]
    return table_of(header, rows)


def write_errors(series, path):
    """Errors on every mesh and the orders between them."""
    with path.open("w", encoding="utf-8", newline="") as file:
        table = csv.writer(file, lineterminator="\n")
        table.writerow(["gradient law", "law", "mesh and edges", "p", "h [m]"] + [text for norm in NORMS for text in (norm, f"order of {norm}")])
        for s in series:
            for i, row in enumerate(s.rows):
                cells = [GRADIENT[s.gradient], LOCAL[s.local], MESH[s.mesh], s.degree, f"1/{1. / row[0]:.4g}"]
                for norm, error in zip(NORMS, row[1:]):
                    cells += [f"{error:.2e}", f"{s.orders(norm)[i - 1]:.2f}" if i > 0 else ""]
                table.writerow(cells)


def draw(series, path):
    """Plots errors over h, one panel per norm, with the theoretical slope below the lines of each degree."""
    page = Page(4.1)
    for panel, norm in enumerate(NORMS):
        axes = page.axes(0.62 + panel * 3.2, 0.35, 2.62, 2.75)
        column = 1 + NORMS.index(norm)
        for s in series:
            colour = COLOURS[s.degree]
            # The local laws nearly coincide: one as a dot, the other as a cross on it.
            style = dict(marker="x", markersize=4, markeredgecolor=BLACK, zorder=3)
            if s.local == "network":
                style = dict(marker="^" if s.mesh == "uniform_loaded" else "o", markersize=6,
                             markerfacecolor="white" if s.mesh == "hanging" else colour)
            axes.loglog([row[0] for row in s.rows], [row[column] for row in s.rows], color=colour, linewidth=1.0, **style)
        for degree in sorted({s.degree for s in series}):
            # Below the lowest of the solid lines, so that it hides none.
            lowest = min((s for s in series if s.degree == degree), key=lambda s: s.rows[-1][column])
            h = [lowest.rows[0][0], lowest.rows[-1][0]]
            order = theory(lowest.gradient, degree)[norm]
            error = [0.55 * lowest.rows[-1][column] * (x / h[1]) ** order for x in h]
            axes.loglog(h, error, "--", color=COLOURS[degree], linewidth=1.0)
            axes.annotate(f"{order}", (h[1], error[1]), xytext=(-3, -2), textcoords="offset points", ha="right",
                          va="center", color=COLOURS[degree])
        steps = sorted({row[0] for s in series for row in s.rows})
        axes.set_xticks(steps, [f"1/{1. / h:.3g}" for h in steps])
        axes.minorticks_off()
        axes.set(xlim=(0.75 * steps[0], 1.2 * steps[-1]), xlabel="largest side h of a cell [m]", title=TITLES[norm])

    degrees = [Line2D([], [], color=COLOURS[d], label=f"p = {d}") for d in sorted({s.degree for s in series})]
    kinds = [("o", GREY, "uniform"), ("o", "white", "hanging nodes"), ("^", GREY, "loaded above"),
             ("x", BLACK, "Mooney-Rivlin")]
    kinds = [Line2D([], [], color=BLACK if mark == "x" else GREY, marker=mark, markersize=4 if mark == "x" else 6,
                    markerfacecolor=fill, linewidth=0, label=label)
             for mark, fill, label in kinds if mark != "^" or any(s.mesh == "uniform_loaded" for s in series)]
    slope = Line2D([], [], color=BLACK, linestyle="--", linewidth=1.0, label="slope of theory")
    page.figure.legend(handles=[*degrees, slope, *kinds], loc="lower center", ncol=8, columnspacing=1.2,
                       handletextpad=0.4, bbox_to_anchor=(0.5, 0.))
    save(page.figure, path)


def page_text(series):
    """The whole page."""
    parts = [f"""# Orders of convergence

Made by `cmake --build build/release --target convergence_page` from the {len(series)} series of
`tests/continuum/convergence_test.cc`; do not edit.

The manufactured displacement on the unit square (side 1 m) is a stretch of 1.55 by 1.4 with a sine in each component, so
that principal stretches range from 0.9 to 2.0. The body force, tractions and double tractions that keep it in equilibrium
are obtained by automatic differentiation of the energies as they are defined, without any code under test. They are
prescribed to the solver together with the displacement on the edges and, with a gradient law, the normal gradient there.
Sheets "loaded above" have traction and double traction prescribed on the upper edge instead. The length of the gradient
laws is l = 0.1 m, more than a cell of the finest meshes. Meshes with hanging nodes have a disc in the middle refined once
more; h is the largest side of a cell.

For a smooth solution and h < l, theory predicts that the errors of displacement, gradient and second gradient (cell by
cell) have the orders 2/2/1, 4/3/2 and 5/4/3 for p = 2, 3, 4 with a gradient law, and p + 1, p, p - 1 without.
`./test -L full` asserts these orders between the two finest meshes to within {TOLERANCE}, `./test` mostly between the two
coarser ones.

{summary_table(series)}
Observed: smallest and largest order over local laws, meshes and edges, between the two finest meshes. Errors on every mesh, and
the orders between them: [convergence.csv](convergence.csv).
"""]
    for gradient, title in GRADIENT.items():
        if any(s.gradient == gradient for s in series):
            parts.append(f"![Errors over h, {title}](images/convergence-{gradient}.png)\n\n*{title[0].upper()}{title[1:]}.*\n")
    return "\n".join(parts)


def write_page(folder, docs):
    """Page and pictures from the tables of a folder."""
    series = read_series(folder)
    (docs / "images").mkdir(parents=True, exist_ok=True)
    for gradient in GRADIENT:
        of_gradient = [s for s in series if s.gradient == gradient]
        if of_gradient:
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
