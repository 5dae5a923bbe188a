"""Where lines are drawn around what is seen: between which pixels, and where between their middles.

The middle rays say which pixels see different things. Between two of these, a few rays more halve
again and again the way from middle to middle on which one thing ends and the other begins. So lines
are as smooth as if all pixels had hundreds of rays, and cost a few for each pixel of their length.
"""

from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from vtray.base.compiler.compiled import device, kernel
from vtray.geometry.packets.packet import (
    BLOCK,
    COLUMN,
    DISTANCE,
    LANES,
    LIGHT,
    MET,
    NO_PRIMITIVE,
    PART,
    PRIMITIVE,
    ROW,
    Packet,
    integers,
    load_ray,
    split_met,
)
from vtray.geometry.packets.search import find_nearest
from vtray.geometry.packets.workspace import Workspace
from vtray.geometry.ray import Footprint
from vtray.geometry.vector import Vec, dot
from vtray.transport.camera_rays import cast_rays, sheaf_of
from vtray.transport.fog import FogFrame, fog_share
from vtray.transport.integrators.layered import choose_surfaces
from vtray.transport.interaction import interact
from vtray.transport.scene_arrays import SceneArrays

HALVINGS = 2
"""How often the way from middle to middle is halved: lines are within 1/8 of a pixel."""

WINDOW = 2
"""Pixels to all sides among which those are counted that see the same thing."""

FEW, MANY = 6, 11
"""With no more of them there is no line, and with so many it has its full width: what is as large
as some pixels alone would be all line."""

TAPER = 2.0
"""From the least jump to that with lines of full width, in parts of the least: there they taper."""

BEFORE, AFTER = LIGHT, LIGHT + LANES
"""In the packet: how far what is seen on both sides of a crossing is."""

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


class Seen(NamedTuple):
    """What the middle rays of all pixels see.

    Attributes
    ----------
    primitive
        What they hit, (height, width).
    distance
        How far that is, (height, width).
    normal
        Its normal, (height, width, 3); None where no creases are drawn.
    """

    primitive: NDArray[np.int32]
    distance: NDArray[np.float64]
    normal: Any


class Crossings(NamedTuple):
    """Where lines cross the ways from the middle of each pixel to those right of it and below.

    Attributes
    ----------
    place
        How far from the pixel, from 0 to 1, (2, height, width).
    width
        In parts of the width of lines, from 0, for none, to 1, (2, height, width).
    share
        How much of what is under the line it hides, which fog makes less, (2, height, width).
    """

    place: NDArray[np.float32]
    width: NDArray[np.float32]
    share: NDArray[np.float32]


def new_crossings(height: int, width: int) -> Crossings:
    """Return crossings that no line has yet."""
    return Crossings(*(np.zeros((2, height, width), np.float32) for _ in range(3)))


@kernel
def find_crossings(
    scene: SceneArrays,
    footprint: Footprint | None,
    fog: FogFrame | None,
    seen: Seen,
    pen: Pen,
    left: int,
    top: int,
    right: int,
    bottom: int,
    crossings: Crossings,
    packet: Packet,
    work: Workspace,
    pending: NDArray[np.int64],
) -> None:
    """Find where lines cross the ways that begin at the pixels of a tile.

    Parameters
    ----------
    scene
        The scene, without its lights.
    footprint
        None, or one without width, as the rays of the picture have.
    fog
        What lines fade in, or None.
    seen, pen
        What the middle rays see, and which lines are drawn.
    left, top, right, bottom
        The tile in pixels.
    crossings
        Out: those of the tile.
    packet, work
        Scratch memory of this thread.
    pending
        Likewise, for the ways of a packet, (LANES,).
    """
    count = 0
    for y in range(top, bottom, BLOCK):
        for x in range(left, right, BLOCK):
            for row in range(y, min(y + BLOCK, bottom)):
                for column in range(x, min(x + BLOCK, right)):
                    count = _list_ways(seen, pen, row, column, pending, count)
                    if count > LANES - 2:
                        _settle(
                            scene,
                            footprint,
                            fog,
                            seen,
                            pen,
                            crossings,
                            packet,
                            work,
                            pending,
                            count,
                        )
                        count = 0
    if count > 0:
        _settle(scene, footprint, fog, seen, pen, crossings, packet, work, pending, count)


@device
def _list_ways(
    seen: Seen, pen: Pen, row: int, column: int, pending: NDArray[np.int64], count: int
) -> int:
    """List the ways from a pixel that a line may cross; return how many are listed then."""
    height, width = seen.primitive.shape
    for axis in range(2):
        below, beside = row + axis, column + 1 - axis
        if not (below < height and beside < width):
            continue
        # Most see the same, which need not take a call.
        is_same = seen.primitive[row, column] == seen.primitive[below, beside]
        if is_same and not pen.normals:
            continue
        if _may_differ(seen, seen.normal, pen, row, column, below, beside):
            pending[count] = (row * width + column) * 2 + axis
            count += 1
    return count


@device
def _may_differ(
    seen: Seen,
    normal: Any,  # noqa: ANN401
    pen: Pen,
    row: int,
    column: int,
    below: int,
    beside: int,
) -> bool:
    """Tell whether there may be a line between two pixels."""
    one, two = seen.primitive[row, column], seen.primitive[below, beside]
    if one != two:
        near, far = seen.distance[row, column], seen.distance[below, beside]
        at_row, at_column = (below, beside) if far < near else (row, column)
        near, far = min(near, far), max(near, far)
        may_jump = pen.depth and far - near > 0.5 * (pen.jump + pen.growth * near)
        is_wanted = may_jump or _is_border(pen, one, two)
        if is_wanted and _fullness(seen.primitive, at_row, at_column) > 0.0:
            return True
    return _is_crease(seen, normal, pen, row, column, below, beside)


