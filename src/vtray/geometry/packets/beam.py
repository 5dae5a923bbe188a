"""A beam: rays from a point or a box into a box of directions, and the boxes that it may meet.

The rays of a camera start at the eye or, in an orthographic view, side by side in one direction;
all shadow rays to a light end there. At a distance of ``s`` times the direction, a beam fills the
box from ``start_low + s * low`` to ``start_high + s * high``; whether that touches a given box is,
for each axis, a question of two bounds on ``s``. With a single ray this is the usual slab test.

References
----------
Kay, Kajiya, "Ray Tracing Complex Scenes", SIGGRAPH 1986 (slabs); Boulos, Wald, Shirley, "Geometric
and Arithmetic Culling Methods for Entire Ray Packets", 2006 (intervals).
"""

from typing import NamedTuple

from vtray.base.compiler.compiled import device
from vtray.geometry.bvh.tree import SIDES, WIDTH, Bvh
from vtray.geometry.rounding import MARGIN
from vtray.geometry.vector import Vec, magnitude
from vtray.geometry.world import ToBoxes

TINY = 1e-30
"""In place of a direction of 0, whose inverse must stay finite."""

NEVER = 1e300
"""A bound that nothing reaches."""

NODE_BITS = (1 << 40) - 1
SIDE_BITS = 63
"""Masks that tell the compiler that no index is negative, without which it does not vectorise."""


class Slab(NamedTuple):
    """The bounds on ``s`` along one axis, linear in the sides of a box.

    Attributes
    ----------
    near_side, far_side
        Where a node's low or high sides begin: the side that the bound is taken from.
    near, near_start
        The beam is in reach of a box from ``side * near + near_start`` on,
    far, far_start
        up to ``side * far + far_start``.
    """

    near_side: int
    near: float
    near_start: float
    far_side: int
    far: float
    far_start: float


class Beam(NamedTuple):
    """A beam; s is measured in directions."""

    x: Slab
    y: Slab
    z: Slab


@device
def make_beam(start_low: Vec, start_high: Vec, low: Vec, high: Vec, margin: float) -> Beam:
    """Return the beam from a box of starts in a box of directions, in the boxes' frame.

    Parameters
    ----------
    start_low, start_high
        The least and the greatest coordinates of where its rays start.
    low, high
        The least and the greatest components of its directions.
    margin
        How far rounding may have moved what the beam is tested for.
    """
    return Beam(
        _make_slab(start_low[0] - margin, start_high[0] + margin, low[0], high[0], 0),
        _make_slab(start_low[1] - margin, start_high[1] + margin, low[1], high[1], 1),
        _make_slab(start_low[2] - margin, start_high[2] + margin, low[2], high[2], 2),
    )


@device
def _make_slab(first: float, last: float, low: float, high: float, axis: int) -> Slab:
    """Return the bounds of an axis, for starts from `first` to `last`.

    These are ``first + s * low <= high side`` and ``last + s * high >= low side``, solved for s.
    """
    low_side, high_side = axis * WIDTH, (axis + 3) * WIDTH
    if low >= 0.0:
        enter, leave = 1.0 / max(high, TINY), 1.0 / max(low, TINY)
        return Slab(low_side, enter, -last * enter, high_side, leave, -first * leave)
    if high <= 0.0:
        enter, leave = 1.0 / min(low, -TINY), 1.0 / min(high, -TINY)
        return Slab(high_side, enter, -first * enter, low_side, leave, -last * leave)
    # Directions to both sides: one bound says something, and there is no end.
    enter = 1.0 / max(high, TINY)
    return Slab(low_side, enter, -last * enter, high_side, 0.0, NEVER)


@device
def children_met(bvh: Bvh, node: int, beam: Beam, start: float, end: float) -> int:
    """Return a bit for each child of a node that a beam may meet with s between two bounds."""
    first = node * SIDES & NODE_BITS
    x_near, x_far = first + (beam.x.near_side & SIDE_BITS), first + (beam.x.far_side & SIDE_BITS)
    y_near, y_far = first + (beam.y.near_side & SIDE_BITS), first + (beam.y.far_side & SIDE_BITS)
    z_near, z_far = first + (beam.z.near_side & SIDE_BITS), first + (beam.z.far_side & SIDE_BITS)
    x, y, z = beam.x, beam.y, beam.z
    met = 0
    for k in range(_width(bvh)):
        enter = max(
            start,
            float(bvh.sides[x_near + k]) * x.near + x.near_start,
            float(bvh.sides[y_near + k]) * y.near + y.near_start,
            float(bvh.sides[z_near + k]) * z.near + z.near_start,
        )
        leave = min(
            end,
            float(bvh.sides[x_far + k]) * x.far + x.far_start,
            float(bvh.sides[y_far + k]) * y.far + y.far_start,
            float(bvh.sides[z_far + k]) * z.far + z.far_start,
        )
        met |= 1 << k if enter <= leave else 0
    return met


@device
def _width(bvh: Bvh) -> int:
    """Return ``WIDTH``, as the compiler cannot know: it unrolls loops that it sees the end of.

    Unrolled, the test of a node's boxes is not vectorised, and takes three times as long.
    """
    float32_bytes: int = bvh.sides.itemsize & 4
    return WIDTH // 4 * float32_bytes


@device
def enter_child(bvh: Bvh, child: int, beam: Beam) -> float:
    """Return from which s on a beam may meet a child."""
    first = child // WIDTH * SIDES + child % WIDTH
    x, y, z = beam.x, beam.y, beam.z
    enter: float = max(
        float(bvh.sides[first + x.near_side]) * x.near + x.near_start,
        float(bvh.sides[first + y.near_side]) * y.near + y.near_start,
        float(bvh.sides[first + z.near_side]) * z.near + z.near_start,
    )
    return enter


@device
def beam_margin(apex: Vec, offset: Vec) -> float:
    """Return how far rounding may move what a beam is tested for, apart from the spheres' own part.

    Parameters
    ----------
    apex
        Where the beam starts.
    offset
        The origin of the kernels' space. Both are in the boxes' space.
    """
    # Eight: more than the boxes themselves reach.
    return MARGIN * (magnitude(apex) + magnitude(offset) + 8.0)


@device
def shape_margin(to_boxes: ToBoxes, apex: Vec, error_scale: float) -> float:
    """Return how far rounding may move what a beam is tested for among the boxes of shapes.

    Parameters
    ----------
    to_boxes
        What leads to the boxes.
    apex
        Where the beam starts, in their space.
    error_scale
        What the rounding errors of the beam's rays are relative to, in the kernels' space.
    """
    margin = beam_margin(apex, to_boxes.offset) + MARGIN * to_boxes.moved
    return margin + MARGIN * error_scale * to_boxes.ratio
