"""What soft lights add to the hits of a packet: fans of rays from each hit to each of them."""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from vtray.base.compiler.compiled import device, part
from vtray.geometry.faded.dimming import dim_fan, may_be_dimmed
from vtray.geometry.packets.cone import CLOSED, MANY, find_touching
from vtray.geometry.packets.fan import Start, count_open
from vtray.geometry.packets.packet import (
    BLOCK,
    COLOR,
    ERROR_SCALE,
    KEPT,
    LAMBERT,
    NOISE,
    NORMAL,
    PLANE_DEPTH,
    POINT,
    SHARE,
    SOURCE,
    UNEVEN,
    VALUE,
    Block,
    Packet,
    integers,
    load,
    store,
)
from vtray.geometry.packets.workspace import Pixels, Workspace
from vtray.geometry.stopped import Bundle, stop_by_all, stop_by_touching
from vtray.geometry.vector import Vec, add
from vtray.geometry.world import Faded
from vtray.transport.integrators.soft_edges import NARROW, is_lit_unevenly
from vtray.transport.lights.light import Powers, load_power, soft_worth
from vtray.transport.lights.soft_light import (
    SoftLights,
    aim_at,
    component_count,
    cone_of,
    is_above,
    is_below,
    is_cone,
    longest_ray,
    middle_share,
    soft_count,
)
from vtray.transport.materials.material import Material, scattered
from vtray.transport.sampling.estimate import (
    counted_variance,
    needs_more,
    no_estimate,
    shares_of,
    with_fan,
    with_unseen,
)
from vtray.transport.sampling.fans import Fans, fan_keys, fans_of_share, offset_of, place_of
from vtray.transport.sampling.light_rays import arriving_shares, spread_fan
from vtray.transport.scene_arrays import LitWorld

NO_SHARES = (0.0, 0.0, 0.0)
"""Those of a light of which nothing arrives."""


class Arriving(NamedTuple):
    """What arrives of a light at a hit.

    Attributes
    ----------
    shares
        The mean weights of all rays, one for each component of the light.
    variance, counted
        That of the shares, as it is estimated, and as a part of what all lights may have.
    cast, arrived
        How many rays were cast, and how many arrive.
    """

    shares: Vec
    variance: float
    counted: float
    cast: int
    arrived: int


@device
def clear_noise(packet: Packet, hits: int) -> None:
    """Start with light of no variance."""
    for hit in range(hits):
        packet[NOISE + hit] = 0.0


