"""Surfaces that do more than scatter light: what kind each is, and its numbers."""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from vtray.base.compiler.compiled import device
from vtray.base.compiler.unseen import apart
from vtray.geometry.vector import Vec

MATT, MIRROR, GLASS, METAL, EMISSIVE, PLASTIC, BLEND = range(7)
"""The kinds. A matt surface scatters light as Lambert says, and does no more."""

NUMBERS = 10
"""Numbers of each: of glass the index of refraction, how much of red, green and blue it absorbs
per length, and 1 if it is thin; of metal its indices of refraction for them, and of extinction; of
plastic its index; of what shines its radiance; of a blend the rows of two materials, and the share
of the second. Then those of rough ones."""

SPREAD = 6
"""Of metal, glass and plastic: how far facets turn away; 0 for a smooth surface."""

THIN = 4
"""Of glass: 1 for a thin sheet, else 0."""

MEANS = 7
"""Of metal without a colour of its own: what its facets mirror on average, for each channel."""

EMPTY = -1
"""In place of a material: no ray is within any."""


Albedos = NDArray[np.float64]
"""What rough surfaces and coats mirror, as `albedo.albedo_at` reads it."""


@apart
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
    brightest
        The brightest channel that is seen along one ray of a camera, infinite for all.
    albedos
        What rough surfaces and coats mirror, as `albedo.albedo_at` reads it; None where there are
        only smooth ones, so that no code is compiled for others.
    absorbs
        True where any glass takes light that goes through it; None where none does, likewise.
    """

    row: NDArray[np.int64]
    step: NDArray[np.int64]
    which: NDArray[np.int64]
    kind: NDArray[np.int64]
    numbers: NDArray[np.float64]
    depth: int
    brightest: float
    albedos: Albedos | None
    absorbs: bool | None


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
def is_thin(looks: Looks, look: Look) -> bool:
    """Tell whether glass is a thin sheet, that has no inside."""
    thin: float = looks.numbers[look.row, THIN]
    return look.kind == GLASS and thin != 0.0


@device
def index_ratio(looks: Looks, look: Look, is_inner: bool) -> float:
    """Return the index of refraction of glass on the other side, divided by that on this one.

    A thin sheet has air on both sides, and is the same from both.
    """
    ior: float = looks.numbers[look.row, 0]
    return 1.0 / ior if is_inner and not is_thin(looks, look) else ior


@device
def spread_of(looks: Looks, look: Look) -> float:
    """Return how far the facets of a surface turn away, 0 for a smooth one."""
    spread: float = looks.numbers[look.row, SPREAD]
    return spread


@device
def part_of_blend(looks: Looks, look: Look, chance: float) -> Look:
    """Return how a surface looks that may be a blend, for a number from 0 to 1: as one of both."""
    if look.kind != BLEND:
        return look
    numbers = looks.numbers
    row = int(numbers[look.row, 1 if chance < numbers[look.row, 2] else 0])
    return Look(int(looks.kind[row]), row)


@device
def parts_of(look: Look) -> int:
    """Return of how many materials a surface is made: two for a blend."""
    return 2 if look.kind == BLEND else 1


@device
def nth_of_blend(looks: Looks, look: Look, part: int) -> tuple[Look, float]:
    """Return one of the materials of a surface, and its share."""
    if look.kind != BLEND:
        return look, 1.0
    numbers = looks.numbers
    row, second = int(numbers[look.row, part]), numbers[look.row, 2]
    return Look(int(looks.kind[row]), row), second if part == 1 else 1.0 - second


@device
def three_numbers(looks: Looks, row: int, first: int) -> Vec:
    """Return three numbers of a material, given its row, from one on."""
    numbers = looks.numbers
    return numbers[row, first], numbers[row, first + 1], numbers[row, first + 2]
