"""What many soft lights add to a hit: fans of rays that all of them share."""

from vtray.base.compiler.compiled import device
from vtray.geometry.packets.cone import CLOSED, Touching, find_touching
from vtray.geometry.packets.fan import Start
from vtray.geometry.packets.packet import (
    COLOR,
    ERROR_SCALE,
    LAMBERT,
    NOISE,
    NORMAL,
    PLANE_DEPTH,
    POINT,
    UNEVEN,
    VALUE,
    Packet,
    load,
    store,
)
from vtray.geometry.packets.stack import Stack
from vtray.geometry.packets.workspace import UNKNOWN, Shared, Workspace
from vtray.geometry.stopped import Bundle, stop_by_all
from vtray.geometry.vector import Vec, add
from vtray.transport.film import Rows
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
from vtray.transport.sampling.fans import Fans, fan_keys, fan_of_sample
from vtray.transport.sampling.shared_estimate import (
    Pool,
    light_of,
    needs_more_shared,
    no_shared_estimate,
    with_shared_fan,
)
from vtray.transport.sampling.shared_fans import longest_of, spread_among, weigh_lights
from vtray.transport.scene_arrays import SceneArrays

SEARCHED = 128
"""So many lights at the most are asked as a whole: each that brings more than such part of all."""

PATIENCE = 8
"""No more are asked when so many more were partly hidden than were not."""

ASKED = 64
"""So many lights at the most are asked about edges around a hit."""


@device
def add_shared_light(
    packet: Packet,
    hit: int,
    column: int,
    row: int,
    sample: int,
    scene: SceneArrays,
    soft: SoftLights,
    crowd: Crowd,
    fans: Fans,
    seed: int,
    error: Rows,
    is_wide: bool | None,
    work: Workspace,
) -> int:
    """Add what all soft lights bring to a hit; return how many shadow rays were cast.

    Parameters
    ----------
    packet, hit
        The hit.
    column, row, sample
        Its pixel and the number of its sample.
    scene, soft, crowd
        The scene, and its soft lights.
    fans, seed
        Which rays are cast.
    error
        Not None if it is wanted how wrong the light may be.
    is_wide
        Whether it is asked if pixels look the same everywhere; None where it never is.
    work
        Scratch memory.
    """
    point, normal = load(packet, POINT, hit), load(packet, NORMAL, hit)
    start = Start(point, packet[PLANE_DEPTH + hit], packet[ERROR_SCALE + hit])
    material = Material(load(packet, COLOR, hit), packet[LAMBERT + hit])
    lights, fan, shared = scene.lights, work.fan, work.shared
    most = weigh_lights(lights, soft, crowd, start, normal, material, shared.sums)
    if _is_uneven(packet, hit, scene, soft, crowd, is_wide, shared, work) or not most > 0.0:
        return 0
    forward, light = scene.camera.forward, soft_count(soft)
    whole, pool = decide_by_cones(
        scene, soft, crowd, start, normal, material, most, shared, work.touching, work.stack
    )
    store(packet, VALUE, hit, add(load(packet, VALUE, hit), whole))
    if not pool.most > 0.0:
        return 0
    keys = fan_keys(column, row, light, seed)
    number = fan_of_sample(fans.levels, sample, column, row, light, seed)
    first = number * fans.rays * fans.fans
    estimate, cast = no_shared_estimate(), 0
    while needs_more_shared(estimate, fans):
        place = first + estimate.fans * fans.rays
        cast += spread_among(
            fan,
            fans.rays,
            lights,
            soft,
            crowd,
            start,
            normal,
            material,
            forward,
            fans.points,
            place,
            keys,
            shared,
        )
        longest = longest_of(fan, fans.rays)
        stop_by_all(Bundle(fan, fans.rays, start, normal, None, longest), scene.world, work.stack)
        estimate = with_shared_fan(estimate, pool, fan, fans, first, shared.brought)
    store(packet, VALUE, hit, add(load(packet, VALUE, hit), light_of(estimate, fans)))
    if error is not None:
        packet[NOISE + hit] += estimate.variance
    return cast


@device
def decide_by_cones(
    scene: SceneArrays,
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
    scene, soft, crowd
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
    strong, forward, undecided = most / SEARCHED, scene.camera.forward, 0
    for place in range(soft_count(soft)):
        likely = sums[place + 1] - before
        before = sums[place + 1]
        number = crowd.order[place]
        shared.known[number] = UNKNOWN
        if likely > strong and undecided < PATIENCE:
            aim = aim_at(soft, number, start, normal)
            if aim.spread < NARROW and is_above(aim, normal):
                cone = cone_of(aim, start, forward)
                count = find_touching(cone, scene.world, touching, stack)
                undecided += 1
                if count in (0, CLOSED):
                    share = middle_share(aim, normal) if count == 0 else 0.0
                    power = load_power(scene.lights, soft.row[number])
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
    scene: SceneArrays,
    soft: SoftLights,
    crowd: Crowd,
    is_wide: bool | None,
    shared: Shared,
    work: Workspace,
) -> bool:
    """Tell whether the pixel of a hit gets samples, for one of the lights that are asked.

    That is one for each of ``ASKED`` equal parts of all light: each that brings as much as a part,
    and of lights near each other that bring so much together at least one.
    """
    if is_wide is not None:  # noqa: SIM102 - by itself, it is known to the compiler
        if is_wide:
            uneven: bool = packet[UNEVEN + hit] != 0.0
            count = soft_count(soft)
            parts = ASKED / max(shared.sums[count], LEAST)
            for place in range(count):
                if uneven:
                    break
                if int(shared.sums[place] * parts) < int(shared.sums[place + 1] * parts):
                    uneven = is_lit_unevenly(packet, hit, scene, soft, crowd.order[place], work)
            packet[UNEVEN + hit] = 1.0 if uneven else 0.0
            return uneven
    return False


LEAST = 1e-300
"""Keeps divisors from 0."""
