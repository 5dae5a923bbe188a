"""The surface of a shape at a point, and its normal."""

import math
from typing import Any, NamedTuple

from vtray.base.compiler.compiled import device
from vtray.geometry.vector import Vec, dot, scale, sub


class Surface(NamedTuple):
    """What a surface is like at a point.

    Attributes
    ----------
    pole
        The unit normal of a flat surface, which leads out of a solid; of a round one the point that
        it is round, from which its normal leads away.
    is_round
        Which of the two it is.
    error_scale
        What the rounding errors of the shape are relative to.
    is_second
        Whether it is in the second half of a shape that has two, which may differ in colour.
    is_cap
        Whether it closes what a clip plane cuts.
    """

    pole: Vec
    is_round: bool
    error_scale: float
    is_second: bool
    is_cap: bool


@device
def no_power(shape: Any, point: Vec) -> float:  # noqa: ANN401, ARG001
    """Return 0: the power of a point where no clip plane cuts."""
    return 0.0


@device
def normal_at(pole: Vec, is_round: bool, point: Vec, direction: Vec) -> Vec:
    """Return the unit normal at a point, on the side that a ray of a direction comes from.

    That of a round surface so small that rounding put the point on its pole is towards the ray.
    """
    outward = sub(point, pole)
    length2 = dot(outward, outward)
    length = math.sqrt(length2) if length2 > 0.0 else -1.0
    x = outward[0] if length2 > 0.0 else direction[0]
    y = outward[1] if length2 > 0.0 else direction[1]
    z = outward[2] if length2 > 0.0 else direction[2]
    normal = (
        x / length if is_round else pole[0],
        y / length if is_round else pole[1],
        z / length if is_round else pole[2],
    )
    side = -1.0 if dot(normal, direction) > 0.0 else 1.0
    return scale(side, normal)


@device
def bend_at(surface: Surface, point: Vec) -> float:
    """Return one divided by the radius of a surface at a point, 0 where it is flat."""
    outward = sub(point, surface.pole)
    radius = math.sqrt(dot(outward, outward))
    bend = 1.0 / radius if radius > 0.0 else math.inf
    return bend if surface.is_round else 0.0
