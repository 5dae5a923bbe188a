"""One path of one pixel, step by step: what ``vtray --pixel`` tells of whitted and path.

The steps are those of a packet, in whose first lane the path goes; whoever calls them reads there
what became of it, and keeps the rays that wait. So the picture has the same paths, to the last bit.
"""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from vtray.base.compiler.compiled import device, kernel
from vtray.geometry.between import first_between
from vtray.geometry.packets.batch import start_of
from vtray.geometry.packets.layer_notes import Walk
from vtray.geometry.packets.packet import (
    BOUNCES,
    COLOR,
    DISTANCE,
    ERROR_SCALE,
    HALF,
    LAMBERT,
    MET,
    NORMAL,
    POINT,
    PRIMITIVE,
    THROUGHPUT,
    Block,
    Packet,
    in_common,
    integers,
    join_met,
    load,
    load_ray,
    split_met,
    store_ray,
)
from vtray.geometry.packets.pending import Waiting, pop_ray, push_ray
from vtray.geometry.packets.stack import Stack
from vtray.geometry.packets.workspace import Workspace
from vtray.geometry.queries import NOTHING, nearest_hit
from vtray.geometry.ray import some_footprint
from vtray.geometry.vector import Vec, scale
from vtray.transport.camera_rays import sample_ray
from vtray.transport.integrators.bounces import begin_bounces, bounced_sheaf, follow_rays, times
from vtray.transport.integrators.glossy_light import (
    GlossRay,
    picked_count,
    picked_lamp,
    ray_to_lamp,
    ray_to_point,
)
from vtray.transport.integrators.lamps import lamp_beyond, nearest_lamp
from vtray.transport.integrators.path import (
    MIRRORED,
    SCATTERED,
    chance_to_go_on,
    gloss_at,
    is_glossy,
    look_at,
    onward_from,
    scatter_hits,
)
from vtray.transport.integrators.reference import TracedPixel, light_of_points
from vtray.transport.integrators.whitted import split_hits
from vtray.transport.interaction import Interaction, gather_interactions, material_at
from vtray.transport.lights.light import lamp_light
from vtray.transport.lights.soft_light import SoftLights, soft_count
from vtray.transport.materials.absorption import transmitted
from vtray.transport.materials.gloss import Gloss
from vtray.transport.materials.look import (
    BLEND,
    EMISSIVE,
    EMPTY,
    Albedos,
    Look,
    Looks,
    three_numbers,
)
from vtray.transport.materials.material import Material, load_look
from vtray.transport.sampling.paths import CHOICE, PICK, Paths, Step, path_point
from vtray.transport.sampling.pixel_samples import Sampling, place_samples
from vtray.transport.scene_arrays import SceneArrays, path_world


class Place(NamedTuple):
    """Where a path goes through the image: a pixel, and the number of its sample."""

    column: int
    row: int
    sample: int


class Begun(NamedTuple):
    """What a ray of the camera meets that is no surface.

    Attributes
    ----------
    lamp
        The row of a lamp, or ``NOTHING``.
    light
        What is seen of it.
    passes
        What is left of light by the glass in which the ray starts.
    """

    lamp: int
    light: Vec
    passes: Vec


@kernel
def begin_path(
    scene: SceneArrays,
    looks: Looks,
    sampling: Sampling,
    place: Place,
    packet: Packet,
    work: Workspace,
) -> Begun:
    """Cast a ray of the camera.

    Parameters
    ----------
    scene, looks, sampling, place
        The scene, what things are made of, how rays are cast, and which ray it is.
    packet
        Out: in the first lane the ray, and what it meets.
    work
        Scratch memory; out: no rays that wait.
    """
    block, sample = Block(place.column, place.row, 1, 1, 0, 0), place.sample
    work.pixels[0] = 0
    lens = scene.camera.lens
    place_samples(packet, block, 0, 1, sampling, sample, sample + 1, work.pixels, lens)
    ray = sample_ray(scene.camera, packet, 0)
    hit = nearest_hit(scene.world, ray, work.stack)
    lamp, distance = nearest_lamp(ray, hit.distance, scene.lights.visible)
    packet[DISTANCE] = distance
    integers(packet)[PRIMITIVE] = hit.primitive if lamp == NOTHING else NOTHING
    integers(packet)[MET] = join_met(hit.group, hit.slot)
    store_ray(packet, 0, ray)
    sheaf, stack = bounced_sheaf(), work.stack
    begin_bounces(packet, 1, sheaf, scene.world, scene.materials, looks, work.pending, stack)
    passes, light = load(packet, THROUGHPUT, 0), (0.0, 0.0, 0.0)
    if lamp != NOTHING:
        light = times(passes, lamp_light(scene.lights, lamp))
    return Begun(lamp, light, passes)


