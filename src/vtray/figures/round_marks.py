"""Round numbers between two others, for the marks of a scale."""

from collections.abc import Callable, Sequence
from decimal import ROUND_CEILING, ROUND_FLOOR, Decimal

MINUS = "\N{MINUS SIGN}"

DIGITS = (1, 5, 2)
"""First digits of numbers that are not spread evenly, those first that people look for most."""

LEAST_POWER = -308
"""Power of ten below which no number is written."""

PLAIN = range(-4, 6)
"""The powers of ten of the greatest number of a scale whose numbers are always written out."""

DIGITS_ALONE = 6
"""How many digits a number has at most that is not one of evenly spread ones."""


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
    return [(float(value), text) for value, text in zip(values, _written(values), strict=True)]


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


def number_text(value: float) -> str:
    """Return a number as people read it."""
    return _written([Decimal(f"{value:.{DIGITS_ALONE - 1}e}").normalize()])[0]


def _written(values: Sequence[Decimal]) -> list[str]:
    """Return numbers as people read them: written out, or all with powers of ten if shorter."""
    texts = [f"{value:f}" for value in values]
    greatest = max((value.copy_abs() for value in values), default=Decimal(0))
    if greatest and greatest.adjusted() not in PLAIN:
        texts = min(texts, [*map(_with_power, values)], key=lambda found: max(map(len, found)))
    return [text.replace("-", MINUS) for text in texts]


def _with_power(value: Decimal) -> str:
    """Return a number such as 1.5e-6, which all fonts can show; 0 as it is."""
    if value == 0:
        return "0"
    power = value.adjusted()
    return f"{value.scaleb(-power).normalize():f}e{power}"
