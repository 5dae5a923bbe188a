"""Through the hierarchy with camera rays: those of a part of a packet, as one beam."""

from vtray.base.compiler.compiled import device
from vtray.geometry.bvh.tree import WIDTH, Bvh, leaf_range
from vtray.geometry.packets.beam import Beam, beam_margin, children_met, enter_child, make_beam
from vtray.geometry.packets.nearest import test_sphere
from vtray.geometry.packets.packet import GROUP, Packet
from vtray.geometry.packets.ray_bounds import Footprint, farthest_of, part_directions, part_starts
from vtray.geometry.packets.shaft import MARGIN
from vtray.geometry.packets.workspace import Workspace
from vtray.geometry.vector import add, scale, sub
from vtray.geometry.world import SceneArrays


@device
def nearest_in_bvh(
    packet: Packet,
    lanes: int,
    part: int,
    scene: SceneArrays,
    footprint: Footprint,
    work: Workspace,
) -> None:
    """Let the spheres take the lanes in which they are nearer than the hits so far."""
    for first in range(0, lanes, part):
        _search_part(packet, first, min(part, lanes - first), scene, footprint, work)


@device
def _search_part(
    packet: Packet,
    first: int,
    lanes: int,
    scene: SceneArrays,
    footprint: Footprint,
    work: Workspace,
) -> None:
    """Search the hierarchy for a part of a packet, nearest boxes first."""
    bvh, ratio = scene.bvh, scene.to_boxes.ratio
    group, groups = first // GROUP, lanes // GROUP
    beam = _part_beam(group, groups, scene, footprint, work)
    start = scene.camera.focus * ratio * (1.0 - MARGIN)
    far = farthest_of(work.cones, group, groups) * ratio
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
                test_sphere(
                    packet,
                    group,
                    groups,
                    scene.camera,
                    scene.spheres,
                    slot,
                    work.cones,
                    footprint,
                )
            far = farthest_of(work.cones, group, groups) * ratio


@device
def _part_beam(
    first: int, count: int, scene: SceneArrays, footprint: Footprint, work: Workspace
) -> Beam:
    """Return the beam of a part's rays and their footprints."""
    low, high = part_directions(work.cones, first, count)
    near, far = part_starts(work.cones, first, count)
    camera, ratio, offset = scene.camera, scene.to_boxes.ratio, scene.to_boxes.offset
    apex = add(scale(ratio, camera.eye), offset)
    margin = beam_margin(apex, offset) + MARGIN * (camera.extent + camera.focus) * ratio
    margin += footprint.width * ratio
    wider = footprint.growth, footprint.growth, footprint.growth
    start, end = add(apex, scale(ratio, near)), add(apex, scale(ratio, far))
    return make_beam(start, end, sub(low, wider), add(high, wider), margin)


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
