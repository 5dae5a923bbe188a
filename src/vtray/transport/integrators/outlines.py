"""Where lines are drawn around what is seen: between which pixels, and where between their middles.

The middle rays say which pixels see different things. Between two of these, a few rays more halve
again and again the way from middle to middle on which one thing ends and the other begins. These
rays are only asked where they meet the two things that are known, for which nothing is searched,
unless there are bodies that let light through. So lines are as smooth as if all pixels had hundreds
of rays, and cost little.
"""

import math
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from vtray.base.compiler.compiled import device, kernel
from vtray.geometry.packets.packet import (
    DISTANCE,
    MET,
    NO_PRIMITIVE,
    PRIMITIVE,
    Packet,
    integers,
    join_met,
    split_met,
    store_ray,
)
from vtray.geometry.packets.workspace import Workspace
from vtray.geometry.queries import NOTHING, Hit, nearer_of, nearest_hit
from vtray.geometry.ray import Ray
from vtray.geometry.vector import Vec, dot
from vtray.geometry.world import World
from vtray.transport.camera_rays import camera_ray, sheaf_of
from vtray.transport.fog import FogFrame, fog_share
from vtray.transport.integrators.layered import choose_surfaces
from vtray.transport.interaction import interact
from vtray.transport.scene_arrays import SceneArrays

HALVINGS = 2
"""How often the way from middle to middle is halved: lines are within 1/8 of a pixel."""

STEPS = 2 << HALVINGS
"""In how many parts the way is then, by which places are written down."""

WINDOW = 2
"""Pixels to all sides among which those are counted that see the same thing."""

FEW, MANY = 6, 11
"""With no more of them there is no line, and with so many it has its full width: what is as large
as some pixels alone would be all line."""

TAPER = 2.0
"""From the least jump to that with lines of full width, in parts of the least: there they taper."""

CREASE = 0.8
SMOOTH = 0.97
"""The cosine of normals across a crease at the most, and of those beside it at the least."""


class Pen(NamedTuple):
    """Which lines are drawn.

    Attributes
    ----------
    borders, depth, normals
        Whether there are lines between primitives of different owners, where distances jump, at
        creases.
    first, owner
        The number of the first primitive of each owner, (n,), and a number for that owner.
    jump, growth
        The least jump of a distance of 0, and by how much it grows with each unit of that.
    """

    borders: bool
    depth: bool
    normals: bool
    first: NDArray[np.int64]
    owner: NDArray[np.int64]
    jump: float
    growth: float


class Scratch(NamedTuple):
    """Scratch memory of a thread."""

    packet: Packet
    work: Workspace


class Seen(NamedTuple):
    """What the middle rays of all pixels see.

    Attributes
    ----------
    primitive
        What they hit, (height, width).
    distance
        How far that is, (height, width).
    met
        Where to find what they hit, as `join_met` says it, (height, width).
    normal
        Its normal, (height, width, 3); None where no creases are drawn.
    """

    primitive: NDArray[np.int32]
    distance: NDArray[np.float64]
    met: NDArray[np.int64]
    normal: Any


class Crossings(NamedTuple):
    """Where lines cross the ways from the middle of each pixel to those right of it and below.

    Attributes
    ----------
    width
        In parts of the width of lines, from 0, for none, to 1, (2, height, width).
    place
        How far from the pixel, in parts of `STEPS`, (2, height, width); of no meaning without line.
    share
        How much of what is under the line it hides, likewise; None where there is no fog.
    """

    width: NDArray[np.float32]
    place: NDArray[np.uint8]
    share: Any


def new_crossings(height: int, width: int, *, has_fog: bool) -> Crossings:
    """Return room for crossings, of no certain content."""
    size = 2, height, width
    share = np.empty(size, np.float32) if has_fog else None
    return Crossings(np.empty(size, np.float32), np.empty(size, np.uint8), share)