@device
def _width(
    seen: Seen,
    normal: Any,  # noqa: ANN401
    pen: Pen,
    row: int,
    column: int,
    below: int,
    beside: int,
    near: float,
    far: float,
) -> float:
    """Return the width of a line between two pixels, from 0 to 1.

    Parameters
    ----------
    seen, normal, pen
        What the middle rays see, and which lines are drawn.
    row, column, below, beside
        The two pixels.
    near, far
        The distances to the nearer and the farther side of it.
    """
    one, two = seen.primitive[row, column], seen.primitive[below, beside]
    found = 0.0
    if one != two:
        if _is_border(pen, one, two):
            found = 1.0
        elif pen.depth:
            least = pen.jump + pen.growth * near
            found = min(max((far - near) / least - 1.0, 0.0) / TAPER, 1.0)
        is_second = seen.distance[below, beside] < seen.distance[row, column]
        at_row, at_column = (below, beside) if is_second else (row, column)
        found *= _fullness(seen.primitive, at_row, at_column)
    if found < 1.0 and _is_crease(seen, normal, pen, row, column, below, beside):
        found = 1.0
    return found


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
    for y in range(max(row - WINDOW, 0), min(row + WINDOW + 1, height)):
        for x in range(max(column - WINDOW, 0), min(column + WINDOW + 1, width)):
            count += 1 if primitive[y, x] == own else 0
    return min(max((count - FEW) / (MANY - FEW), 0.0), 1.0)


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
def _settle(
    scene: SceneArrays,
    footprint: Footprint | None,
    fog: FogFrame | None,
    seen: Seen,
    pen: Pen,
    crossings: Crossings,
    packet: Packet,
    work: Workspace,
    pending: NDArray[np.int64],
    count: int,
) -> None:
    """Find where lines cross some ways: halve these, and halve what is left."""
    width, place = seen.primitive.shape[1], crossings.place
    whole = (count + PART - 1) // PART * PART
    for lane in range(count):
        axis, pixel = pending[lane] & 1, pending[lane] >> 1
        row, column = pixel // width, pixel % width
        place[axis, row, column] = 0.5
        packet[BEFORE + lane] = seen.distance[row, column]
        packet[AFTER + lane] = seen.distance[row + axis, column + 1 - axis]
    step, sheaf = 0.25, sheaf_of(scene.camera)
    for _ in range(HALVINGS):
        for lane in range(whole):
            way = pending[min(lane, count - 1)]
            axis, pixel = way & 1, way >> 1
            row, column = pixel // width, pixel % width
            along = float(place[axis, row, column])
            packet[ROW + lane] = row + axis * along
            packet[COLUMN + lane] = column + (1 - axis) * along
        cast_rays(packet, whole, scene.camera)
        find_nearest(packet, whole, PART, sheaf, footprint, scene.world, work)
        choose_surfaces(packet, whole, sheaf, scene.world, scene.world.faded, work)
        for lane in range(count):
            axis, pixel = pending[lane] & 1, pending[lane] >> 1
            row, column = pixel // width, pixel % width
            is_first = _is_first(packet, lane, scene, seen, seen.normal, row, column, axis)
            place[axis, row, column] += step if is_first else -step
            packet[(BEFORE if is_first else AFTER) + lane] = packet[DISTANCE + lane]
        step *= 0.5
    for lane in range(count):
        axis, pixel = pending[lane] & 1, pending[lane] >> 1
        row, column = pixel // width, pixel % width
        near = min(packet[BEFORE + lane], packet[AFTER + lane])
        far = max(packet[BEFORE + lane], packet[AFTER + lane])
        crossings.width[axis, row, column] = _width(
            seen, seen.normal, pen, row, column, row + axis, column + 1 - axis, near, far
        )
        crossings.share[axis, row, column] = _left_by(fog, near)


@device
def _is_first(
    packet: Packet,
    lane: int,
    scene: SceneArrays,
    seen: Seen,
    normal: Any,  # noqa: ANN401
    row: int,
    column: int,
    axis: int,
) -> bool:
    """Tell whether a ray between two pixels sees what the first of them sees."""
    below, beside = row + axis, column + 1 - axis
    one, two = seen.primitive[row, column], seen.primitive[below, beside]
    found = integers(packet)[PRIMITIVE + lane]
    if one == two:
        return normal is not None and _leans_to_first(
            packet, lane, scene, normal, row, column, below, beside
        )
    if seen.distance[row, column] <= seen.distance[below, beside]:
        return bool(found == one)
    return bool(found != two)


@device
def _leans_to_first(
    packet: Packet,
    lane: int,
    scene: SceneArrays,
    normal: NDArray[np.float64],
    row: int,
    column: int,
    below: int,
    beside: int,
) -> bool:
    """Tell whether the normal that a ray finds is nearer to that of the first of two pixels."""
    numbers = integers(packet)
    if numbers[PRIMITIVE + lane] <= NO_PRIMITIVE:
        return False
    group, slot = split_met(numbers[MET + lane])
    ray = load_ray(packet, sheaf_of(scene.camera), lane)
    found = interact(scene.world, ray, packet[DISTANCE + lane], group, slot).normal
    one, two = _normal(normal, row, column), _normal(normal, below, beside)
    return dot(found, one) > dot(found, two)


@device
def _left_by(fog: FogFrame | None, distance: float) -> float:
    """Return how much fog leaves of a line."""
    return 1.0 if fog is None else 1.0 - fog_share(fog, distance)
