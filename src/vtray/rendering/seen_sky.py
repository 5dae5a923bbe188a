"""The skies of a scene as its camera sees them, behind all that there is."""

import numpy as np
from numpy.typing import NDArray

from vtray.base.errors import RenderError
from vtray.base.pool import run_tasks
from vtray.base.tiles import TILE
from vtray.geometry.packets.packet import LANES, new_packet
from vtray.rendering.pack_skies import changes_color, pack_skies, up_of
from vtray.scene.colors.color_light import light_of
from vtray.scene.light_types import AnyLight, Sky
from vtray.scene.scene import Scene
from vtray.scene.settings import RenderSettings
from vtray.transport.backdrop import see_sky
from vtray.transport.camera_rays import CameraFrame
from vtray.transport.sampling.pixel_samples import (
    Sampling,
    filter_samples,
    lens_points,
    middle_rays,
)

Floats = NDArray[np.float64]

NO_MARKS = np.zeros((0, 0), np.bool_)


def check_sky(lights: list[AnyLight], settings: RenderSettings) -> None:
    """Raise RenderError if the sky shall be the background, and there is none."""
    if settings.background == "sky" and not _skies_of(lights):
        message = 'background: "sky" shows the skies among the lights, and there are none; add one'
        raise RenderError(f"{message} by scene.add_sky, or choose another background")


class SeenSky:
    """Gives the light of skies behind a scene.

    Parameters
    ----------
    camera
        The camera as kernels see it.
    settings
        How many samples a pixel has, and which.
    threads
        How many threads to use at the most.
    """

    def __init__(self, camera: CameraFrame, settings: RenderSettings, threads: int) -> None:
        many = settings.samples > 1
        self._camera = camera if many else camera._replace(lens=None)
        self._is_seen = settings.background == "sky"
        self._threads = threads
        lens = lens_points(camera, int(settings.samples))
        self._sampling: Sampling = (
            filter_samples(settings, NO_MARKS, None, lens=lens) if many else middle_rays()
        )

    def __call__(self, scene: Scene, cover: Floats) -> Floats:
        """Return the light of all skies as the pixels see them, (height, width, 3).

        Parameters
        ----------
        scene
            The scene, from whose lights the skies are taken.
        cover
            How much of each pixel is covered, (height, width); where all is, there is no light.
        """
        seen = np.zeros((*cover.shape, 3))
        for sky in _skies_of(scene.lights):
            color = np.array(light_of(sky.color, scene.render.tonemap)) * sky.radiance
            if changes_color(sky):
                seen += color * self._look_at(sky, scene, cover)
            else:
                seen += color * (cover < 1.0)[..., None]
        return seen

    def warm_up(self, scene: Scene) -> None:
        """Load the kernel, or compile it, if the sky is the background."""
        if self._is_seen:
            self(scene, np.zeros((0, 0)))

    def _look_at(self, sky: Sky, scene: Scene, cover: Floats) -> Floats:
        """Return the light of one sky of many colours, 1 for its radiance."""
        seen = np.zeros((*cover.shape, 3))
        skies = pack_skies([sky], up_of(scene.camera), scene.render.tonemap)

        def look(top: int) -> None:
            scratch = new_packet(), np.zeros(LANES, np.int64)
            bottom = min(top + TILE, len(cover))
            see_sky(self._camera, skies, 0, self._sampling, cover, top, bottom, *scratch, seen)

        run_tasks(range(0, max(len(cover), 1), TILE), lambda: look, self._threads)
        return seen


def _skies_of(lights: list[AnyLight]) -> list[Sky]:
    """Return the skies among lights."""
    return [light for light in lights if isinstance(light, Sky)]
