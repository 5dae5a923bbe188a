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

WAY, CHOICE, PICK = 0, 1, 1 << 10
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


class Step(NamedTuple):
    """A step of a path, and how it chooses.

    Attributes
    ----------
    column, row, sample
        The pixel, and the number of its sample.
    number
        The number of the step: that of surfaces before.
    paths
        How paths choose.
    seed
        That of the picture.
    """

    column: int
    row: int
    sample: int
    number: int
    paths: Paths
    seed: int


@device
def path_point(step: Step, purpose: int) -> tuple[float, float]:
    """Return a point of the unit square for a step of a path.

    Parameters
    ----------
    step
        The step.
    purpose
        ``WAY``, ``CHOICE`` or ``PICK``.
    """
    return _point(step, 2 * int(step.number) + purpose, step.seed)


@device
def lamp_point(step: Step, light: int) -> tuple[float, float]:
    """Return a point of the unit square for a ray to one of the lights."""
    return _point(step, LAMPS + light, seed_of_step(step.seed, step.number))


@device
def _point(step: Step, purpose: int, seed: int) -> tuple[float, float]:
    """Return a point of the unit square, others for each purpose and seed."""
    order, _ = pixel_keys(step.column, step.row, PATH_ORDER + purpose, seed)
    one, other = pixel_keys(step.column, step.row, PATHS + purpose, seed)
    return dealt_point(step.paths, step.sample, order, one, other)


@device
def dealt_point(paths: Paths, sample: int, order: int, one: int, other: int) -> tuple[float, float]:
    """Return the point that is dealt to a sample by a key, scrambled by two others."""
    place = shuffled(sample, paths.levels, order)
    return scrambled(paths.points[0, place], one), scrambled(paths.points[1, place], other)


@device
def seed_of_step(seed: int, step: int) -> int:
    """Return the seed of the shadow rays from the surface after so many others."""
    return seed + step * _STEP & BITS
