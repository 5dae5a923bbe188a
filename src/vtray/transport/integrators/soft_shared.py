"""What many soft lights add to a hit: fans of rays that all of them share."""

from vtray.base.compiler.compiled import device, long_part, passing_on
from vtray.geometry.faded.dimming import dim_fan, may_be_dimmed
from vtray.geometry.packets.batch import start_of
from vtray.geometry.packets.cone import CLOSED, MANY, MOST, Touching, find_touching
from vtray.geometry.packets.fan import Start, spot_at
from vtray.geometry.packets.packet import (
    COLOR,
    LAMBERT,
    NOISE,
    NORMAL,
    SOURCE,
    UNEVEN,
    VALUE,
    Block,
    Packet,
    integers,
    load,
    store,
)
from vtray.geometry.packets.stack import Stack
from vtray.geometry.packets.workspace import UNKNOWN, Shared, Workspace
from vtray.geometry.stopped import Bundle, stop_rays
from vtray.geometry.vector import Vec, add
from vtray.geometry.world import Solids
from vtray.transport.integrators.soft import clear_noise, sample_of
from vtray.transport.integrators.soft_edges import NARROW, is_lit_unevenly
from vtray.transport.lights.crowd import Crowd
from vtray.transport.lights.light import load_power
from vtray.transport.lights.soft_light import (
    SoftLights,
    aim_at,
    cone_of,
    is_above,
    middle_share,
    soft_count,
)
from vtray.transport.materials.material import Material, scattered
from vtray.transport.sampling.fans import Fans, shared_keys
from vtray.transport.sampling.shared_estimate import (
    Pool,
    light_of,
    needs_more_shared,
    no_shared_estimate,
    with_shared_fan,
)
from vtray.transport.sampling.shared_fans import longest_of, spread_among, weigh_lights
from vtray.transport.scene_arrays import LitWorld

SEARCHED = 128
"""So many lights at the most are asked as a whole: each that brings more than such part of all."""

PATIENCE = 8
"""No more are asked when so many more were partly hidden than were not."""

ASKED = 64
"""So many lights at the most are asked about edges around a hit."""


@long_part
@passing_on(Solids)
def add_shared_light(
    packet: Packet,
    hits: int,
    samples: int,
    first: int,
    block: Block,
    begin: int,
    lit: LitWorld,
    soft: SoftLights,
    crowd: Crowd,
    fans: Fans,
    seed: int,
    is_wide: bool,
    work: Workspace,
) -> int:
    """Add what all soft lights bring to the hits of a packet; return how many rays were cast.

    Parameters
    ----------
    packet, hits, samples, first, block, begin
        As for `soft.add_soft_lights`.
    lit, soft, crowd
        The scene, and its soft lights.
    fans, seed
        Which rays are cast.
    is_wide
        Whether it is asked if pixels look the same everywhere.
    work
        Scratch memory.
    """
    cast = 0
    clear_noise(packet, hits)
    for hit in range(hits):
        lane = integers(packet)[SOURCE + hit]
        column, row, sample = sample_of(lane, samples, first, block, begin, work.pixels)
        cast += _light_hit(
            packet, hit, column, row, sample, lit, soft, crowd, fans, seed, is_wide, work
        )
    return cast


