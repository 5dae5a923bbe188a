"""Where a ray meets the world: the point and its surface, ready for shading."""

import math
from typing import NamedTuple

from vtray.base.compiler.compiled import device, part, passing_on
from vtray.geometry.dispatch import with_any
from vtray.geometry.packets.coherence import CLUSTER, cluster_hits, list_hits
from vtray.geometry.packets.packet import (
    BEND,
    CAP,
    COLOR,
    CURVED,
    DISTANCE,
    ERROR_SCALE,
    HALF,
    LAMBERT,
    LENGTH,
    MET,
    NORMAL,
    OCTET,
    PLANE_DEPTH,
    POINT,
    PRIMITIVE,
    SECOND,
    SOURCE,
    START,
    TOWARDS,
    VALUE,
    Packet,
    Sheaf,
    integers,
    load,
    load_own_ray,
    load_ray,
    split_met,
    start_apart,
    store,
)
from vtray.geometry.packets.workspace import Workspace
from vtray.geometry.ray import Footprint, Ray, has_width, ray_point
from vtray.geometry.shapes.surface import Surface, bend_at, normal_at
from vtray.geometry.shapes.unrolled import Unrolled, Upright
from vtray.geometry.shapes.verbs import Shape, Verbs
from vtray.geometry.vector import Vec, add, dot, scale, sub
from vtray.geometry.world import Group, World, has_trees, load_group
from vtray.transport.materials.look import Looks
from vtray.transport.materials.material import Material, Materials, load_material, pattern_of
from vtray.transport.materials.pattern import PLAIN, Patterns, pattern_color, upright_of


class Interaction(NamedTuple):
    """A point on a surface.

    Attributes
    ----------
    point
        The place, relative to the centre of the image plane.
    normal
        The surface's unit normal, on the side that the ray came from.
    error_scale
        What the point's rounding error is relative to.
    half
        As in field ``HALF`` of a packet.
    """

    point: Vec
    normal: Vec
    error_scale: float
    half: int


@device
def surface_at(world: World, group: Group, slot: int, point: Vec, error_scale: float) -> Surface:
    """Return the surface of a shape of a group at a point.

    Parameters
    ----------
    world, group, slot
        The shape.
    point
        The point.
    error_scale
        What its rounding error is relative to, beside the shape.
    """
    surface: Surface = with_any(world, group, slot, _surface, (point, error_scale))
    return surface


@device
def _surface(
    shape: Shape,
    verbs: Verbs,
    number: int,  # noqa: ARG001
    arguments: tuple[Vec, float],
) -> Surface:
    """Return the surface of a shape at a point."""
    point, error_scale = arguments
    return verbs.surface(shape, point, error_scale)


@part
def comes_from_within(packet: Packet, hit: int, lane: int, world: World) -> bool:
    """Tell whether a ray meets a surface from within."""
    row, slot = split_met(integers(packet)[MET + lane])
    point, direction = load(packet, POINT, hit), load(packet, TOWARDS, hit)
    surface = surface_at(world, load_group(world, row), slot, point, packet[ERROR_SCALE + hit])
    outward = sub(point, surface.pole) if surface.is_round else surface.pole
    return dot(outward, direction) > 0.0


@device
def interact(world: World, ray: Ray, distance: float, row: int, slot: int) -> Interaction:
    """Return the point where a ray hits a shape of the group in a row."""
    point = ray_point(ray, distance)
    group = load_group(world, row)
    surface = surface_at(world, group, slot, point, ray.error_scale + distance)
    normal = normal_at(surface.pole, surface.is_round, point, ray.direction)
    error_scale = surface.error_scale + ray.error_scale + distance
    return Interaction(point, normal, error_scale, _half_of(surface))


@device
def material_at(
    world: World,
    materials: Materials,
    primitive: int,
    half: int,
    row: int,
    slot: int,
    point: Vec,
) -> Material:
    """Return what a surface is made of at a point, with its pattern.

    Parameters
    ----------
    world, materials
        The scene.
    primitive, half
        What is there, as in fields ``PRIMITIVE`` and ``HALF`` of a packet.
    row, slot
        The row of its group, and its slot there.
    point
        The point.
    """
    own = load_material(materials, primitive, half)
    return _with_pattern(
        world, materials, materials.paints.patterns, own, primitive, half, row, slot, point
    )


