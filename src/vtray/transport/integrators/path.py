"""The path integrator: all light, by paths that go on at random from whatever they meet.

From each surface one ray goes on: from a matt one in a direction drawn by the cosine, from glass by
chance mirrored or refracted, from a rough one as its facets stand. What lamps and skies shed on a
matt surface is added there, by shadow rays; so the ray that goes on from it does not see them,
which would count them twice. For a glossy one both see them, and each counts in part. Light of one
colour from everywhere needs no shadow rays: the rays that go on find it as often as it is worth.
Mirrors and glass show all lamps and skies as they are. From the third surface on, paths of which
little is seen end by chance, and the others count for them: no light is lost on average.

References
----------
Kajiya, "The Rendering Equation", SIGGRAPH 1986; Arvo, Kirk, "Particle Transport and Image
Synthesis", SIGGRAPH 1990 (Russian roulette).
"""

from typing import NamedTuple

from vtray.base.compiler.compiled import device, part, passing_on
from vtray.geometry.packets.batch import start_of
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
from vtray.geometry.packets.stack import Stack
from vtray.geometry.packets.workspace import Workspace
from vtray.geometry.vector import Vec, dot, scale
from vtray.geometry.warps import cosine_direction
from vtray.transport.integrators.bounces import (
    gather_at,
    mirrored_share,
    push_from,
    shine,
    times,
)
from vtray.transport.integrators.glossy_light import light_gloss
from vtray.transport.integrators.soft import sample_of
from vtray.transport.interaction import comes_from_within
from vtray.transport.lights.light import powers_of
from vtray.transport.lights.surroundings import has_even_light
from vtray.transport.materials.frosted import Passed, chance_of, pass_facet
from vtray.transport.materials.gloss import Gloss, gloss_of, scatter_gloss
from vtray.transport.materials.look import (
    EMISSIVE,
    EMPTY,
    GLASS,
    MATT,
    METAL,
    PLASTIC,
    Albedos,
    Look,
    Looks,
    index_ratio,
    is_thin,
    part_of_blend,
    spread_of,
)
from vtray.transport.materials.material import Paints, load_look
from vtray.transport.materials.optics import mirrored, split_at, through_both
from vtray.transport.orders import OrderRows
from vtray.transport.sampling.paths import CHOICE, PICK, WAY, Paths, Step, path_point
from vtray.transport.scene_arrays import LitWorld, PathWorld

MIRRORED, REFRACTED, SCATTERED = range(3)
"""How light goes on from a surface."""

SAFE = 3
"""Over so many surfaces no path ends by chance."""


class Onward(NamedTuple):
    """How a path goes on.

    Attributes
    ----------
    way
        The unit direction.
    seen
        How much is seen of the light from there.
    sees_lights, within, density
        As in `Waiting`.
    chance
        With which chance it goes on by what it does here, as glass both mirrors and refracts.
    how
        What that is: ``MIRRORED``, ``REFRACTED`` or ``SCATTERED``.
    light, cast
        What lights bring to a glossy surface, and how many shadow rays that took.
    """

    way: Vec
    seen: Vec
    sees_lights: bool
    within: int
    density: float
    chance: float
    how: int
    light: Vec
    cast: int


