"""Where the shadow rays of a surface point aim within a light: a fan of points of the unit square.

Fans are blocks of Sobol's sequence, so that each fills the square evenly. The first fans of all
pixels of a large part of the image are blocks of one sequence, those of the samples of a pixel side
by side, and pixels in an order in which neighbours follow each other. So the first fans of 2, 4 ...
samples fill the square evenly together, and so do those of 4, 16 ... pixels: what one has too much,
another has too little.

More fans are cast where light is noisy, blocks of a sequence that each pixel has for itself. Each
of several samples gets as many blocks side by side, a power of two: so those of one fill the square
evenly together, and those of all of them more finely.

Points that follow each other are near each other: each two share an elementary cell, a side of
which is a power of 1/2, in the places of its size, and each 4, 8 ... a larger one. Scrambling moves
whole cells, and so does going from a block to the next, which is adding its first number modulo 2,
digit by digit; thus one order of a fan's points is right for all of them.

References
----------
Niederreiter, "Point sets and sequences with small discrepancy", 1987 (elementary cells, called
intervals there); Owen, "Randomly permuted (t,m,s)-nets", 1995; Hilbert, "Ueber die stetige
Abbildung einer Linie auf ein Flächenstück", 1891 (the order of the cells).
"""

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from vtray.base.compiler.compiled import device
from vtray.transport.sampling.pixel_order import (
    ENTRIES,
    levels_for,
    order_offset,
    order_offsets,
    place_in_order,
)
from vtray.transport.sampling.sobol import (
    FAN_ORDER,
    FIRST_FANS,
    LIGHT_FANS,
    PIXEL_ORDER,
    SHARED_FANS,
    pixel_keys,
    scrambled,
    shuffled,
    sobol_points,
)

Integers = NDArray[np.int64]

RUN = 2
"""Points in a row that share a cell."""

NO_OFFSET = (0, 0)
"""That of the first block of points."""

WHOLE_FAN = 64
"""Rays from a hit to a light at a time, where a pixel has one sample."""

TRIAL = 128
"""Rays from all hits of a pixel with few samples to a light on trial; see `soft_trial`. They cost
little beside the samples themselves: with 64, what is left of grain was 3/2 times as much."""

LEAST_FAN = 16
"""Rays of each of many samples of a pixel."""

LEAST_EDGE_FAN = 4
"""Rays of each of the samples of a pixel with sharp edges, among which grain is not seen."""

FEWEST = 8
"""Rays of each fan of a layer of which little is seen, at the least."""

COARSE = 0.016, 0.024, 0.036
"""From these tolerances on, the fans of samples have half, a quarter and an eighth as many rays.

With half as many, light is off by 1.5 times as much. How much the samples of a pixel differ says
what that does; where there is but one, thin bars would make errors larger than they are estimated.
"""

MOST_FANS = 64
"""Fans from the one hit of a pixel to one light at the most."""

MOST_FANS_OF_SAMPLES = 128
"""The same of all samples of a pixel, where each has more than one."""


class Fans(NamedTuple):
    """Which rays are cast to soft lights.

    Attributes
    ----------
    rays
        Rays from a hit to a light at a time.
    fans
        How often that is repeated at the most, while the estimated variance is too large.
    levels
        There are ``2**levels`` places for the samples of a pixel.
    points
        What `fan_points` returns, for so many rays, and then for half, a quarter ... of them; for
        lights that share their fans, `shared_points`.
    offsets
        What `block_offsets` returns, likewise.
    first, first_block
        Where those for so many rays begin in `points` and in `offsets`.
    blocks
        How many blocks there are of each.
    order, first_order
        What `order_offsets` returns, likewise, and where that for so many rays begins.
    order_levels
        There are ``2**order_levels`` pixels whose first fans are blocks of one sequence.
    error
        The standard error that the light at a hit may have.
    by_light
        Whether that is meant of light; else of the sum of the shares of all lamps, so that nothing
        depends on intensities and colours.
    """

    rays: int
    fans: int
    levels: int
    points: Integers
    offsets: Integers
    first: int
    first_block: int
    blocks: int
    order: Integers
    first_order: int
    order_levels: int
    error: float
    by_light: bool


@device
def fans_of_share(fans: Fans, share: float) -> Fans:
    """Return which rays are cast from a hit of whose light only a share is seen.

    So much less its error counts, and so many fewer rays its fans have.
    """
    rays, first, first_block = fans.rays, fans.first, fans.first_block
    first_order = fans.first_order
    while share <= 0.5 and rays > FEWEST:
        first += rays
        first_block += fans.blocks
        first_order += ENTRIES
        rays //= 2
        share *= 2.0
    return Fans(
        rays,
        fans.fans,
        fans.levels,
        fans.points,
        fans.offsets,
        first,
        first_block,
        fans.blocks,
        fans.order,
        first_order,
        fans.order_levels,
        fans.error,
        fans.by_light,
    )


