"""What soft lights add to the hits of a packet: fans of rays from each hit to each of them."""

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from vtray.base.compiler.compiled import device, long_part, passing_on
from vtray.geometry.bits import count_bits
from vtray.geometry.caps import UNKNOWN
from vtray.geometry.faded.dimming import dim_fan, may_be_dimmed
from vtray.geometry.packets.batch import APART, spot_of, start_of, take_near, wider_spot
from vtray.geometry.packets.cone import (
    CLOSED,
    MANY,
    MOST,
    Cone,
    find_among,
    find_touching,
)
from vtray.geometry.packets.fan import FAN, set_start
from vtray.geometry.packets.packet import (
    BLOCK,
    COLOR,
    KEPT,
    LAMBERT,
    NOISE,
    NORMAL,
    REACH,
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
from vtray.geometry.stopped import Bundle, stop_rays
from vtray.geometry.vector import Vec, add
from vtray.geometry.world import Faded, Solids, World
from vtray.transport.integrators.soft_edges import is_lit_unevenly
from vtray.transport.integrators.soft_known import (
    MOST_KNOWN,
    WORTH_IT,
    is_narrow,
    known_share,
)
from vtray.transport.integrators.soft_trial import (
    begin_trial,
    end_trial,
    fans_on_trial,
    note_trial,
)
from vtray.transport.lights.light import Powers, load_power, soft_worth
from vtray.transport.lights.soft_light import (
    Aim,
    SoftLights,
    aim_at,
    component_count,
    cone_from,
    cone_of,
    is_below,
    is_everywhere,
    is_round,
    longest_ray,
    soft_count,
)
from vtray.transport.materials.material import Material, scattered
from vtray.transport.sampling.estimate import (
    AS_NEEDED,
    counted_variance,
    load_estimate,
    needs_more,
    no_estimate,
    shares_of,
    store_estimate,
    with_fan,
    with_unseen,
)
from vtray.transport.sampling.fans import Fans, fan_of, fans_of_share
from vtray.transport.sampling.light_rays import arriving_shares, spread_fan
from vtray.transport.scene_arrays import LitWorld

DARK, ALL = (0.0, 0.0, 0.0), (1.0, 1.0, 1.0)
"""The shares of a light of which nothing arrives, and of one of which everything does."""


class Casting(NamedTuple):
    """What the fans of all hits of a packet are cast by.

    Attributes
    ----------
    lit, soft
        The scene, and its soft lights.
    fans, seed
        Which rays are cast.
    samples, first, block, begin
        As in `add_soft_lights`.
    cosines
        Where what each light adds is kept.
    """

    lit: LitWorld
    soft: SoftLights
    fans: Fans
    seed: int
    samples: int
    first: int
    block: Block
    begin: int
    cosines: NDArray[np.float64]


ASKED, FAR_APART = 16, 4.0
"""Where each pixel has one ray, so many hits of a batch, which cast their fans one after the other,
are asked together what is around them, and so many pixels are between them and the first."""


class Seen(NamedTuple):
    """A light as it is seen from the first hit of a batch, and whether that is alone."""

    aim: Aim
    is_alone: bool


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


@long_part
@passing_on(Solids)
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
    is_wide: bool,
    is_near: bool,
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
        Whether it is asked if pixels look the same everywhere.
    is_near
        Whether hits of lanes near each other may be near each other.
    cosines
        Out: what each light adds, if that is kept, (components, places), else (0, 0).
    work
        Scratch memory.
    """
    casting = Casting(lit, soft, fans, seed, samples, first, block, begin, cosines)
    cast, batch, waiting, is_trial = 0, work.batch, hits, samples > 1
    clear_noise(packet, hits)
    for hit in range(hits):
        batch.is_taken[hit] = False
    if is_trial:
        begin_trial(packet, hits)
    while waiting > 0:
        for hit in range(hits):
            if batch.is_taken[hit]:
                continue
            own = fans_of_hit(packet, hit, casting)
            most, apart = most_of(lit.world.faded, own, samples, is_near)
            count = take_near(packet, hits, hit, most, apart, batch)
            for member in range(count):
                batch.spent[member] = 0.0
            for light in range(soft_count(soft)):
                cast += _light_batch(packet, count, casting, own, light, is_wide, work)
            if is_trial:
                note_trial(packet, count, batch)
        waiting = end_trial(packet, hits, samples, fans, batch) if is_trial else 0
        is_trial = False
    return cast


@device
def most_of(faded: Faded | None, fans: Fans, samples: int, is_near: bool) -> tuple[int, float]:
    """Return how many hits of a packet may be in a batch, and how many pixels from its first."""
    # An argument that is None is known to the compiler, which drops what depends on that alone.
    if faded is not None or not is_near:
        return 1, APART
    return (FAN // fans.rays, APART) if samples > 1 else (ASKED, FAR_APART)


@device
def fans_of_hit(packet: Packet, hit: int, casting: Casting) -> Fans:
    """Return which rays are cast from a hit."""
    lane = integers(packet)[SOURCE + hit]
    return fans_of_share(casting.fans, _seen_share(packet, lane, casting.lit.world.faded))


@device
def _seen_share(packet: Packet, lane: int, faded: Faded | None) -> float:
    """Return how much of the light of the hit of a lane is seen."""
    # An argument that is None is known to the compiler, which drops what depends on that alone.
    if faded is not None:
        share: float = packet[SHARE + lane]
        return share
    return 1.0


@device
def _light_batch(
    packet: Packet,
    count: int,
    casting: Casting,
    fans: Fans,
    light: int,
    is_wide: bool,
    work: Workspace,
) -> int:
    """Add a light to the hits of a batch, so many; return how many shadow rays were cast.

    Each has as many fans as its variance asks for. What the lights before it left of the variance
    that all may have is shared with those after it.
    """
    batch, soft = work.batch, casting.soft
    first = Seen(aim_from(packet, batch.hit[0], soft, light), count == 1)
    active = _leave_above(packet, count, casting, first, light, is_wide, work)
    touching = _find_around(packet, active, casting, first, light, is_wide, work)
    active = _leave_even(packet, active, casting, light, touching, is_wide, work)
    if count <= FAN // fans.rays:
        return _cast_together(packet, active, casting, fans, first, light, touching, work)
    cast, one = 0, min(active, 1)  # a constant would be compiled for by itself
    for k in range(active):
        # Those after the first stay where they are.
        batch.active[0] = batch.active[k]
        alone = Seen(aim_from(packet, batch.hit[batch.active[0]], soft, light), True)
        cast += _cast_together(packet, one, casting, fans, alone, light, touching, work)
    return cast


@device
def _find_around(
    packet: Packet,
    count: int,
    casting: Casting,
    first: Seen,
    light: int,
    is_wide: bool,
    work: Workspace,
) -> int:
    """Find the shapes that can stop the rays of the active hits of a batch, so many.

    If it is asked whether pixels look the same everywhere, these are the rays from all around the
    hits that their pixels see.

    Return how many there are, or ``MANY`` if that is not known.
    """
    if count == 0 or not is_narrow(first.aim):
        return MANY
    if count == 1 and not is_wide:
        return MANY
    spot = spot_of(packet, work.batch, count)
    if is_wide:
        reach = 0.0
        for k in range(count):
            reach = max(reach, packet[REACH + work.batch.hit[work.batch.active[k]]])
        spot = wider_spot(spot, reach)
    aim = aim_at(casting.soft, light, spot.start, spot.normal)
    cone = cone_from(aim, spot, casting.lit.forward)
    if math.isinf(spot.extent) or not cone.cosine > 0.0:
        return MANY
    return find_touching(cone, casting.lit.world, work.touching, MOST, work.stack)


@device
def _leave_even(
    packet: Packet,
    count: int,
    casting: Casting,
    light: int,
    around: int,
    is_wide: bool,
    work: Workspace,
) -> int:
    """Leave those of so many hits active whose pixels look the same everywhere, if that is asked.

    Return how many these are.
    """
    if not is_wide:
        return count
    active, batch = 0, work.batch
    for k in range(count):
        member = batch.active[k]
        if not _is_uneven(packet, batch.hit[member], casting, light, around, is_wide, work):
            batch.active[active] = member
            active += 1
    return active


@device
def _cast_together(
    packet: Packet,
    count: int,
    casting: Casting,
    fans: Fans,
    seen: Seen,
    light: int,
    touching: int,
    work: Workspace,
) -> int:
    """Add a light to active hits, so many, whose fans are cast at a time.

    Return how many rays were cast. Only so many shapes can stop any, or ``MANY``.
    """
    batch, fan, world = work.batch, work.fan, casting.lit.world
    if count == 0:
        return 0
    shift = count_bits(np.uint64(fans.rays - 1))
    active, touching, is_dimmed, cast = _ask_cones(
        packet, count, casting, fans, seen, light, touching, work
    )
    shapes = work.own if seen.is_alone else work.touching
    while active > 0:
        longest = 0.0
        for k in range(active):
            length, rays = _spread_from(packet, k, casting, fans, seen, light, work)
            longest = max(longest, length)
            cast += rays
        spot = spot_of(packet, batch, active)
        bundle = Bundle(fan, active * fans.rays, shift, spot, longest)
        stop_rays(bundle, world, shapes, touching, work.stack)
        if is_dimmed:
            dim_fan(bundle, world, work.walk, work.stack)
        going_on = 0
        for k in range(active):
            if _goes_on(packet, k, casting, fans, seen, light, work):
                batch.active[going_on] = batch.active[k]
                going_on += 1
        active = going_on
    return cast


@device
def _leave_above(
    packet: Packet,
    count: int,
    casting: Casting,
    first: Seen,
    light: int,
    is_wide: bool,
    work: Workspace,
) -> int:
    """Make those hits active that a light is not below; return how many these are.

    Those are left out whose pixels are known to look different elsewhere.
    """
    batch, active = work.batch, 0
    for member in range(count):
        hit = batch.hit[member]
        if is_wide and packet[UNEVEN + hit] != 0.0:
            continue
        aim = aim_of(packet, hit, casting.soft, light, first)
        if is_below(aim, load(packet, NORMAL, hit)):
            _is_uneven(packet, hit, casting, light, MANY, is_wide, work)
            _add_shares(packet, hit, casting, light, DARK)
        else:
            store_estimate(batch, member, no_estimate())
            batch.active[active] = member
            active += 1
    return active


@device
def _ask_cones(
    packet: Packet,
    count: int,
    casting: Casting,
    fans: Fans,
    seen: Seen,
    light: int,
    around: int,
    work: Workspace,
) -> tuple[int, int, bool, int]:
    """Add a light to those active hits, so many, where it is known how much of it arrives.

    Of the shapes that `_find_around` has found, so many, all others can touch no ray; all may,
    where that is ``MANY``.

    Returns
    -------
    active, touching, is_dimmed, cast
        How many hits are left, which are the active ones then; how many shapes can stop their rays,
        as `find_touching` tells it; whether faded bodies may dim any; and how many rays need not be
        cast.
    """
    batch, soft, world, forward = work.batch, casting.soft, casting.lit.world, casting.lit.forward
    if is_everywhere(seen.aim):
        for k in range(count):
            hit = batch.hit[batch.active[k]]
            _add_shares(packet, hit, casting, light, ALL)
        return 0, around, False, 0
    if not is_round(seen.aim):
        return count, MANY, True, 0
    active, touching, cast, is_dimmed = 0, around, 0, False
    for k in range(count):
        member = batch.active[k]
        hit = batch.hit[member]
        aim, normal = aim_of(packet, hit, soft, light, seen), load(packet, NORMAL, hit)
        may_be_dim = True
        if is_narrow(aim):
            cone = cone_of(aim, start_of(packet, hit), forward)
            found = _find_touching(cone, world, fans, seen, around, work)
            if seen.is_alone:
                touching = found
            may_be_dim = found != CLOSED and may_be_dimmed(cone, world, work.stack)
            known = MANY if may_be_dim else found
            share = known_share(cone, aim, normal, world, fans, work.own, known, work.caps)
            if share != UNKNOWN:
                _add_shares(packet, hit, casting, light, (share, 0.0, 0.0))
                cast += fans.rays
                continue
        is_dimmed |= may_be_dim
        batch.active[active] = member
        active += 1
    return active, touching, is_dimmed, cast


@device
def _find_touching(
    cone: Cone, world: World, fans: Fans, seen: Seen, around: int, work: Workspace
) -> int:
    """Find the shapes that touch a cone among so many around it, or all if that is ``MANY``."""
    if around >= 0:
        return find_among(cone, world, work.touching, around, work.own)
    if seen.is_alone:
        return find_touching(cone, world, work.own, MOST, work.stack)
    if fans.rays >= WORTH_IT:
        return find_touching(cone, world, work.own, MOST_KNOWN, work.stack)
    return MANY


@device
def _spread_from(
    packet: Packet,
    k: int,
    casting: Casting,
    fans: Fans,
    seen: Seen,
    light: int,
    work: Workspace,
) -> tuple[float, int]:
    """Set the next fan of an active hit, given by its number among them.

    Return how long its rays are at the most, and how many count.
    """
    batch, seed = work.batch, casting.seed
    member = batch.active[k]
    hit = batch.hit[member]
    start, aim = start_of(packet, hit), aim_of(packet, hit, casting.soft, light, seen)
    lane = integers(packet)[SOURCE + hit]
    column, row, sample = sample_of(
        lane, casting.samples, casting.first, casting.block, casting.begin, work.pixels
    )
    number = load_estimate(batch, member).fans
    count = _fans_of(packet, lane, casting)
    offset, keys = fan_of(fans, number, max(count, 1), sample, column, row, light, seed)
    set_start(work.fan, k, start, aim.error_scale + start.error_scale)
    rays = spread_fan(
        work.fan[k * fans.rays :],
        fans.rays,
        aim,
        start,
        load(packet, NORMAL, hit),
        casting.lit.forward,
        casting.soft.skies,
        fans.points,
        fans.first,
        offset,
        keys,
    )
    return longest_ray(aim, start), rays


@device
def _goes_on(
    packet: Packet,
    k: int,
    casting: Casting,
    fans: Fans,
    seen: Seen,
    light: int,
    work: Workspace,
) -> bool:
    """Tell whether an active hit needs another fan; add the light to it if not."""
    batch, soft = work.batch, casting.soft
    member = batch.active[k]
    hit, fan = batch.hit[member], work.fan[k * fans.rays :]
    aim, normal = aim_of(packet, hit, soft, light, seen), load(packet, NORMAL, hit)
    shares, spread = arriving_shares(fan, fans.rays, component_count(soft, light), aim, normal)
    estimate = with_fan(load_estimate(batch, member), shares, spread)
    worth, spent = _worth_at(packet, hit, casting, light), batch.spent[member]
    count = _fans_of(packet, integers(packet)[SOURCE + hit], casting)
    if needs_more(estimate, fans, count, worth, spent, light, soft_count(soft)):
        store_estimate(batch, member, estimate)
        return True
    variance = with_unseen(estimate, fans.rays, aim.share)
    batch.spent[member] = spent + counted_variance(estimate, fans, worth)
    packet[NOISE + hit] += worth * worth * variance
    _add_shares(packet, hit, casting, light, shares_of(estimate))
    return False


@device
def _fans_of(packet: Packet, lane: int, casting: Casting) -> int:
    """Return how many fans are cast from the hit of a lane to each light, or ``AS_NEEDED``."""
    return fans_on_trial(packet, lane) if casting.samples > 1 else AS_NEEDED


@device
def aim_from(packet: Packet, hit: int, soft: SoftLights, light: int) -> Aim:
    """Return a light as it is seen from a hit."""
    return aim_at(soft, light, start_of(packet, hit), load(packet, NORMAL, hit))


@device
def aim_of(packet: Packet, hit: int, soft: SoftLights, light: int, seen: Seen) -> Aim:
    """Return a light as it is seen from a hit of a batch, which is known if it is alone."""
    return seen.aim if seen.is_alone else aim_from(packet, hit, soft, light)


@device
def _worth_at(packet: Packet, hit: int, casting: Casting, light: int) -> float:
    """Return the largest channel of what all of a light adds at a hit, shining squarely."""
    material = Material(load(packet, COLOR, hit), packet[LAMBERT + hit])
    return soft_worth(casting.lit.powers, casting.soft, light, material)


@device
def _add_shares(packet: Packet, hit: int, casting: Casting, light: int, shares: Vec) -> None:
    """Add what arrives of a light to a hit, given the shares of its components."""
    lane, soft = integers(packet)[SOURCE + hit], casting.soft
    for component in range(component_count(soft, light)):
        power, share = soft.row[light] + component, shares[component]
        _add_share(packet, hit, casting.lit.powers, power, share)
        _keep_share(packet, lane, power, share, casting.cosines)


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
    casting: Casting,
    light: int,
    around: int,
    is_wide: bool,
    work: Workspace,
) -> bool:
    """Tell whether the pixel of a hit gets samples for a light, if that is asked, and note it."""
    if not is_wide:
        return False
    uneven = is_lit_unevenly(packet, hit, casting.lit, casting.soft, light, around, work)
    packet[UNEVEN + hit] = 1.0 if uneven else packet[UNEVEN + hit]
    return uneven
