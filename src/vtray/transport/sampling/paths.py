"""The numbers by which a path of light chooses where it goes on.

Each step of a path has points of the unit square: one for the direction, one for the choices,
between mirroring and refraction, and of ending, and for glossy surfaces one for each light. For
each, the samples of a pixel have the points of a Sobol sequence, scrambled and dealt anew, so that
no two steps are alike.

References
----------
Burley, "Practical Hash-based Owen Scrambling", JCGT 9 (4), 2020.
"""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from vtray.base.compiler.compiled import device
from vtray.transport.sampling.sobol import (
    BITS,
    PATH_ORDER,
    PATHS,
    pixel_keys,
    scrambled,
    shuffled,
    sobol_points,
)

WAY, CHOICE, BLEND = 0, 1, 1 << 10
"""What a point is for: the direction, choices, and the choices of which material and lights."""

LAMPS = 1 << 20
"""What the points from here on are for: shadow rays, one for each light."""

_STEP = 0x9E3779B1


class Paths(NamedTuple):
    """How paths choose.

    Attributes
    ----------
    levels
        There are ``2**levels`` places for the samples of a pixel.
    points
        Points of Sobol's sequence, (2, 2**levels).
    """

    levels: int
    points: NDArray[np.int64]


def paths_of(samples: int) -> Paths:
    """Return how the paths of pixels with so many samples choose."""
    levels = (samples - 1).bit_length()
    return Paths(levels, sobol_points(1 << levels))


@device
def path_point(
    paths: Paths, purpose: int, column: int, row: int, sample: int, step: int, seed: int
) -> tuple[float, float]:
    """Return a point of the unit square for a step of a path.

    Parameters
    ----------
    paths
        How paths choose.
    purpose
        ``WAY``, ``CHOICE`` or ``BLEND``.
    column, row, sample
        The pixel, and the number of its sample.
    step
        The number of the step: that of surfaces before.
    seed
        That of the picture.
    """
    return _point(paths, 2 * int(step) + purpose, column, row, sample, seed)


@device
def lamp_point(
    paths: Paths, light: int, column: int, row: int, sample: int, step: int, seed: int
) -> tuple[float, float]:
    """Return a point of the unit square for a ray to one of the lights; see `path_point`."""
    return _point(paths, LAMPS + light, column, row, sample, seed_of_step(seed, step))


@device
def _point(
    paths: Paths, number: int, column: int, row: int, sample: int, seed: int
) -> tuple[float, float]:
    """Return a point of the unit square, others for each number; see `path_point`."""
    order, _ = pixel_keys(column, row, PATH_ORDER + number, seed)
    place = shuffled(sample, paths.levels, order)
    one, other = pixel_keys(column, row, PATHS + number, seed)
    points = paths.points
    return scrambled(points[0, place], one), scrambled(points[1, place], other)


@device
def seed_of_step(seed: int, step: int) -> int:
    """Return the seed of the shadow rays from the surface after so many others."""
    return seed + step * _STEP & BITS