class Noise(NamedTuple):
    """How noisy soft light may be.

    Attributes
    ----------
    error
        The standard error of a pixel.
    by_light
        Whether it is one of light; see `Fans`.
    are_shared
        Whether all lights share their fans.
    halvings
        How often the rays of the fans of samples are halved; see `halvings_for`.
    """

    error: float
    by_light: bool
    are_shared: bool = False
    halvings: int = 0

    def of_one(self, samples: int) -> float:
        """Return the standard error that the light at one of the samples of a pixel may have."""
        return self.error * math.sqrt(samples)


def halvings_for(tolerance: float) -> int:
    """Return how often the rays of the fans of samples are halved for a tolerance, 1 for white."""
    return sum(tolerance >= least for least in COARSE)


def fans_of_middles(noise: Noise) -> Fans:
    """Return the fans of rays through the middles of pixels."""
    return _fans(WHOLE_FAN, MOST_FANS, 1, noise)


def fans_of_samples(samples: int, noise: Noise) -> Fans:
    """Return the fans of pixels with so many samples, more than 1, which share their rays."""
    rays = LEAST_FAN
    while 2 * rays * samples <= TRIAL:
        rays *= 2
    return _fans(rays >> noise.halvings, max(MOST_FANS_OF_SAMPLES // samples, 1), samples, noise)


def fans_of_edges(edge_samples: int, samples: int, noise: Noise) -> Fans:
    """Return the fans of pixels with more samples than others, which cast as many rays in all.

    Parameters
    ----------
    edge_samples, samples
        The samples of such a pixel, and of others that have some.
    noise
        How noisy soft light may be.
    """
    rays = fans_of_samples(samples, noise).rays
    most = rays * samples
    while rays > LEAST_EDGE_FAN and rays * edge_samples > most:
        rays //= 2
    return _fans(rays, max(MOST_FANS_OF_SAMPLES // edge_samples, 1), edge_samples, noise)


def fans_of_paths(samples: int, noise: Noise) -> Fans:
    """Return the fans of paths, of which pixels have so many: one fan, the same at each surface."""
    rays = RUN
    while 2 * rays * samples <= WHOLE_FAN:
        rays *= 2
    return _fans(rays, 1, samples, noise)


def _fans(rays: int, fans: int, samples: int, noise: Noise) -> Fans:
    """Return fans of so many rays, so many for each of the samples of a pixel at the most."""
    levels, error = (samples - 1).bit_length(), noise.of_one(samples)
    if noise.are_shared:
        fans = 1 << fans.bit_length() - 1
        blocks = 1
        points, offsets = shared_points(rays, fans), block_offsets(rays, blocks)
        order = offsets  # not asked for
    else:
        blocks = 1 << levels + (fans - 1).bit_length()
        sizes = [rays >> k for k in range(rays.bit_length()) if k == 0 or rays >> k >= FEWEST]
        points = np.concatenate([fan_points(size) for size in sizes], axis=1)
        offsets = np.concatenate([block_offsets(size, blocks) for size in sizes], axis=1)
        order = np.concatenate([order_offsets(size << levels) for size in sizes], axis=1)
    order_levels = levels_for(rays << levels)
    return Fans(
        rays=rays,
        fans=fans,
        levels=levels,
        points=points,
        offsets=offsets,
        first=0,
        first_block=0,
        blocks=blocks,
        order=order,
        first_order=0,
        order_levels=order_levels,
        error=error,
        by_light=noise.by_light,
    )


def fan_points(fan: int) -> Integers:
    """Return the points of the first block of fans, before they are scrambled.

    Parameters
    ----------
    fan
        Points of a fan: a power of two, at least ``RUN``.

    Returns
    -------
    NDArray[np.int64]
        As `sobol_points` has them, ``(2, fan)``. Each ``RUN`` points share one of ``fan // RUN``
        cells, which are squares or half as wide as high; each 2, 4 ... of these runs share a larger
        cell. Without scrambling, cells that follow each other are side by side; with it, those in a
        common square of four are.
    """
    return sobol_points(fan).take(_fan_order(fan), axis=1)


def block_offsets(fan: int, blocks: int) -> Integers:
    """Return the first points of blocks of so many points, a power of two, ``(2, blocks)``.

    Combined with them by XOR, the points of the first block become those of the others.
    """
    return sobol_points(blocks, fan)


def shared_points(fan: int, fans: int) -> Integers:
    """Return the points of the shared fans of a sample before they are scrambled.

    Parameters
    ----------
    fan, fans
        Points of a fan, and how many fans there are: powers of two.

    Returns
    -------
    NDArray[np.int64]
        As `sobol_points` has them, ``(2, fan * fans)``: first a fan, and then in passes as many
        points again as there were, each pass along the first coordinate. So 2, 4, 8 ... points in a
        row share a part of that.
    """
    order = _along_first(fan)
    while len(order) < fan * fans:
        order = np.concatenate([order, len(order) + _along_first(len(order))])
    return sobol_points(len(order)).take(order, axis=1)


def _along_first(count: int) -> Integers:
    """Return the numbers of the first points, a power of two, by their first coordinate."""
    return _reversed_bits(np.arange(count), count.bit_length() - 1)


@device
def fan_keys(column: int, row: int, light: int, seed: int) -> tuple[int, int]:
    """Return what scrambles more fans of a pixel for a light, which is given by its number."""
    return pixel_keys(column, row, LIGHT_FANS + light, seed)


@device
def shared_keys(column: int, row: int, sample: int, seed: int) -> tuple[int, int]:
    """Return what scrambles the shared fans of a sample of a pixel."""
    return pixel_keys(column, row, SHARED_FANS + sample, seed)


@device
def place_of(levels: int, sample: int, column: int, row: int, light: int, seed: int) -> int:
    """Return the place of a sample among the ``2**levels`` of a pixel, for a light.

    In the order of the samples, those of two lights, and the places in the image, would be alike:
    points of the same number are in the same halves of the square, or all in opposite ones.

    References
    ----------
    Burley, "Practical Hash-based Owen Scrambling", JCGT 9 (4), 2020, section 3.
    """
    key, _ = pixel_keys(column, row, FAN_ORDER + light, seed)
    return shuffled(sample, levels, key)


@device
def fan_of(
    fans: Fans, number: int, count: int, sample: int, column: int, row: int, light: int, seed: int
) -> tuple[tuple[int, int], tuple[int, int]]:
    """Return what makes the points of the first block those of a fan: its offset, and its keys.

    Parameters
    ----------
    fans
        The fans.
    number, count
        Which fan of the sample it is, and of how many, as far as that is known before: else of one.
    sample
        The number of the sample.
    column, row
        The pixel.
    light, seed
        The number of the light, and what chooses other places of all samples.
    """
    place = place_of(fans.levels, sample, column, row, light, seed)
    if number > 0 or count > 1:
        return offset_of(fans, place * count + number), fan_keys(column, row, light, seed)
    offset = offset_of(fans, place)
    side = fans.order_levels // 2
    across, down = column >> side, row >> side
    key, _ = pixel_keys(across, down, PIXEL_ORDER + light, seed)
    place = place_in_order(column, row, fans.order_levels, key)
    x, y = order_offset(fans.order, fans.first_order, place)
    return (x ^ offset[0], y ^ offset[1]), pixel_keys(across, down, FIRST_FANS + light, seed)


@device
def offset_of(fans: Fans, block: int) -> tuple[int, int]:
    """Return that of a block, given by its number.

    Combined with it by XOR, the points of the first block become those of this one.
    """
    place = fans.first_block + block
    return fans.offsets[0, place], fans.offsets[1, place]


@device
def fan_point(
    points: Integers, k: int, offset: tuple[int, int], keys: tuple[int, int]
) -> tuple[float, float]:
    """Return a point of a fan, from 0 to below 1 either way.

    Parameters
    ----------
    points, k
        Those of the first fan, and the number of one of them.
    offset, keys
        What `fan_of` returns.
    """
    u = scrambled(points[0, k] ^ offset[0], keys[0])
    return u, scrambled(points[1, k] ^ offset[1], keys[1])


def _fan_order(fan: int) -> Integers:
    """Return the numbers of a block's points, cell by cell, (fan,)."""
    levels = (fan // RUN).bit_length() - 1  # how often the square is halved
    down = levels // 2
    across = levels - down
    x, y = sobol_points(fan)
    cell = _reversed_bits(x, across) << down | _reversed_bits(y, down)
    columns, rows = _hilbert_curve(down)
    if across > down:
        # Round two squares side by side; of four cells by two, each two then make a square.
        side = 1 << down
        columns, rows = (
            np.concatenate([side - 1 - rows, side + rows]),
            np.concatenate([columns, side - 1 - columns]),
        )
    place = np.argsort(columns << down | rows)
    return np.argsort(place[cell], kind="stable")


def _reversed_bits(numbers: Integers, bits: int) -> Integers:
    """Return the lowest bits of numbers with their order reversed."""
    reversed_bits = np.zeros_like(numbers)
    for bit in range(bits):
        reversed_bits |= (numbers >> bit & 1) << bits - 1 - bit
    return reversed_bits


def _hilbert_curve(levels: int) -> tuple[Integers, Integers]:
    """Return the columns and rows of a square's ``4**levels`` cells along Hilbert's curve.

    It goes from the first column and row to the last column in the first row.
    """
    x = y = np.zeros(1, np.int64)
    for level in range(levels):
        side = 1 << level
        x, y = (
            np.concatenate([y, x, x + side, 2 * side - 1 - y]),
            np.concatenate([x, y + side, y + side, side - 1 - x]),
        )
    return x, y
