"""Whether the light of a lamp may have an edge in what a pixel sees around a hit."""

import math

from vtray.base.compiler.compiled import device
from vtray.geometry.bundle import Bundle
from vtray.geometry.edges import LampView, has_edge
from vtray.geometry.faded.dimming import is_tube_dimmed
from vtray.geometry.packets.batch import start_of
from vtray.geometry.packets.cone import MANY, Cone, are_round
from vtray.geometry.packets.fan import Start
from vtray.geometry.packets.packet import (
    BEND,
    NORMAL,
    OWNER,
    PLANE_DEPTH,
    POINT,
    REACH,
    THICKEST,
    Packet,
    integers,
    load,
)
from vtray.geometry.packets.patch import NEAR_END, crossed_share
from vtray.geometry.packets.workspace import Workspace
from vtray.geometry.vector import Vec, dot, scale, sub
from vtray.transport.lights.soft_light import RECTANGLE, SUN, SoftLights, aim_at, is_below
from vtray.transport.sampling.adaptive import LIMIT_OF_SWAY, NEARNESS
from vtray.transport.scene_arrays import LitWorld

NARROW = 0.1
"""Up to this spread, which a lamp has that is seen under 50 degrees, shadows have edges."""


@device
def is_lit_unevenly(
    packet: Packet,
    hit: int,
    lit: LitWorld,
    soft: SoftLights,
    light: int,
    around: int,
    work: Workspace,
) -> bool:
    """Tell whether a soft light may do something else around a hit than there.

    That of wide ones changes slowly.

    Parameters
    ----------
    packet, hit, lit, soft, light
        The hit, the scene, its soft lights, and the number of one.
    around, work
        So many shapes of the workspace may be in the way and no others; all may, with ``MANY``.
    """
    point, normal = load(packet, POINT, hit), load(packet, NORMAL, hit)
    start = start_of(packet, hit)
    aim = aim_at(soft, light, start, normal)
    if not aim.spread < NARROW:
        return False
    way, reach = sub(aim.place, point), packet[REACH + hit]
    length = soft.far if aim.kind == SUN else math.sqrt(dot(way, way))
    # Of half the angle under which it is seen: 1 - cosine is known.
    cosine = 1.0 - aim.spread
    axis, tangent = aim.axis, math.sqrt(aim.spread * (2.0 - aim.spread)) / cosine
    if aim.kind == RECTANGLE:
        # As the ball around it.
        axis, tangent = scale(1.0 / length, way), aim.size / length
    height, sway = dot(normal, axis), reach * (packet[BEND + hit] + 1.0 / length)
    if NEARNESS * reach * reach >= length * length:
        return True
    if abs(height) < sway and sway > max(LIMIT_OF_SWAY, tangent):
        return True
    if height < -tangent or is_below(aim, normal):
        return False
    if is_tube_dimmed(lit.world, start, axis, reach, tangent, length, work.stack):
        return True
    view = _view(packet, hit, start, lit.forward, axis, length, tangent)
    # Boxes tell more than balls of what is long.
    known = around if are_round(lit.world, work.touching, around) else MANY
    return has_edge(lit.world, view, work.touching, known, work.stack)


@device
def _view(
    packet: Packet,
    hit: int,
    start: Start,
    forward: Vec,
    axis: Vec,
    length: float,
    tangent: float,
) -> LampView:
    """Return the rays between a patch and a lamp."""
    reach, radius, depth = packet[REACH + hit], tangent * length, packet[PLANE_DEPTH + hit]
    end = depth + length * dot(axis, forward)
    least, most = crossed_share(depth, reach, end)
    growth, point = (radius - reach) / length, start.point
    cosine = 1.0 / math.sqrt(1.0 + tangent * tangent)
    cone = Cone(start, reach, axis, cosine, tangent * cosine, 0.0, length, forward)
    return LampView(
        _bundle(point, axis, reach, growth, 0.0),
        _bundle(point, axis, reach, growth, 4.0 * reach),
        load(packet, NORMAL, hit),
        integers(packet)[OWNER + hit],
        reach,
        radius,
        length,
        NEAR_END * least * length,
        NEAR_END * most * length,
        packet[THICKEST + hit],
        cone,
    )


@device
def _bundle(point: Vec, axis: Vec, width: float, growth: float, start: float) -> Bundle:
    """Return the rays from all of a patch to all of a lamp, from where they count on."""
    return Bundle(point, axis, width, growth, 1.0, None, None, start, start, True)
