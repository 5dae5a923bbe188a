"""From the arrays of a scene to a film: which rays are cast, tile by tile, in one pass or two."""

from collections.abc import Callable
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from vtray.base.memory import check_memory_of_lights
from vtray.base.pool import Progress
from vtray.base.tiles import TILE, Tile, split_into_tiles
from vtray.geometry.shapes import cylinder, sphere
from vtray.geometry.world import World
from vtray.rendering.engines.engine import Engine, trace_to
from vtray.rendering.engines.threads import Threads
from vtray.scene.settings import RenderSettings
from vtray.transport.film import Film, new_film
from vtray.transport.light_buffer import KeptLight, new_kept_light
from vtray.transport.sampling.fans import Fans, fans_of_middles, fans_of_samples
from vtray.transport.sampling.pixel_samples import (
    Sampling,
    filter_footprint,
    filter_samples,
    middle_rays,
)
from vtray.transport.scene_arrays import SceneArrays

ONE_RAY = ("linear",)
"""What is wanted of a picture with one ray a pixel."""

SAMPLES = ("linear", "coverage", "mixed")
"""What is wanted of one with samples."""


class Traced(NamedTuple):
    """What tracing gave.

    Attributes
    ----------
    film
        What was wanted.
    peak
        The largest channel of its light.
    rays
        How many rays were cast.
    kept
        What was kept of the rays of each pass; nothing unless asked for.
    """

    film: Film
    peak: float
    rays: int
    kept: tuple[KeptLight, ...] = ()


class Tracer:
    """Casts the rays of a picture.

    Parameters
    ----------
    scene
        The arrays of the scene.
    threads
        How many threads to use at the most.
    tile
        Side of a tile in pixels.
    progress
        Called from time to time with the tiles done and their number.
    """

    def __init__(
        self,
        scene: SceneArrays,
        threads: int,
        tile: int = TILE,
        progress: Progress | None = None,
    ) -> None:
        self._scene = scene
        self._size = scene.camera.width, scene.camera.height
        self._threads = threads
        self._engine: Engine = Threads(threads)
        self._tile = tile
        self._progress = progress
        self._passes = 1
        self._done = 0

    def surfaces(self) -> Film:
        """Return distance, normal, primitive and half of the middle rays."""
        wanted = new_film(*self._size, "distance", "normal", "primitive", "half")
        return self._trace(middle_rays(), wanted).film

    def light(self, settings: RenderSettings, *, keep: bool = False) -> Traced:
        """Return the light of all pixels, and their coverage if they have samples.

        Parameters
        ----------
        settings
            How many samples, and which.
        keep
            Whether to keep what each ray hits and which lights reach it.
        """
        if settings.samples == 1:
            rays = middle_rays(fans=self._fans(fans_of_middles, 1), seed=int(settings.seed))
            return self._middles(rays, keep, *ONE_RAY)
        self._passes = 2
        footprint = filter_footprint(settings, self._scene.camera)
        samples, seed = int(settings.samples), int(settings.seed)
        fans = self._fans(fans_of_middles, samples)
        thickest = _thickest(self._scene.world)
        middles = middle_rays(footprint, thickest, before_samples=True, fans=fans, seed=seed)
        found = self._middles(middles, keep, *SAMPLES)
        film, kept = found.film, found.kept
        marks = film.mixed.copy()  # the film is written anew
        if keep:
            kept = (*kept, self._keep(marks, samples))
            film = film._replace(kept=kept[-1])
        sampling = filter_samples(settings, marks, self._fans(fans_of_samples, samples))
        sampled = self._trace(sampling, film)
        peak, cast = max(found.peak, sampled.peak), found.rays + sampled.rays
        return Traced(film, peak, cast, kept)

    def _fans(self, make: Callable[[int], Fans], samples: int) -> Fans | None:
        """Return which rays are cast to soft lights, if there are any."""
        return None if self._scene.lights.soft is None else make(samples)

    def _middles(self, sampling: Sampling, keep: bool, *wanted: str) -> Traced:
        """Trace one ray for each pixel."""
        film = new_film(*self._size, *wanted)
        if not keep:
            return self._trace(sampling, film)
        kept = self._keep(np.ones(self._size[::-1], np.bool_), 1)
        return self._trace(sampling, film._replace(kept=kept))._replace(kept=(kept,))

    def _keep(self, marks: NDArray[np.bool_], samples: int) -> KeptLight:
        """Return where to keep what the samples of the marked pixels meet."""
        count, lights = int(np.count_nonzero(marks)) * samples, len(self._scene.lights.intensity)
        check_memory_of_lights(count, lights)
        first = np.cumsum(marks, dtype=np.int64).reshape(marks.shape)
        first = np.where(marks, (first - 1) * samples, -1)
        return new_kept_light(first, count, lights)

    def _trace(self, sampling: Sampling, film: Film) -> Traced:
        """Cast rays, and write to a film."""
        tiles = split_into_tiles(*self._size, self._tile)
        progress = self._progress_of(len(tiles))
        cast = self._engine.trace(self._scene, sampling, tiles, film, progress)
        return Traced(film, cast.peak, cast.rays)

    def _progress_of(self, tiles: int) -> Progress | None:
        """Return what shows the progress of a pass as a part of all passes."""
        tell, before, passes = self._progress, self._done, self._passes
        self._done += tiles
        return tell and (lambda done, _: tell(before + done, passes * tiles))


def _thickest(world: World) -> float:
    """Return the radius of the thickest solid, in the kernels' space."""
    radii = [world.spheres.data[3 :: sphere.SIZE]]
    if world.cylinders is not None:
        radii.append(world.cylinders.data[6 :: cylinder.SIZE])
    return max(float(of_kind.max(initial=0.0)) for of_kind in radii) * world.scale


def compile_kernels(scene: SceneArrays, settings: RenderSettings, *, keep: bool = False) -> None:
    """Compile what is needed to trace a scene, or load it from disk; see `Tracer.light`."""
    has_samples = settings.samples > 1
    film = new_film(0, 0, *(SAMPLES if has_samples else ONE_RAY))
    if keep:
        film = film._replace(kept=new_kept_light(np.zeros((0, 0), np.int64), 0, 0))
    fans = None if scene.lights.soft is None else fans_of_middles(1)
    trace_to(film, scene, middle_rays(before_samples=has_samples, fans=fans), Tile(0, 0, 0, 0))
