"""How much light is left on its way through what absorbs it, in nothing but + - * /."""

from vtray.base.compiler.compiled import device
from vtray.geometry.vector import Vec

LEAST = -745.2
"""Below that, the exponential is less than half of the smallest double."""

_LOG2_OF_E = 1.44269504088896338700
_LN2_HIGH = 6.93147180369123816490e-01
_LN2_LOW = 1.90821492927058770002e-10
_P1 = 1.66666666666666019037e-01
_P2 = -2.77777777770155933842e-03
_P3 = 6.61375632143793436117e-05
_P4 = -1.65339022054652515390e-06
_P5 = 4.13813679705723846039e-08


@device
def transmitted(absorption: Vec, distance: float) -> Vec:
    """Return the share of light that is left, by Beer's law.

    Parameters
    ----------
    absorption
        How much of red, green and blue is absorbed per length, ≥ 0.
    distance
        The length, ≥ 0; infinity leaves nothing of what is absorbed at all.
    """
    red, green, blue = absorption
    return _left(red, distance), _left(green, distance), _left(blue, distance)


@device
def _left(absorption: float, distance: float) -> float:
    """Return the share of one channel that is left."""
    return exponential(-(absorption * distance)) if absorption > 0.0 else 1.0


@device
def exponential(x: float) -> float:
    """Return e to the power of a number ≤ 0, within a unit in the last place.

    Below the least normal double, within a unit in the last place of that.

    References
    ----------
    Sun Microsystems, "e_exp.c" of fdlibm, 1993: its reduction, and its approximation by Remez, of
    error 2**-59 for up to half of ln 2.
    """
    if not x >= LEAST:
        return 0.0
    halvings = int(0.5 - x * _LOG2_OF_E)
    high, low = x + halvings * _LN2_HIGH, -(halvings * _LN2_LOW)
    rest = high - low
    square = rest * rest
    bent = rest - square * (_P1 + square * (_P2 + square * (_P3 + square * (_P4 + square * _P5))))
    near_one = 1.0 - ((low - (rest * bent) / (2.0 - bent)) - high)
    return near_one * _half_to_the(halvings // 2) * _half_to_the(halvings - halvings // 2)


@device
def _half_to_the(power: int) -> float:
    """Return 0.5 to the power of an integer from 0 to 1000, exactly."""
    found, square = 1.0, 0.5
    while power > 0:
        if power & 1:
            found *= square
        square *= square
        power >>= 1
    return found
