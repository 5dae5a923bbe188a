"""One pixel, traced plainly: every object tested, nothing left out by a hierarchy."""

from typing import Any

import numpy as np
from numpy.typing import NDArray

from vtray.base.compiler.compiled import pinned
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
    if _last[0] is not scene:  # many pixels of one scene follow each other
        _last[:] = scene, _pinned_without_hierarchy(scene)
    return reference.trace_pixel(_last[1], column, row, new_stack(), cosines, blockers, new_walk(0))


_last: list[Any] = [None, None]
"""The scene of the last pixel, and what kernels take for it."""


def _pinned_without_hierarchy(scene: SceneArrays) -> SceneArrays:
    """Return a scene in which nothing has a hierarchy."""
    world = scene.world
    groups = world.groups._replace(root=np.full_like(world.groups.root, NO_TREE))
    places = world.places and world.places._replace(root=NO_TREE)
    return pinned(scene._replace(world=world._replace(groups=groups, places=places)))
