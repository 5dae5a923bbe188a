"""From light to pictures: what all pictures of a render have in common, parts of it too."""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from vtray.image.image import Image
from vtray.image.orders import Orders
from vtray.image.rendered import GivesStarlight, GivesSurfaces
from vtray.image.white import white_of
from vtray.rendering.growth import Part
from vtray.scene.scene import Scene
from vtray.scene.settings import RenderSettings
from vtray.scene.style import Style
from vtray.transport.sampling.fans import Noise

Floats = NDArray[np.float64]
Shares = NDArray[np.float32]


@dataclass(frozen=True)
class Darkroom:
    """Makes pictures of light.

    Attributes
    ----------
    scene
        The scene as it is rendered.
    original
        The scene with its camera as it was given.
    settings
        The settings.
    style
        How pictures are drawn, beside their light.
    look, albedo, orders
        Give what the middle rays meet, what share of light the surfaces of a scene send on, and how
        often they have scattered that of the picture.
    sky
        Gives the light of the skies of a scene where its pixels are not covered.
    starlight
        Gives the light of the points that shine in a scene, if there are any.
    lock
        A picture whose exposure is taken, or None.
    keep_lights
        Whether lights are kept.
    threads
        How many threads to use at the most.
    """

    scene: Scene
    original: Scene
    settings: RenderSettings
    style: Style
    look: GivesSurfaces
    albedo: Callable[[Scene], Floats]
    orders: Callable[[Scene], Orders]
    sky: Callable[[Scene, Floats], Floats]
    starlight: GivesStarlight
    lock: object
    keep_lights: bool
    threads: int

    def part(self, part: Part) -> Image:
        """Return the picture of what there is so far."""
        peak = max(float(part.linear.max()), 0.0)
        return self.picture(part.linear, part.coverage, peak, fog=part.fog, partial=part.done)

    def picture(
        self,
        linear: Floats,
        coverage: Floats | None,
        peak: float,
        *,
        fog: Floats | None = None,
        lines: Shares | None = None,
        shade: Shares | None = None,
        error: Floats | None = None,
        samples: NDArray[np.int32] | None = None,
        noise: Noise | None = None,
        relighting: Callable[[Scene], Floats] | None = None,
        denoising: Callable[[Scene, Floats], Floats] | None = None,
        partial: float | None = None,
    ) -> Image:
        """Return the picture of some light; see `Image` and `Rendered`.

        Parameters
        ----------
        linear
            Light as it was traced.
        fog, lines, shade
            How much of each pixel fog is, and lines hide, and how much light eye-dome lighting
            leaves, if there are any.
        error, samples, noise, relighting, partial
            What the picture has.
        denoising
            Gives the light of a scene without grain, if the picture shall have that.
        coverage
            How much of each pixel is covered; None for what the middle rays say.
        peak
            The largest channel of light.
        """
        traced = raw = linear
        if denoising is not None:
            linear = denoising(self.scene, raw)
        shine = self.starlight(self.scene)
        if shine is not None:
            linear, raw = linear + shine, raw + shine
        if linear is not traced:
            peak = max(float(linear.max()), 0.0)
        return Image(
            linear,
            None,
            white_of(self.settings, linear, self.lock, peak),
            self.scene,
            self.settings,
            {},
            look=self.look,
            albedo=self.albedo,
            orders=self.orders,
            alpha=coverage,
            fog=fog,
            lines=lines,
            shade=shade,
            error=error,
            samples=samples,
            noise=noise,
            relighting=relighting,
            raw=raw,
            denoising=denoising,
            threads=self.threads,
            original=self.original,
            locked=self.lock is not None,
            keep_lights=self.keep_lights,
            partial=partial,
            sky=self.sky,
            starlight=None if shine is None else self.starlight,
            style=self.style,
        )
