"""Lines around what is seen: which, where, and how much of each pixel they hide."""

from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray

from vtray.base.pool import run_tasks
from vtray.base.tiles import TILE, Tile, split_into_tiles
from vtray.geometry.packets.packet import LANES, new_packet
from vtray.geometry.packets.workspace import new_workspace
from vtray.geometry.ray import Footprint
from vtray.image.strokes import draw_strokes
from vtray.rendering.numbering import number_objects
from vtray.rendering.pack import Packed
from vtray.scene.camera import Camera
from vtray.scene.placing.panorama import pixel_angle
from vtray.scene.scene import Scene
from vtray.scene.style import Outline
from vtray.transport.integrators.outlines import Pen, Seen, find_crossings, new_crossings
from vtray.transport.scene_arrays import without_light

JUMP = 0.01
"""The least jump of distance that has a line, in parts of the larger side of what the picture shows
at that distance."""


def pixel_size(camera: Camera, packed: Packed) -> tuple[float, float]:
    """Return the larger side of a pixel as kernels count: at a distance of 0, and its growth."""
    if camera.projection == "panorama":
        return 0.0, pixel_angle(camera)
    side = max(map(float, camera.resolution))
    if camera.projection == "orthographic":
        return side / packed.unit, 0.0
    growth = side / camera.focus
    return growth * (packed.before / packed.unit), growth


def draw_outlines(
    outline: Outline,
    scene: Scene,
    packed: Packed,
    seen: Seen,
    *,
    has_samples: bool,
    threads: int,
) -> NDArray[np.float32]:
    """Return how much of each pixel lines hide, from 0 to 1, (height, width).

    Parameters
    ----------
    outline
        Which lines are drawn, and how wide.
    scene, packed
        The scene, and its arrays.
    seen
        What the middle rays see.
    has_samples
        Whether pixels have samples, so that the same kernels are used.
    threads
        How many threads to use at the most.
    """
    height, width = seen.primitive.shape
    fog, arrays = packed.arrays.fog, without_light(packed.arrays)
    pen, crossings = _pen_of(outline, scene, packed), new_crossings(height, width)
    footprint = Footprint(0.0, 0.0) if has_samples else None

    def new_worker() -> Callable[[Tile], None]:
        scratch = new_packet(), new_workspace(arrays.world), np.zeros(LANES, np.int64)

        def find(tile: Tile) -> None:
            find_crossings(arrays, footprint, fog, seen, pen, *tile, crossings, *scratch)

        return find

    run_tasks(split_into_tiles(width, height) or [Tile(0, 0, 0, 0)], new_worker, threads)
    lines = np.zeros((height, width), np.float32)

    def draw(top: int) -> None:
        bottom, points = min(top + TILE, height), np.zeros((5, 4))
        draw_strokes(seen.primitive, *crossings, float(outline.width), top, bottom, lines, points)

    run_tasks(range(0, max(height, 1), TILE), lambda: draw, threads)
    return lines


def _pen_of(outline: Outline, scene: Scene, packed: Packed) -> Pen:
    """Return which lines are drawn, as kernels see it."""
    side = JUMP * max(map(int, scene.camera.size))
    size, growth = pixel_size(scene.camera, packed)
    first = owner = np.zeros(0, np.int64)
    if outline.borders == "objects":
        numbering = number_objects(scene.objects)
        first, owner = np.ascontiguousarray(numbering.first), np.ascontiguousarray(numbering.place)
    return Pen(
        outline.borders != "none",
        outline.depth,
        outline.normals,
        first,
        owner,
        side * size,
        side * growth,
    )
