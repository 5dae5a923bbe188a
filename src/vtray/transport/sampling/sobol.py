"""Where the samples of a pixel lie: scrambled points of low discrepancy, from counters alone.

The first 2**k points of Sobol's sequence in two dimensions lie one in each of 2**k cells of equal
size, whatever the shape of the cells; Owen's scrambling makes them random and keeps that. Both
depend on nothing but the pixel, the number of the sample, its purpose, and the seed.

References
----------
Sobol, "On the distribution of points in a cube", 1967; Owen, "Randomly permuted (t,m,s)-nets",
1995; Burley, "Practical Hash-based Owen Scrambling", JCGT 9 (4), 2020; Vegdahl, "Building a Better
LK Hash", 2021 (its constants); Jarzynski, Olano, "Hash Functions for GPU Rendering", JCGT 9 (3),
2020 (pcg4d).
"""

import numpy as np
from numpy.typing import NDArray

from vtray.base.compiler.compiled import device

IMAGE_PLACE = 0
"""The purpose of the samples: where in the image plane a ray goes through."""

LENS_PLACE, LENS_ORDER = 1, 2
"""Where in the lens it goes through, and which sample gets which of these places."""

LIGHT_FANS = 1 << 16
"""The purposes from here on: where in a light shadow rays aim, one purpose for each light."""

FAN_ORDER = 1 << 24
"""The purposes from here on: which sample gets which fan of a light, one purpose for each."""

SHARED_FANS = 1 << 25
"""The purposes from here on: where rays aim that many lights share, one purpose for each sample."""

PATH_ORDER = 1 << 26
"""The purposes from here on: which sample gets which point for a step of a path."""

PATHS = 1 << 27
"""The purposes from here on: where paths go on, two purposes for each step."""

FIRST_FANS = 1 << 28
"""As from `LIGHT_FANS` on: where the first fans of pixels aim, one purpose for each light."""

PIXEL_ORDER = 1 << 29
"""The purposes from here on: which pixel gets which first fan of a light, one purpose for each."""

BITS = (1 << 32) - 1

UNIT = 2.0**-32


def sobol_points(count: int, step: int = 1) -> NDArray[np.int64]:
    """Return points of Sobol's sequence as integers with their bits reversed, (2, count).

    Those are the first ones; with a step, each so many.

    The first coordinate is the sample's number with its 32 bits reversed, so it stands here as the
    number itself; the second takes the rows of Pascal's triangle modulo 2.
    """
    number = step * np.arange(count, dtype=np.int64)
    second = np.zeros(count, np.int64)
    row = 1  # the bits of a direction, in the order of the reversed coordinate
    for bit in range((count * step).bit_length()):
        second ^= np.where(number >> bit & 1, row, 0)
        row ^= row << 1 & BITS
    return np.stack([number, second])


@device
def pixel_keys(column: int, row: int, purpose: int, seed: int) -> tuple[int, int]:
    """Return two random integers of 32 bits for a pixel and a purpose, by the hash pcg4d."""
    x = int(column) * 1664525 + 1013904223 & BITS
    y = int(row) * 1664525 + 1013904223 & BITS
    z = purpose * 1664525 + 1013904223 & BITS
    w = seed * 1664525 + 1013904223 & BITS
    x = x + y * w & BITS
    y = y + z * x & BITS
    z = z + x * y & BITS
    w = w + y * z & BITS
    x ^= x >> 16
    y ^= y >> 16
    z ^= z >> 16
    w ^= w >> 16
    x = x + y * w & BITS
    y = y + z * x & BITS
    # The lowest bits, which scrambling makes the first digits, are alike for pixels side by side.
    return x ^ x >> 16, y ^ y >> 16


@device
def scrambled(reversed_bits: int, key: int) -> float:
    """Return a coordinate of a point, scrambled by a key, from 0 to below 1."""
    return float(_reversed(_scrambled_bits(reversed_bits, key))) * UNIT


@device
def shuffled(number: int, levels: int, key: int) -> int:
    """Return the place of a number below ``2**levels`` in an order that a key chooses.

    Any block of a power of two that follows such blocks becomes another one, in some order: what is
    a net stays one.
    """
    if levels == 0:
        return number
    unused = 32 - levels
    bits = _scrambled_bits(_reversed(number) >> unused, key) & (1 << levels) - 1
    return _reversed(bits) >> unused


@device
def _scrambled_bits(reversed_bits: int, key: int) -> int:
    """Return an integer with each bit scrambled by a key and the bits below it."""
    bits = reversed_bits
    bits ^= bits * 0x3D20ADEA & BITS
    bits = bits + key & BITS
    bits = bits * (key >> 16 | 1) & BITS
    bits ^= bits * 0x05526C56 & BITS
    bits ^= bits * 0x53A22864 & BITS
    return bits


@device
def _reversed(bits: int) -> int:
    """Return an integer of 32 bits with their order reversed."""
    bits = (bits & 0x55555555) << 1 | bits >> 1 & 0x55555555
    bits = (bits & 0x33333333) << 2 | bits >> 2 & 0x33333333
    bits = (bits & 0x0F0F0F0F) << 4 | bits >> 4 & 0x0F0F0F0F
    bits = (bits & 0x00FF00FF) << 8 | bits >> 8 & 0x00FF00FF
    return (bits & 0x0000FFFF) << 16 | bits >> 16
