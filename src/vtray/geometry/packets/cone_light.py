"""How much light comes from a round lamp that is partly hidden, in closed form.

What hides it must be a horizon or whole balls, each of which hides a cap of directions, or planes
that hide all directions on one side of a great circle.
"""

import math

from vtray.base.compiler.compiled import device, part
from vtray.geometry.caps import MOST_CAPS, UNKNOWN, Caps, light_within, set_cap, swap_caps
from vtray.geometry.circle import PI
from vtray.geometry.dispatch import with_bounded
from vtray.geometry.packets.cone import SLIGHT, Cone, Touching, has_only_balls
from vtray.geometry.ray import EVERYWHERE
from vtray.geometry.rounding import MARGIN
from vtray.geometry.shapes.plane import load_plane, plane_side
from vtray.geometry.shapes.verbs import Shape, Verbs
from vtray.geometry.vector import Vec, dot, scale, sub
from vtray.geometry.world import PLANE, World, load_group

NO_CAP = -1
"""In place of how many caps there are: something hides no cap."""

OWN = 1.0 - 1e-6
"""From this cosine on, a horizon is that of the ball on which rays start."""


@part
def light_of_cone(
    cone: Cone, normal: Vec, world: World, touching: Touching, count: int, caps: Caps
) -> float:
    """Return the light of a lamp that is seen as a cone, as the mean cosine over all of it.

    Parameters
    ----------
    cone
        The cone, all of whose rays start at a point.
    normal
        The unit normal of the surface there.
    world, touching, count
        The only shapes that touch the cone, so many.
    caps
        Scratch memory.

    Returns
    -------
    float
        The mean over all directions of the cone, of the cosine where light arrives and of 0 where
        it does not; or ``UNKNOWN``.
    """
    if not has_only_balls(world):
        return UNKNOWN
    set_cap(caps, 0, cone.axis, cone.cosine, cone.sine)
    taken = 1
    if dot(normal, cone.axis) < cone.sine + SLIGHT:
        set_cap(caps, 1, normal, 0.0, 1.0)
        taken = 2
    first = taken
    for k in range(count):
        taken = _take_shape(cone, normal, world, touching.row[k], touching.slot[k], caps, taken)
        if taken == NO_CAP:
            return UNKNOWN
    _sort(caps, first, taken)
    light = light_within(caps, taken, normal)
    if light == UNKNOWN:
        return UNKNOWN
    # The solid angle of a cone is 2 pi (1 - cosine), and 1 - cosine is sine^2 / (1 + cosine).
    return light * (1.0 + cone.cosine) / (2.0 * PI * cone.sine * cone.sine)


@device
def _sort(caps: Caps, first: int, end: int) -> None:
    """Sort caps, so that sums do not depend on how their shapes were found."""
    for k in range(first + 1, end):
        at = k
        while at > first and _numbers(caps, at) < _numbers(caps, at - 1):
            swap_caps(caps, at, at - 1)
            at -= 1


@device
def _numbers(caps: Caps, k: int) -> tuple[float, float, float, float]:
    """Return what tells a cap from all others."""
    return caps.cosine[k], caps.x[k], caps.y[k], caps.z[k]


@device
def _take_shape(
    cone: Cone, normal: Vec, world: World, row: int, slot: int, caps: Caps, taken: int
) -> int:
    """Add the cap of what a shape leaves to so many; return how many there are, or ``NO_CAP``."""
    group = load_group(world, row)
    if taken == MOST_CAPS:
        return NO_CAP
    if group.kind == PLANE:
        plane = load_plane(world.planes, slot, group.place)
        side = plane_side(plane, cone.start.point)
        margin = MARGIN * (cone.start.error_scale + plane.error_scale)
        return _take_plane(cone, plane.normal, side, margin, caps, taken)
    count: int = with_bounded(world.solids, group, slot, _take_sphere, (cone, normal, caps, taken))
    return count


@device
def _take_plane(
    cone: Cone, plane_normal: Vec, side: float, margin: float, caps: Caps, taken: int
) -> int:
    """Add what a plane leaves of light from far away."""
    if cone.shortest < cone.longest or abs(side) <= margin:
        return NO_CAP
    away = plane_normal if side > 0.0 else scale(-1.0, plane_normal)
    depth, forward = cone.start.plane_depth, cone.forward
    ahead = dot(cone.axis, forward)
    spread = cone.sine * math.sqrt(max(1.0 - ahead * ahead, 0.0)) + SLIGHT
    if depth < EVERYWHERE and ahead * cone.cosine - spread < 0.0:
        if ahead * cone.cosine + spread >= 0.0:
            return NO_CAP
        # Where rays meet the plane behind the image plane, it does not count. That is decided by
        # which of the two they meet first, the line between is a great circle, too.
        border = sub(scale(depth, away), scale(abs(side), forward))
        away = scale(1.0 / math.sqrt(dot(border, border)), border)
    set_cap(caps, taken, away, 0.0, 1.0)
    return taken + 1


@device
def _take_sphere(
    sphere: Shape,
    verbs: Verbs,  # noqa: ARG001
    number: int,  # noqa: ARG001
    arguments: tuple[Cone, Vec, Caps, int],
) -> int:
    """Add what a sphere leaves that is between, as a whole, or on which rays start."""
    cone, normal, caps, taken = arguments
    start, radius = cone.start, sphere.radius
    way = sub(sphere.center, start.point)
    margin = MARGIN * (sphere.error_scale + start.error_scale)
    distance2 = dot(way, way)
    outside, clear = distance2 - radius * radius, 4.0 * margin * (radius + margin)
    distance = math.sqrt(distance2)
    if abs(outside) <= clear:
        # All that is above the horizon of a ball is beside it.
        return taken if -dot(way, normal) >= OWN * distance else NO_CAP
    depth = start.plane_depth + dot(way, cone.forward)
    if depth < -radius - margin:
        return taken
    is_between = outside > 0.0 and distance + radius + margin < cone.shortest
    if not is_between or depth <= radius + margin:
        return NO_CAP
    inverse = -1.0 / distance
    set_cap(caps, taken, scale(inverse, way), math.sqrt(outside) * inverse, -radius * inverse)
    return taken + 1
