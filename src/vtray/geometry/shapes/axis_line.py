"""Lines as a shape with an axis sees them, and what its caps and a bundle of rays make of them."""

import math
from collections.abc import Callable
from typing import NamedTuple, Protocol, TypeVar

from vtray.base.compiler.compiled import device
from vtray.geometry.bundle import (
    Bundle,
    Crossing,
    Passage,
    bundle_width,
    first_crossing,
    is_looked_at,
    spread_along,
)
from vtray.geometry.rounding import MARGIN, ROUNDING
from vtray.geometry.shapes.sides import Sides
from vtray.geometry.vector import Vec, add, cross, dot, scale, sub

ON_SIDE = 0.125
"""A point is on the side, or beside it, if it is no deeper than such a part of what rounding may
do. What a shape stops comes in deeper than all of that."""

TINY = 1e-300
"""In place of a growth of 0, whose inverse must not be infinite times 0; the least square of a
length whose direction is known."""


class Axial(Protocol):
    """A shape with an axis, between two caps.

    Attributes
    ----------
    start
        Where its axis starts.
    axis
        The unit direction to the end, 0 for a shape without length.
    length
        How far the end is.
    error_scale
        What its rounding errors are relative to.
    """

    @property
    def start(self) -> Vec: ...  # noqa: D102

    @property
    def axis(self) -> Vec: ...  # noqa: D102

    @property
    def length(self) -> float: ...  # noqa: D102

    @property
    def error_scale(self) -> float: ...  # noqa: D102


AnyAxial = TypeVar("AnyAxial", bound=Axial)


class Line(NamedTuple):
    """A line beside an axis: its way along the axis, and that around it.

    Attributes
    ----------
    height, rise
        How far along the axis it starts, and how that grows.
    beside, aside
        How far from the axis it starts, and how that grows, as vectors square to the axis.
    """

    height: float
    rise: float
    beside: Vec
    aside: Vec


class Span(NamedTuple):
    """From where to where a line is within something, in its own unit; empty if not near < far."""

    near: float
    far: float


@device
def line_beside(shape: Axial, origin: Vec, way: Vec) -> Line:
    """Return a line through a point in a direction as the shape sees it."""
    from_start = sub(origin, shape.start)
    height, rise = dot(from_start, shape.axis), dot(way, shape.axis)
    return Line(
        height,
        rise,
        sub(from_start, scale(height, shape.axis)),
        sub(way, scale(rise, shape.axis)),
    )


@device
def move_along(line: Line, distance: float) -> Line:
    """Return a line that starts so much later."""
    return Line(
        line.height + distance * line.rise,
        line.rise,
        add(line.beside, scale(distance, line.aside)),
        line.aside,
    )


@device
def passes_by(line: Line, radius: float, margin: float) -> bool:
    """Tell whether a line stays farther from the axis than a radius, by more than a margin."""
    reach = radius + margin
    square, along = dot(line.aside, line.aside), dot(line.beside, line.aside)
    # Less by more than what rounding may leave of the difference below.
    beside = dot(line.beside, line.beside) * (1.0 - ROUNDING)
    misses: bool = (beside - reach * reach) * square > along * along
    return misses


@device
def cap_span(line: Line, low: float, high: float) -> Span:
    """Return where a line is between two heights."""
    rises = line.rise != 0.0
    divisor = line.rise if rises else 1.0
    first, last = (low - line.height) / divisor, (high - line.height) / divisor
    between = (line.height > low) & (line.height < high)
    near = min(first, last) if rises else -math.inf
    far = max(first, last) if rises else math.inf
    return Span(near if rises | between else math.inf, far if rises | between else -math.inf)


@device
def both_spans(one: Span, other: Span) -> Span:
    """Return where a line is within two things."""
    return Span(max(one.near, other.near), min(one.far, other.far))


@device
def sides_around(shape: Axial, radius: float, point: Vec, error_scale: float) -> Sides:
    """Return the half-spaces in which a shape lies as it is seen from a point.

    Two are bounded by the planes through the point that touch an endless cylinder around the shape,
    the third by the cap that the point is beyond.

    Parameters
    ----------
    shape, radius
        The shape, and how far it is from its axis at the most.
    point, error_scale
        The point, and what its rounding error is relative to.
    """
    error_bound = ROUNDING * (shape.error_scale + error_scale)
    margin = MARGIN * (shape.error_scale + error_scale)
    line = line_beside(shape, point, shape.axis)
    distance2 = dot(line.beside, line.beside)
    distance = math.sqrt(distance2)
    end = 1.0 if line.height < -margin else -1.0 if line.height > shape.length + margin else 0.0
    is_beside = (distance2 > TINY) & (distance >= radius - ON_SIDE * error_bound)
    inverse = 1.0 / distance if is_beside else 0.0
    inward = scale(-inverse, line.beside)
    # From the side itself, what leads away from the axis does not come back.
    sine = min((radius + margin) * inverse, 1.0)
    cosine = math.sqrt(1.0 - sine * sine)
    along, aside = scale(sine, inward), scale(cosine, cross(inward, shape.axis))
    return Sides(add(along, aside), sub(along, aside), scale(end, shape.axis))


@device
def side_or_cap(shape: Axial, height: float, foot: Vec, is_side: bool) -> Vec:
    """Return the point of the axis that a side is round, or the outward normal of the nearer cap.

    Parameters
    ----------
    shape
        The shape.
    height
        How far along the axis a point of it is.
    foot
        What is returned for the side.
    is_side
        Whether the point is on the side.
    """
    outward = scale(1.0 if height > 0.5 * shape.length else -1.0, shape.axis)
    return (
        foot[0] if is_side else outward[0],
        foot[1] if is_side else outward[1],
        foot[2] if is_side else outward[2],
    )


