"""The layers of one pixel, and what is behind them, ray by ray."""

import numpy as np
from numpy.typing import NDArray

from vtray.base.compiler.compiled import kernel
from vtray.geometry.faded.chords import End
from vtray.geometry.faded.layers import Slot, list_layers
from vtray.geometry.packets.layer_notes import Layers, Walk
from vtray.geometry.packets.packet import NO_PRIMITIVE, split_met
from vtray.geometry.packets.stack import Stack
from vtray.geometry.queries import NOTHING, Hit
from vtray.geometry.world import Faded
from vtray.transport.camera_rays import camera_ray
from vtray.transport.integrators.reference import TracedPixel, light_hit, trace_behind
from vtray.transport.scene_arrays import SceneArrays


@kernel
def list_pixel(
    scene: SceneArrays,
    faded: Faded,
    column: int,
    row: int,
    distance: float,
    primitive: int,
    skipped: int,
    layers: Layers,
    walk: Walk,
    stack: Stack,
) -> int:
    """List the layers of one pixel after so many; return how many there are.

    Parameters
    ----------
    scene, faded
        The scene, and what of it is faded.
    column, row
        The pixel, from the left and from the top.
    distance, primitive
        How far what is behind all layers is along the ray, and its number, or ``NOTHING``.
    skipped
        So many layers before the first that is listed are passed over.
    layers
        Out: they are listed as those of the first lane.
    walk, stack
        Scratch memory.
    """
    number = NO_PRIMITIVE if primitive == NOTHING else primitive
    ray, end = camera_ray(scene.camera, column, row), End(distance, number, 0.0)
    return list_layers(scene.world, faded, ray, end, Slot(layers, 0, skipped), walk, stack)


@kernel
def trace_layer(
    scene: SceneArrays,
    column: int,
    row: int,
    layers: Layers,
    k: int,
    stack: Stack,
    cosines: NDArray[np.float64],
    blockers: NDArray[np.int64],
    walk: Walk,
) -> TracedPixel:
    """Trace the k-th layer that is listed of one pixel; see `trace_pixel` for the parameters."""
    ray = camera_ray(scene.camera, column, row)
    group, slot = split_met(layers.met[k])
    hit = Hit(layers.distance[k], 0.0, int(layers.number[k]), group, slot)
    return light_hit(scene, ray, hit, layers.share[k], stack, cosines, blockers, walk)


@kernel
def trace_dimmed_pixel(
    scene: SceneArrays,
    column: int,
    row: int,
    share: float,
    stack: Stack,
    cosines: NDArray[np.float64],
    blockers: NDArray[np.int64],
    walk: Walk,
) -> TracedPixel:
    """Trace what is behind all layers of one pixel, of which a share is seen.

    The other parameters are those of `reference.trace_pixel`.
    """
    return trace_behind(scene, column, row, share, stack, cosines, blockers, walk)
