"""Summary of all runs: counts, worst errors, comparison with published values, and the table on stdout."""
from dataclasses import dataclass

from ..quantities import UNITS, number_text, shown_unit
from ..rows import text_table
from .runs import Check, Run

VERDICTS = ("fails", "holds", "reported")


@dataclass(frozen=True)
class Tally:
    """Number of rows of one claim in one run, by verdict."""

    claim: str
    count: dict  # verdict: number of rows
    worst: float  # largest error over tolerance; None if no row has a tolerance
    kind: str  # CSS class: "fails", "warns" (holds, but was not verified), "holds" or "reported"


@dataclass(frozen=True)
class Comparison:
    """A measured quantity and its published value, both in `unit`."""

    run: Run
    quantity: str
    unit: str
    published: float  # None: none is known
    measured: float  # None: not measured
    uncertainty: float  # one standard deviation; None: not known
    check: Check = None  # the row, with a published value

    @property
    def difference(self):
        """Relative difference from the published value [1]; None if nothing was measured."""
        return self.measured / self.published - 1 if self.published and self.measured is not None else None


def tallies(run):
    """One Tally per claim, in the order in which the claims were checked."""
    return [tally_of(claim, [check for check in run.checks if check.claim == claim])
            for claim in dict.fromkeys(check.claim for check in run.checks)]


def tally_of(claim, checks):
    """Tally of the given rows."""
    ratios = [check.ratio for check in checks if check.ratio is not None]
    count = {verdict: sum(check.verdict == verdict for check in checks) for verdict in VERDICTS}
    kind = next((kind for kind in ("fails", "warns", "holds") if any(check.kind == kind for check in checks)), "reported")
    return Tally(claim, count, max(ratios, default=None), kind)


def comparisons(run):
    """Rows of the claim "fracture" that have a published value; lengths in cm, as the literature gives them."""
    result = []
    for check in run.checks:
        if check.claim != "fracture" or check.theory is None:
            continue
        scale, unit = shown_unit(check.unit)
        name = NAMES.get(check.quantity)
        uncertainty = run.crack[f"{name}_uncertainty"] if name and run.crack is not None else None
        measured = check.continuum if check.lattice is None else check.lattice
        result.append(Comparison(run, check.quantity, unit or "1", *(
            None if value is None else scale * value for value in (check.theory, measured, uncertainty)), check))
    return result


# Rows of the claim "fracture", and their names in crack.json.
NAMES = {"Lagrangian crack speed": "speed_lagrangian", "laboratory crack speed": "speed_laboratory",
         "wavelength, undeformed": "wavelength", "amplitude, undeformed": "amplitude"}


def unpublished(run):
    """Quantities of crack.json without a published value, lengths in cm."""
    compared = {c.quantity for c in comparisons(run)}
    found = []
    for quantity, name in NAMES.items():
        value, uncertainty = ((run.crack or {}).get(key) for key in (name, f"{name}_uncertainty"))
        if quantity not in compared and value is not None:
            scale, unit = shown_unit(UNITS[name])
            found.append(Comparison(run, quantity, unit, None, scale * value, None if uncertainty is None else scale * uncertainty))
    return found


def percent(fraction):
    """Signed percentage; "not measured" for None."""
    return "not measured" if fraction is None else f"{100 * fraction:+.1f} %"


def ratio_text(ratio):
    """Error over tolerance; a dash if there is none."""
    return "-" if ratio is None else f"{ratio:.2g}"


def text_summary(runs, unreadable):
    """Text for the terminal: claims of every run, failing rows, measured and published values. `unreadable`: runs that
    cannot be read."""
    parts = []
    rows = []
    for run in runs:
        name = shortened(run.name)
        for tally in tallies(run):
            rows.append([name, tally.claim] + [str(tally.count[v]) for v in ("holds", "fails", "reported")]
                        + [ratio_text(tally.worst)])
            name = ""
        for word in [*([run.state] if run.state != "complete" else []),
                     *(["not verified"] if run.skipped_verification else [])]:
            rows.append([name, word, "", "", "", ""])
            name = ""
    rows += [[shortened(run.name), "cannot be read", "", "", "", ""] for run in unreadable]
    parts.append(text_table(["run", "claim", "holds", "fails", "reported", "worst error / tolerance"], rows,
                            (2, 3, 4, 5)))
    failing = [[shortened(run.name), f"{check.claim}: {check.quantity}", ratio_text(check.ratio)]
               for run in runs for check in run.checks if check.verdict == "fails"]
    if failing:
        parts.append(text_table(["run", "fails", "error / tolerance"], failing, (2,)))
    compared = [[shortened(c.run.name), c.quantity, c.unit, f"{c.published:.4g}",
                 "-" if c.measured is None else number_text(c.measured, c.uncertainty, "+-"),
                 percent(c.difference), c.check.verdict]
                for run in runs for c in comparisons(run)]
    if compared:
        parts.append(text_table(["run", "quantity", "unit", "paper", "latcon", "difference", "verdict"], compared,
                                (3, 4, 5)))
    return "\n\n".join(parts)


def shortened(name, length=24):
    """A name, shortened to leave room for the rest of the line."""
    return name if len(name) <= length else name[:length - 3] + "..."