@device
def _with_pattern(
    world: World,
    materials: Materials,
    patterns: Patterns | None,
    own: Material,
    primitive: int,
    half: int,
    row: int,
    slot: int,
    point: Vec,
) -> Material:
    # An argument that is None is known to the compiler, which drops what depends on that alone.
    if patterns is not None:
        pattern = pattern_of(materials, patterns, primitive)
        if patterns.kind[pattern] != PLAIN and not half & CAP:
            group, upright = load_group(world, row), upright_of(patterns, pattern)
            place = with_any(world, group, slot, _unroll, (point, upright))
            return Material(pattern_color(patterns, pattern, place, own.color), own.lambert)
    return own


@device
def _unroll(
    shape: Shape,
    verbs: Verbs,
    number: int,  # noqa: ARG001
    arguments: tuple[Vec, Upright],
) -> Unrolled:
    """Return where a point is on the unrolled surface of a shape."""
    point, upright = arguments
    return verbs.unroll(shape, point, upright)


@device
def _has_pattern(materials: Materials, patterns: Patterns | None, primitive: int) -> bool:
    """Tell whether a primitive has a pattern."""
    if patterns is not None:
        return bool(patterns.kind[pattern_of(materials, patterns, primitive)] != PLAIN)
    return False


@device
def _half_of(surface: Surface) -> int:
    """Return what stands for a surface in field ``HALF``."""
    return (SECOND if surface.is_second else 0) | (CAP if surface.is_cap else 0)


@part
@passing_on(Looks)
def gather_interactions(
    packet: Packet,
    lanes: int,
    samples: int,
    sheaf: Sheaf,
    are_own: bool,
    footprint: Footprint,
    world: World,
    materials: Materials,
    forward: Vec,
    middle_depth: float,
    work: Workspace,
) -> int:
    """Bring the hits of a packet together, as interactions with no light yet; return how many.

    Where there are hierarchies, they are in clusters. Field ``SOURCE`` says where each came from.
    Field ``BEND`` is set if the footprint has a width. What rays have in common, in a `sheaf` of
    the camera's type, holds where they do not have all in fields of their own (`are_own`).
    """
    if has_trees(world):
        hits = cluster_hits(packet, lanes, CLUSTER * min(samples, OCTET), work)
    else:
        hits = list_hits(packet, lanes, work)
    for hit in range(hits):
        _fetch(packet, hit, work.order[hit], sheaf, are_own, footprint, world, materials)
    # A loop of its own, only so is it vectorised.
    for hit in range(hits):
        origin = load(packet, START, hit) if start_apart(sheaf) or are_own else sheaf.origin
        direction, length = load(packet, TOWARDS, hit), packet[LENGTH + hit]
        point = add(origin, scale(length, direction))
        is_round = packet[CURVED + hit] > 0.0
        normal = normal_at(load(packet, NORMAL, hit), is_round, point, direction)
        store(packet, POINT, hit, point)
        store(packet, NORMAL, hit, normal)
        packet[ERROR_SCALE + hit] = packet[ERROR_SCALE + hit] + sheaf.error_scale + length
        store(packet, VALUE, hit, (0.0, 0.0, 0.0))
        packet[PLANE_DEPTH + hit] = dot(point, forward) + middle_depth
    return hits


@device
def _fetch(
    packet: Packet,
    hit: int,
    lane: int,
    sheaf: Sheaf,
    are_own: bool,
    footprint: Footprint,
    world: World,
    materials: Materials,
) -> None:
    """Bring together what a hit is made of."""
    numbers = integers(packet)
    row, slot = split_met(numbers[MET + lane])
    ray = load_own_ray(packet, lane) if are_own else load_ray(packet, sheaf, lane)
    distance = packet[DISTANCE + lane]
    point, error_scale = ray_point(ray, distance), ray.error_scale + distance
    surface = surface_at(world, load_group(world, row), slot, point, error_scale)
    store(packet, NORMAL, hit, surface.pole)
    packet[CURVED + hit] = 1.0 if surface.is_round else 0.0
    primitive = numbers[PRIMITIVE + lane]
    if has_width(footprint):
        bend = bend_at(surface, point)
        # Where colours change, no part of a surface is even.
        is_even = not _has_pattern(materials, materials.paints.patterns, primitive)
        packet[BEND + hit] = bend if is_even else math.inf
    # What all rays have in common is added later.
    own = ray.error_scale if are_own else 0.0
    packet[ERROR_SCALE + hit] = surface.error_scale + own
    store(packet, TOWARDS, hit, ray.direction)
    if start_apart(sheaf) or are_own:
        store(packet, START, hit, ray.origin)
    packet[LENGTH + hit] = distance
    half = _half_of(surface)
    numbers[HALF + lane] = half
    material = material_at(world, materials, primitive, half, row, slot, point)
    store(packet, COLOR, hit, material.color)
    packet[LAMBERT + hit] = material.lambert
    numbers[SOURCE + hit] = lane
