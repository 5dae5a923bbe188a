"""The layers of faded bodies along a ray.

A body is the union of faded primitives. A ray goes through it from where it enters the first of
them to where it leaves the last, and what is within does not count: each such way is one layer,
seen where it begins, or where it ends if the ray starts inside.
"""

import math
from typing import NamedTuple

from vtray.base.compiler.compiled import device, part
from vtray.geometry.faded.chords import End, Key, collect_chords
from vtray.geometry.packets.layer_notes import ALONE, AT_ONCE, MOST, Chords, Layers, Walk
from vtray.geometry.packets.stack import Stack
from vtray.geometry.ray import Ray, Segment
from vtray.geometry.vector import dot, scale, sub
from vtray.geometry.world import Bodies, Faded, World, load_body

LEAST = 2.0**-14
"""Where less than such a share of light passes, it is followed no farther: a quarter of the
smallest step of 12 bits."""


class Slot(NamedTuple):
    """Where the layers of a ray are listed.

    Attributes
    ----------
    layers
        The lists.
    lane
        Which of them it is.
    skipped
        So many layers before the first that is listed are passed over.
    """

    layers: Layers
    lane: int
    skipped: int


class Passed(NamedTuple):
    """What a ray has passed so far.

    Attributes
    ----------
    layers, share
        So many layers, and the share of light that passes them.
    insides
        How many bodies in which it starts it has not left.
    """

    layers: int
    share: float
    insides: int


@part
def list_layers(
    world: World, faded: Faded, ray: Ray, end: End, slot: Slot, walk: Walk, stack: Stack
) -> int:
    """List the layers of a ray; return how many there are.

    Parameters
    ----------
    world, faded
        The shapes.
    ray, end
        The ray.
    slot
        Out: where the layers are listed.
    walk, stack
        Scratch memory.
    """
    layers, lane, skipped = slot
    found, share = _walk_through(world, faded, ray, end, slot, walk, stack)
    layers.listed[lane] = min(max(found - skipped, 0), AT_ONCE)
    layers.passed[lane] = share
    return found


@part
def passed_share(world: World, faded: Faded, segment: Segment, walk: Walk, stack: Stack) -> float:
    """Return which share of light passes the faded bodies between two points.

    Each body takes its share once for each time that its surface is crossed on the way in, or
    without that on the way out.
    """
    ray, end = ray_along(segment)
    _, share = _walk_through(world, faded, ray, end, None, walk, stack)
    return share


@device
def ray_along(segment: Segment) -> tuple[Ray, End]:
    """Return the way between two points as a ray and its end."""
    way = sub(segment.end, segment.start)
    length = math.sqrt(dot(way, way))
    inverse = 1.0 / length if length > 0.0 else 0.0
    forward = (segment.end_plane_depth - segment.start_plane_depth) * inverse
    # Which bound of the error holds depends on the shape; any above 0 says that there is one.
    ray = Ray(
        segment.start,
        scale(inverse, way),
        segment.start_plane_depth,
        forward,
        segment.start_scale,
        1.0,
    )
    return ray, End(length, -1, segment.end_scale)


@device
def _walk_through(
    world: World,
    faded: Faded,
    ray: Ray,
    end: End,
    slot: Slot | None,
    walk: Walk,
    stack: Stack,
) -> tuple[int, float]:
    """Go through the layers of a ray in their order; return how many, and what passes them."""
    bodies, chords, last = faded.bodies, walk.chords, ALONE * MOST + MOST - 1
    walk.rays[0] += 1
    passed, after, count = Passed(0, 1.0, 0), Key(-math.inf, -1), MOST
    while count == MOST and passed.share >= LEAST:
        count = collect_chords(world, faded, ray, end, after, chords, stack)
        passed = _pass_chords(bodies, passed, chords, ALONE * MOST, count, slot, walk)
        if count == MOST:
            after = Key(chords.near[last], chords.number[last])
    return _after_all(bodies, passed, slot, walk)


@device
def share_of_list(bodies: Bodies, row: int, walk: Walk) -> float:
    """Return which share of light passes the bodies of a list of all chords of a ray."""
    chords = walk.chords
    return share_of_chords(bodies, chords, row * MOST, chords.found[row], walk)


