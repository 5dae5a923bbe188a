"""Round numbers between two others, for the marks of a scale."""

from collections.abc import Callable
from decimal import ROUND_CEILING, ROUND_FLOOR, Decimal

MINUS = "\N{MINUS SIGN}"

DIGITS = (1, 5, 2)
"""First digits of numbers that are not spread evenly, those first that people look for most."""

LEAST_POWER = -308
"""Power of ten below which no number is written."""

LONGEST = 7
"""How many digits a number has at most that is written out, if fewer tell it from others."""

MOST = 16
"""With more, doubles cannot be told from each other."""

SHORTEST = 6
"""So many digits numbers may always have."""


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
    needed = whole - step.adjusted() + 1  # digits by which they differ
    is_short = digits < LONGEST and whole < LONGEST
    if is_short or (needed > LONGEST and max(whole, 0) + digits < MOST):
        return [(float(v), _signed(f"{v:.{digits}f}")) for v in values]
    return [(float(v), number_text(float(v), max(needed, SHORTEST))) for v in values]


def spread_marks(
    low: float, high: float, share: Callable[[float], float], most: int
) -> list[tuple[float, str]]:
    """Return round numbers from `low` to `high` where these are not spread evenly.

    They are 0 and powers of ten, the greatest first, and between these five and two times such,
    as far as they are apart: so that `most` of them would fill the scale.

    Parameters
    ----------
    low, high
        The ends of the scale, 0 ≤ low < high.
    share
        Gives how far up a number stands, from 0 to 1.
    most
        About how many there are at most.
    """
    gap = 1.0 / max(most, 1) - 1e-9
    found: dict[float, float] = {} if low > 0.0 else {0.0: share(0.0)}
    top = Decimal(high).adjusted()
    for digit in DIGITS:
        for power in range(top, LEAST_POWER, -1):
            value = float(Decimal(digit).scaleb(power))
            if value < low or (low == 0.0 and share(value) < gap):
                break
            place = share(value)
            if value <= high and all(abs(place - other) >= gap for other in found.values()):
                found[value] = place
    if len(found) < 2:
        return round_marks(low, high, most)
    return [(value, number_text(value)) for value in sorted(found)]


def number_text(value: float, digits: int = SHORTEST) -> str:
    """Return a number as people read it, with at most so many digits."""
    return _signed(f"{value:.{digits}g}")


def _signed(text: str) -> str:
    return text.replace("-", MINUS)
