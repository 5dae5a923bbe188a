"""Light without the grain of its rays."""

import numpy as np
from numpy.typing import NDArray

from vtray.image.denoise import denoise
from vtray.rendering.guides import Guiding
from vtray.scene.scene import Scene

Floats = NDArray[np.float64]


class Denoising:
    """Takes the grain out of the light of a picture.

    Parameters
    ----------
    guiding
        Gives its guides; None where a lens makes surfaces sharper than their light: these would
        lead astray.
    coverage
        How much of each pixel its samples saw covered; None where pixels have one ray.
    threads
        How many threads to use at the most.
    """

    def __init__(self, guiding: Guiding | None, coverage: Floats | None, threads: int) -> None:
        self._guiding = guiding
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
        if self._guiding is None:
            return denoise(light, np.ones_like(light), None, self._threads)
        guides = self._guiding(scene)
        albedo = guides.albedo
        if self._coverage is not None:
            # Guides have samples of their own: at edges, these cover other parts of a pixel.
            none, is_covered = np.zeros_like(guides.cover), guides.cover > 0.0
            parts = np.divide(self._coverage, guides.cover, out=none, where=is_covered)
            albedo = albedo * parts[..., None]
        return denoise(light, albedo, guides.normals, self._threads)

    def shares(self, shares: Floats | None) -> Floats | None:
        """Return how much of each pixel is something, without the grain that a lens gives it.

        Without a lens, only edges have grain, and these stay as they are.

        Parameters
        ----------
        shares
            How much of each is covered, or fog, (height, width); None if that is not known.
        """
        if self._guiding is not None or shares is None:
            return shares
        grey = shares[..., None].repeat(3, axis=2)
        return denoise(grey, np.ones_like(grey), None, self._threads)[..., 0].clip(0.0, 1.0)