@device
def share_of_chords(bodies: Bodies, chords: Chords, begin: int, count: int, walk: Walk) -> float:
    """Return which share of light passes the bodies of all chords of a ray, in their order."""
    walk.rays[0] += 1
    passed = _pass_chords(bodies, Passed(0, 1.0, 0), chords, begin, count, None, walk)
    _, share = _after_all(bodies, passed, None, walk)
    return share


@device
def _pass_chords(
    bodies: Bodies,
    passed: Passed,
    chords: Chords,
    begin: int,
    count: int,
    slot: Slot | None,
    walk: Walk,
) -> Passed:
    """Let a ray come to its next chords, as long as enough light passes."""
    for k in range(begin, begin + count):
        passed = _leave_bodies(bodies, passed, chords.near[k], slot, walk)
        passed = _add_chord(bodies, passed, chords, k, slot, walk)
        if passed.share < LEAST:
            return passed
    return passed


@device
def _after_all(bodies: Bodies, passed: Passed, slot: Slot | None, walk: Walk) -> tuple[int, float]:
    """Return how many layers there are, and what passes all of them."""
    if passed.share >= LEAST:
        passed = _leave_bodies(bodies, passed, math.inf, slot, walk)
    return passed.layers, passed.share if passed.share >= LEAST else 0.0


@device
def _add_chord(
    bodies: Bodies, passed: Passed, chords: Chords, k: int, slot: Slot | None, walk: Walk
) -> Passed:
    """Let a ray come to the chord in a place."""
    near, far, number = chords.near[k], chords.far[k], chords.number[k]
    body = load_body(bodies, number)
    is_within = walk.ray[body] == walk.rays[0] and near <= walk.leaves[body]
    if is_within and not far > walk.leaves[body]:
        return passed
    walk.leaves[body], walk.number[body], walk.met[body] = far, number, chords.met[k]
    if is_within:
        return passed
    walk.ray[body] = walk.rays[0]
    if near > -math.inf:
        return _pass(passed, near, body, bodies.opacity[body], slot, walk)
    walk.inside[passed.insides] = body
    return Passed(passed.layers, passed.share, passed.insides + 1)


@device
def _leave_bodies(
    bodies: Bodies, passed: Passed, distance: float, slot: Slot | None, walk: Walk
) -> Passed:
    """Let a ray leave those of the bodies in which it starts that end before a distance."""
    while passed.insides > 0:
        first = _first_left(walk, passed.insides)
        body = walk.inside[first]
        leaves = walk.leaves[body]
        if not leaves < distance:
            return passed
        walk.inside[first] = walk.inside[passed.insides - 1]
        passed = Passed(passed.layers, passed.share, passed.insides - 1)
        passed = _pass(passed, leaves, body, bodies.opacity[body], slot, walk)
    return passed


@device
def _first_left(walk: Walk, insides: int) -> int:
    """Return which of the bodies in which a ray starts it leaves first."""
    first = 0
    for k in range(1, insides):
        if walk.leaves[walk.inside[k]] < walk.leaves[walk.inside[first]]:
            first = k
    return first


@device
def _pass(
    passed: Passed, distance: float, body: int, opacity: float, slot: Slot | None, walk: Walk
) -> Passed:
    """Let a ray pass a layer, and list that, if it is asked."""
    # An argument that is None is known to the compiler, which drops what depends on that alone.
    if slot is not None:
        _list(slot, passed, opacity, distance, walk.number[body], walk.met[body])
    return Passed(passed.layers + 1, passed.share * (1.0 - opacity), passed.insides)


@device
def _list(
    slot: Slot, passed: Passed, opacity: float, distance: float, number: int, met: int
) -> None:
    """List a layer, if there is room."""
    layers, lane, skipped = slot
    place = passed.layers - skipped
    if 0 <= place < AT_ONCE:
        layers.distance[lane * AT_ONCE + place] = distance
        layers.number[lane * AT_ONCE + place] = number
        layers.met[lane * AT_ONCE + place] = met
        layers.share[lane * AT_ONCE + place] = passed.share * opacity
