"""From the arrays of a scene to a film: which rays are cast, tile by tile, in some passes."""

import math
from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from vtray.base.memory import check_memory_of_lights
from vtray.base.pool import Progress
from vtray.base.tiles import TILE, split_into_tiles
from vtray.geometry.ray import Footprint
from vtray.geometry.shapes import cone, cylinder, sphere
from vtray.geometry.world import World
from vtray.image.white import white_of
from vtray.rendering.edge_pixels import edge_pixels
from vtray.rendering.engines.engine import Engine, begin_compiling
from vtray.rendering.engines.threads import Threads
from vtray.rendering.growth import DRAFT_TILE, Growth, draft_camera
from vtray.scene.settings import RenderSettings
from vtray.transport.film import Film, new_film
from vtray.transport.light_buffer import KeptLight, new_kept_light
from vtray.transport.lights.light import noisy_light
from vtray.transport.sampling.fans import (
    Fans,
    Noise,
    fans_of_edges,
    fans_of_middles,
    fans_of_paths,
    fans_of_samples,
    halvings_for,
)
from vtray.transport.sampling.paths import Paths, paths_of
from vtray.transport.sampling.pixel_samples import (
    WIDEST,
    Sampling,
    filter_footprint,
    filter_samples,
    lens_points,
    middle_rays,
)
from vtray.transport.scene_arrays import SceneArrays, with_pinhole

SURFACES = ("distance", "normal", "primitive", "half", "albedo", "coverage")
"""What is recorded of the surfaces that middle rays hit."""

