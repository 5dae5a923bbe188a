"""Light over many surfaces: rays go on from what they meet, and all that they meet is lit.

The rays of a camera are traced as packets. What each meets may let rays go on, which wait in their
lane; the next of each is traced by itself, and what it meets becomes a hit of the same packet. So
all hits are lit alike, by the same parts as the first ones. Which rays go on is what the
integrators are about.
"""

from vtray.base.compiler.compiled import device, part, passing_on
from vtray.geometry.packets.packet import (
    BEHIND,
    BEHIND_DISTANCE,
    BEHIND_MET,
    BOUNCES,
    DISTANCE,
    ERROR_SCALE,
    GATHERED,
    LENGTH,
    LIGHT,
    MET,
    MIXED,
    NO_PRIMITIVE,
    NOISE,
    NORMAL,
    PLANE_DEPTH,
    POINT,
    PRIMITIVE,
    SOURCE,
    THROUGHPUT,
    VALUE,
    VARIANCE,
    WITHIN,
    Packet,
    Sheaf,
    integers,
    join_met,
    load,
    load_ray,
    store,
    store_ray,
)
from vtray.geometry.packets.pending import Pending, Waiting, clear_pending, pop_ray, push_ray
from vtray.geometry.packets.stack import Stack
from vtray.geometry.packets.workspace import Workspace
from vtray.geometry.queries import NOTHING, Hit, nearest_hit
from vtray.geometry.ray import Ray
from vtray.geometry.rounding import ROUNDING
from vtray.geometry.vector import Vec, add, dot, scale
from vtray.geometry.world import World
from vtray.transport.far_light import far_light
from vtray.transport.glass_around import leave_glass
from vtray.transport.integrators.glossy_light import light_met
from vtray.transport.integrators.lamps import lamp_beyond
from vtray.transport.lights.light import Lights, lamp_light
from vtray.transport.materials.absorption import transmitted
from vtray.transport.materials.look import (
    EMPTY,
    MATT,
    METAL,
    Albedos,
    Look,
    Looks,
    first_number,
    three_numbers,
)
from vtray.transport.materials.material import Materials, Paints, load_look
from vtray.transport.materials.metal import metal_shares
from vtray.transport.orders import OrderRows, add_in_order, limit_orders
from vtray.transport.sampling.paths import Paths


@device
def bounced_sheaf() -> Sheaf:
    """Return what rays from surfaces have in common: nothing."""
    return Sheaf((0.0, 0.0, 0.0), 0.0, 0.0, 0.0, True)


@device
def mix_looks(
    packet: Packet,
    lanes: int,
    sheaf: Sheaf,
    world: World,
    materials: Materials,
    looks: Looks | None,
    paths: Paths | None,
    stack: Stack,
) -> None:
    """Set field ``MIXED`` of the lanes whose pixels get samples, as more is seen than surfaces.

    That is where rays meet mirrors or glass, or start in glass that takes light; for paths, where
    they meet anything.
    """
    # Arguments that are None are known to the compiler, which drops what depends on them alone.
    if looks is not None:
        _mix_looks(packet, lanes, sheaf, world, materials, looks, paths, stack)


@part
@passing_on(Paints)
def _mix_looks(
    packet: Packet,
    lanes: int,
    sheaf: Sheaf,
    world: World,
    materials: Materials,
    looks: Looks,
    paths: Paths | None,
    stack: Stack,
) -> None:
    """Set field ``MIXED``, as above, where anything is seen that is no matt surface."""
    numbers = integers(packet)
    for lane in range(lanes):
        met = numbers[PRIMITIVE + lane]
        if met > NO_PRIMITIVE:  # noqa: SIM102 - the look of nothing is not asked
            if paths is not None or load_look(materials, looks, met).kind != MATT:
                packet[MIXED + lane] = 1.0
        ray, distance = load_ray(packet, sheaf, lane), packet[DISTANCE + lane]
        within, _ = leave_glass(world, materials, looks, ray, distance, stack)
        if within != EMPTY:
            packet[MIXED + lane] = 1.0


