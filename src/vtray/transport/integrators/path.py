"""The path integrator: all light, by paths that go on at random from whatever they meet.

From each surface one ray goes on: from a matt one in a direction drawn by the cosine, from glass by
chance mirrored or refracted. What lamps and skies shed on a matt surface is added there, by shadow
rays; so the ray that goes on from it does not see them, which would count them twice. Light of one
colour from everywhere needs no shadow rays: the rays that go on find it as often as it is worth.
Mirrors and glass show all lamps and skies as they are. From the third surface on, paths of which
little is seen end by chance, and the others count for them: no light is lost on average.

References
----------
Kajiya, "The Rendering Equation", SIGGRAPH 1986; Arvo, Kirk, "Particle Transport and Image
Synthesis", SIGGRAPH 1990 (Russian roulette).
"""

from vtray.base.compiler.compiled import device
from vtray.geometry.packets.packet import (
    BOUNCES,
    COLOR,
    LAMBERT,
    NOISE,
    NORMAL,
    PRIMITIVE,
    SOURCE,
    THROUGHPUT,
    TOWARDS,
    WITHIN,
    Block,
    Packet,
    integers,
    load,
    store,
)
from vtray.geometry.packets.pending import Pending
from vtray.geometry.packets.workspace import Pixels
from vtray.geometry.vector import Vec, dot, scale
from vtray.geometry.world import World
from vtray.transport.integrators.bounces import (
    comes_from_within,
    mirrored_share,
    push_from,
    shine,
    times,
)
from vtray.transport.integrators.soft import sample_of
from vtray.transport.lights.surroundings import Surroundings, has_even_light
from vtray.transport.materials.look import EMISSIVE, EMPTY, GLASS, MATT, Looks, first_number
from vtray.transport.materials.material import Materials, load_look
from vtray.transport.materials.optics import mirrored, split_at
from vtray.transport.sampling.paths import CHOICE, WAY, Paths, path_point
from vtray.transport.sampling.warps import cosine_direction

SAFE = 3
"""Over so many surfaces no path ends by chance."""


@device
def scatter_hits(
    packet: Packet,
    hits: int,
    world: World,
    materials: Materials,
    looks: Looks,
    surroundings: Surroundings | None,
    forward: Vec,
    pending: Pending,
    most: int,
    samples: int,
    first: int,
    block: Block,
    begin: int,
    pixels: Pixels,
    paths: Paths,
    seed: int,
) -> None:
    """Let a ray go on from each hit, and weigh the colours of hits by what is seen.

    Parameters
    ----------
    packet, hits
        So many hits.
    world, materials, looks
        What they are on, and what that is made of.
    surroundings
        What shines from far away.
    forward
        The unit direction in which the camera looks.
    pending
        Out: the rays.
    most
        How many bounces there are at the most.
    samples, first, block, begin, pixels
        Which samples of which pixels the lanes belong to, as in `soft.add_soft_lights`.
    paths, seed
        How paths choose.
    """
    numbers, looks_far = integers(packet), has_even_light(surroundings)
    for hit in range(hits):
        lane = numbers[SOURCE + hit]
        look = load_look(materials, looks, numbers[PRIMITIVE + lane])
        seen, color = load(packet, THROUGHPUT, lane), load(packet, COLOR, hit)
        packet[NOISE + hit] = 0.0
        tinted = times(seen, scale(1.0 / 255.0, color))
        is_matt = look.kind == MATT
        store(packet, COLOR, hit, times(seen, color) if is_matt else (0.0, 0.0, 0.0))
        if look.kind == EMISSIVE:
            shine(packet, lane, looks, look, tinted)
            continue
        step, within = numbers[BOUNCES + lane], numbers[WITHIN + lane]
        # After the last surface that is lit, a ray only looks for the light from everywhere.
        if step > most or (step == most and not (is_matt and looks_far)):
            continue
        column, row, sample = sample_of(lane, samples, first, block, begin, pixels)
        chance, survival = path_point(paths, CHOICE, column, row, sample, step, seed)
        direction, normal = load(packet, TOWARDS, hit), load(packet, NORMAL, hit)
        if is_matt:
            u, v = path_point(paths, WAY, column, row, sample, step, seed)
            way, seen = cosine_direction(u, v, normal), scale(packet[LAMBERT + hit], tinted)
        elif look.kind == GLASS:
            is_inner = comes_from_within(packet, hit, lane, world)
            ior = first_number(looks, look)
            split = split_at(direction, normal, 1.0 / ior if is_inner else ior)
            is_mirrored = chance < split.reflected
            way = mirrored(direction, normal) if is_mirrored else split.refracted
            seen = seen if is_mirrored else tinted
            beyond = EMPTY if is_inner else look.row
            within = within if is_mirrored else beyond
        else:
            way = mirrored(direction, normal)
            seen = mirrored_share(looks, look, -dot(direction, normal), seen, tinted)
        goes_on = _chance_to_go_on(seen, step)
        if survival < goes_on:
            seen, sees_lights = scale(1.0 / goes_on, seen), not is_matt
            push_from(packet, hit, lane, way, seen, step + 1, sees_lights, within, forward, pending)


@device
def _chance_to_go_on(seen: Vec, step: int) -> float:
    """Return with which chance a path goes on of whose light so much is seen; 0 for nothing."""
    most = max(seen[0], seen[1], seen[2])
    return min(most, 1.0) if step >= SAFE else (1.0 if most > 0.0 else 0.0)
