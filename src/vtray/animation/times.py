"""When pictures of a movie end, in the units of its format."""

from collections.abc import Iterator
from fractions import Fraction
from itertools import count


def ends_of(fps: float, units: int) -> Iterator[int]:
    """Give for how many units each picture is shown, so that no error adds up.

    Parameters
    ----------
    fps
        Pictures in a second, > 0.
    units
        Units in a second.
    """
    each = Fraction(units) / Fraction(fps)
    for k in count():
        yield round(each * (k + 1)) - round(each * k)