@device
def sample_of(
    lane: int, samples: int, first: int, block: Block, begin: int, pixels: Pixels
) -> tuple[int, int, int]:
    """Return the pixel of a lane, its column and row, and the number of its sample.

    The parameters are those of `add_soft_lights`; `pixels` is the block's list.
    """
    pixel = pixels[begin + lane // samples]
    column, row = block.left + (pixel & (BLOCK - 1)), block.top + pixel // BLOCK
    return column, row, first + lane % samples


@part
def add_soft_lights(
    packet: Packet,
    hits: int,
    samples: int,
    first: int,
    block: Block,
    begin: int,
    lit: LitWorld,
    soft: SoftLights,
    fans: Fans,
    seed: int,
    is_wide: bool | None,
    cosines: NDArray[np.float64],
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
    lit, soft
        The scene, and its soft lights.
    fans, seed
        Which rays are cast.
    is_wide
        Whether it is asked if pixels look the same everywhere; None where it never is.
    cosines
        Out: what each light adds, if that is kept, (components, places), else (0, 0).
    work
        Scratch memory.
    """
    cast = 0
    clear_noise(packet, hits)
    for hit in range(hits):
        lane = integers(packet)[SOURCE + hit]
        column, row, sample = sample_of(lane, samples, first, block, begin, work.pixels)
        material, spent = Material(load(packet, COLOR, hit), packet[LAMBERT + hit]), 0.0
        own = fans_of_share(fans, _seen_share(packet, lane, lit.world.faded))
        for light in range(soft_count(soft)):
            if _is_uneven(packet, hit, lit, soft, light, is_wide, work):
                break
            keys = fan_keys(column, row, light, seed)
            place = place_of(fans.levels, sample, column, row, light, seed)
            worth = soft_worth(lit.powers, soft, light, material)
            arriving = _arriving(
                packet, hit, lit, soft, light, worth, spent, own, place, keys, work
            )
            spent += arriving.counted
            for component in range(component_count(soft, light)):
                power, share = soft.row[light] + component, arriving.shares[component]
                _add_share(packet, hit, lit.powers, power, share)
                _keep_share(packet, lane, power, share, cosines)
            packet[NOISE + hit] += worth * worth * arriving.variance
            cast += arriving.cast
    return cast


@device
def _seen_share(packet: Packet, lane: int, faded: Faded | None) -> float:
    """Return how much of the light of the hit of a lane is seen."""
    # An argument that is None is known to the compiler, which drops what depends on that alone.
    if faded is not None:
        share: float = packet[SHARE + lane]
        return share
    return 1.0


@device
def _arriving(
    packet: Packet,
    hit: int,
    lit: LitWorld,
    soft: SoftLights,
    light: int,
    worth: float,
    spent: float,
    fans: Fans,
    place: int,
    keys: tuple[int, int],
    work: Workspace,
) -> Arriving:
    """Return what arrives of a light at a hit, by as many fans as its variance asks for.

    What the lights before it left of the variance that all may have is shared with those after it.
    """
    point, normal = load(packet, POINT, hit), load(packet, NORMAL, hit)
    start = Start(point, packet[PLANE_DEPTH + hit], packet[ERROR_SCALE + hit])
    aim = aim_at(soft, light, start, normal)
    is_narrow, is_dimmed, forward = aim.spread < NARROW, True, lit.forward
    touching, count = work.touching, MANY
    if is_below(aim, normal):
        return Arriving(NO_SHARES, 0.0, 0.0, 0, 0)
    if is_narrow and is_cone(aim):
        cone = cone_of(aim, start, forward)
        count = find_touching(cone, lit.world, touching, work.stack)
        is_dimmed = count != CLOSED and may_be_dimmed(cone, lit.world, work.stack)
        # What a cone as a whole tells is what all its rays would.
        if count == 0 and is_above(aim, normal) and not is_dimmed:
            shares = middle_share(aim, normal), 0.0, 0.0
            return Arriving(shares, 0.0, 0.0, fans.rays, fans.rays)
        if count == CLOSED and is_above(aim, normal):
            return Arriving(NO_SHARES, 0.0, 0.0, fans.rays, 0)
    fan, components = work.fan, component_count(soft, light)
    end_scale = soft.error_scale[light] + start.error_scale
    bundle = Bundle(fan, fans.rays, start, normal, end_scale, longest_ray(aim, start))
    estimate, cast, arrived, lights = no_estimate(), 0, 0, soft_count(soft)
    while needs_more(estimate, fans, worth, spent, light, lights):
        offset = offset_of(fans.offsets, place, estimate.fans)
        cast += spread_fan(
            fan, fans.rays, aim, start, normal, forward, soft.skies, fans.points, offset, keys
        )
        if count >= 0:
            stop_by_touching(bundle, lit.world, touching, count)
        else:
            stop_by_all(bundle, lit.world, work.stack)
        if is_dimmed:
            dim_fan(bundle, lit.world, work.walk, work.stack)
        shares, spread = arriving_shares(fan, fans.rays, components, aim, normal)
        estimate = with_fan(estimate, shares, spread)
        arrived += count_open(fan, fans.rays)
    variance = with_unseen(estimate, fans.rays, aim.share)
    counted = counted_variance(estimate, fans, worth)
    return Arriving(shares_of(estimate), variance, counted, cast, arrived)


@device
def _add_share(packet: Packet, hit: int, powers: Powers, row: int, share: float) -> None:
    """Add what arrives of a component of a soft light to a hit."""
    power = load_power(powers, row)
    material = Material(load(packet, COLOR, hit), packet[LAMBERT + hit])
    added = scattered(material, share, power)
    store(packet, VALUE, hit, add(load(packet, VALUE, hit), added))


@device
def _keep_share(
    packet: Packet, lane: int, row: int, share: float, cosines: NDArray[np.float64]
) -> None:
    """Keep what arrives of a component of a soft light at the hit of a lane, if that is kept."""
    if cosines.shape[0] > 0:
        place = integers(packet)[KEPT + lane]
        cosines[row, place] = share


@device
def _is_uneven(
    packet: Packet,
    hit: int,
    lit: LitWorld,
    soft: SoftLights,
    light: int,
    is_wide: bool | None,
    work: Workspace,
) -> bool:
    """Tell whether the pixel of a hit gets samples, for one of the lights so far or this one."""
    if is_wide is not None:  # noqa: SIM102 - by itself, it is known to the compiler
        if is_wide:
            uneven: bool = packet[UNEVEN + hit] != 0.0
            uneven = uneven or is_lit_unevenly(packet, hit, lit, soft, light, work)
            packet[UNEVEN + hit] = 1.0 if uneven else 0.0
            return uneven
    return False
