"""What soft lights add to the hits of a packet: a fan of rays from each hit to each of them."""

from typing import NamedTuple

import numpy as np

from vtray.base.compiler.compiled import device
from vtray.geometry.packets.cone import CLOSED, MANY, find_touching
from vtray.geometry.packets.fan import Start, count_open
from vtray.geometry.packets.packet import (
    BLOCK,
    COLOR,
    ERROR_SCALE,
    KEPT,
    LAMBERT,
    NORMAL,
    PLANE_DEPTH,
    POINT,
    SHADOWS,
    SOURCE,
    VALUE,
    Block,
    Packet,
    load,
    store,
)
from vtray.geometry.packets.workspace import Workspace
from vtray.geometry.stopped import Bundle, stop_by_all, stop_by_touching
from vtray.geometry.vector import add, dot
from vtray.transport.film import Rows
from vtray.transport.light_buffer import KeptLight
from vtray.transport.lights.light import Lights, light_count, load_power
from vtray.transport.lights.lighting import light_bit
from vtray.transport.lights.soft_light import (
    SoftLights,
    aim_at,
    cone_of,
    is_above,
    is_below,
    longest_ray,
    soft_count,
)
from vtray.transport.materials.material import Material, scattered
from vtray.transport.sampling.fans import Fans, fan_keys
from vtray.transport.sampling.light_rays import arriving_share, spread_fan
from vtray.transport.scene_arrays import SceneArrays

NARROW = 0.1
"""Up to this spread, which a lamp has that is seen under 50 degrees, its rays are kept together."""


class Arriving(NamedTuple):
    """What arrives of a light at a hit.

    Attributes
    ----------
    share
        The mean weight of all rays.
    cast, arrived
        How many rays were cast, and how many arrive.
    is_narrow
        Whether the light is seen under a small angle, so that its shadows have edges.
    """

    share: float
    cast: int
    arrived: int
    is_narrow: bool


@device
def add_soft_lights(
    packet: Packet,
    hits: int,
    samples: int,
    first: int,
    block: Block,
    begin: int,
    scene: SceneArrays,
    soft: SoftLights | None,
    fans: Fans | None,
    seed: int,
    shadows: Rows,
    kept: KeptLight | None,
    work: Workspace,
) -> int:
    """Add all soft lights to the hits of a packet; return how many shadow rays were cast.

    Parameters
    ----------
    packet, hits
        The hits.
    samples, first
        How many samples of each pixel the packet has, and the number of the first of them.
    block, begin
        Its lanes belong to the pixels of the block's list from `begin` on, one after the other.
    scene, soft
        The scene, and its soft lights.
    fans, seed
        Which rays are cast.
    shadows
        Not None if it is wanted which lights something keeps from the hits.
    kept
        Out: what each light adds, if that is kept.
    work
        Scratch memory.
    """
    cast = 0
    # Arguments that are None are known to the compiler, which drops what depends on them alone.
    if soft is not None:  # noqa: SIM102
        if fans is not None:
            for hit in range(hits):
                lane = packet.view(np.int64)[SOURCE + hit]
                pixel = work.pixels[begin + lane // samples]
                column, row = block.left + (pixel & (BLOCK - 1)), block.top + pixel // BLOCK
                point = (first + lane % samples) * fans.rays * fans.rounds
                for light in range(soft_count(soft)):
                    keys = fan_keys(column, row, light, seed)
                    arriving = _arriving(packet, hit, scene, soft, light, fans, point, keys, work)
                    _add_share(packet, hit, scene.lights, light, arriving.share)
                    _keep_share(packet, lane, scene.lights, light, arriving.share, kept)
                    _note_shadow(packet, hit, scene.lights, light, arriving, shadows)
                    cast += arriving.cast
    return cast


@device
def _arriving(
    packet: Packet,
    hit: int,
    scene: SceneArrays,
    soft: SoftLights,
    light: int,
    fans: Fans,
    first: int,
    keys: tuple[int, int],
    work: Workspace,
) -> Arriving:
    """Return what arrives of a light at a hit, after one round if all its rays tell the same."""
    point, normal = load(packet, POINT, hit), load(packet, NORMAL, hit)
    start = Start(point, packet[PLANE_DEPTH + hit], packet[ERROR_SCALE + hit])
    aim = aim_at(soft, light, start, normal)
    is_narrow, forward = aim.spread < NARROW, scene.camera.forward
    touching, count = work.touching, MANY
    if is_below(aim, normal):
        return Arriving(0.0, 0, 0, is_narrow)
    if is_narrow:
        count = find_touching(cone_of(aim, start, forward), scene.world, touching, work.stack)
        # What a cone as a whole tells is what all its rays would.
        if count == 0 and is_above(aim, normal):
            return Arriving(dot(normal, aim.axis), fans.rays, fans.rays, is_narrow)
        if count == CLOSED and is_above(aim, normal):
            return Arriving(0.0, fans.rays, 0, is_narrow)
    fan = work.fan
    end_scale = soft.error_scale[light] + start.error_scale
    bundle = Bundle(fan, fans.rays, start, normal, end_scale, longest_ray(aim, start))
    total, cast, arrived, rounds = 0.0, 0, 0, 0
    while rounds < fans.rounds and (rounds == 0 or 0 < arrived < cast):
        place = first + rounds * fans.rays
        cast += spread_fan(fan, fans.rays, aim, start, normal, forward, fans.points, place, keys)
        if count >= 0:
            stop_by_touching(bundle, scene.world, touching, count)
        else:
            stop_by_all(bundle, scene.world, work.stack)
        total += arriving_share(fan, fans.rays, aim, normal)
        arrived += count_open(fan, fans.rays)
        rounds += 1
    return Arriving(total / rounds, cast, arrived, is_narrow)


@device
def _add_share(packet: Packet, hit: int, lights: Lights, light: int, share: float) -> None:
    """Add what arrives of a soft light to a hit."""
    power = load_power(lights, light_count(lights) + light)
    material = Material(load(packet, COLOR, hit), packet[LAMBERT + hit])
    added = scattered(material, share, power)
    store(packet, VALUE, hit, add(load(packet, VALUE, hit), added))


@device
def _keep_share(
    packet: Packet, lane: int, lights: Lights, light: int, share: float, kept: KeptLight | None
) -> None:
    """Keep what arrives of a soft light at the hit of a lane, after the point lights."""
    if kept is not None:
        place = packet.view(np.int64)[KEPT + lane]
        kept.cosines[light_count(lights) + light, place] = share


@device
def _note_shadow(
    packet: Packet, hit: int, lights: Lights, light: int, arriving: Arriving, shadows: Rows
) -> None:
    """Note whether a light that throws shadows with edges is hidden, in part or as a whole."""
    if shadows is not None:  # noqa: SIM102 - by itself, it is known to the compiler
        if arriving.is_narrow and arriving.arrived < arriving.cast:
            number = light_count(lights) + 2 * light
            packet[SHADOWS + hit] += light_bit(number)
            packet[SHADOWS + hit] += light_bit(number + 1) if arriving.arrived == 0 else 0.0
