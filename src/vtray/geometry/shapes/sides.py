"""Half-spaces in which a shape lies as it is seen from a point: what many rays miss at once."""

from typing import NamedTuple

from vtray.base.compiler.compiled import device
from vtray.geometry.vector import Vec


class Sides(NamedTuple):
    """Three half-spaces of directions. A ray from the point that meets the shape is in all of them.

    Attributes
    ----------
    one, other, end
        Their inner normals, of length 1, or 0 for one that holds all directions.
    """

    one: Vec
    other: Vec
    end: Vec


@device
def all_sides() -> Sides:
    """Return half-spaces that hold all directions."""
    zero = 0.0, 0.0, 0.0
    return Sides(zero, zero, zero)
