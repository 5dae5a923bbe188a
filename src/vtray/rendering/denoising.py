"""Light without the grain of its rays."""

import numpy as np
from numpy.typing import NDArray

from vtray.image.denoise import denoise
from vtray.rendering.acceleration import Acceleration
from vtray.rendering.guides import find_guides
from vtray.rendering.pack import pack
from vtray.scene.scene import Scene
from vtray.scene.settings import RenderSettings

Floats = NDArray[np.float64]


class Denoising:
    """Takes the grain out of the light of a picture.

    Parameters
    ----------
    kept
        The shapes of the scene that was traced.
    settings
        How the picture was taken.
    coverage
        How much of each pixel its samples saw covered; None where pixels have one ray.
    threads
        How many threads to use at the most.
    """

    def __init__(
        self,
        kept: Acceleration,
        settings: RenderSettings,
        coverage: Floats | None,
        threads: int,
    ) -> None:
        self._kept = kept
        self._settings = settings
        self._coverage = coverage
        self._threads = threads

    def __call__(self, scene: Scene, light: Floats) -> Floats:
        """Return light without grain.

        Parameters
        ----------
        scene
            The scene that was traced, but for its lights and the colours of its objects.
        light
            Its light, (height, width, 3).
        """
        arrays = pack(scene, self._kept.with_colors_of(scene.objects)).arrays
        if arrays.camera.lens is not None and self._settings.samples > 1:
            # Surfaces are sharper than their light, and would lead astray.
            return denoise(light, np.ones_like(light), None, self._threads)
        guides = find_guides(arrays, self._settings, self._threads)
        clean = denoise(light, guides.albedo, guides.normals, self._threads)
        if self._coverage is not None:
            clean[self._coverage == 0.0] = 0.0
        return clean
