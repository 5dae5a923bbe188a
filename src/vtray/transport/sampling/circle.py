"""Sines and cosines up to an eighth of a turn, for kernels.

They are polynomials, the same to the last bit on every machine, without a branch.

References
----------
Remez, "Sur la détermination des polynômes d'approximation de degré donnée", 1934: the coefficients
are those whose largest error over the range is least, then rounded to doubles.
"""

from vtray.base.compiler.compiled import device


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
