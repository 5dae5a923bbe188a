"""One pixel, traced plainly: every object tested, nothing left out by a hierarchy."""

import numpy as np
from numpy.typing import NDArray

from vtray.geometry.packets.layer_notes import new_walk
from vtray.geometry.packets.stack import new_stack
from vtray.geometry.queries import NOTHING
from vtray.geometry.world import NO_TREE
from vtray.transport.integrators import reference
from vtray.transport.scene_arrays import SceneArrays

__all__ = ["NOTHING", "trace_pixel"]


def trace_pixel(
    scene: SceneArrays,
    column: int,
    row: int,
    cosines: NDArray[np.float64],
    blockers: NDArray[np.int64],
) -> reference.TracedPixel:
    """Trace one pixel of a scene as if nothing had a hierarchy."""
    world = scene.world
    groups = world.groups._replace(root=np.full_like(world.groups.root, NO_TREE))
    places = world.places and world.places._replace(root=NO_TREE)
    plain = scene._replace(world=world._replace(groups=groups, places=places))
    return reference.trace_pixel(plain, column, row, new_stack(), cosines, blockers, new_walk(0))
