"""Other lights and colours for a picture, without tracing it again; or its light in orders."""

import numpy as np
from numpy.typing import NDArray

from vtray.base.memory import BYTES_PER_PIXEL_IN_ORDERS, check_memory
from vtray.base.pool import run_tasks
from vtray.base.tiles import TILE
from vtray.image.orders import Orders
from vtray.rendering.acceleration import Acceleration
from vtray.rendering.pack import pack
from vtray.rendering.passes import Tracer
from vtray.rendering.styled import styled
from vtray.scene.scene import Scene
from vtray.scene.settings import RenderSettings
from vtray.scene.style import Style
from vtray.transport.film import Film
from vtray.transport.light_buffer import KeptLight, add_up_rows


class Relighting:
    """Adds up the light of a picture anew.

    Parameters
    ----------
    kept
        The shapes of the scene that was traced.
    passes
        What was kept of the rays of each pass; a later one replaces pixels of those before it.
    samples
        How many rays each pixel of the last pass has, if there are two.
    threads
        How many threads to use at the most.
    """

    def __init__(
        self, kept: Acceleration, passes: tuple[KeptLight, ...], samples: int, threads: int
    ) -> None:
        self._kept = kept
        self._passes = passes
        self._samples = samples
        self._threads = threads

    def __call__(self, scene: Scene) -> NDArray[np.float64]:
        """Return the linear light, (height, width, 3), of the scene with other lights or colours.

        Parameters
        ----------
        scene
            The scene that was traced, but for the intensities of its lights and the colours of its
            objects.
        """
        arrays = pack(scene, self._kept.with_colors_of(scene.objects)).arrays
        linear = np.zeros((arrays.camera.height, arrays.camera.width, 3))
        for kept, samples in zip(self._passes, (1, self._samples), strict=False):

            def add_up(top: int, kept: KeptLight = kept, samples: int = samples) -> None:
                bottom = min(top + TILE, len(linear))
                add_up_rows(arrays, kept, samples, top, bottom, linear)

            run_tasks(range(0, len(linear), TILE), lambda: add_up, self._threads)
        return linear


class Rerendering:
    """Traces a picture again: with other lights or colours, or to have its light in orders.

    Parameters
    ----------
    kept
        The shapes of the scene that was traced.
    settings, style, white
        How the picture was taken, and the light that becomes 255, if that was known before.
    threads
        How many threads to use at the most.
    keep_lights
        Whether its lights were kept, by which rays are chosen in other ways.
    """

    def __init__(
        self,
        kept: Acceleration,
        settings: RenderSettings,
        style: Style,
        white: float | None,
        threads: int,
        *,
        keep_lights: bool,
    ) -> None:
        self._kept = kept
        self._settings = settings
        self._style = style
        self._white = white
        self._threads = threads
        self._keep_lights = keep_lights

    def __call__(self, scene: Scene) -> NDArray[np.float64]:
        """Return the linear light, as `Relighting` does."""
        linear: NDArray[np.float64] = self._trace(scene).linear
        return linear

    def orders(self, scene: Scene) -> Orders:
        """Return the light in orders of the scene that was traced, maybe with other lights."""
        width, height = map(int, scene.camera.size)
        samples = int(self._settings.samples)
        check_memory(width, height, samples, more=BYTES_PER_PIXEL_IN_ORDERS)
        found = self._trace(scene, "orders").orders
        return Orders(*(np.ascontiguousarray(found[..., k : k + 3]) for k in (0, 3, 6)))

    def _trace(self, scene: Scene, *more: str) -> Film:
        """Trace the same rays again; return their light, and what else is wanted."""
        packed = pack(scene, self._kept.with_colors_of(scene.objects))
        arrays = styled(packed, self._style).arrays
        tracer = Tracer(arrays, self._threads, more=more)
        return tracer.light(self._settings, self._white, keep=self._keep_lights).film