@device
def at_least(rate: float, value: float) -> Span:
    """Return where so many times a distance are at least a value."""
    divisor = rate if rate != 0.0 else 1.0
    bound = value / divisor
    never = (rate == 0.0) & (value > 0.0)
    near = bound if rate > 0.0 else math.inf if never else -math.inf
    far = bound if rate < 0.0 else -math.inf if never else math.inf
    return Span(near, far)


@device
def is_second_half(shape: Axial, point: Vec, error_scale: float) -> bool:
    """Tell whether a point is nearer to the end of the axis, by more than rounding can explain.

    Parameters
    ----------
    shape
        The shape.
    point
        The point.
    error_scale
        What its rounding error is relative to, beside the shape.
    """
    height = dot(sub(point, shape.start), shape.axis)
    error_bound = ROUNDING * (shape.error_scale + error_scale)
    return height - 0.5 * shape.length > error_bound


class AxialPassage(NamedTuple):
    """Where the rays of a bundle enter and leave a shape, and how wide the bundle is there."""

    passage: Passage
    before: float
    behind: float


@device
def axial_crossing(
    shape: AnyAxial,
    line: Line,
    bundle: Bundle,
    any_inside: Span,
    spans_of: Callable[[AnyAxial, Line, float, float], tuple[Span, Span]],
) -> Crossing:
    """Return from where to where the rays of a bundle first meet a shape.

    The parameters are those of `axial_passage`.
    """
    passage, before, behind = axial_passage(shape, line, bundle, any_inside, spans_of)
    enters, leaves, _ = passage
    found = first_crossing(passage, bundle)
    if is_looked_at(bundle.sight) and found.far < math.inf:
        reverse = Line(line.height, -line.rise, line.beside, scale(-1.0, line.aside))
        is_one = (
            _is_one_part(shape, line, bundle, before, enters, spans_of)
            if found.far == enters.far
            else _is_one_part(
                shape, reverse, bundle, behind, Crossing(-leaves.far, -leaves.near), spans_of
            )
        )
        return Crossing(found.near, found.far if is_one else math.inf)
    return found


@device
def axial_passage(
    shape: AnyAxial,
    line: Line,
    bundle: Bundle,
    any_inside: Span,
    spans_of: Callable[[AnyAxial, Line, float, float], tuple[Span, Span]],
) -> AxialPassage:
    """Return where the rays of a bundle enter and leave a shape.

    As long as a bundle is no wider than some width, all its rays are inside where they would be
    inside a shape that is so much smaller.

    Parameters
    ----------
    shape, line, bundle
        The shape, and the rays with the middle one.
    any_inside
        Where any of them may be inside.
    spans_of
        Returns where a line is within the side and between the caps of a shape that is larger, on
        its side and at its caps, by two lengths; which may be below 0.
    """
    own = both_spans(*spans_of(shape, line, 0.0, 0.0))
    entry = max(own.near, 0.0)
    # A little farther on, the bundle is wider by a quarter.
    before = 1.25 * bundle_width(bundle, entry)
    valid = entry + 0.25 * bundle_width(bundle, entry) / max(bundle.growth, TINY)
    if bundle.growth < 0.0:
        before, valid = bundle_width(bundle, max(any_inside.near, 0.0)), math.inf
    behind = max(bundle_width(bundle, own.near), bundle_width(bundle, own.far))
    all_before = _all_inside(shape, line, bundle, before, spans_of)
    all_behind = _all_inside(shape, line, bundle, behind, spans_of)
    covers = (all_before.near < all_before.far) & (all_before.near <= valid)
    end = all_behind.far if all_behind.near < all_behind.far else -math.inf
    enters = Crossing(any_inside.near, all_before.near)
    return AxialPassage(Passage(enters, Crossing(end, any_inside.far), covers), before, behind)


@device
def _all_inside(
    shape: AnyAxial,
    line: Line,
    bundle: Bundle,
    width: float,
    spans_of: Callable[[AnyAxial, Line, float, float], tuple[Span, Span]],
) -> Span:
    """Return where all rays of a bundle no wider than that are inside a shape."""
    along = width * spread_along(bundle, shape.axis)
    side, caps = spans_of(shape, line, -width * bundle.stretch, -along)
    span = both_spans(side, caps)
    is_there = 2.0 * along < shape.length
    return Span(span.near if is_there else math.inf, span.far if is_there else -math.inf)


@device
def _is_one_part(
    shape: AnyAxial,
    line: Line,
    bundle: Bundle,
    width: float,
    enters: Crossing,
    spans_of: Callable[[AnyAxial, Line, float, float], tuple[Span, Span]],
) -> bool:
    """Tell whether all rays of a bundle no wider than that enter one cap, or one half of the side.

    Parameters
    ----------
    shape, line, bundle, width, spans_of
        The shape, and the rays with the middle one.
    enters
        From where to where they enter it.
    """
    wide, along = width * bundle.stretch, width * spread_along(bundle, shape.axis)
    larger_side, larger_caps = spans_of(shape, line, wide, along)
    smaller_side, smaller_caps = spans_of(shape, line, -wide, -along)
    on_cap, on_side = (
        larger_caps.near >= smaller_side.near,
        larger_side.near >= smaller_caps.near,
    )
    first, last = line.height + enters.near * line.rise, line.height + enters.far * line.rise
    low, high = min(first, last) - along, max(first, last) + along
    middle = 0.5 * shape.length
    return on_cap | (on_side & ((high < middle) | (low > middle)))