@part
@passing_on(Paints)
def begin_bounces(
    packet: Packet,
    lanes: int,
    sheaf: Sheaf,
    world: World,
    materials: Materials,
    looks: Looks,
    pending: Pending,
    stack: Stack,
) -> None:
    """Keep what the rays of the camera meet, and start with no light.

    Parameters
    ----------
    packet, lanes
        The rays of so many lanes; out: of their light, and of that of lamps that they see, is left
        what glass around the camera leaves of it.
    sheaf
        What they have in common.
    world, materials, looks
        The scene.
    pending
        Out: no rays that wait.
    stack
        Scratch memory.
    """
    numbers = integers(packet)
    clear_pending(pending, lanes)
    for lane in range(lanes):
        packet[BEHIND_DISTANCE + lane] = packet[DISTANCE + lane]
        numbers[BEHIND + lane] = numbers[PRIMITIVE + lane]
        numbers[BEHIND_MET + lane] = numbers[MET + lane]
        packet[VARIANCE + lane] = 0.0
        ray, distance = load_ray(packet, sheaf, lane), packet[DISTANCE + lane]
        within, left = leave_glass(world, materials, looks, ray, distance, stack)
        numbers[BOUNCES + lane], numbers[WITHIN + lane] = 0, within
        store(packet, GATHERED, lane, (0.0, 0.0, 0.0))
        store(packet, THROUGHPUT, lane, left)
        if numbers[PRIMITIVE + lane] < NO_PRIMITIVE:
            store(packet, LIGHT, lane, times(left, load(packet, LIGHT, lane)))


@device
def mirrored_share(looks: Looks, look: Look, cosine: float, seen: Vec, tinted: Vec) -> Vec:
    """Return how much is seen of the light that a mirror or a metal reflects.

    Parameters
    ----------
    looks, look
        What the surface is made of.
    cosine
        That of the angle between the ray and the normal.
    seen, tinted
        How much is seen of light from the surface, and that times its colour.
    """
    if look.kind != METAL:
        return tinted
    return metal_shares(looks, look.row, cosine, tinted, seen)


@device
def shine(
    packet: Packet, lane: int, looks: Looks, look: Look, tinted: Vec, orders: OrderRows
) -> None:
    """Add the light of what shines to that of a lane; `tinted` is as for `mirrored_share`."""
    light = scale(255.0 * first_number(looks, look), tinted)
    gather_at(packet, lane, light, integers(packet)[BOUNCES + lane], orders)


@device
def push_from(
    packet: Packet,
    hit: int,
    lane: int,
    direction: Vec,
    seen: Vec,
    bounces: int,
    sees_lights: bool,
    within: int,
    density: float,
    forward: Vec,
    pending: Pending,
) -> None:
    """Let a ray from a hit wait.

    Parameters
    ----------
    packet, hit, lane
        The hit, and its lane.
    direction
        The unit direction of the ray.
    seen
        How much of its light is seen.
    bounces
        How many surfaces are then between it and the camera.
    sees_lights
        Whether it sees lamps and skies; else their light was added at the hit.
    within
        The row of the material within which it goes, ``EMPTY`` for none.
    density
        As in `Waiting`.
    forward
        The unit direction in which the camera looks.
    pending
        Out: the ray.
    """
    error_scale = packet[ERROR_SCALE + hit]
    ray = Ray(
        load(packet, POINT, hit),
        direction,
        packet[PLANE_DEPTH + hit],
        dot(direction, forward),
        error_scale,
        ROUNDING * error_scale,
    )
    normal = load(packet, NORMAL, hit)
    push_ray(pending, lane, Waiting(ray, seen, bounces, sees_lights, within, density, normal))


