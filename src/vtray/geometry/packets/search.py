"""What the rays of a packet meet, and what hides a light from its points, group by group."""

from vtray.base.compiler.compiled import device, part, passing_on
from vtray.geometry.packets.nearest import clear_hits, find_starts, nearest_planes, nearest_slots
from vtray.geometry.packets.occlusion import (
    Bounds,
    Target,
    block_by_few,
    block_by_planes,
    box_of,
    widened_box,
)
from vtray.geometry.packets.packet import OCTET, Packet, Sheaf
from vtray.geometry.packets.ray_bounds import find_cones, find_farthest
from vtray.geometry.packets.tree_nearest import nearest_in_group, nearest_placed
from vtray.geometry.packets.tree_occlusion import block_by_placed, block_in_group
from vtray.geometry.packets.workspace import Workspace
from vtray.geometry.ray import Footprint
from vtray.geometry.world import NO_TREE, PLANE, Places, Solids, World, group_count, load_group


@part
@passing_on(Solids)
def find_nearest(
    packet: Packet,
    lanes: int,
    beam: int,
    sheaf: Sheaf,
    footprint: Footprint | None,
    world: World,
    work: Workspace,
) -> None:
    """Find each lane's nearest hit; planes first, so that less of the hierarchies is searched.

    Parameters
    ----------
    packet, lanes
        The rays of so many lanes, whole parts of a packet.
    beam
        Lanes that go through a hierarchy as one beam.
    sheaf, footprint
        What the rays have in common.
    world
        What they can meet.
    work
        Scratch memory.
    """
    find_cones(packet, lanes, sheaf, work.cones)
    clear_hits(packet, lanes)
    find_starts(packet, lanes, sheaf, footprint, work.cones)
    for row in range(group_count(world)):
        group = load_group(world, row)
        if group.kind == PLANE:
            nearest_planes(packet, lanes, sheaf, footprint, world, group)
            continue
        find_farthest(packet, 0, lanes // OCTET, footprint, work.cones)
        for first in range(0, lanes, beam):
            octet, count = first // OCTET, min(beam, lanes - first) // OCTET
            if group.root == NO_TREE:
                begin, end = group.begin, group.end
                nearest_slots(
                    packet,
                    octet,
                    count,
                    sheaf,
                    footprint,
                    world.solids,
                    group,
                    begin,
                    end,
                    work.cones,
                )
            else:
                nearest_in_group(packet, octet, count, sheaf, footprint, world, group, work, 0)
    _find_nearest_placed(packet, lanes, beam, sheaf, footprint, world, world.places, work)


@device
def _find_nearest_placed(
    packet: Packet,
    lanes: int,
    beam: int,
    sheaf: Sheaf,
    footprint: Footprint | None,
    world: World,
    places: Places | None,
    work: Workspace,
) -> None:
    """Find what is nearer among what is placed, if anything is."""
    # An argument that is None is known to the compiler, which drops what depends on that alone.
    if places is not None:
        find_farthest(packet, 0, lanes // OCTET, footprint, work.cones)
        for first in range(0, lanes, beam):
            octet, count = first // OCTET, min(beam, lanes - first) // OCTET
            nearest_placed(packet, octet, count, sheaf, footprint, world, places, work)


@part
@passing_on(Solids)
def find_blocked(
    packet: Packet,
    hits: int,
    bounds: Bounds,
    own: int,
    world: World,
    target: Target,
    work: Workspace,
) -> bool:
    """Mark in field ``BLOCKED`` the points that a light does not reach; tell if any may be left.

    Other shapes are not looked at where planes leave none. `own` is that of `block_by_few`.
    """
    for row in range(group_count(world)):
        group = load_group(world, row)
        if group.kind == PLANE:
            if not block_by_planes(packet, hits, bounds, world, group, target, work):
                return False
        elif group.root == NO_TREE:
            box = widened_box(packet, hits, box_of(bounds), target.is_wide)
            block_by_few(packet, hits, box, own, world.solids, group, target, work.near)
        else:
            block_in_group(packet, world, group, target, work)
    _find_blocked_by_placed(packet, world, world.places, target, work)
    return True


@device
def _find_blocked_by_placed(
    packet: Packet, world: World, places: Places | None, target: Target, work: Workspace
) -> None:
    """Mark the points that something that is placed hides from a light."""
    if places is not None:
        block_by_placed(packet, world, places, target, work)
