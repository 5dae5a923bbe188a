"""Sines and cosines up to an eighth of a turn, and angles, for kernels.

They are polynomials and roots, the same to the last bit on every machine; the sines have no branch.

References
----------
Remez, "Sur la détermination des polynômes d'approximation de degré donnée", 1934: the coefficients
are those whose largest error over the range is least, then rounded to doubles.
"""

import math

from vtray.base.compiler.compiled import device

PI = 3.141592653589793


@device
def cosine_sine(eighths: float) -> tuple[float, float]:
    """Return cosine and sine of so many eighths of a turn, from -1 to 1, both within 2e-16.

    Before rounding, the cosine's polynomial is within 4e-20, the sine's within 2e-18. Those of 0
    are exact.
    """
    t = eighths * eighths
    cosine = -3.8585769937444963e-13
    cosine = cosine * t + 1.1500526509921125e-10
    cosine = cosine * t - 2.4611364249568737e-08
    cosine = cosine * t + 3.590860446191548e-06
    cosine = cosine * t - 0.0003259918869268038
    cosine = cosine * t + 0.015854344243815433
    cosine = cosine * t - 0.30842513753404244
    cosine = cosine * t + 1.0
    sine = 6.872309959772423e-12
    sine = sine * t - 1.757133659468373e-09
    sine = sine * t + 3.133616020231993e-07
    sine = sine * t - 3.657620414660098e-05
    sine = sine * t + 0.0024903945701852523
    sine = sine * t - 0.08074551218828009
    sine = sine * t + 0.7853981633974483
    return cosine, sine * eighths


@device
def cosine_sine_of_turn(eighths: float) -> tuple[float, float]:
    """Return cosine and sine of so many eighths of a turn, ≥ 0."""
    quarters = int(0.5 * (eighths + 1.0))
    cosine, sine = cosine_sine(eighths - 2.0 * quarters)
    if quarters % 2 == 1:
        cosine, sine = -sine, cosine
    return (-cosine, -sine) if quarters // 2 % 2 == 1 else (cosine, sine)


@device
def angle_of(along: float, across: float) -> float:
    """Return the angle of the vector (along, across) from (1, 0), from -pi to pi, in radians.

    It is within 2e-15 of itself: the tangent of the half of it is that of a triangle, and halved
    three times more until Taylor's series leaves out less than ``0.2**22 / 23 < 2e-17`` of it.

    Parameters
    ----------
    along, across
        The vector, neither so long nor so short that squares cannot be had; that of length 0 has
        the angle 0.
    """
    if across == 0.0:
        return 0.0 if along >= 0.0 else PI
    length = math.sqrt(along * along + across * across)
    tangent = across / (length + along) if along > 0.0 else (length - along) / across
    for _ in range(3):
        tangent = tangent / (1.0 + math.sqrt(1.0 + tangent * tangent))
    t = tangent * tangent
    series = 0.0
    for k in range(21, 0, -2):
        series = 1.0 / k - t * series
    return 16.0 * tangent * series
