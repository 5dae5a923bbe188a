"""Round numbers between two others, for the marks of a scale."""

from decimal import ROUND_CEILING, ROUND_FLOOR, Decimal

MINUS = "\N{MINUS SIGN}"

LONGEST = 7
"""How many digits a number has at most that is written out."""


def round_marks(low: float, high: float, most: int) -> list[tuple[float, str]]:
    """Return round numbers from `low` to `high`, and how they are written.

    Their distance is 1, 2 or 5 times a power of ten, as small as allows no more than `most` of
    them, where that is at least 2; there may be one or none for less.
    """
    if low == high:
        return [(low, number_text(low))]
    first, last = Decimal(repr(low)), Decimal(repr(high))
    power = ((last - first) / max(most, 1)).adjusted()
    for step in (Decimal(digit).scaleb(power + k) for k in range(3) for digit in (1, 2, 5)):
        start = (first / step).to_integral_value(ROUND_CEILING)
        end = (last / step).to_integral_value(ROUND_FLOOR)
        if end - start < most:
            break
    values = [(start + k) * step for k in range(int(end - start) + 1)]
    digits = max(0, -step.adjusted())
    whole = max((abs(value).adjusted() for value in values), default=0)
    written_out = digits < LONGEST and whole < LONGEST
    return [
        (float(v), _signed(f"{v:.{digits}f}") if written_out else number_text(float(v)))
        for v in values
    ]


def number_text(value: float) -> str:
    """Return a number as people read it, with at most six digits."""
    return _signed(f"{value:g}")


def _signed(text: str) -> str:
    return text.replace("-", MINUS)
