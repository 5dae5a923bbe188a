"""Surfaces that do more than scatter light: what kind each is, and its numbers."""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from vtray.base.compiler.compiled import device
from vtray.geometry.vector import Vec

MATT, MIRROR, GLASS, METAL, EMISSIVE = 0, 1, 2, 3, 4
"""The kinds. A matt surface scatters light as Lambert says, and does no more."""

NUMBERS = 6
"""Numbers of each: of glass the index of refraction and how much of red, green and blue it absorbs
per length; of metal its indices of refraction for them, and of extinction; of what shines its
radiance."""

EMPTY = -1
"""In place of a material: no ray is within any."""


class Looks(NamedTuple):
    """How surfaces look, by the ranges of `Materials`.

    Attributes
    ----------
    row, step
        The rows of each range, as for colours, (ranges,).
    which
        Which material each is made of, (rows,).
    kind
        What each material is, (materials,).
    numbers
        What else is known of it, (materials, ``NUMBERS``).
    depth
        Over how many surfaces rays are followed at the most.
    """

    row: NDArray[np.int64]
    step: NDArray[np.int64]
    which: NDArray[np.int64]
    kind: NDArray[np.int64]
    numbers: NDArray[np.float64]
    depth: int


class Look(NamedTuple):
    """How a surface looks.

    Attributes
    ----------
    kind
        What it is.
    row
        The row of its material.
    """

    kind: int
    row: int


@device
def look_of(looks: Looks, k: int, place: int) -> Look:
    """Return how a primitive looks, given its range and its place there."""
    row = looks.which[looks.row[k] + place * looks.step[k]]
    return Look(int(looks.kind[row]), int(row))


@device
def first_number(looks: Looks, look: Look) -> float:
    """Return the first of the numbers of a surface."""
    number: float = looks.numbers[look.row, 0]
    return number


@device
def three_numbers(looks: Looks, row: int, first: int) -> Vec:
    """Return three numbers of a material, given its row, from one on."""
    numbers = looks.numbers
    return numbers[row, first], numbers[row, first + 1], numbers[row, first + 2]