@kernel
def find_normals(
    scene: SceneArrays, seen: Seen, left: int, top: int, right: int, bottom: int
) -> None:
    """Write the normals of a tile of what is seen, 0 where nothing is."""
    for row in range(top, bottom):
        for column in range(left, right):
            normal = 0.0, 0.0, 0.0
            if seen.primitive[row, column] > NO_PRIMITIVE:
                ray = camera_ray(scene.camera, column, row)
                group, slot = split_met(seen.met[row, column])
                distance = seen.distance[row, column]
                normal = interact(scene.world, ray, distance, group, slot).normal
            for k in range(3):
                seen.normal[row, column, k] = normal[k]


@kernel
def find_crossings(
    scene: SceneArrays,
    fog: FogFrame | None,
    seen: Seen,
    pen: Pen,
    left: int,
    top: int,
    right: int,
    bottom: int,
    crossings: Crossings,
    marks: NDArray[np.bool_],
    scratch: Scratch | None,
) -> None:
    """Find where lines cross the ways that begin at the pixels of a tile.

    Parameters
    ----------
    scene
        The scene, without its lights.
    fog
        What lines fade in, or None.
    seen, pen
        What the middle rays see, and which lines are drawn.
    left, top, right, bottom
        The tile in pixels.
    crossings
        Out: those of the tile.
    marks
        Scratch memory of this thread, one for each pixel of a row of the tile.
    scratch
        Likewise, for what is seen of faded bodies; None where there are none.
    """
    height, width = seen.primitive.shape
    for row in range(top, bottom):
        _mark_pixels(seen.primitive, pen.normals, row, left, right, marks)
        crossings.width[:, row, left:right] = 0.0
        for column in range(left, right):
            if not marks[column - left]:
                continue
            if column + 1 < width:
                _find_crossing(
                    scene, fog, seen, seen.normal, pen, row, column, 0, crossings, scratch
                )
            if row + 1 < height:
                _find_crossing(
                    scene, fog, seen, seen.normal, pen, row, column, 1, crossings, scratch
                )


@device
def _mark_pixels(
    primitive: NDArray[np.int32],
    are_all: bool,
    row: int,
    left: int,
    right: int,
    marks: NDArray[np.bool_],
) -> None:
    """Mark the pixels of a row of a tile that see another thing than those right of or below them.

    Most do not. If `are_all`, all pixels are marked.
    """
    height, width = primitive.shape
    below = min(row + 1, height - 1)
    for column in range(left, right):
        marks[column - left] = are_all or primitive[row, column] != primitive[below, column]
    for column in range(left, min(right, width - 1)):
        marks[column - left] |= primitive[row, column] != primitive[row, column + 1]


@device
def _find_crossing(
    scene: SceneArrays,
    fog: FogFrame | None,
    seen: Seen,
    normal: Any,  # noqa: ANN401
    pen: Pen,
    row: int,
    column: int,
    axis: int,
    crossings: Crossings,
    scratch: Scratch | None,
) -> None:
    """Find whether and where a line crosses the way from a pixel to that right of it or below."""
    below, beside = row + axis, column + 1 - axis
    fullness = _fullness_between(seen, pen, row, column, below, beside)
    has_crease = _is_crease(seen, normal, pen, row, column, below, beside)
    if not (fullness > 0.0 or has_crease):
        return
    place, before, after = _halve(scene, seen, normal, row, column, axis, scratch)
    near, far = min(before, after), max(before, after)
    one, two = seen.primitive[row, column], seen.primitive[below, beside]
    share = 1.0 if has_crease else fullness * _width(pen, one, two, near, far)
    crossings.place[axis, row, column] = np.uint8(STEPS * place)
    crossings.width[axis, row, column] = share
    _veil(fog, near, row, column, axis, crossings.share)


@device
def _fullness_between(
    seen: Seen, pen: Pen, row: int, column: int, below: int, beside: int
) -> float:
    """Return how wide a line where what two pixels see ends may be, from 0 to 1."""
    one, two = seen.primitive[row, column], seen.primitive[below, beside]
    if one == two:
        return 0.0
    near, far = seen.distance[row, column], seen.distance[below, beside]
    at_row, at_column = (below, beside) if far < near else (row, column)
    near, far = min(near, far), max(near, far)
    may_jump = pen.depth and far - near > 0.5 * (pen.jump + pen.growth * near)
    if may_jump or _is_border(pen, one, two):
        return _fullness(seen.primitive, at_row, at_column)
    return 0.0


