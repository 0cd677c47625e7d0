"""Plots of the claim on disorder."""
from latcon.report.claim_tables import Plot, groups, largest_text, sorted_by
from latcon.report.panels import Grid, entry
from latcon.report.pictures import BLUE, GREEN, RED

MODULI = ("bulk modulus", "shear modulus")
WORDS = {"modulus": MODULI}


def draw_disorder(tables):
    """Moduli of sheets with disorder between their bounds."""
    rows = groups(tables["disorder"], "shells")
    legend = [entry("sheet, relaxed", "", BLUE, marker="o"), entry("effective medium", "--", GREEN),
              entry("bounds of Voigt and Reuss", "-", RED)]
    grid = Grid([shells for (shells,), _ in rows], 2, legend)
    metrics = []
    for number, ((shells,), part) in enumerate(rows):
        for (modulus,), of_modulus in groups(part, "modulus"):
            table = sorted_by(of_modulus, "sheet")
            axes = grid.axes(number, MODULI.index(modulus), title=f"{modulus} over that of homogeneous deformation [1]",
                             xlabel="sheet")
            ratio, theory = table["ratio [1]"], table["effective_medium [1]"]
            axes.axhline(1, color=RED)
            axes.plot(table["sheet"], table["reuss [1]"], "-", color=RED)
            axes.plot(table["sheet"], theory, "--", color=GREEN)
            axes.plot(table["sheet"], ratio, "o", color=BLUE, markerfacecolor="none", markersize=5)
            metrics.append(f"{shells}, {modulus}: mean off the effective medium by "
                           f"{largest_text(ratio.mean() - theory)}, reduction by disorder {1 - ratio.mean():.2e}")
    return grid, metrics


PLOTS = (
    Plot("disorder", draw_disorder,
         "The moduli of a sheet with disorder lie between the bounds of Voigt and Reuss, about those of the effective medium.",
         "Energy of undeformed sheets at a small dilation and a small shear, relaxed, over that at homogeneous deformation. Each "
         "sheet has bonds of its own; red: its bounds, dashed: effective medium, circles: lattice."),
)
