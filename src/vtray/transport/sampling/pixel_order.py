"""The order of the pixels, in which neighbours follow each other.

Where pixels that follow each other have blocks of one sequence that do, any 4, 16, 64 ... of them
that form a square fill it evenly together: what one has too much, its neighbours have too little.
What is left of noise changes from pixel to pixel, so that it is hardly seen, and a smaller copy of
the picture has much less of it.

References
----------
Ahmed, Wonka, "Screen-Space Blue-Noise Diffusion of Monte Carlo Sampling Error via Hierarchical
Ordering of Pixels", ACM Transactions on Graphics 39 (6), 2020.
"""

from functools import cache

import numpy as np
from numpy.typing import NDArray

from vtray.base.compiler.compiled import device
from vtray.transport.sampling.sobol import shuffled, sobol_points

Integers = NDArray[np.int64]

_TABLE_BITS = 10
_TABLE = 1 << _TABLE_BITS
ENTRIES = 2 * _TABLE
"""Numbers of what `order_offsets` returns, for each coordinate."""

MOST_LEVELS = 2 * _TABLE_BITS


def levels_for(points: int) -> int:
    """Return how many digits the place of a pixel may have if each has so many points.

    The number is even. The sequence has points of 32 digits, of which a power of two takes some.
    """
    return min(MOST_LEVELS, 32 - (points.bit_length() - 1)) // 2 * 2


@cache
def order_offsets(points: int) -> Integers:
    """Return what `order_offset` needs for pixels that have so many points, ``(2, ENTRIES)``.

    These are first points of blocks: those of the lowest digits of a place, then of the others.
    They are kept, and not to be changed.
    """
    steps = points, points << _TABLE_BITS
    return np.concatenate([sobol_points(_TABLE, step) for step in steps], axis=1)


@device
def place_in_order(column: int, row: int, levels: int, key: int) -> int:
    """Return the place of a pixel within the square of ``2**levels`` pixels that it is in.

    Parameters
    ----------
    column, row
        The pixel.
    levels
        How many digits places have, an even number.
    key
        Chooses for each square and its four quarters, again and again, which of these come first.
    """
    across, down = _spread_bits(column), _spread_bits(row)
    return shuffled((across | down << 1) & (1 << levels) - 1, levels, key)


@device
def order_offset(offsets: Integers, first: int, place: int) -> tuple[int, int]:
    """Return the first point of the block of the pixel at a place.

    Parameters
    ----------
    offsets, first
        What `order_offsets` returns, from this entry on.
    place
        What `place_in_order` returns.
    """
    low, high = first + (place & _TABLE - 1), first + _TABLE + (place >> _TABLE_BITS)
    return offsets[0, low] ^ offsets[0, high], offsets[1, low] ^ offsets[1, high]


@device
def _spread_bits(number: int) -> int:
    """Return the lowest 16 bits of a number, each with a 0 above it."""
    bits = int(number) & 0xFFFF
    bits = (bits | bits << 8) & 0x00FF00FF
    bits = (bits | bits << 4) & 0x0F0F0F0F
    bits = (bits | bits << 2) & 0x33333333
    return (bits | bits << 1) & 0x55555555
