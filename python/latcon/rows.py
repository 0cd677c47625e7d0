"""Rows of `results.json`: their verdict, the dictionary that is written, and tables of text."""
from __future__ import annotations

import math
import textwrap
from collections.abc import Collection, Iterable, Sequence
from typing import Any


def finite_or_text(value: float | None) -> float | str | None:
    """JSON has no number that is not finite, and null means that there is no value."""
    return value if value is None or math.isfinite(value) else str(value)


def ratio_to_tolerance(error: float | None, tolerance: float | None, numbers: Iterable[float | None] = ()) -> float | None:
    """Error over tolerance, at most 1 if a row with these numbers holds; None without a tolerance, infinite if a given number is
    not finite."""
    if tolerance is None:
        return None
    if error is None or not all(math.isfinite(x) for x in (error, tolerance, *numbers) if x is not None):
        return math.inf
    if tolerance == 0:
        return 0.0 if error == 0 else math.inf
    return error / tolerance


def verdict(ratio: float | None) -> str:
    """Verdict of a row with this error over tolerance."""
    return "reported" if ratio is None else "holds" if ratio <= 1 else "fails"


def judged_row(claim: str, quantity: str, unit: str, lattice: float | None, continuum: float | None = None,
               theory: float | None = None, error: float | None = None, tolerance: float | None = None,
               reason: str = "") -> dict[str, Any]:
    """A judged row as it is written; `reason` is that of its tolerance, or what its error is."""
    return {"claim": claim, "quantity": quantity, "unit": unit, "lattice": finite_or_text(lattice),
            "continuum": finite_or_text(continuum), "theory": finite_or_text(theory), "error": finite_or_text(error),
            "tolerance": finite_or_text(tolerance),
            "verdict": verdict(ratio_to_tolerance(error, tolerance, (lattice, continuum, theory))), "reason": reason,
            "gate": False, "kind": "claim"}


def text_table(header: Sequence[str], rows: Sequence[Sequence[str]], numbers: Collection[int], width: int = 120) -> str:
    """Aligned text, of at most `width` columns if wrapping the second column, to 10 at least, is enough: nothing is cut off.
    `numbers`: right-aligned columns."""
    sizes = [max(map(len, column)) for column in zip(header, *rows)]
    sizes[1] = max(10, min(sizes[1], width - sum(sizes) + sizes[1] - 2 * (len(sizes) - 1)))
    lines = []
    for row in [header, *rows]:
        for i, part in enumerate(textwrap.wrap(row[1], sizes[1], break_on_hyphens=False) or [""]):
            cells = [row[0] if i == 0 else "", part] + [cell if i == 0 else "" for cell in row[2:]]
            padded = [cell.rjust(size) if column in numbers else cell.ljust(size)
                      for column, (cell, size) in enumerate(zip(cells, sizes))]
            lines.append("  ".join(padded).rstrip())
    lines.insert(1, "-" * min(width, sum(sizes) + 2 * (len(sizes) - 1)))
    return "\n".join(lines)
