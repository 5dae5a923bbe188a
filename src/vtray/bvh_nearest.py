"""Through the hierarchy with camera rays: those of 8 by 8 pixels, one beam from the eye."""

import math

import numpy as np

from vtray.beam import Beam, beam_margin, children_met, enter_child, make_beam
from vtray.bvh import WIDTH, Bvh, leaf_range
from vtray.camera import CameraFrame, left_side, top_side
from vtray.compiled import device
from vtray.culling import MARGIN, outside_side
from vtray.nearest import nearest_sphere
from vtray.packet import BLOCK, DIRECTION, DISTANCE, LANES, PART, Block, Packet, load
from vtray.scene_arrays import SceneArrays
from vtray.sphere_arrays import sphere_center, sphere_magnitude, sphere_radius
from vtray.vector import Vec, add, dot, lower, scale, sub, upper
from vtray.workspace import Workspace


@device
def nearest_in_bvh(packet: Packet, block: Block, scene: SceneArrays, work: Workspace) -> None:
    """Let the spheres take the lanes in which they are nearer than the hits so far."""
    for top in range(0, BLOCK, PART):
        for left in range(0, BLOCK, PART):
            _search_part(packet, block, left, top, scene, work)


@device
def _search_part(
    packet: Packet, block: Block, left: int, top: int, scene: SceneArrays, work: Workspace
) -> None:
    """Search the hierarchy for a part of a block, nearest boxes first."""
    bvh, ratio = scene.bvh, scene.to_boxes.ratio
    first = top * BLOCK + left
    sides = _part_sides(scene.camera, block.left + left)
    beam = _part_beam(packet, first, scene)
    _set_rows(scene.camera, block.top + top, work)
    start = scene.camera.focus * ratio * (1.0 - MARGIN)
    far = _farthest(packet, first) * ratio
    waiting = _push_met(bvh, 0, beam, start, far, work, 0)
    while waiting > 0:
        waiting -= 1
        if work.stack_enter[waiting] > far:
            continue
        child = work.stack[waiting]
        if child >= 0:
            waiting = _push_met(bvh, child, beam, start, far, work, waiting)
        else:
            begin, end = leaf_range(child)
            for slot in range(begin, end):
                _test_sphere(packet, first, sides, scene, slot, work)
            far = _farthest(packet, first) * ratio


@device
def _part_beam(packet: Packet, first: int, scene: SceneArrays) -> Beam:
    """Return the beam of a part's rays."""
    # Infinite at first, so that a direction that is not a number, which hits nothing, is no bound.
    low = math.inf, math.inf, math.inf
    high = -math.inf, -math.inf, -math.inf
    for row in range(PART):
        for lane in range(first + row * BLOCK, first + row * BLOCK + PART):
            direction = load(packet, DIRECTION, lane)
            low, high = lower(low, direction), upper(high, direction)
    camera, ratio, offset = scene.camera, scene.to_boxes.ratio, scene.to_boxes.offset
    apex = add(scale(ratio, camera.eye), offset)
    return make_beam(apex, low, high, beam_margin(apex, offset) + MARGIN * camera.focus * ratio)


@device
def _part_sides(camera: CameraFrame, column: int) -> tuple[Vec, Vec]:
    """Return the normals, pointing out, of the left and the right side of a part."""
    return left_side(camera, column), scale(-1.0, left_side(camera, column + PART - 1))


@device
def _set_rows(camera: CameraFrame, top: int, work: Workspace) -> None:
    """Note the normal of the plane in which the rays of each row lie, and its square."""
    for row in range(PART):
        normal = top_side(camera, top + row)
        work.rows[row] = normal[0]
        work.rows[row + PART] = normal[1]
        work.rows[row + 2 * PART] = normal[2]
        work.rows[row + 3 * PART] = dot(normal, normal)


@device
def _test_sphere(
    packet: Packet,
    first: int,
    sides: tuple[Vec, Vec],
    scene: SceneArrays,
    slot: int,
    work: Workspace,
) -> None:
    """Test a sphere for those rows of a part that it reaches."""
    camera, spheres = scene.camera, scene.spheres
    place, radius = sphere_center(spheres, slot), sphere_radius(spheres, slot)
    radius += MARGIN * (sphere_magnitude(place, radius) + camera.focus)
    center = sub(place, camera.eye)
    if outside_side(center, sides[0], radius) | outside_side(center, sides[1], radius):
        return
    rows = _rows_met(center, radius, work)
    lane = first
    while rows > 0:
        if rows & 1:
            nearest_sphere(packet, lane, camera, spheres, slot)
        rows >>= 1
        lane += BLOCK


@device
def _rows_met(center: Vec, radius: float, work: Workspace) -> int:
    """Return a bit for each row whose plane a sphere reaches."""
    met = 0
    for row in range(PART):
        normal = work.rows[row], work.rows[row + PART], work.rows[row + 2 * PART]
        distance = dot(center, normal)
        outside = distance * distance > radius * radius * work.rows[row + 3 * PART]
        met |= 0 if outside else 1 << row
    return met


@device
def _farthest(packet: Packet, first: int) -> float:
    """Return the largest distance of the hits so far in a part of a block."""
    # Doubles ≥ 0 are in the order of their bits, and a maximum of integers can be vectorised.
    bits = packet.view(np.int64)
    far = 0
    begin = first & (LANES - 1)
    for row in range(PART):
        for lane in range(begin + row * BLOCK, begin + row * BLOCK + PART):
            far = max(far, bits[DISTANCE + lane])
    largest: float = np.int64(far).view(np.float64)
    return largest


@device
def _push_met(
    bvh: Bvh, node: int, beam: Beam, start: float, end: float, work: Workspace, base: int
) -> int:
    """Push the children that a beam may meet, the nearest last; return the stack's new height."""
    met = children_met(bvh, node, beam, start, end)
    stack, enters = work.stack, work.stack_enter
    child = node * WIDTH
    top = base
    while met > 0:
        if met & 1:
            enter = enter_child(bvh, child, beam)
            place = top
            while place > base and enters[place - 1] < enter:
                enters[place] = enters[place - 1]
                stack[place] = stack[place - 1]
                place -= 1
            enters[place] = enter
            stack[place] = bvh.child[child]
            top += 1
        met >>= 1
        child += 1
    return top
