"""What points of light add to the hits of a packet."""

import numpy as np
from numpy.typing import NDArray

from vtray.base.compiler.compiled import device, part, passing_on
from vtray.geometry.faded.dimming import dim_points
from vtray.geometry.packets.occlusion import Target, bound_points, find_sides, own_sphere
from vtray.geometry.packets.packet import Packet
from vtray.geometry.packets.patch import judge_patches
from vtray.geometry.packets.search import find_blocked
from vtray.geometry.packets.workspace import Workspace
from vtray.geometry.world import Solids, has_trees
from vtray.transport.light_buffer import keep_cosines
from vtray.transport.lights.light import Points, light_count, light_target, load_power
from vtray.transport.lights.lighting import add_light, find_facing
from vtray.transport.sampling.adaptive import ask_of_light
from vtray.transport.scene_arrays import LitWorld


@part
@passing_on(Solids)
def add_points(
    packet: Packet,
    hits: int,
    points: Points,
    lit: LitWorld,
    is_wide: bool | None,
    cosines: NDArray[np.float64],
    work: Workspace,
    stop: NDArray[np.bool_],
) -> int:
    """Add all points to the hits of a packet; return how many shadow rays were cast.

    Parameters
    ----------
    packet, hits
        The hits.
    points, lit
        The points, and the scene.
    is_wide
        Whether it is asked if pixels look the same everywhere; None where it never is.
    cosines
        Out: those of each light, if they are kept, (components, places), else (0, 0).
    work
        Scratch memory.
    stop
        One flag: no more lights are added soon after another thread sets it.
    """
    rays, world = 0, lit.world
    bounds = bound_points(packet, hits)
    find_sides(packet, hits, world, work)
    own = -1 if has_trees(world) else own_sphere(packet, hits, world)
    for light in range(light_count(points)):
        if stop[0]:
            break
        target = light_target(points, light, is_wide)
        _ask_of_light(packet, hits, target, is_wide)
        facing = find_facing(packet, hits, bounds, target)
        if facing > 0:
            if find_blocked(packet, hits, bounds, own, world, target, work):
                dim_points(packet, hits, world, target, is_wide, work)
                add_light(packet, hits, target, load_power(lit.powers, light))
            _judge_patches(packet, hits, is_wide)
            keep_cosines(packet, hits, target, light, cosines)
            rays += facing
    return rays


@device
def _ask_of_light(packet: Packet, hits: int, target: Target, is_wide: bool | None) -> None:
    """Begin to ask what a light does around the hits of a packet, if that is asked."""
    if is_wide is not None:  # noqa: SIM102 - by itself, it is known to the compiler
        if is_wide:
            ask_of_light(packet, hits, target)


@device
def _judge_patches(packet: Packet, hits: int, is_wide: bool | None) -> None:
    """Tell what a light does around the hits of a packet, if that is asked."""
    if is_wide is not None:  # noqa: SIM102 - by itself, it is known to the compiler
        if is_wide:
            judge_patches(packet, hits)
