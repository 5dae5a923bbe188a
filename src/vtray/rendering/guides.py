"""What surfaces are like in each pixel, which guides a denoiser: colours and normals.

They must be as sharp as the light that they guide. Where pixels have one ray, they are those of the
middle rays. Where pixels have samples, rays on a grid within each of them are weighted by the same
filter.
"""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from vtray.base.pool import run_tasks
from vtray.base.tiles import Tile, split_into_tiles
from vtray.rendering.acceleration import Acceleration
from vtray.rendering.engines.engine import Plan, trace
from vtray.rendering.pack import pack
from vtray.rendering.passes import SURFACES
from vtray.rendering.styled import styled
from vtray.scene.scene import Scene
from vtray.scene.settings import RenderSettings
from vtray.scene.style import Style
from vtray.transport.camera_rays import CameraFrame, turned_by
from vtray.transport.film import Film
from vtray.transport.sampling.filters import FILTERS
from vtray.transport.sampling.pixel_samples import middle_rays
from vtray.transport.scene_arrays import SceneArrays, without_light

Floats = NDArray[np.float64]

GRID = 4
"""Rays across and down a pixel that has samples."""


class Guides(NamedTuple):
    """What surfaces are like, as seen in each pixel.

    Attributes
    ----------
    albedo
        The share of light that they send on, (height, width, 3); 0 where nothing is. Of bodies that
        let light through, all that is seen of each layer counts.
    normals
        Normals in world space of what ids show, shorter where several are mixed, (height, width,
        3).
    cover
        How much of a pixel is covered, (height, width).
    """

    albedo: Floats
    normals: Floats
    cover: Floats


class Guiding:
    """Gives the guides of a picture, when they are asked for.

    Parameters
    ----------
    kept
        The shapes of the scene that was traced.
    settings, style
        How the picture was taken, and how it is drawn.
    threads
        How many threads to use at the most.
    """

    def __init__(
        self, kept: Acceleration, settings: RenderSettings, style: Style, threads: int
    ) -> None:
        self._kept = kept
        self._settings = settings
        self._style = style
        self._threads = threads

    def __call__(self, scene: Scene) -> Guides:
        """Return them for the scene that was traced, maybe in other colours."""
        packed = pack(scene, self._kept.with_colors_of(scene.objects))
        arrays = styled(packed, self._style).arrays
        return find_guides(arrays, self._settings, self._threads)

    def albedo(self, scene: Scene) -> Floats:
        """Return the albedo alone."""
        return self(scene).albedo


def find_guides(scene: SceneArrays, settings: RenderSettings, threads: int) -> Guides:
    """Return the guides of a picture.

    Parameters
    ----------
    scene
        The arrays of the scene.
    settings
        How the picture is taken.
    threads
        How many threads to use at the most.
    """
    camera = scene.camera
    side, weights = _filter(settings)
    fine = without_light(scene._replace(camera=_finer(camera, side)))
    plan = Plan(middle_rays(), SURFACES)
    before = len(weights) // 2
    found = np.empty((camera.height, camera.width, 7))

    def find(tile: Tile) -> None:
        left, top = side * tile.left - before, side * tile.top - before
        right, bottom = side * (tile.right - 1) + before + 1, side * (tile.bottom - 1) + before + 1
        film, _ = trace(fine, plan, Tile(left, top, right, bottom))
        rows = _weighted(_surfaces(film), weights, side)
        columns = _weighted(rows.swapaxes(0, 1), weights, side)
        found[tile.top : tile.bottom, tile.left : tile.right] = columns.swapaxes(0, 1)

    run_tasks(split_into_tiles(camera.width, camera.height), lambda: find, threads)
    # Filters with negative sides go a little beyond.
    return Guides(found[..., :3].clip(0.0, 1.0), found[..., 3:6], found[..., 6].clip(0.0, 1.0))


def _surfaces(film: Film) -> Floats:
    """Return albedo, normal and how much is covered, all 0 for no hit, (height, width, 7)."""
    found = np.empty((*film.primitive.shape, 7))
    found[..., :3] = film.albedo
    found[..., 3:6] = film.normal
    found[..., 6] = film.coverage
    return found


def _filter(settings: RenderSettings) -> tuple[int, Floats]:
    """Return how many rays a pixel has across and down, and what they weigh from side to side."""
    if settings.samples == 1:
        return 1, np.ones(1)
    kernel = FILTERS[settings.filter]
    reach = int(kernel.radius * GRID)
    weights = kernel.value(np.arange(-reach, reach + 1) / GRID)
    weights[[0, -1]] *= 0.5  # of which the half lies within
    return GRID, weights / weights.sum()


def _weighted(rows: Floats, weights: Floats, step: int) -> Floats:
    """Return the weighted means of rows, one for so many steps, without the margins."""
    count = (len(rows) - len(weights)) // step + 1
    total = np.zeros((count, *rows.shape[1:]))
    for k, weight in enumerate(weights):
        total += weight * rows[k : k + step * (count - 1) + 1 : step]
    return total


def _finer(camera: CameraFrame, side: int) -> CameraFrame:
    """Return a camera with the same view, and so many pixels for each across and down."""
    across, down, distance = camera.pixel
    return camera._replace(
        pixel=(across / side, down / side, distance),
        shift=(camera.shift[0] / side, camera.shift[1] / side),
        turn=turned_by(camera.turn, 1.0 / side),
        width=side * camera.width,
        height=side * camera.height,
    )