@device
def _light_hit(
    packet: Packet,
    hit: int,
    column: int,
    row: int,
    sample: int,
    lit: LitWorld,
    soft: SoftLights,
    crowd: Crowd,
    fans: Fans,
    seed: int,
    is_wide: bool,
    work: Workspace,
) -> int:
    """Add what all soft lights bring to a hit; return how many shadow rays were cast."""
    start, normal = start_of(packet, hit), load(packet, NORMAL, hit)
    material = Material(load(packet, COLOR, hit), packet[LAMBERT + hit])
    powers, fan, shared = lit.powers, work.fan, work.shared
    most = weigh_lights(powers, soft, crowd, start, normal, material, shared.sums)
    if _is_uneven(packet, hit, lit, soft, crowd, is_wide, shared, work) or not most > 0.0:
        return 0
    forward = lit.forward
    whole, pool = decide_by_cones(
        lit, soft, crowd, start, normal, material, most, shared, work.touching, work.stack
    )
    store(packet, VALUE, hit, add(load(packet, VALUE, hit), whole))
    if not pool.most > 0.0:
        return 0
    keys = shared_keys(column, row, sample, seed)
    estimate, cast = no_shared_estimate(), 0
    while needs_more_shared(estimate, fans):
        first = estimate.fans * fans.rays
        cast += spread_among(
            fan,
            fans.rays,
            powers,
            soft,
            crowd,
            start,
            normal,
            material,
            forward,
            fans.points,
            first,
            keys,
            shared,
        )
        longest = longest_of(fan, fans.rays)
        bundle = Bundle(fan, fans.rays, 0, spot_at(start, normal), longest)
        stop_rays(bundle, lit.world, work.touching, MANY, work.stack)
        dim_fan(bundle, lit.world, work.walk, work.stack)
        estimate = with_shared_fan(estimate, pool, fan, fans, shared.brought)
    store(packet, VALUE, hit, add(load(packet, VALUE, hit), light_of(estimate, fans)))
    packet[NOISE + hit] += estimate.variance
    return cast


@device
def decide_by_cones(
    lit: LitWorld,
    soft: SoftLights,
    crowd: Crowd,
    start: Start,
    normal: Vec,
    material: Material,
    most: float,
    shared: Shared,
    touching: Touching,
    stack: Stack,
) -> tuple[Vec, Pool]:
    """Ask of each strong light whether all of it arrives, or nothing, and take it out of the sums.

    Parameters
    ----------
    lit, soft, crowd
        The scene, and its soft lights.
    start, normal, material
        The point, the unit normal of its surface, and what that is made of.
    most, shared
        What `weigh_lights` gives; out: the sums of the lights that are left, and what is known.
    touching, stack
        Scratch memory.

    Returns
    -------
    light, pool
        The light of those that arrive, and those that are left.
    """
    sums, light = shared.sums, (0.0, 0.0, 0.0)
    total, squares, before = 0.0, 0.0, 0.0
    strong, forward, undecided = most / SEARCHED, lit.forward, 0
    for place in range(soft_count(soft)):
        likely = sums[place + 1] - before
        before = sums[place + 1]
        number = crowd.order[place]
        shared.known[number] = UNKNOWN
        if likely > strong and undecided < PATIENCE:
            aim = aim_at(soft, number, start, normal)
            if aim.spread < NARROW and is_above(aim, normal):
                cone = cone_of(aim, start, forward)
                count = find_touching(cone, lit.world, touching, MOST, stack)
                undecided += 1
                is_dimmed = count == 0 and may_be_dimmed(cone, lit.world, stack)
                if count in (0, CLOSED) and not is_dimmed:
                    share = middle_share(aim, normal) if count == 0 else 0.0
                    power = load_power(lit.powers, soft.row[number])
                    light = add(light, scattered(material, share, power))
                    shared.known[number] = share
                    likely = 0.0
                    undecided -= 2
        total += likely
        squares += likely * likely
        sums[place + 1] = total
    return light, Pool(total, total * total / squares if squares > 0.0 else 1.0)


@device
def _is_uneven(
    packet: Packet,
    hit: int,
    lit: LitWorld,
    soft: SoftLights,
    crowd: Crowd,
    is_wide: bool,
    shared: Shared,
    work: Workspace,
) -> bool:
    """Tell whether the pixel of a hit gets samples, for one of the lights that are asked.

    That is one for each of ``ASKED`` equal parts of all light: each that brings as much as a part,
    and of lights near each other that bring so much together at least one.
    """
    if not is_wide:
        return False
    uneven: bool = packet[UNEVEN + hit] != 0.0
    count = soft_count(soft)
    parts = ASKED / max(shared.sums[count], LEAST)
    for place in range(count):
        if uneven:
            break
        if int(shared.sums[place] * parts) < int(shared.sums[place + 1] * parts):
            uneven = is_lit_unevenly(packet, hit, lit, soft, crowd.order[place], MANY, work)
    packet[UNEVEN + hit] = 1.0 if uneven else 0.0
    return uneven


LEAST = 1e-300
"""Keeps divisors from 0."""