SPARSE = 8
"""Each so many pixels, both ways, tell about how bright a picture will be."""


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
    noise
        How noisy soft light may be, if there is any.
    kept
        What was kept of the rays of each pass; nothing unless asked for.
    samples
        How many rays each pixel has; None where each has one.
    """

    film: Film
    peak: float
    rays: int
    noise: Noise | None = None
    kept: tuple[KeptLight, ...] = ()
    samples: NDArray[np.int32] | None = None


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
    growth
        Collects the light as it grows; None where nobody looks, and there is no draft.
    more
        What else is wanted of a film: of `SURFACES`, for middle rays, or light in ``"orders"``.
    """

    def __init__(
        self,
        scene: SceneArrays,
        threads: int,
        tile: int = TILE,
        progress: Progress | None = None,
        growth: Growth | None = None,
        more: Sequence[str] = (),
    ) -> None:
        self._scene = scene
        self._size = scene.camera.width, scene.camera.height
        self._threads = threads
        self._engine: Engine = Threads(threads)
        self._tile = tile
        self._progress = progress
        self._growth = growth
        self._more = more
        self._passes = 1
        self._done = 0

    def surfaces(self, *wanted: str) -> Film:
        """Return what the middle rays meet: what is wanted of it, all of `SURFACES` for nothing."""
        film = new_film(*self._size, *(wanted or SURFACES))
        return self._trace(middle_rays(), film).film

    def light(self, settings: RenderSettings, white: float | None, *, keep: bool = False) -> Traced:
        """Return the light of all pixels, and their coverage if they have samples.

        Parameters
        ----------
        settings
            How many samples, and which, and how noisy soft light may be.
        white
            The light that becomes 255; None if the light of the picture decides it.
        keep
            Whether to keep what each ray hits and which lights reach it.
        """
        samples, seed = int(settings.samples), int(settings.seed)
        noise = self.noise(settings, white, keep=keep)
        has_edges = has_more_for_edges(settings) and not keep
        # What rays see layer by layer is not kept.
        keep = keep and self._scene.world.faded is None
        first, later = rays_from_surfaces(settings, noise)
        if samples == 1:
            self._scene = with_pinhole(self._scene)
            rays = middle_rays(fans=first.fans, paths=first.paths, seed=seed)
            found = self._middles(rays, keep, *one_ray(self._scene, self._more))
            if settings.background != "black" or self._scene.lights.visible is not None:
                found = found._replace(film=_with_coverage(found.film))
            return found._replace(noise=noise)
        if self._scene.camera.lens is not None:
            return self._through_lens(settings, first, later, keep=keep)._replace(noise=noise)
        self._passes = 2 + has_edges
        footprint = filter_footprint(settings, self._scene.camera)
        thickest = _thickest(self._scene.world)
        fans, paths = first
        middles = middle_rays(
            footprint, thickest, before_samples=True, fans=fans, paths=paths, seed=seed
        )
        found = self._middles(middles, keep, *with_samples(self._scene, self._more))
        film, kept = found.film, found.kept
        marks = film.mixed.copy()  # the film is written anew
        if self._scene.camera.turn is not None and footprint.growth == WIDEST:
            marks.fill(True)  # rays of a pixel may turn away from each other
        if keep:
            kept = (*kept, self._keep(marks, samples))
            film = film._replace(kept=kept[-1])
        sampled = self._trace(filter_samples(settings, marks, later.fans, later.paths), film)
        peak, cast = max(found.peak, sampled.peak), found.rays + sampled.rays
        count = np.where(marks, samples, 1).astype(np.int32)
        traced = Traced(film, peak, cast, noise, kept, count)
        return self._with_edges(settings, white, traced) if has_edges else traced

    def _with_edges(self, settings: RenderSettings, white: float | None, traced: Traced) -> Traced:
        """Trace more samples of the pixels in which edges are sharpest, in place of theirs."""
        film, noise, samples = traced.film, traced.noise, traced.samples
        assert samples is not None  # noqa: S101 - some pixels have several
        if white is None:
            white = white_of(settings, film.linear, peak=traced.peak)
        marks, more = edge_pixels(film, samples > 1, settings, white), int(settings.edge_samples)
        fans = None if noise is None else fans_of_edges(more, int(settings.samples), noise)
        found = self._trace(filter_samples(settings.replace(samples=more), marks, fans), film)
        return traced._replace(
            peak=max(float(film.linear.max(initial=0.0)), 0.0),
            rays=traced.rays + found.rays,
            samples=np.where(marks, more, samples).astype(np.int32),
        )

    def _through_lens(
        self, settings: RenderSettings, first: "SurfaceRays", later: "SurfaceRays", *, keep: bool
    ) -> Traced:
        """Trace the samples of all pixels: none sees one thing only, as far as is known."""
        samples, seed = int(settings.samples), int(settings.seed)
        lens = lens_points(self._scene.camera, samples)
        wanted = with_samples(self._scene, self._more)
        if self._growth is not None:
            fans, paths = first
            rays = middle_rays(before_samples=True, fans=fans, paths=paths, lens=lens, seed=seed)
            self._draft(self._growth, rays, *wanted)
        film = new_film(*self._size, *wanted)
        film.mixed.fill(True)
        marks = film.mixed.copy()
        kept: tuple[KeptLight, ...] = ()
        if keep:
            kept = self._keep(~marks, 1), self._keep(marks, samples)
            film = film._replace(kept=kept[-1])
        sampled = filter_samples(settings, marks, later.fans, later.paths, lens)
        count = np.full(marks.shape, samples, np.int32)
        return self._trace(sampled, film)._replace(kept=kept, samples=count)

    def noise(self, settings: RenderSettings, white: float | None, *, keep: bool) -> Noise | None:
        """Return how noisy soft light may be, if there is any; the parameters are those of `light`.

        Where light is kept to be changed later, it has no say in how many rays are cast: each of n
        lights counts as if it gave one n-th of white.
        """
        soft = self._scene.lights.soft
        if soft is None:
            return None
        if settings.integrator == "path":  # what the samples of a pixel differ by says how noisy
            return self._noise_of_light(math.inf, settings)
        if keep:
            error, halvings = settings.tolerance * len(soft.kind), halvings_for(settings.tolerance)
            return Noise(error, by_light=False, halvings=halvings)
        if white is None:
            white = self._about_white(settings)
        return self._noise_of_light(settings.tolerance * white or math.inf, settings)

    def _noise_of_light(self, error: float, settings: RenderSettings) -> Noise:
        """Return how noisy light may be that is not kept to be changed."""
        are_shared = self._scene.lights.crowd is not None
        tolerance = settings.tolerance
        if not are_shared and math.isfinite(error):
            tolerance = max(tolerance, error / (noisy_light(self._scene.lights) or math.inf))
        return Noise(error, True, are_shared, halvings_for(tolerance))

    def _about_white(self, settings: RenderSettings) -> float:
        """Return the light that becomes white in some pixels, with as few rays as there can be."""
        marks = np.zeros(self._size[::-1], np.bool_)
        marks[SPARSE // 2 :: SPARSE, SPARSE // 2 :: SPARSE] = True
        has_samples = settings.samples > 1
        fans = fans_of_middles(self._noise_of_light(math.inf, settings))
        seed, lens = int(settings.seed), lens_points(self._scene.camera, int(settings.samples))
        rays = middle_rays(before_samples=has_samples, fans=fans, lens=lens, seed=seed)
        film = new_film(
            *self._size, *(with_samples if has_samples else one_ray)(self._scene, self._more)
        )
        tiles = split_into_tiles(*self._size, self._tile)
        cast = self._engine.trace(self._scene, rays._replace(marks=marks), tiles, film, None)
        return white_of(settings, film.linear[marks], peak=cast.peak)

    def _middles(self, sampling: Sampling, keep: bool, *wanted: str) -> Traced:
        """Trace one ray for each pixel."""
        if self._growth is not None:
            self._draft(self._growth, sampling, *wanted)
        film = new_film(*self._size, *wanted)
        if not keep:
            return self._trace(sampling, film)
        kept = self._keep(np.ones(self._size[::-1], np.bool_), 1)
        return self._trace(sampling, film._replace(kept=kept))._replace(kept=(kept,))

    def _draft(self, growth: Growth, sampling: Sampling, *wanted: str) -> None:
        """Trace what is shown of the picture until its own pixels are there."""
        scene = self._scene._replace(camera=draft_camera(self._scene.camera))
        if sampling.footprint is not None:  # none waits for samples
            sampling = sampling._replace(footprint=Footprint(0.0, 0.0))
        width, height = scene.camera.width, scene.camera.height
        film = new_film(width, height, *wanted)
        growth.begin_draft(film, *self._size)
        tell = self._progress_of(len(split_into_tiles(*self._size, self._tile)))

        def nothing_done(_done: int, _total: int) -> None:
            tell(0, 0)

        tiles = split_into_tiles(width, height, DRAFT_TILE)
        self._engine.trace(scene, sampling, tiles, film, nothing_done, growth.add)

    def _keep(self, marks: NDArray[np.bool_], samples: int) -> KeptLight:
        """Return where to keep what the samples of the marked pixels meet."""
        count, components = (
            int(np.count_nonzero(marks)) * samples,
            len(self._scene.lights.intensity),
        )
        check_memory_of_lights(count, components)
        first = np.cumsum(marks, dtype=np.int64).reshape(marks.shape)
        first = np.where(marks, (first - 1) * samples, -1)
        has_fog = self._scene.fog is not None
        return new_kept_light(first, count, components, has_fog=has_fog)

    def _trace(self, sampling: Sampling, film: Film) -> Traced:
        """Cast rays, and write to a film."""
        tiles, done = split_into_tiles(*self._size, self._tile), None
        if self._growth is not None:
            tiles = self._growth.begin(film, tiles, has_samples=sampling.rays > 1)
            done = self._growth.add
        tell = self._progress_of(len(tiles))
        cast = self._engine.trace(self._scene, sampling, tiles, film, tell, done)
        self._done += len(tiles)
        return Traced(film, cast.peak, cast.rays)

    def _progress_of(self, tiles: int) -> Progress:
        """Return what shows the progress of a pass as a part of all passes."""
        before, total = self._done, self._passes * tiles

        def tell(done: int, _total: int) -> None:
            if self._progress is not None:
                self._progress(before + done, total)
            if self._growth is not None:
                self._growth.update(before + done, total)

        return tell


def has_more_for_edges(settings: RenderSettings) -> bool:
    """Tell whether pixels with sharp edges may have more samples than others.

    The light of paths differs by chance: more for those that happen to differ would make it darker.
    """
    return settings.edge_samples > settings.samples > 1 and settings.integrator == "direct"


def depends_on_white(settings: RenderSettings, noise: Noise | None) -> bool:
    """Tell whether it depends on the light that becomes white which rays are cast.

    Parameters
    ----------
    settings, noise
        Those of a picture whose lights are not kept.
    """
    return has_more_for_edges(settings) or (noise is not None and math.isfinite(noise.error))


class SurfaceRays(NamedTuple):
    """Which rays are cast from surfaces."""

    fans: Fans | None
    paths: Paths | None


def rays_from_surfaces(
    settings: RenderSettings, noise: Noise | None
) -> tuple[SurfaceRays, SurfaceRays]:
    """Return which rays are cast from the surfaces that middle rays meet, and that samples do."""
    samples = int(settings.samples)
    if settings.integrator == "path":
        fans = None if noise is None else fans_of_paths(samples, noise)
        paths = SurfaceRays(fans, paths_of(samples))
        return paths, paths
    if noise is None:
        return SurfaceRays(None, None), SurfaceRays(None, None)
    of_samples = fans_of_samples(samples, noise) if samples > 1 else None
    return SurfaceRays(fans_of_middles(noise), None), SurfaceRays(of_samples, None)


def one_ray(scene: SceneArrays, more: Sequence[str] = ()) -> tuple[str, ...]:
    """Return what is wanted of a picture with one ray a pixel."""
    wanted = ["linear", *more]
    if scene.lights.soft is not None:
        wanted.append("error")
    wanted.append("covered" if scene.world.faded is None else "coverage")
    if scene.fog is not None:
        wanted.append("fog")
    return tuple(wanted)


def with_samples(scene: SceneArrays, more: Sequence[str] = ()) -> tuple[str, ...]:
    """Return what is wanted of a picture with samples."""
    fog = () if scene.fog is None else ("fog",)
    return ("linear", "error", "coverage", "mixed", *fog, *more)


def _with_coverage(film: Film) -> Film:
    """Return a film with the coverage by what the middle rays meet, if it has no other."""
    if film.covered is None:
        return film
    return film._replace(coverage=film.covered.astype(float))


def _thickest(world: World) -> float:
    """Return the radius of the thickest solid, in the kernels' space."""
    radii = [world.spheres.data[3 :: sphere.SIZE]]
    solids = world.solids
    if solids.cylinders is not None:
        radii.append(solids.cylinders.data[6 :: cylinder.SIZE])
    if solids.cones is not None:
        radii += [solids.cones.data[6 :: cone.SIZE], solids.cones.data[7 :: cone.SIZE]]
    return max(float(of_kind.max(initial=0.0)) for of_kind in radii) * world.scale


def begin_kernels(scene: SceneArrays, settings: RenderSettings, more: Sequence[str] = ()) -> None:
    """Begin to compile what traces the first pass, before what this process compiles meanwhile.

    The parameters are those of `Tracer` and `Tracer.light`.
    """
    has_samples = settings.samples > 1
    scene = scene if has_samples else with_pinhole(scene)
    soft = scene.lights.soft
    film = new_film(0, 0, *(with_samples if has_samples else one_ray)(scene, more))
    noise = None if soft is None else Noise(math.inf, by_light=True)
    (fans, paths), _ = rays_from_surfaces(settings, noise)
    lens = lens_points(scene.camera, int(settings.samples))
    rays = middle_rays(before_samples=has_samples, fans=fans, paths=paths, lens=lens)
    begin_compiling(film, scene, rays)
