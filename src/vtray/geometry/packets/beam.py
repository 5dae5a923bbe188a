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

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from vtray.base.compiler.compiled import device
from vtray.geometry.bvh.boxes import Bounds, boxes_met
from vtray.geometry.bvh.tree import FRAME, SIDES, WIDTH, Bvh
from vtray.geometry.rounding import MARGIN
from vtray.geometry.vector import Vec, magnitude
from vtray.geometry.world import ToBoxes

TINY = 1e-30
"""In place of a direction of 0, whose inverse must stay finite."""

NEVER = 3e38
"""A bound that nothing reaches, in single precision."""

SINGLE_ROUNDING = 2.0**-22
"""Bound on the error of a bound in single precision, relative to what is added up: four times the
error of one operation, where there are three."""

SINGLE_TINY = 1e-44
"""The same where numbers are so small that they have fewer digits."""


class Beam(NamedTuple):
    """A beam; s is measured in directions.

    Attributes
    ----------
    near, far
        The beam is in reach of a box between these bounds on s, less `ahead`.
    ahead
        About the s at which the beam reaches the space of the boxes, 0 if it starts there. What
        counts from there is small, and single precision enough for it.
    """

    near: Bounds
    far: Bounds
    ahead: float


class Slab(NamedTuple):
    """The bounds on s along one axis, linear in the sides of a box; see `Bounds`."""

    near_side: int
    near: float
    near_start: float
    far_side: int
    far: float
    far_start: float


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
    x = _make_slab(start_low[0] - margin, start_high[0] + margin, low[0], high[0], 0)
    y = _make_slab(start_low[1] - margin, start_high[1] + margin, low[1], high[1], 1)
    z = _make_slab(start_low[2] - margin, start_high[2] + margin, low[2], high[2], 2)
    return _beam_of(x, y, z)


@device
def _beam_of(x: Slab, y: Slab, z: Slab) -> Beam:
    """Return the beam with these bounds."""
    ahead = max(0.0, _reach_frame(x), _reach_frame(y), _reach_frame(z))
    return Beam(
        Bounds(
            (x.near_side, y.near_side, z.near_side),
            (np.float32(x.near), np.float32(y.near), np.float32(z.near)),
            (
                _lower_term(x.near, x.near_start, ahead),
                _lower_term(y.near, y.near_start, ahead),
                _lower_term(z.near, z.near_start, ahead),
            ),
        ),
        Bounds(
            (x.far_side, y.far_side, z.far_side),
            (np.float32(x.far), np.float32(y.far), np.float32(z.far)),
            (
                -_lower_term(x.far, -x.far_start, -ahead),
                -_lower_term(y.far, -y.far_start, -ahead),
                -_lower_term(z.far, -z.far_start, -ahead),
            ),
        ),
        ahead,
    )


@device
def ray_beam(start: Vec, direction: Vec, margin: float) -> Beam:
    """Return the beam of a single ray, in the boxes' frame, at less cost than `make_beam`.

    Parameters
    ----------
    start, direction
        The ray.
    margin
        How far rounding may have moved what it is tested for.
    """
    x = _ray_slab(start[0], direction[0], margin, 0)
    y = _ray_slab(start[1], direction[1], margin, 1)
    z = _ray_slab(start[2], direction[2], margin, 2)
    return _beam_of(x, y, z)


@device
def _ray_slab(start: float, direction: float, margin: float, axis: int) -> Slab:
    """Return the bounds of an axis for one ray; without a branch, so that loops are vectorised."""
    low_side, high_side = axis * WIDTH, (axis + 3) * WIDTH
    is_up = direction >= 0.0
    size = max(abs(direction), TINY)
    inverse = 1.0 / (size if is_up else -size)
    middle, reach = -start * inverse, margin * abs(inverse)
    return Slab(
        low_side if is_up else high_side,
        inverse,
        middle - reach,
        high_side if is_up else low_side,
        inverse,
        middle + reach,
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
    return Slab(low_side, enter, -last * enter, high_side, 0.0, math.inf)


@device
def _reach_frame(slab: Slab) -> float:
    """Return the s from which on a beam may be in the space of the boxes, along one axis."""
    return slab.near_start - FRAME * abs(slab.near)


@device
def _lower_term(factor: float, term: float, ahead: float) -> np.float32:
    """Return the term of a lower bound, less `ahead`: no rounding makes the bound too great."""
    term = min(max(term - ahead, -NEVER), NEVER)
    return np.float32(term - SINGLE_ROUNDING * (FRAME * abs(factor) + abs(term)) - SINGLE_TINY)


@device
def lower_limit(beam: Beam, s: float) -> np.float32:
    """Return a limit on s as the bounds of a beam count it, not greater than it is."""
    return _lower_term(0.0, s, beam.ahead)


@device
def upper_limit(beam: Beam, s: float) -> np.float32:
    """Return a limit on s as the bounds of a beam count it, not less than it is."""
    return -_lower_term(0.0, -s, -beam.ahead)


@device
def children_met(
    bvh: Bvh,
    node: int,
    beam: Beam,
    start: np.float32,
    end: np.float32,
    entered: NDArray[np.float32],
) -> int:
    """Return a bit for each child of a node that a beam may meet.

    Parameters
    ----------
    bvh, node, beam
        The node, and the beam.
    start, end
        Its `lower_limit` and `upper_limit`.
    entered
        Out: from which s on it may meet each child, as its bounds count, (8,).
    """
    return boxes_met(bvh, node * SIDES, beam.near, beam.far, start, end, entered)


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
