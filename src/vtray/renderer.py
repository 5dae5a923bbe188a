"""From a scene to its picture: the steps in their order."""

import os
from collections.abc import Callable
from functools import partial

import numpy as np
from numpy.typing import NDArray

from vtray.acceleration import accelerate
from vtray.compiled import loading_seconds, pinned
from vtray.exposure import check_brightness, develop
from vtray.film import Film, new_film
from vtray.image import Image, Surfaces
from vtray.integrator import trace_tile
from vtray.memory import check_memory
from vtray.packet import new_packet
from vtray.pool import Progress as StepProgress
from vtray.pool import run_tasks
from vtray.sampling import Sampling, middle_rays
from vtray.scene import Scene
from vtray.scene_arrays import SceneArrays, pack
from vtray.settings import RenderSettings
from vtray.stopwatch import Stopwatch
from vtray.tiles import TILE, Tile, split_into_tiles
from vtray.workspace import new_workspace

Progress = Callable[[str, int, int], None]


def render(
    scene: Scene, threads: int | None = None, progress: Progress | None = None, *, tile: int = TILE
) -> Image:
    """Render a scene.

    The picture depends on the scene alone: not on threads, tiles or the machine.

    Parameters
    ----------
    scene
        The scene.
    threads
        How many threads to use, at least 1; None for all cores.
    progress
        Called from time to time with what is being done, ``"build"`` or ``"trace"``, how many of
        its tasks are done, and how many there are.
    tile
        Side of a tile in pixels.

    Returns
    -------
    Image
        The picture.

    Raises
    ------
    SceneError
        The scene holds something that no scene may hold.
    RenderError
        The image does not fit into memory, or its light is too bright for a double.
    ValueError
        `threads` or `tile` is not an integer of at least 1.
    KeyboardInterrupt
        After Ctrl-C; all threads have ended by then.
    """
    threads = _count("threads", threads if threads is not None else available_cores())
    tile = _count("tile", tile)
    scene.check()
    check_memory(*(int(side) for side in scene.camera.size))
    check_brightness(scene.lights)
    clock = Stopwatch()
    loaded = loading_seconds()
    kept = accelerate(scene, threads, _step_of(progress, "build"))
    clock.lap("build")
    loading = loading_seconds() - loaded
    arrays = pack(scene, kept).arrays
    clock.lap("pack")
    compile_kernels(arrays)
    clock.lap("compile")
    width, height = arrays.camera.width, arrays.camera.height
    light = new_film(width, height, "linear")
    step = _step_of(progress, "trace")
    peak, rays = _trace(arrays, middle_rays(), light, threads, tile, step)
    film = light.linear
    clock.lap("trace")
    pixels = _develop(film, peak, threads)
    clock.lap("develop")
    # Kernels are loaded when they are first called; that is no part of the build.
    clock.seconds["build"] -= loading
    clock.seconds["compile"] += loading
    stats = {"rays": rays, "nodes": kept.nodes, "depth": kept.depth, "memory": kept.memory}
    return Image(
        film,
        pixels,
        peak,
        Scene(scene.camera, list(scene.lights), list(scene.objects)),
        RenderSettings(),
        {**clock.seconds, **stats},
        look=_look,
    )


def _look() -> Surfaces:
    raise NotImplementedError


def _step_of(progress: Progress | None, step: str) -> StepProgress | None:
    """Return what shows the progress of one step."""
    return None if progress is None else partial(progress, step)


def available_cores() -> int:
    """Return how many cores this process may use."""
    if hasattr(os, "sched_getaffinity"):
        return len(os.sched_getaffinity(0))
    return os.cpu_count() or 1


def compile_kernels(scene: SceneArrays) -> None:
    """Compile what is needed to render a scene, or load it from disk."""
    film = new_film(0, 0)
    stop = np.zeros(1, np.bool_)
    packet, work = new_packet(), new_workspace(scene)
    trace_tile(scene, middle_rays(), 0, 0, 0, 0, film, packet, work, stop)
    develop(film.linear, 0.0, np.zeros((0, 0, 3), np.uint8))


def _trace(
    scene: SceneArrays,
    sampling: Sampling,
    film: Film,
    threads: int,
    tile: int,
    progress: StepProgress | None,
) -> tuple[float, int]:
    """Trace rays and write to the film; return the largest channel, and how many rays."""
    camera = scene.camera
    stop = np.zeros(1, np.bool_)
    results: list[tuple[float, int]] = []
    world, places, canvas, flag = pinned(scene), pinned(sampling), pinned(film), pinned(stop)

    def new_worker() -> Callable[[Tile], None]:
        packet, work = pinned(new_packet()), pinned(new_workspace(scene))

        def trace(tile: Tile) -> None:
            results.append(trace_tile(world, places, *tile, canvas, packet, work, flag))

        return trace

    def hurry() -> None:
        stop[0] = True

    tiles = split_into_tiles(camera.width, camera.height, tile)
    run_tasks(tiles, new_worker, threads, stop=hurry, progress=progress)
    return max(peak for peak, _ in results), sum(rays for _, rays in results)


def _develop(film: NDArray[np.float64], peak: float, threads: int) -> NDArray[np.uint8]:
    """Return the exposed pixels of a film."""
    pixels = np.empty(film.shape, np.uint8)

    def develop_rows(top: int) -> None:
        rows = slice(top, top + TILE)
        develop(film[rows], peak, pixels[rows])

    run_tasks(range(0, len(film), TILE), lambda: develop_rows, threads)
    return pixels


def _count(name: str, value: int) -> int:
    """Return an argument that must be an integer of at least 1."""
    if isinstance(value, bool) or not isinstance(value, (int, np.integer)) or value < 1:
        message = f"{name}: expected an integer ≥ 1, got {value!r}"
        raise ValueError(message)
    return int(value)
