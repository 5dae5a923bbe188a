"""Surfaces that do more than scatter light: what kind each is, and its numbers."""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from vtray.base.compiler.compiled import device
from vtray.transport.surroundings import Surroundings

MATT, MIRROR, GLASS = 0, 1, 2
"""The kinds. A matt surface scatters light as Lambert says, and does no more."""


class Looks(NamedTuple):
    """How surfaces look, by the ranges of `Materials`.

    Attributes
    ----------
    row, step
        The rows of each range, as for colours, (ranges,).
    kind
        What each is, (rows,).
    ior
        The indices of refraction of glass, (rows,).
    surroundings
        What rays see that meet nothing.
    """

    row: NDArray[np.int64]
    step: NDArray[np.int64]
    kind: NDArray[np.int64]
    ior: NDArray[np.float64]
    surroundings: Surroundings


class Look(NamedTuple):
    """How a surface looks.

    Attributes
    ----------
    kind
        What it is.
    ior
        The index of refraction of glass.
    """

    kind: int
    ior: float


@device
def look_of(looks: Looks, k: int, place: int) -> Look:
    """Return how a primitive looks, given its range and its place there."""
    row = looks.row[k] + place * looks.step[k]
    return Look(int(looks.kind[row]), looks.ior[row])
