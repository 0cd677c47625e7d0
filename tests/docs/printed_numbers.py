"""Comparison of printed text by value: pages against numbers that are computed again, on any processor and with any BLAS.

The words must be the same. Two printed numbers agree if they differ by no more than

    one unit of the last decimal of the finer one, at most a tenth of the number: each is rounded by half of that, and numbers with
    decimals are taken to have two digits, since trailing zeros may be left out; integers have no such unit, as they are counts,
    + relative * the larger of them + absolute: the effect of round-off on the number itself, which the caller derives.

A number followed by ` %` is a fraction, in units of its last digit.
"""
import re

_NUMBER = re.compile(r"([-+]?\d+(?:\.\d+)?(?:e[-+]?\d+)?)( %)?")


def _value_and_unit(text, percent):
    mantissa, _, exponent = text.partition("e")
    decimals = len(mantissa.partition(".")[2])
    scale = 10.0 ** int(exponent or 0) * (0.01 if percent else 1.0)
    return float(mantissa) * scale, 10.0 ** -decimals * scale if decimals or percent else None


def _numbers_agree(one, other, relative, absolute):
    (a, unit_a), (b, unit_b) = _value_and_unit(*one), _value_and_unit(*other)
    largest = max(abs(a), abs(b))
    units = [unit for unit in (unit_a, unit_b) if unit is not None]
    rounding = min(*units, 0.1 * largest) if units else 0.0
    return abs(a - b) <= (rounding + relative * largest + absolute) * (1 + 1e-9)


def agrees(printed, computed, relative=0.0, absolute=0.0):
    """Whether two texts have the same words, and numbers that agree."""
    if _NUMBER.sub(r"0\2", printed) != _NUMBER.sub(r"0\2", computed):
        return False
    return all(_numbers_agree(one, other, relative, absolute)
               for one, other in zip(_NUMBER.findall(printed), _NUMBER.findall(computed)))


def differences(page, lines, relative=0.0, absolute=0.0, labels=0):
    """Lines that agree with no part of a page: in the part with the fewest, `LINE: the page has LINE`.

    labels: cells at the beginning of each row of a table that must be the same text.
    """
    def same(printed, computed):
        return (printed.split(" | ")[:labels] == computed.split(" | ")[:labels] and
                agrees(printed, computed, relative, absolute))
    rows = page.splitlines()
    parts = (rows[begin:begin + len(lines)] for begin in range(len(rows) - len(lines) + 1))
    return min(([f"{computed}: the page has {printed}" for printed, computed in zip(part, lines) if not same(printed, computed)]
                for part in parts), key=len, default=["the page is shorter than the lines"])
