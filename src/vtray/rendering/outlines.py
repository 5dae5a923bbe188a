"""Lines around what is seen: which, where, and how much of each pixel they hide."""

from collections.abc import Callable
from typing import Any

import numpy as np
from numpy.typing import NDArray

from vtray.base.compiler.compiled import pinned, uncompiled
from vtray.base.pool import run_tasks
from vtray.base.tiles import TILE, Tile, split_into_tiles
from vtray.geometry.packets.packet import new_packet
from vtray.geometry.packets.workspace import new_workspace
from vtray.image.strokes import draw_strokes, reach_of_strokes
from vtray.rendering.numbering import number_objects
from vtray.rendering.pack import Packed
from vtray.rendering.seam import cut, seam_margin, widened
from vtray.scene.camera import Camera
from vtray.scene.placing.panorama import pixel_angle
from vtray.scene.scene import Scene
from vtray.scene.style import Outline
from vtray.transport.integrators.outlines import (
    STEPS,
    WINDOW,
    Pen,
    Scratch,
    Seen,
    find_crossings,
    find_normals,
    new_crossings,
)
from vtray.transport.scene_arrays import SceneArrays, without_light

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
        What the middle rays see; normals, if any, are found here.
    threads
        How many threads to use at the most.
    """
    reach = uncompiled(reach_of_strokes)(float(outline.width)) + WINDOW + 1
    margin = seam_margin(scene.camera, seen.primitive.shape[1], reach)
    seen = _widened(seen, margin)
    height, width = seen.primitive.shape
    crossings = new_crossings(height, width, has_fog=packed.arrays.fog is not None)
    arrays = pinned(_widened_camera(without_light(packed.arrays), margin))
    fog, pen = pinned(packed.arrays.fog), pinned(_pen_of(outline, scene, packed))
    pixels, found = pinned(seen), pinned(crossings)
    tiles = split_into_tiles(width, height) or [Tile(0, 0, 0, 0)]
    if seen.normal is not None:
        run_tasks(tiles, lambda: lambda tile: find_normals(arrays, pixels, *tile), threads)

    def new_worker() -> Callable[[Tile], None]:
        marks = pinned(np.zeros(TILE, np.bool_))
        scratch, world = None, packed.arrays.world
        if world.faded is not None:
            scratch = pinned(Scratch(new_packet(), new_workspace(world)))

        def find(tile: Tile) -> None:
            find_crossings(arrays, fog, pixels, pen, *tile, found, marks, scratch)

        return find

    run_tasks(tiles, new_worker, threads)
    lines = np.empty((height, width), np.float32)

    def draw(top: int) -> None:
        bottom, points, marks = min(top + TILE, height), np.zeros((5, 4)), np.zeros(width, np.bool_)
        pen_width = float(outline.width)
        draw_strokes(
            seen.primitive, *crossings, STEPS, pen_width, top, bottom, lines, points, marks
        )

    run_tasks(range(0, max(height, 1), TILE), lambda: draw, threads)
    return cut(lines, margin)


def _widened(seen: Seen, margin: int) -> Seen:
    """Return what pixels see with so many columns more on both sides."""
    parts: list[Any] = [part if part is None else widened(part, margin) for part in seen]
    return Seen(*parts)


def _widened_camera(arrays: SceneArrays, margin: int) -> SceneArrays:
    """Return a scene whose picture has so many columns more on both sides."""
    camera = arrays.camera
    return arrays._replace(camera=camera._replace(width=camera.width + 2 * margin))


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
