"""Sines, angles, exponentials and lengths that are the same to the last bit on every machine.

IEEE 754 says what ``+ - * /`` and square roots give, to the last bit. What the library of C makes
of a sine differs from machine to machine, and from version to version, in the last digit; NumPy's
vectorised ones do as well, and Python's `math.hypot`. A light or a pixel that stands elsewhere by
such a digit makes another picture. So what decides pixels is worked out here, of these operations
alone.

References
----------
Taylor's series, with Lagrange's bound of what is left out. `math.fsum`, `math.remainder`,
`math.frexp` and `math.ldexp` are exact wherever doubles are those of IEEE 754.
"""

import math
from typing import TYPE_CHECKING, TypeVar

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

    Real = TypeVar("Real", float, NDArray[np.float64])

RADIAN = math.pi / 180
"""One degree, in radians."""


def sine(degrees: float) -> float:
    """Return the sine of an angle in degrees, within 2**-51; exact for multiples of 30."""
    return _sines(degrees)[0]


def cosine(degrees: float) -> float:
    """Return the cosine of an angle in degrees, within 2**-51; exact for multiples of 30."""
    return _sines(degrees)[1]


def tangent(degrees: float) -> float:
    """Return the tangent of an angle in degrees, below 90 either way, within 2**-50 of itself."""
    sine_, cosine_ = _sines(degrees)
    return sine_ / cosine_


def _sines(degrees: float) -> tuple[float, float]:
    """Return sine and cosine."""
    # The remainder and what is left of it are exact: no digit is lost, however large the angle.
    rest = math.remainder(degrees, 360.0)
    quarters = round(rest / 90.0)
    rest -= 90.0 * quarters
    if abs(rest) == 30.0:  # else 0.49999999999999994
        a, b = math.copysign(0.5, rest), math.sqrt(0.75)
    else:
        a, b = small_sine(rest * RADIAN), small_cosine(rest * RADIAN)
    return ((a, b), (b, -a), (-a, -b), (-b, a))[quarters % 4]


def small_sine(x: "Real") -> "Real":
    """Return the sine of an angle in radians, from -pi/4 to pi/4, to within two roundings.

    What the series leaves out is below ``(pi/4)**19 / 19! < 2**-63``.
    """
    square = x * x
    return x + x * (square * _series(square, _SINE))


def small_cosine(x: "Real") -> "Real":
    """Return the cosine of an angle in radians, from -pi/4 to pi/4, to within two roundings.

    What the series leaves out is below ``(pi/4)**18 / 18! < 2**-58``.
    """
    square = x * x
    return 1.0 + square * _series(square, _COSINE)


def exponential(x: "Real") -> "Real":
    """Return e to the power of x, from -8 to 8, within 2**-45 of itself.

    That of ``x / 64`` is squared six times, which makes its error of two roundings 64 times as
    large. What the series leaves out is below ``(1/8)**12 / 12! < 2**-64``.
    """
    power = 1.0 + (x / 64.0) * _series(x / 64.0, _EXPONENTIAL)
    for _ in range(6):
        power = power * power
    return power


def logarithm(x: "NDArray[np.float64]") -> "NDArray[np.float64]":
    """Return the natural logarithm of doubles, within 2**-50; NaN of what is not above 0.

    Of ``m`` times a power of two, with m from 0.7 to 1.41, the logarithm of m is
    ``2 artanh((m - 1) / (m + 1))``. What its series leaves out is below ``0.172**23 / 10``.
    """
    import numpy as np

    part, exponent = np.frexp(x)
    small = part < _ROOT_OF_HALF
    part = np.where(small, part * 2.0, part)
    with np.errstate(invalid="ignore", divide="ignore"):
        ratio = (part - 1.0) / (part + 1.0)
        found = (exponent - small) * _LOGARITHM_OF_2
        found = found + 2.0 * (ratio + ratio * (ratio * ratio * _series(ratio * ratio, _ARTANH)))
    found = np.where(x == np.inf, np.inf, found)
    return np.where(x > 0.0, found, np.nan)


def power_of_2(x: float) -> float:
    """Return 2 to the power of x, from -1000 to 1000, within 2**-45 of itself; exact for integers.

    Of the nearest integer it is exact, and of what is left, at most a half, it is an exponential.
    """
    whole = round(x)
    return math.ldexp(exponential((x - whole) * _LOGARITHM_OF_2), whole)


