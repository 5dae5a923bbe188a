"""Reconstruction filters: how much the light near a pixel counts for it.

All are products of a function of the distance across and one of that down, in pixels. Samples are
placed with a density proportional to the filter's magnitude, so that each counts the same, but for
the sign: that is the inverse of the filter's cumulative integral, kept as a table.

References
----------
Ernst, Stamminger, Greiner, "Filter Importance Sampling", 2006; Mitchell, Netravali, "Reconstruction
Filters in Computer Graphics", SIGGRAPH 1988; Harris, "On the Use of Windows for Harmonic Analysis
with the Discrete Fourier Transform", Proc. IEEE 66 (1), 1978.
"""

import math
from collections.abc import Callable
from functools import lru_cache
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from vtray.base.compiler.compiled import device
from vtray.base.exact_math import exponential, small_cosine
from vtray.scene.settings import FilterName

Floats = NDArray[np.float64]

STEPS = 1024
"""Steps of a table; places between them are interpolated."""

_FINE = 64
"""Steps of the integral for each step of the table."""


class Filter(NamedTuple):
    """A reconstruction filter of one axis.

    Attributes
    ----------
    value
        The filter at distances in pixels, of any scale.
    radius
        From where on it is 0.
    positive
        Up to where it is not negative.
    """

    value: Callable[[Floats], Floats]
    radius: float
    positive: float


def _box(x: Floats) -> Floats:
    return np.ones_like(x)


def _tent(x: Floats) -> Floats:
    return 1.0 - np.abs(x)


def _gaussian(x: Floats) -> Floats:
    """Fall off with a standard deviation of half a pixel, to 0 at the radius."""
    return exponential(-2.0 * x * x) - exponential(-2.0 * 1.5 * 1.5)


def _mitchell(x: Floats) -> Floats:
    """Mitchell's and Netravali's cubic for B = C = 1/3, times 18."""
    x = np.abs(x)
    near = (21.0 * x - 36.0) * x * x + 16.0
    far = ((-7.0 * x + 36.0) * x - 60.0) * x + 32.0
    return np.where(x < 1.0, near, far)


def _blackman_harris(x: Floats) -> Floats:
    """Sum Harris' four terms of least side lobes."""
    # The cosine of pi * x from that of a quarter, and those of its multiples as Chebyshev has them.
    quarter = small_cosine(math.pi / 4 * x)
    half = 2.0 * quarter * quarter - 1.0
    c = 2.0 * half * half - 1.0
    return 0.35875 + 0.48829 * c + 0.14128 * (2.0 * c * c - 1.0) + 0.01168 * (4.0 * c * c - 3.0) * c


FILTERS: dict[FilterName, Filter] = {
    "box": Filter(_box, 0.5, math.inf),
    "tent": Filter(_tent, 1.0, math.inf),
    "gaussian": Filter(_gaussian, 1.5, math.inf),
    "mitchell": Filter(_mitchell, 2.0, 8.0 / 7.0),
    "blackman-harris": Filter(_blackman_harris, 1.0, math.inf),
}


@lru_cache
def filter_places(name: FilterName) -> Floats:
    """Return the table by which a filter's samples are placed, (STEPS + 2,).

    Entry k is the distance, negative for left and up, up to which a share ``k / STEPS`` of the
    filter's magnitude lies; the last is there twice.
    """
    kernel = FILTERS[name]
    steps = STEPS * _FINE
    edges = np.linspace(-kernel.radius, kernel.radius, steps + 1)
    magnitude = np.abs(kernel.value(0.5 * (edges[1:] + edges[:-1])))
    integral = np.concatenate([[0.0], np.cumsum(magnitude)])
    shares = np.linspace(0.0, integral[-1], STEPS + 1)
    # In NumPy's single steps: its `interp` is a loop in C, which some compilers round otherwise.
    k = np.searchsorted(integral, shares, side="right").clip(1, steps) - 1
    slope = (edges[k + 1] - edges[k]) / (integral[k + 1] - integral[k])
    places = edges[k] + (shares - integral[k]) * slope
    # Symmetric, and no finer than the table can be.
    places = np.round((places - places[::-1]) / 2.0 * 2.0**24) / 2.0**24
    return np.append(places, places[-1])


@device
def place_in_filter(places: NDArray[np.float64], share: float) -> float:
    """Return the distance from the pixel for a share from 0 to below 1."""
    position = share * STEPS
    # The mask tells the compiler that the index is not negative.
    step = int(position) & (STEPS - 1)
    place: float = places[step] + (position - step) * (places[step + 1] - places[step])
    return place