@device
def _width(pen: Pen, one: int, two: int, near: float, far: float) -> float:
    """Return the width of a line between two primitives that are so far away, from 0 to 1."""
    if _is_border(pen, one, two):
        return 1.0
    if not pen.depth:
        return 0.0
    least = pen.jump + pen.growth * near
    return min(max((far - near) / least - 1.0, 0.0) / TAPER, 1.0)


@device
def _is_border(pen: Pen, one: int, two: int) -> bool:
    """Tell whether there is a line between two primitives wherever they meet in the picture."""
    if not pen.borders or min(one, two) <= NO_PRIMITIVE:
        return False
    return _owner(pen, one) != _owner(pen, two)


@device
def _owner(pen: Pen, primitive: int) -> int:
    """Return the number of the owner of a primitive; its own where each owns itself."""
    if pen.first.shape[0] == 0:
        return primitive
    low, high = 0, pen.first.shape[0]
    while high - low > 1:
        middle = (low + high) // 2
        if pen.first[middle] <= primitive:
            low = middle
        else:
            high = middle
    owner: int = pen.owner[low]
    return owner


@device
def _fullness(primitive: NDArray[np.int32], row: int, column: int) -> float:
    """Return how wide a line around what a pixel sees may be, from 0 to 1."""
    height, width = primitive.shape
    own, count = primitive[row, column], 0
    top, bottom = max(row - WINDOW, 0), min(row + WINDOW + 1, height)
    left, right = max(column - WINDOW, 0), min(column + WINDOW + 1, width)
    for y in range(top, bottom):
        for x in range(left, right):
            count += 1 if primitive[y, x] == own else 0
    # As many beside the picture as there are in it.
    share: float = (2 * WINDOW + 1) * (2 * WINDOW + 1) / ((bottom - top) * (right - left))
    return min(max((share * count - FEW) / (MANY - FEW), 0.0), 1.0)


@device
def _is_crease(
    seen: Seen,
    normal: Any,  # noqa: ANN401
    pen: Pen,
    row: int,
    column: int,
    below: int,
    beside: int,
) -> bool:
    """Tell whether normals differ across two pixels, and not beside them, if that is asked."""
    if normal is None:
        return False
    return pen.normals and _has_crease(seen, normal, row, column, below, beside)


@device
def _has_crease(
    seen: Seen, normal: NDArray[np.float64], row: int, column: int, below: int, beside: int
) -> bool:
    """Tell whether normals differ across two pixels, and not beside them."""
    height, width = seen.primitive.shape
    down, right = below - row, beside - column
    before_row, before_column = row - down, column - right
    after_row, after_column = below + down, beside + right
    if before_row < 0 or before_column < 0 or after_row >= height or after_column >= width:
        return False
    one, two = _normal(normal, row, column), _normal(normal, below, beside)
    before = _normal(normal, before_row, before_column)
    after = _normal(normal, after_row, after_column)
    return dot(one, two) < CREASE and dot(before, one) > SMOOTH and dot(two, after) > SMOOTH


@device
def _normal(normal: NDArray[np.float64], row: int, column: int) -> Vec:
    return normal[row, column, 0], normal[row, column, 1], normal[row, column, 2]


@device
def _halve(
    scene: SceneArrays,
    seen: Seen,
    normal: Any,  # noqa: ANN401
    row: int,
    column: int,
    axis: int,
    scratch: Scratch | None,
) -> tuple[float, float, float]:
    """Return where a line crosses the way between two pixels, and the distances on both sides."""
    below, beside = row + axis, column + 1 - axis
    before, after = seen.distance[row, column], seen.distance[below, beside]
    is_nearer = before <= after
    place, step = 0.5, 0.25
    for _ in range(HALVINGS):
        ray = camera_ray(scene.camera, column + (1 - axis) * place, row + axis * place)
        hit = _met_by(scene, ray, seen, row, column, below, beside, scratch)
        is_first = _is_first(
            scene.world, ray, hit, seen, normal, is_nearer, row, column, below, beside
        )
        place += step if is_first else -step
        step *= 0.5
        # Where it meets neither, another thing may be seen, which is as far as what is known.
        if hit.primitive != NOTHING and is_first:
            before = hit.distance
        elif hit.primitive != NOTHING:
            after = hit.distance
    return place, before, after


