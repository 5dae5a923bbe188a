"""What a style draws onto a picture once its rays are traced: lines, and shade by distance."""

import numpy as np
from numpy.typing import NDArray

from vtray.base.pool import run_tasks
from vtray.base.tiles import TILE
from vtray.image.eye_dome import shade_rows, surroundings
from vtray.rendering.outlines import draw_outlines, pixel_size
from vtray.rendering.pack import Packed
from vtray.rendering.passes import Tracer
from vtray.rendering.seam import cut, seam_margin, widened
from vtray.scene.scene import Scene
from vtray.scene.style import EyeDome, Outline, Style
from vtray.transport.film import Film, new_film
from vtray.transport.integrators.outlines import Seen
from vtray.transport.scene_arrays import without_light

Shares = NDArray[np.float32]


class Drawing:
    """Draws what a style wants.

    Parameters
    ----------
    style
        The style.
    scene, packed
        The scene as it is rendered, and its arrays.
    threads
        How many threads to use at the most.
    """

    def __init__(self, style: Style, scene: Scene, packed: Packed, threads: int) -> None:
        self._outline = style.outline if isinstance(style.outline, Outline) else None
        self._eye_dome = style.eye_dome if isinstance(style.eye_dome, EyeDome) else None
        self._scene = scene
        self._packed = packed
        self._threads = threads

    @property
    def wanted(self) -> tuple[str, ...]:
        """What is wanted of the rays that find light, by the names of a film's rows."""
        return () if self._looks_apart else self._needed

    @property
    def _needed(self) -> tuple[str, ...]:
        """What is needed of what the middle rays meet, likewise."""
        if self._outline is not None:
            return ("primitive", "distance", "met")
        return () if self._eye_dome is None else ("distance",)

    @property
    def _looks_apart(self) -> bool:
        """Whether the rays that find light do not tell which surface is drawn.

        They may see layers, and not one surface; or only samples are cast, through a lens.
        """
        arrays = self._packed.arrays
        return arrays.world.faded is not None or arrays.camera.lens is not None

    def _surfaces(self) -> Film:
        """Return the surfaces that are drawn."""
        tracer = Tracer(without_light(self._packed.arrays), self._threads)
        return tracer.surfaces(*self._needed)

    def warm_up(self) -> None:
        """Load the kernels, or compile them."""
        if self._looks_apart:
            return
        nothing = new_film(0, 0, *self.wanted)
        self.lines(nothing)
        self.shade(nothing)

    def lines(self, film: Film) -> Shares | None:
        """Return how much of each pixel lines hide, if there are any."""
        if self._outline is None:
            return None
        if self._looks_apart:
            film = self._surfaces()
        normal = np.empty((*film.primitive.shape, 3)) if self._outline.normals else None
        return draw_outlines(
            self._outline,
            self._scene,
            self._packed,
            Seen(film.primitive, film.distance, film.met, normal),
            self._threads,
        )

    def shade(self, film: Film) -> Shares | None:
        """Return how much of its light each pixel keeps in eye-dome lighting, if there is any."""
        if self._eye_dome is None:
            return None
        film = self._surfaces() if self._looks_apart else film
        strength, around = float(self._eye_dome.strength), surroundings(self._eye_dome.radius)
        size, growth = pixel_size(self._scene.camera, self._packed)
        # One more, since what nothing is seen in looks as what is beside it.
        reach = int(np.abs(around[:, 0]).max()) + 1
        margin = seam_margin(self._scene.camera, film.distance.shape[1], reach)
        distance = widened(film.distance, margin)
        shade = np.empty(distance.shape, np.float32)

        def shade_tile(top: int) -> None:
            bottom = min(top + TILE, len(shade))
            shade_rows(distance, size, growth, around, strength, top, bottom, shade)

        run_tasks(range(0, max(len(shade), 1), TILE), lambda: shade_tile, self._threads)
        return cut(shade, margin)
