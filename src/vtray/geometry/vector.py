"""Points and directions as 3-tuples of floats."""

from typing import Protocol

import numpy as np
from numpy.typing import NDArray

from vtray.base.compiler.compiled import device

Vec = tuple[float, float, float]


class Columns(Protocol):
    """Many points or directions, as an array for each coordinate, (n,)."""

    @property
    def x(self) -> NDArray[np.float64]: ...  # noqa: D102

    @property
    def y(self) -> NDArray[np.float64]: ...  # noqa: D102

    @property
    def z(self) -> NDArray[np.float64]: ...  # noqa: D102


@device
def pick(columns: Columns, k: int) -> Vec:
    """Return one of many points or directions."""
    return columns.x[k], columns.y[k], columns.z[k]


@device
def dot(a: Vec, b: Vec) -> float:
    """Return the scalar product."""
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]


@device
def cross(a: Vec, b: Vec) -> Vec:
    """Return the vector product."""
    return (
        a[1] * b[2] - a[2] * b[1],
        a[2] * b[0] - a[0] * b[2],
        a[0] * b[1] - a[1] * b[0],
    )


@device
def add(a: Vec, b: Vec) -> Vec:
    """Return a + b."""
    return a[0] + b[0], a[1] + b[1], a[2] + b[2]


@device
def sub(a: Vec, b: Vec) -> Vec:
    """Return a - b."""
    return a[0] - b[0], a[1] - b[1], a[2] - b[2]


@device
def lower(a: Vec, b: Vec) -> Vec:
    """Return the smaller of each coordinate."""
    return min(a[0], b[0]), min(a[1], b[1]), min(a[2], b[2])


@device
def upper(a: Vec, b: Vec) -> Vec:
    """Return the larger of each coordinate."""
    return max(a[0], b[0]), max(a[1], b[1]), max(a[2], b[2])


@device
def magnitude(a: Vec) -> float:
    """Return the sum of the absolute coordinates, which rounding errors are relative to."""
    return abs(a[0]) + abs(a[1]) + abs(a[2])


@device
def scale(s: float, a: Vec) -> Vec:
    """Return s * a."""
    return s * a[0], s * a[1], s * a[2]