@part
def follow_rays(
    packet: Packet,
    lanes: int,
    world: World,
    lights: Lights,
    looks: Looks,
    pending: Pending,
    most: int,
    work: Workspace,
    orders: OrderRows,
) -> int:
    """Let the next ray of each lane that meets a surface take the lane; return how many rays go.

    The light of lamps that are met instead, or of skies, is added to that of the lane. What rays
    meet after more than `most` surfaces is not followed. Light is added in its order, too, where
    `orders` are wanted.
    """
    numbers, cast = integers(packet), 0
    for lane in range(lanes):
        numbers[PRIMITIVE + lane] = NO_PRIMITIVE
        while pending.waiting[lane] > 0 and numbers[PRIMITIVE + lane] == NO_PRIMITIVE:
            ray, seen, bounces, sees_lights, within, density, normal = pop_ray(pending, lane)
            hit, cast = nearest_hit(world, ray, work.stack), cast + 1
            lamp, distance = NOTHING, hit.distance
            if sees_lights:
                lamp, distance = lamp_beyond(ray, distance, lights.mirrored)
            if within != EMPTY:
                seen = times(seen, transmitted(three_numbers(looks, within, 1), distance))
            _gather_met(
                packet,
                lane,
                looks.albedos,
                lights,
                ray,
                seen,
                normal,
                hit,
                density,
                bounces,
                orders,
            )
            if lamp != NOTHING:
                gather_at(packet, lane, times(seen, lamp_light(lights, lamp)), bounces, orders)
            elif hit.primitive != NOTHING and bounces > most:
                continue
            elif hit.primitive != NOTHING:
                packet[DISTANCE + lane] = distance
                numbers[PRIMITIVE + lane] = hit.primitive
                numbers[MET + lane] = join_met(hit.group, hit.slot)
                numbers[BOUNCES + lane], numbers[WITHIN + lane] = bounces, within
                store(packet, THROUGHPUT, lane, seen)
                store_ray(packet, lane, ray)
            else:
                light = far_light(lights.surroundings, ray.direction, sees_lights)
                gather_at(packet, lane, times(seen, light), bounces, orders)
    return cast


@device
def _gather_met(
    packet: Packet,
    lane: int,
    albedos: Albedos | None,
    lights: Lights,
    ray: Ray,
    seen: Vec,
    normal: Vec,
    hit: Hit,
    density: float,
    bounces: int,
    orders: OrderRows,
) -> None:
    """Add the light of lamps and skies that shadow rays find, too, to that of a lane, in part."""
    # An argument that is None is known to the compiler, which drops what depends on that alone.
    if albedos is not None:  # noqa: SIM102
        if density > 0.0:
            light = light_met(lights, ray, normal, hit.distance, density)
            gather_at(packet, lane, times(seen, light), bounces, orders)


@device
def gather_at(packet: Packet, lane: int, light: Vec, number: int, orders: OrderRows) -> None:
    """Add light to that of a lane: surfaces have scattered it so often."""
    store(packet, GATHERED, lane, add(load(packet, GATHERED, lane), light))
    add_in_order(packet, lane, light, number, orders)


@device
def end_bounces(packet: Packet, lanes: int, brightest: float, orders: OrderRows) -> int:
    """Make one hit of all that each lane sees; return how many there are.

    No channel is brighter than `brightest`: what is, becomes darker as a whole.
    """
    numbers, hits = integers(packet), 0
    for lane in range(lanes):
        packet[DISTANCE + lane] = packet[BEHIND_DISTANCE + lane]
        numbers[PRIMITIVE + lane] = numbers[BEHIND + lane]
        numbers[MET + lane] = numbers[BEHIND_MET + lane]
        if numbers[BEHIND + lane] > NO_PRIMITIVE:
            numbers[SOURCE + hits] = lane
            packet[LENGTH + hits] = packet[DISTANCE + lane]
            light = load(packet, GATHERED, lane)
            peak = max(light[0], light[1], light[2])
            store(
                packet, VALUE, hits, scale(brightest / peak, light) if peak > brightest else light
            )
            limit_orders(packet, lane, brightest, peak, orders)
            packet[NOISE + hits] = packet[VARIANCE + lane]
            hits += 1
    return hits


@device
def times(one: Vec, other: Vec) -> Vec:
    """Return the products of the parts of two vectors."""
    return one[0] * other[0], one[1] * other[1], one[2] * other[2]