@part
@passing_on(Paints)
def scatter_hits(
    packet: Packet,
    hits: int,
    scene: PathWorld,
    looks: Looks,
    samples: int,
    first: int,
    block: Block,
    begin: int,
    paths: Paths,
    seed: int,
    work: Workspace,
    orders: OrderRows,
) -> int:
    """Let a ray go on from each hit, and weigh the colours of hits by what is seen.

    Parameters
    ----------
    packet, hits
        So many hits.
    scene, looks
        What they are on, and what that is made of.
    samples, first, block, begin
        Which samples of which pixels the lanes belong to, as in `soft.add_soft_lights`.
    paths, seed
        How paths choose.
    work
        Scratch memory; out: the rays that wait.
    orders
        Where light is added in its order, too, if that is wanted.

    Returns
    -------
    rays
        How many shadow rays were cast: those of glossy surfaces.
    """
    numbers, looks_far, cast = integers(packet), has_even_light(scene.lights.surroundings), 0
    for hit in range(hits):
        lane = numbers[SOURCE + hit]
        number = numbers[BOUNCES + lane]
        column, row, sample = sample_of(lane, samples, first, block, begin, work.pixels)
        step = Step(column, row, sample, number, paths, seed)
        look = look_at(packet, lane, scene, looks, step)
        seen, color = load(packet, THROUGHPUT, lane), load(packet, COLOR, hit)
        packet[NOISE + hit] = 0.0
        is_matt = look.kind == MATT
        store(packet, COLOR, hit, times(seen, color) if is_matt else (0.0, 0.0, 0.0))
        if look.kind == EMISSIVE:
            shine(packet, lane, looks, look, times(seen, scale(1.0 / 255.0, color)), orders)
            continue
        # After the last surface that is lit, a ray only looks for what shines far away.
        is_last, has_coat = number == looks.depth, is_glossy(looks, looks.albedos, look)
        if number > looks.depth or (is_last and not (has_coat or (is_matt and looks_far))):
            continue
        chance, survival = path_point(step, CHOICE)
        onward = onward_from(packet, hit, scene, looks, look, color, step, chance, work.stack)
        cast += onward.cast
        if has_coat:
            gather_at(packet, lane, times(seen, onward.light), number + 1, orders)
            if is_last and onward.density == 0.0:
                continue
        goes_on = chance_to_go_on(onward.seen, number)
        if survival < goes_on:
            push_from(
                packet,
                hit,
                lane,
                onward.way,
                scale(1.0 / goes_on, onward.seen),
                number + 1,
                onward.sees_lights,
                onward.within,
                onward.density,
                scene.forward,
                work.pending,
            )
    return cast


@device
def look_at(packet: Packet, lane: int, scene: PathWorld, looks: Looks, step: Step) -> Look:
    """Return how what the ray of a lane met looks to a path: a blend as one of both materials."""
    look = load_look(scene.materials, looks, integers(packet)[PRIMITIVE + lane])
    return _of_blend(looks, looks.albedos, look, step)


@device
def _of_blend(
    looks: Looks,
    albedos: Albedos | None,
    look: Look,
    step: Step,
) -> Look:
    """Return how a surface looks to a path: as one of both materials of a blend."""
    # An argument that is None is known to the compiler, which drops what depends on that alone.
    if albedos is None:
        return look
    chance, _ = path_point(step, PICK)
    return part_of_blend(looks, look, chance)


@device
def is_glossy(looks: Looks, albedos: Albedos | None, look: Look) -> bool:
    """Tell whether a surface has a coat of its own over a base: plastic, and rough metal."""
    if albedos is None:
        return False
    return look.kind == PLASTIC or (look.kind == METAL and spread_of(looks, look) > 0.0)


@device
def onward_from(
    packet: Packet,
    hit: int,
    scene: PathWorld,
    looks: Looks,
    look: Look,
    color: Vec,
    step: Step,
    chance: float,
    stack: Stack,
) -> Onward:
    """Return how a path goes on from a hit, and what lights bring there to a glossy surface.

    Parameters
    ----------
    packet, hit
        The hit.
    scene, looks, look, color
        What it is on, and what that is made of; its colour, 255 for white.
    step, chance
        How the path chooses, and its number from 0 to 1 for choices.
    stack
        Scratch memory.
    """
    numbers, dark = integers(packet), (0.0, 0.0, 0.0)
    lane = numbers[SOURCE + hit]
    seen, within = load(packet, THROUGHPUT, lane), int(numbers[WITHIN + lane])
    direction, normal = load(packet, TOWARDS, hit), load(packet, NORMAL, hit)
    tint = scale(1.0 / 255.0, color)
    tinted = times(seen, tint)
    if look.kind == MATT:
        u, v = path_point(step, WAY)
        way, share = cosine_direction(u, v, normal), scale(packet[LAMBERT + hit], tinted)
        return Onward(way, share, False, within, 0.0, 1.0, SCATTERED, dark, 0)
    if is_glossy(looks, looks.albedos, look):
        return _from_gloss(
            packet, hit, lane, scene, looks, looks.albedos, look, tint, step, chance, stack
        )
    if look.kind == GLASS:
        is_inner = comes_from_within(packet, hit, lane, scene.world)
        passed = _pass_glass(looks, looks.albedos, look, is_inner, direction, normal, step, chance)
        beyond = EMPTY if is_inner or is_thin(looks, look) else look.row
        share = scale(passed.share, seen if passed.is_mirrored else tinted)
        side = within if passed.is_mirrored else beyond
        how = MIRRORED if passed.is_mirrored else REFRACTED
        return Onward(passed.way, share, True, side, 0.0, passed.chance, how, dark, 0)
    share = mirrored_share(looks, look, -dot(direction, normal), seen, tinted)
    return Onward(mirrored(direction, normal), share, True, within, 0.0, 1.0, MIRRORED, dark, 0)