def power(base: "NDArray[np.float64]", exponent: float) -> "NDArray[np.float64]":
    """Return powers of doubles from 0 to 1, within 2**-43 of themselves; 0 of what is below.

    Parameters
    ----------
    base
        From 0 to 1; what is below ``2**-60`` counts as 0.
    exponent
        From 0.1 to 4.

    Notes
    -----
    The logarithm of the power, t, is above -167, and its error below ``2**-44``: 4 times that of a
    logarithm down to -42, which is a rounding, and one of its own. With k the integer nearest to
    ``t / log(2)``, it is the exponential of ``t - k log(2)``, which is at most 0.35, times a power
    of two.
    """
    import numpy as np

    known = np.maximum(base, 2.0**-60)
    t = exponent * logarithm(known)
    k = np.rint(t / _LOGARITHM_OF_2)
    rest = t - k * _LOGARITHM_OF_2
    found = np.ldexp(exponential(rest), k.astype(np.int32))
    return np.where(base < 2.0**-60, 0.0, found)


def angle(along: "NDArray[np.float64]", across: "NDArray[np.float64]") -> "NDArray[np.float64]":
    """Return the angles of vectors (along, across) from (1, 0), from -pi to pi, in radians.

    They are within 2e-15 of themselves; that of a vector of length 0 is 0. The tangent of half the
    angle from the nearer end of the axis is that of a triangle; it is halved three times more,
    until Taylor's series leaves out less than ``0.1**22 / 23`` of it.

    Parameters
    ----------
    along, across
        The vectors, of the same shape.
    """
    import numpy as np

    longest = np.maximum(np.abs(along), np.abs(across))
    scale = np.where(longest > 0.0, longest, 1.0)
    x, y = along / scale, across / scale  # so that the squares are doubles
    above = np.sqrt(x * x + y * y) + np.abs(x)
    tangent = y / np.where(longest > 0.0, above, 1.0)
    for _ in range(3):
        tangent = tangent / (1.0 + np.sqrt(1.0 + tangent * tangent))
    found = 16.0 * tangent * _series(tangent * tangent, _ARCTANGENT)
    return np.where(along < 0.0, np.copysign(math.pi, across) - found, found)


def hypotenuse(*parts: float) -> float:
    """Return the square root of the sum of the squares, rounded once; infinite if it is no double.

    Unlike a sum of squares of doubles, it neither overflows nor vanishes. The parts are no NaN.
    """
    try:
        ratios = [part.as_integer_ratio() for part in parts]
        below = max(denominator for _, denominator in ratios)  # all are powers of two
        wholes = [above * (below // own) for above, own in ratios]
        square = sum(whole * whole for whole in wholes)
        # More bits than a double holds, and one more that tells whether the rest is 0: the division
        # of integers then rounds as if it saw all of them.
        shift = max(0, 64 - square.bit_length() // 2)
        root = math.isqrt(square << 2 * shift)
        inexact = root * root != square << 2 * shift
        return (2 * root + inexact) / (below << shift + 1)
    except OverflowError:
        return math.inf


def _series(x: "Real", coefficients: list[float]) -> "Real":
    """Return a polynomial, by Horner's rule; its highest coefficient comes first."""
    value = 0.0 * x
    for coefficient in coefficients:
        value *= x  # in place, where x is an array
        value += coefficient
    return value


# 1/n! without n = 0 and 1, as these terms are added last.
_SINE = [(1 - k % 2 * 2) / math.factorial(2 * k + 1) for k in range(8, 0, -1)]
_COSINE = [(1 - k % 2 * 2) / math.factorial(2 * k) for k in range(8, 0, -1)]
_EXPONENTIAL = [1.0 / math.factorial(k) for k in range(11, 0, -1)]
_ARTANH = [1.0 / (2 * k + 1) for k in range(10, 0, -1)]
_ARCTANGENT = [(1 - k % 2 * 2) / (2 * k + 1) for k in range(10, -1, -1)]
_ROOT_OF_HALF = math.sqrt(0.5)
_LOGARITHM_OF_2 = 0.6931471805599453