class Choice(NamedTuple):
    """How a path goes on from a hit, which whitted does in all ways at once.

    Attributes
    ----------
    row, share
        The row of the material, and the chance with which it was chosen of a blend.
    has_coat
        Whether it is glossy, so that `tell_point` and `tell_lamp` say what lights bring.
    chance, how, density
        As in `Onward`.
    goes_on
        With which chance the path does not end here.
    """

    row: int
    share: float
    has_coat: bool
    chance: float
    how: int
    density: float
    goes_on: float


@kernel
def leave_hit(
    scene: SceneArrays,
    looks: Looks,
    sampling: Sampling,
    place: Place,
    packet: Packet,
    work: Workspace,
) -> Choice:
    """Let rays go on from what the ray in the first lane met.

    Parameters
    ----------
    scene, looks, sampling, place
        As for `begin_path`.
    packet
        Out: the hit, its colour weighed by how much is seen of it as matt.
    work
        Scratch memory; out: the rays that go on.
    """
    gather_interactions(
        packet,
        1,
        1,
        in_common(bounced_sheaf()),
        True,
        some_footprint(sampling.footprint),
        scene.world,
        scene.materials,
        scene.camera.forward,
        scene.camera.middle_depth,
        work,
    )
    return _leave(scene, looks, sampling.paths, sampling.seed, place, packet, work)


@device
def _leave(
    scene: SceneArrays,
    looks: Looks,
    paths: Paths | None,
    seed: int,
    place: Place,
    packet: Packet,
    work: Workspace,
) -> Choice:
    """Let rays go on from the first hit of a packet; see `leave_hit`."""
    # An argument that is None is known to the compiler, which drops what depends on that alone.
    if paths is not None:
        choice = _choose(scene, looks, paths, seed, place, packet, work)
        block = Block(place.column, place.row, 1, 1, 0, 0)
        scatter_hits(
            packet,
            1,
            path_world(scene),
            looks,
            1,
            place.sample,
            block,
            0,
            paths,
            seed,
            work,
            work.unasked,
        )
        return choice
    forward, pending = scene.camera.forward, work.pending
    look = load_look(scene.materials, looks, integers(packet)[PRIMITIVE])
    split_hits(
        packet, 1, scene.world, scene.materials, looks, forward, pending, looks.depth, work.unasked
    )
    return Choice(look.row, 1.0, False, 1.0, MIRRORED, 0.0, 1.0)


@device
def _choose(
    scene: SceneArrays,
    looks: Looks,
    paths: Paths,
    seed: int,
    place: Place,
    packet: Packet,
    work: Workspace,
) -> Choice:
    """Return what `scatter_hits` is about to choose for the first hit of a packet."""
    step = _step_at(packet, paths, seed, place)
    whole = load_look(scene.materials, looks, integers(packet)[PRIMITIVE])
    look, share = look_at(packet, 0, path_world(scene), looks, step), 1.0
    if whole.kind == BLEND:
        second = looks.numbers[whole.row, 2]
        share = second if look.row == int(looks.numbers[whole.row, 1]) else 1.0 - second
    if look.kind == EMISSIVE:
        return Choice(look.row, share, False, 1.0, SCATTERED, 0.0, 0.0)
    chance, _ = path_point(step, CHOICE)
    color = load(packet, COLOR, 0)
    onward = onward_from(packet, 0, path_world(scene), looks, look, color, step, chance, work.stack)
    goes_on = chance_to_go_on(onward.seen, step.number)
    has_coat = is_glossy(looks, looks.albedos, look)
    return Choice(look.row, share, has_coat, onward.chance, onward.how, onward.density, goes_on)


@device
def _step_at(packet: Packet, paths: Paths, seed: int, place: Place) -> Step:
    """Return the step that a path takes at the first hit of a packet."""
    number = int(integers(packet)[BOUNCES])
    return Step(place.column, place.row, place.sample, number, paths, seed)


@kernel
def light_matt(
    scene: SceneArrays,
    place: Place,
    packet: Packet,
    stack: Stack,
    cosines: NDArray[np.float64],
    blockers: NDArray[np.int64],
    walk: Walk,
) -> TracedPixel:
    """Return the first hit of a packet as a matt surface, with the light of points.

    The other parameters are those of `reference.trace_pixel`.
    """
    numbers = integers(packet)
    material = Material(load(packet, COLOR, 0), packet[LAMBERT])
    found = Interaction(
        load(packet, POINT, 0), load(packet, NORMAL, 0), packet[ERROR_SCALE], int(numbers[HALF])
    )
    value = light_of_points(scene, found, material, stack, cosines, blockers, walk)
    return TracedPixel(
        load_ray(packet, bounced_sheaf(), 0),
        packet[DISTANCE],
        int(numbers[PRIMITIVE]),
        found,
        value,
        NOTHING,
        1.0,
        material,
        _own_color(scene, packet),
        place.sample,
    )