@device
def gloss_at(
    packet: Packet, hit: int, looks: Looks, albedos: Albedos, look: Look, tint: Vec
) -> Gloss:
    """Return a glossy surface as the ray of a hit sees it; `tint` is its colour, 1 for white."""
    direction, normal = load(packet, TOWARDS, hit), load(packet, NORMAL, hit)
    return gloss_of(looks, albedos, look, tint, packet[LAMBERT + hit], direction, normal)


@device
def _from_gloss(
    packet: Packet,
    hit: int,
    lane: int,
    scene: PathWorld,
    looks: Looks,
    albedos: Albedos | None,
    look: Look,
    tint: Vec,
    step: Step,
    chance: float,
    stack: Stack,
) -> Onward:
    """Return how a path goes on from a glossy surface, and what lights bring there."""
    seen, within = load(packet, THROUGHPUT, lane), int(integers(packet)[WITHIN + lane])
    if albedos is None:
        direction = load(packet, TOWARDS, hit)
        return Onward(direction, seen, True, within, 0.0, 1.0, MIRRORED, (0.0, 0.0, 0.0), 0)
    u, v = path_point(step, WAY)
    gloss, start = gloss_at(packet, hit, looks, albedos, look, tint), start_of(packet, hit)
    lit = LitWorld(scene.world, scene.forward, powers_of(scene.lights))
    light, cast = light_gloss(looks, albedos, gloss, start, lit, scene.lights, step, stack)
    onward = scatter_gloss(looks, albedos, gloss, u, v, chance)
    is_sharp, is_base = onward.density == 0.0, not chance < gloss.chance
    return Onward(
        onward.way,
        times(seen, onward.share),
        is_sharp,
        within,
        onward.density,
        1.0 - gloss.chance if is_base else gloss.chance,
        SCATTERED if is_base else MIRRORED,
        light,
        cast,
    )


@device
def _pass_glass(
    looks: Looks,
    albedos: Albedos | None,
    look: Look,
    is_inner: bool,
    direction: Vec,
    normal: Vec,
    step: Step,
    chance: float,
) -> Passed:
    """Return how a path goes on at glass, which it meets from within or from outside."""
    ratio = index_ratio(looks, look, is_inner)
    # An argument that is None is known to the compiler, which drops what depends on that alone.
    if albedos is not None:
        spread = spread_of(looks, look)
        if spread > 0.0:
            u, v = path_point(step, WAY)
            table = 2 * look.row + (1 if is_inner else 0)
            return pass_facet(albedos, table, spread, ratio, direction, normal, u, v, chance)
    split = split_at(direction, normal, ratio)
    if is_thin(looks, look):
        split = through_both(split, direction)
    is_mirrored = chance < split.reflected
    way = mirrored(direction, normal) if is_mirrored else split.refracted
    return Passed(way, 1.0, is_mirrored, chance_of(split, is_mirrored))


@device
def chance_to_go_on(seen: Vec, number: int) -> float:
    """Return with which chance a path goes on of whose light so much is seen; 0 for nothing."""
    most = max(seen[0], seen[1], seen[2])
    return min(most, 1.0) if number >= SAFE else (1.0 if most > 0.0 else 0.0)
