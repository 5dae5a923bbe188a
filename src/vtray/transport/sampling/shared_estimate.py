"""How much light shared fans bring, and how wrong that may be.

After each pass there are 2 n rays, one in each of 2 n elementary cells of the square of any shape.
Each two that share a cell twice as large are a pair; the variance of the mean is about the sum of
the squares of their differences, divided by (2 n)^2: that of samples drawn from n cells, two in
each. As the points are spread more evenly than that, this is too much rather than too little.
Cells are narrow enough along the lights that a pair goes to one of them, if there are rays enough;
what is left makes them as high as they are wide within it.

The number of a point says in which cells it lies: the highest a digits of the first coordinate are
the lowest of the number, and with the number as a polynomial p(y) over the integers modulo 2, the
digits of the second are the coefficients of p(1 + x). Two numbers whose difference is
y^a (1 + y)^b so share the highest a digits of the one and b of the other; scrambling changes that
of both alike.

What hides some of many lights need not be near each other, and rays find it by chance: where none
of n rays is stopped, still about one n-th of all light may be, so that much counts as an error too.

References
----------
Cochran, "Sampling Techniques", 3rd edition, 1977, section 5A.12 (collapsed strata, pairs).
"""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from vtray.base.compiler.compiled import device
from vtray.geometry.packets.fan import BLOCKED, FAN, MOST_RAYS, WEIGHT, Fan
from vtray.geometry.vector import Vec, add
from vtray.transport.sampling.fans import Fans


class Pool(NamedTuple):
    """Lights that share fans at a hit.

    Attributes
    ----------
    most
        What all of them would bring with nothing in the way.
    lights
        How many there are, if those count less that bring less: as many equal ones would have the
        same sum and the same sum of squares.
    """

    most: float
    lights: float


class SharedEstimate(NamedTuple):
    """What is known after some shared fans.

    Attributes
    ----------
    fans
        How many there were.
    total
        The light that all rays bring, times their number.
    variance
        That of the light, of the noisiest channel, after the last whole pass.
    """

    fans: int
    total: Vec
    variance: float


@device
def no_shared_estimate() -> SharedEstimate:
    """Return what is known before the first fan."""
    return SharedEstimate(0, (0.0, 0.0, 0.0), 0.0)


@device
def with_shared_fan(
    estimate: SharedEstimate,
    pool: Pool,
    fan: Fan,
    fans: Fans,
    brought: NDArray[np.float64],
) -> SharedEstimate:
    """Return what is known after one more fan.

    Parameters
    ----------
    estimate, pool
        What was known before it, and the lights.
    fan, fans
        Its rays, and which fans there are.
    brought
        What all rays bring, by the numbers of their points.
    """
    begin = estimate.fans * fans.rays
    total = estimate.total
    for ray in range(fans.rays):
        number = fans.points[0, begin + ray]
        blocked = fan[BLOCKED + ray]
        red = fan[WEIGHT + ray] * (1.0 - blocked) if blocked < 1.0 else 0.0
        green = fan[WEIGHT + FAN + ray] * (1.0 - blocked) if blocked < 1.0 else 0.0
        blue = fan[WEIGHT + 2 * FAN + ray] * (1.0 - blocked) if blocked < 1.0 else 0.0
        brought[number] = red
        brought[MOST_RAYS + number] = green
        brought[2 * MOST_RAYS + number] = blue
        total = add(total, (red, green, blue))
    count = estimate.fans + 1
    if not _is_pass(count):
        return SharedEstimate(count, total, estimate.variance)
    unseen = pool.most / (count * fans.rays)
    variance = _variance_of(brought, count * fans.rays, pool.lights) + unseen * unseen
    return SharedEstimate(count, total, variance)


@device
def _is_pass(fans: int) -> bool:
    """Tell whether so many fans are whole passes: powers of two."""
    return fans & (fans - 1) == 0


@device
def _variance_of(brought: NDArray[np.float64], rays: int, lights: float) -> float:
    """Return the variance of the mean of so many rays, that of the noisiest channel."""
    half = rays // 2
    across = _difference_in_cells(half, lights)
    red, green, blue = 0.0, 0.0, 0.0
    for k in range(half):
        other = k ^ across
        difference = brought[other] - brought[k]
        red += difference * difference
        difference = brought[MOST_RAYS + other] - brought[MOST_RAYS + k]
        green += difference * difference
        difference = brought[2 * MOST_RAYS + other] - brought[2 * MOST_RAYS + k]
        blue += difference * difference
    return max(red, green, blue) / (float(rays) * rays)


@device
def _difference_in_cells(cells: int, lights: float) -> int:
    """Return by what the numbers of two points in one of so many cells differ, a power of two."""
    columns, row, is_column = 0, 1, True
    while cells > 1:
        cells //= 2
        # Columns of one light each, and then in turn rows and columns within it.
        if lights > 1.0 or is_column:
            columns += 1
            lights *= 0.5
            is_column = lights > 1.0
        else:
            row ^= row << 1
            is_column = True
    return row << columns


@device
def needs_more_shared(estimate: SharedEstimate, fans: Fans) -> bool:
    """Tell whether another fan is to be cast: within a pass, or as the light is too noisy."""
    if estimate.fans == 0 or not _is_pass(estimate.fans):
        return True
    is_noisy = estimate.variance > fans.error * fans.error
    return is_noisy and estimate.fans < fans.fans


@device
def light_of(estimate: SharedEstimate, fans: Fans) -> Vec:
    """Return the light that the rays bring: the mean of all."""
    rays = max(estimate.fans, 1) * fans.rays
    red, green, blue = estimate.total
    return red / rays, green / rays, blue / rays
