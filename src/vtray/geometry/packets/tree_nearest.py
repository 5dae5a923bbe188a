"""Through a hierarchy with the rays of a part of a packet, as one beam."""

from vtray.base.compiler.compiled import device
from vtray.geometry.bvh.tree import leaf_range
from vtray.geometry.packets.beam import Beam, beam_margin, make_beam
from vtray.geometry.packets.nearest import nearest_slots
from vtray.geometry.packets.packet import Packet, Sheaf
from vtray.geometry.packets.ray_bounds import farthest_of, part_directions, part_starts
from vtray.geometry.packets.stack import push_met
from vtray.geometry.packets.workspace import Workspace
from vtray.geometry.ray import CORNER, Footprint
from vtray.geometry.rounding import MARGIN
from vtray.geometry.vector import add, scale, sub
from vtray.geometry.world import Group, ToBoxes, World


@device
def nearest_in_tree(
    packet: Packet,
    first: int,
    count: int,
    sheaf: Sheaf,
    footprint: Footprint,
    world: World,
    group: Group,
    work: Workspace,
) -> None:
    """Let the shapes of a hierarchy take lanes in which they are nearer, nearest boxes first.

    Parameters
    ----------
    packet, sheaf, footprint
        The rays.
    first, count
        The first of the octets that form the beam, and how many there are.
    world, group
        The shapes.
    work
        Scratch memory.
    """
    bvh, ratio = world.bvh, group.to_boxes.ratio
    beam = _part_beam(first, count, sheaf, footprint, group.to_boxes, work)
    start = -sheaf.depth * ratio * (1.0 - MARGIN)
    far = farthest_of(work.cones, first, count) * ratio
    waiting = push_met(bvh, group.root, beam, start, far, work.stack, 0)
    while waiting > 0:
        waiting -= 1
        if work.stack.enter[waiting] > far:
            continue
        child = work.stack.node[waiting]
        if child >= 0:
            waiting = push_met(bvh, child, beam, start, far, work.stack, waiting)
        else:
            begin, end = leaf_range(child)
            nearest_slots(packet, first, count, sheaf, footprint, world, group, begin, end, work)
            far = farthest_of(work.cones, first, count) * ratio


@device
def _part_beam(
    first: int,
    count: int,
    sheaf: Sheaf,
    footprint: Footprint,
    to_boxes: ToBoxes,
    work: Workspace,
) -> Beam:
    """Return the beam of a part's rays and their footprints."""
    low, high = part_directions(work.cones, first, count)
    near, far = part_starts(work.cones, first, count, sheaf)
    ratio, offset = to_boxes.ratio, to_boxes.offset
    apex = add(scale(ratio, sheaf.origin), offset)
    margin = beam_margin(apex, offset) + MARGIN * sheaf.error_scale * ratio
    margin += CORNER * footprint.width * ratio
    growth = CORNER * footprint.growth
    wider = growth, growth, growth
    start, end = add(scale(ratio, near), offset), add(scale(ratio, far), offset)
    return make_beam(start, end, sub(low, wider), add(high, wider), margin)
