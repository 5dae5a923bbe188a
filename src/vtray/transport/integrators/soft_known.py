"""Which share of a round lamp arrives at a hit, where that is known without casting rays."""

from vtray.base.compiler.compiled import device
from vtray.geometry.caps import UNKNOWN, Caps
from vtray.geometry.packets.cone import CLOSED, Cone, Touching, find_touching
from vtray.geometry.packets.cone_light import light_of_cone
from vtray.geometry.packets.fan import Start
from vtray.geometry.packets.stack import Stack
from vtray.geometry.vector import Vec
from vtray.geometry.world import World
from vtray.transport.integrators.soft_edges import NARROW
from vtray.transport.lights.soft_light import Aim, cone_of, is_above, is_cone, middle_share
from vtray.transport.sampling.fans import Fans

MOST_KNOWN = 4
"""Among more shapes that touch the cone of a lamp, rays are cast."""

WORTH_IT = 32
"""So are they where fans have fewer of them: that takes less time than to find what is around."""


@device
def is_narrow(aim: Aim) -> bool:
    """Tell whether it is asked which shapes touch the cone of a light."""
    return is_cone(aim) and aim.spread < NARROW


@device
def known_share(
    cone: Cone,
    aim: Aim,
    normal: Vec,
    world: World,
    fans: Fans,
    touching: Touching,
    count: int,
    caps: Caps,
) -> float:
    """Return which share of a light arrives, or ``UNKNOWN``.

    Parameters
    ----------
    cone, aim, normal
        The light as it is seen from a point, and the unit normal of the surface there.
    world, touching, count
        The only shapes that touch the cone, as `find_touching` tells it.
    fans
        Which rays are cast if it is not known.
    caps
        Scratch memory.
    """
    if count == CLOSED:
        return 0.0
    if count == 0 and is_above(aim, normal):
        return middle_share(aim, normal)
    if count < 0 or count > MOST_KNOWN or fans.rays < WORTH_IT:
        return UNKNOWN
    light = light_of_cone(cone, normal, world, touching, count, caps)
    return UNKNOWN if light == UNKNOWN else aim.share * light


@device
def share_at(
    aim: Aim,
    start: Start,
    normal: Vec,
    forward: Vec,
    world: World,
    fans: Fans,
    touching: Touching,
    caps: Caps,
    stack: Stack,
) -> float:
    """Return what is known of one light at a point by itself, as `known_share` returns it.

    Parameters
    ----------
    aim, start, normal, forward
        The light, the point with the unit normal there, and the direction of the camera.
    world, fans
        What can be in the way, and which rays are cast.
    touching, caps, stack
        Scratch memory.
    """
    if not is_narrow(aim):
        return UNKNOWN
    cone = cone_of(aim, start, forward)
    count = find_touching(cone, world, touching, MOST_KNOWN, stack)
    return known_share(cone, aim, normal, world, fans, touching, count, caps)
