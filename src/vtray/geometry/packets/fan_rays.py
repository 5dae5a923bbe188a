"""Which rays of a fan may meet a ball: all are asked at once, in single precision.

Sets of rays are the bits of an integer. A ray that is left out misses the ball, whatever rounding
does; of the others, nearly all meet it.
"""

import math

import numpy as np
from numpy.typing import NDArray

from vtray.base.compiler.compiled import device, written_in_llvm
from vtray.geometry.packets.fan import BLOCKED, DIRECTION, FAN, SINGLES, Fan
from vtray.geometry.vector import Vec, magnitude

OCTET = 8
"""Rays that are asked at once."""

NONE = np.uint64(0)
"""The set of no rays."""

ALL = np.uint64(2**64 - 1)
"""The set of all rays."""

ONE = np.uint64(1)

SINGLE_ERROR = 2.0**-20
"""Bound on the error of a product of a direction and a way in single precision, relative to the
way: four times the six roundings of half 2**-23."""

SINGLE_TINY = 1e-43
"""The same where numbers are so small that they have fewer digits."""

SINGLE_HUGE = 1e37
"""Ways up to this size are numbers of single precision, and so are all that come of them."""


@device
def narrow_directions(fan: Fan, rays: int) -> None:
    """Set the directions in single precision."""
    singles = fan.view(np.float32)
    for ray in range(rays):
        singles[2 * SINGLES + ray] = fan[DIRECTION + ray]
        singles[2 * SINGLES + FAN + ray] = fan[DIRECTION + FAN + ray]
        singles[2 * SINGLES + 2 * FAN + ray] = fan[DIRECTION + 2 * FAN + ray]


@device
def open_rays(fan: Fan, rays: int) -> np.uint64:
    """Return the rays that nothing stops so far."""
    found = NONE
    for ray in range(rays):
        found |= (ONE if fan[BLOCKED + ray] == 0.0 else NONE) << np.uint64(ray)
    return found


@device
def rays_near(
    fan: Fan, rays: int, way: Vec, tangent2: float, margin: float, starts_inside: bool
) -> np.uint64:
    """Return the rays that may meet a ball; `narrow_directions` has been called.

    Parameters
    ----------
    fan, rays
        So many rays.
    way
        From where they start to the centre.
    tangent2
        The square of the distance to where a ray touches the ball: that to the centre less that of
        the radius, which is wider than rounding could explain. Below 0 they start within it.
    margin
        How far rounding may have moved the ball against the rays.
    starts_inside
        Whether they may start inside the ball if they start within it, and not only on it: then
        those that lead away from its centre meet it, too.
    """
    size = magnitude(way)
    if size > SINGLE_HUGE or (starts_inside and tangent2 <= 0.0):
        return ALL
    # With m = way * direction, a ray meets the ball if m > 0 and way^2 - m^2 < radius^2.
    tangent = math.sqrt(max(tangent2, 0.0))
    least = np.float32(tangent - SINGLE_ERROR * size - SINGLE_TINY - margin)
    narrow = np.float32(way[0]), np.float32(way[1]), np.float32(way[2])
    singles = fan.view(np.float32)
    found = NONE
    for octet in range(rays // OCTET):
        first = 2 * SINGLES + OCTET * octet
        met = octet_within(singles, first, FAN, narrow, least)
        found |= met << np.uint64(OCTET * octet)
    return found


@written_in_llvm("vtray.geometry.packets.fan_in_llvm:write_octet_within")
def octet_within(
    singles: NDArray[np.float32],
    first: int,
    step: int,
    way: tuple[np.float32, np.float32, np.float32],
    least: np.float32,
) -> np.uint64:
    """Return a bit for each of eight directions along which a way goes at least so far.

    Parameters
    ----------
    singles, first, step
        Where the eight x stand, and how many numbers later y, and then z.
    way, least
        The way, and how far.
    """
    x, y, z = (singles[first + k * step :][:OCTET] * way[k] for k in range(3))
    return np.uint64(np.packbits(x + y + z >= least, bitorder="little")[0])


@written_in_llvm("vtray.geometry.packets.fan_in_llvm:write_count_bits")
def count_bits(rays: np.uint64) -> int:
    """Return how many rays are in a set."""
    return int(rays).bit_count()


@written_in_llvm("vtray.geometry.packets.fan_in_llvm:write_first_bit")
def first_bit(rays: np.uint64) -> int:
    """Return the first ray of a set that has one."""
    return (int(rays) & -int(rays)).bit_length() - 1