@device
def _own_color(scene: SceneArrays, packet: Packet) -> Vec:
    """Return the colour of the first hit of a packet as light, 255 for white."""
    numbers = integers(packet)
    row, slot = split_met(numbers[MET])
    primitive, half, point = numbers[PRIMITIVE], int(numbers[HALF]), load(packet, POINT, 0)
    own = material_at(scene.world, scene.materials, primitive, half, row, slot, point)
    return own.color


class ToldRay(NamedTuple):
    """A shadow ray from a glossy surface.

    Attributes
    ----------
    light
        The light it goes to: its number among the points, or among the others.
    end
        Where it ends.
    brings
        The light that it adds to the path, 255 for white, if nothing is in the way.
    blocker
        The number of what is, or ``NOTHING``.
    """

    light: int
    end: Vec
    brings: Vec
    blocker: int


class Glossy(NamedTuple):
    """The material of a glossy hit: its row, and the tables in which that is."""

    looks: Looks
    albedos: Albedos
    row: int


@kernel
def tell_point(scene: SceneArrays, glossy: Glossy, packet: Packet, k: int, stack: Stack) -> ToldRay:
    """Return the shadow ray from the first hit of a packet, which is glossy, to a point.

    Parameters
    ----------
    scene, glossy
        The scene, and the material of the hit.
    packet, k
        The hit, and the number of the point.
    stack
        Scratch memory.
    """
    gloss, start = _gloss(scene, glossy, packet), start_of(packet, 0)
    ray = ray_to_point(glossy.looks, glossy.albedos, gloss, start, scene.lights, k)
    return _told(scene, packet, ray, k, 1.0, stack)


@kernel
def tell_lamp(
    scene: SceneArrays,
    glossy: Glossy,
    soft: SoftLights,
    step: Step,
    packet: Packet,
    k: int,
    stack: Stack,
) -> ToldRay:
    """Return the k-th shadow ray from the first hit of a packet to lights that are no points.

    Parameters
    ----------
    scene, glossy, packet, stack
        As for `tell_point`.
    soft, step
        The lights, and how the path chooses among them.
    k
        The number of the ray.
    """
    _, choice = path_point(step, PICK)
    number, factor = picked_lamp(soft, k, choice), soft_count(soft) / picked_count(soft)
    gloss, start = _gloss(scene, glossy, packet), start_of(packet, 0)
    looks, albedos, forward = glossy.looks, glossy.albedos, scene.camera.forward
    ray = ray_to_lamp(looks, albedos, gloss, start, forward, scene.lights, soft, number, step)
    return _told(scene, packet, ray, number, factor, stack)


@device
def _gloss(scene: SceneArrays, glossy: Glossy, packet: Packet) -> Gloss:
    """Return the glossy surface of the first hit of a packet."""
    looks, color = glossy.looks, _own_color(scene, packet)
    look = Look(int(looks.kind[glossy.row]), glossy.row)
    return gloss_at(packet, 0, looks, glossy.albedos, look, scale(1.0 / 255.0, color))


@device
def _told(
    scene: SceneArrays, packet: Packet, ray: GlossRay, light: int, factor: float, stack: Stack
) -> ToldRay:
    """Return a shadow ray from the first hit of a packet, which counts so many times."""
    brings = times(load(packet, THROUGHPUT, 0), scale(factor, ray.light))
    blocker = first_between(scene.world, ray.segment, stack)
    return ToldRay(light, ray.segment.end, brings, blocker)


class Followed(NamedTuple):
    """A ray that went on from a surface, lengths in units of the arrays.

    Attributes
    ----------
    waiting
        The ray, and what was known of it when it began.
    distance
        How far it goes to what it meets; infinite if it meets nothing.
    lamp
        The row of the lamp that it meets, or ``NOTHING``.
    passes
        What is left of its light by the glass through which it goes.
    """

    waiting: Waiting
    distance: float
    lamp: int
    passes: Vec


@kernel
def follow_ray(scene: SceneArrays, looks: Looks, packet: Packet, work: Workspace) -> Followed:
    """Let the one ray that waits go on, and take the first lane if it meets a surface.

    The parameters are those of `leave_hit`.
    """
    lights, pending = scene.lights, work.pending
    waiting = pop_ray(pending, 0)
    push_ray(pending, 0, waiting)
    hit = nearest_hit(scene.world, waiting.ray, work.stack)
    lamp, distance = NOTHING, hit.distance
    if waiting.sees_lights:
        lamp, distance = lamp_beyond(waiting.ray, distance, lights.mirrored)
    passes = (1.0, 1.0, 1.0)
    if waiting.within != EMPTY:
        passes = transmitted(three_numbers(looks, waiting.within, 1), distance)
    follow_rays(packet, 1, scene.world, lights, looks, pending, looks.depth, work, work.unasked)
    return Followed(waiting, distance, lamp, passes)
