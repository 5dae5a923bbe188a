"""What all kinds of shapes can do, as their modules say it."""

from collections.abc import Callable
from typing import Any, NamedTuple

from vtray.geometry.bundle import Bundle, Crossing
from vtray.geometry.ray import Ray, Segment
from vtray.geometry.shapes.sides import Sides
from vtray.geometry.shapes.stay import Stay
from vtray.geometry.shapes.surface import Surface
from vtray.geometry.shapes.unrolled import Unrolled, Upright
from vtray.geometry.vector import Vec

Shape = Any
"""The numbers of a shape in the kernels' space. Each kind has a type of its own; all have an
``error_scale``, and bounded ones ``center`` and ``radius`` of a ball around them."""


class Verbs(NamedTuple):
    """What shapes of a kind can do: the functions of its module.

    Attributes
    ----------
    distance_to
        Returns the distance at which a ray first meets a shape, or infinity.
    is_aside
        Tells whether a ray is sure to miss a shape, at less cost: worth asking one ray at a time.
    hides
        Tells whether a shape stands between two points.
    sides
        Returns half-spaces in which a shape lies as it is seen from a point.
    is_outside
        Tells whether a point of the surface is looked at from outside, given the normal there.
    crossing
        Returns from where to where the rays of a bundle first meet a shape.
    surface
        Returns the surface at a point, whose rounding error is relative to a number beside the
        shape.
    power_at
        Returns how deep a point is within the side of what clip planes cut, as a square below 0,
        and 0 for all else: of several that a ray meets at the same distance, as it meets the caps
        that lie in one plane, the one is hit in which the point is deepest.
    stay
        Returns the part of a ray within a shape.
    unroll
        Returns where a point of the surface is on the unrolled surface.
    """

    distance_to: Callable[[Shape, Ray], float]
    is_aside: Callable[[Shape, Ray], bool]
    hides: Callable[[Shape, Segment], bool]
    sides: Callable[[Shape, Vec, float], Sides]
    is_outside: Callable[[Shape, Vec, Vec], bool]
    crossing: Callable[[Shape, Bundle], Crossing]
    surface: Callable[[Shape, Vec, float], Surface]
    power_at: Callable[[Shape, Vec], float]
    stay: Callable[[Shape, Ray], Stay]
    unroll: Callable[[Shape, Vec, Upright], Unrolled]
