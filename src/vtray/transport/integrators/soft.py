"""What soft lights add to the hits of a packet: a fan of rays from each hit to each of them."""

from typing import NamedTuple

import numpy as np

from vtray.base.compiler.compiled import device
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
    SOURCE,
    UNEVEN,
    VALUE,
    Block,
    Packet,
    load,
    store,
)
from vtray.geometry.packets.workspace import Workspace
from vtray.geometry.stopped import find_stopped
from vtray.geometry.vector import add
from vtray.transport.integrators.soft_edges import NARROW, is_lit_unevenly
from vtray.transport.light_buffer import KeptLight
from vtray.transport.lights.light import Lights, light_count, load_power
from vtray.transport.lights.soft_light import SoftLights, aim_at, soft_count
from vtray.transport.materials.material import Material, scattered
from vtray.transport.sampling.fans import Fans, fan_keys, fan_of_sample
from vtray.transport.sampling.light_rays import arriving_share, spread_fan
from vtray.transport.scene_arrays import SceneArrays


class Arriving(NamedTuple):
    """What arrives of a light at a hit.

    Attributes
    ----------
    share
        The mean weight of all rays.
    cast, arrived
        How many rays were cast, and how many arrive.
    """

    share: float
    cast: int
    arrived: int


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
    is_wide: bool | None,
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
    is_wide
        Whether it is asked if pixels look the same everywhere; None where it never is.
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
                sample = first + lane % samples
                for light in range(soft_count(soft)):
                    if _is_uneven(packet, hit, scene, soft, light, is_wide, work):
                        break
                    keys = fan_keys(column, row, light, seed)
                    number = fan_of_sample(fans.levels, sample, column, row, light, seed)
                    point = number * fans.rays * fans.rounds
                    arriving = _arriving(packet, hit, scene, soft, light, fans, point, keys, work)
                    _add_share(packet, hit, scene.lights, light, arriving.share)
                    _keep_share(packet, lane, scene.lights, light, arriving.share, kept)
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
    is_narrow = aim.spread < NARROW
    fan, forward = work.fan, scene.camera.forward
    end_scale = soft.error_scale[light] + start.error_scale
    total, cast, arrived, rounds = 0.0, 0, 0, 0
    while rounds < fans.rounds and (rounds == 0 or 0 < arrived < cast):
        place = first + rounds * fans.rays
        cast += spread_fan(fan, fans.rays, aim, start, normal, forward, fans.points, place, keys)
        find_stopped(fan, fans.rays, is_narrow, start, end_scale, scene.world, work.stack)
        total += arriving_share(fan, fans.rays)
        arrived += count_open(fan, fans.rays)
        rounds += 1
    return Arriving(total / rounds, cast, arrived)


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
def _is_uneven(
    packet: Packet,
    hit: int,
    scene: SceneArrays,
    soft: SoftLights,
    light: int,
    is_wide: bool | None,
    work: Workspace,
) -> bool:
    """Tell whether the pixel of a hit gets samples, for one of the lights so far or this one."""
    if is_wide is not None:  # noqa: SIM102 - by itself, it is known to the compiler
        if is_wide:
            uneven: bool = packet[UNEVEN + hit] != 0.0
            uneven = uneven or is_lit_unevenly(packet, hit, scene, soft, light, work)
            packet[UNEVEN + hit] = 1.0 if uneven else 0.0
            return uneven
    return False