@device
def _met_by(
    scene: SceneArrays,
    ray: Ray,
    seen: Seen,
    row: int,
    column: int,
    below: int,
    beside: int,
    scratch: Scratch | None,
) -> Hit:
    """Return what a ray between two pixels meets: of what both see, or of all in its way."""
    # An argument that is None is known to the compiler, which drops what depends on that alone.
    if scratch is not None:
        return _first_surface(scene, ray, scratch.packet, scratch.work)
    return _nearer_of_both(scene.world, ray, seen, row, column, below, beside)


@device
def _first_surface(scene: SceneArrays, ray: Ray, packet: Packet, work: Workspace) -> Hit:
    """Return the first surface that a ray meets which is opaque enough."""
    world, numbers, sheaf = scene.world, integers(packet), sheaf_of(scene.camera)
    hit = nearest_hit(world, ray, work.stack)
    store_ray(packet, 0, ray)
    packet[DISTANCE] = hit.distance
    numbers[PRIMITIVE], numbers[MET] = hit.primitive, join_met(hit.group, hit.slot)
    choose_surfaces(packet, 1, sheaf, world, world.faded, work)
    group, slot = split_met(numbers[MET])
    return Hit(packet[DISTANCE], hit.power_at, numbers[PRIMITIVE], group, slot)


@device
def _nearer_of_both(
    world: World, ray: Ray, seen: Seen, row: int, column: int, below: int, beside: int
) -> Hit:
    """Return where a ray meets the nearer of what two pixels see."""
    hit = Hit(math.inf, 0.0, NOTHING, 0, 0)
    one, two = seen.primitive[row, column], seen.primitive[below, beside]
    if one > NO_PRIMITIVE:
        group, slot = split_met(seen.met[row, column])
        hit = nearer_of(world, ray, hit, group, slot)
    if two > NO_PRIMITIVE and two != one:
        group, slot = split_met(seen.met[below, beside])
        hit = nearer_of(world, ray, hit, group, slot)
    return hit


@device
def _is_first(
    world: World,
    ray: Ray,
    hit: Hit,
    seen: Seen,
    normal: Any,  # noqa: ANN401
    is_nearer: bool,
    row: int,
    column: int,
    below: int,
    beside: int,
) -> bool:
    """Tell whether a ray between two pixels sees what the first of them sees.

    Parameters
    ----------
    world
        What there is.
    ray, hit
        The ray, and where it meets what both see.
    seen, normal
        What they see.
    is_nearer
        Whether the first is nearer, which then ends there; else the second begins there.
    row, column, below, beside
        The two pixels.
    """
    one, two = seen.primitive[row, column], seen.primitive[below, beside]
    if one == two:
        return normal is not None and _leans_to_first(
            world, ray, hit, normal, row, column, below, beside
        )
    return bool(hit.primitive == one) if is_nearer else bool(hit.primitive != two)


@device
def _leans_to_first(
    world: World,
    ray: Ray,
    hit: Hit,
    normal: NDArray[np.float64],
    row: int,
    column: int,
    below: int,
    beside: int,
) -> bool:
    """Tell whether the normal that a ray finds is nearer to that of the first of two pixels."""
    if hit.primitive == NOTHING:
        return False
    found = interact(world, ray, hit.distance, hit.group, hit.slot).normal
    one, two = _normal(normal, row, column), _normal(normal, below, beside)
    return dot(found, one) > dot(found, two)


@device
def _veil(
    fog: FogFrame | None,
    distance: float,
    row: int,
    column: int,
    axis: int,
    share: Any,  # noqa: ANN401
) -> None:
    """Write how much fog leaves of a line."""
    # Arguments that are None are known to the compiler, which drops what depends on that alone.
    if fog is not None:
        share[axis, row, column] = 1.0 - fog_share(fog, distance)
