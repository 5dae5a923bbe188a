"""Reconstruction filters as the papers' formulas say."""

import math
from collections.abc import Callable


def box(x: float) -> float:
    return 1.0 if abs(x) < 0.5 else 0.0


def tent(x: float) -> float:
    return max(0.0, 1.0 - abs(x))


def gaussian(x: float) -> float:
    """Return a normal distribution of standard deviation 1/2, lowered to end at 3/2."""
    bell, end = (math.exp(-(d**2) / (2 * 0.5**2)) for d in (x, 1.5))
    return max(0.0, bell - end)


def mitchell(x: float, b: float = 1 / 3, c: float = 1 / 3) -> float:
    """Return equation 8 of the paper."""
    x = abs(x)
    if x < 1:
        return ((12 - 9 * b - 6 * c) * x**3 + (-18 + 12 * b + 6 * c) * x**2 + (6 - 2 * b)) / 6
    if x < 2:
        cubic = (-b - 6 * c) * x**3 + (6 * b + 30 * c) * x**2 + (-12 * b - 48 * c) * x
        return (cubic + 8 * b + 24 * c) / 6
    return 0.0


def blackman_harris(x: float) -> float:
    """Return the minimum four-term window, of a length of 2, about its middle."""
    if abs(x) >= 1:
        return 0.0
    turn = 2 * math.pi * (x + 1) / 2
    return (
        0.35875
        - 0.48829 * math.cos(turn)
        + 0.14128 * math.cos(2 * turn)
        - 0.01168 * math.cos(3 * turn)
    )


Formula = Callable[[float], float]
FORMULAS: dict[str, tuple[Formula, float]] = {
    "box": (box, 0.5),
    "tent": (tent, 1.0),
    "gaussian": (gaussian, 1.5),
    "mitchell": (mitchell, 2.0),
    "blackman-harris": (blackman_harris, 1.0),
}
