"""What the picture's rays meet, beside light: traced only when it is asked for."""

import sys

import numpy as np

from vtray.geometry.packets.packet import SECOND
from vtray.image.surfaces import Surfaces
from vtray.rendering.numbering import find_all
from vtray.rendering.pack import Packed
from vtray.rendering.passes import Tracer
from vtray.rendering.styled import with_solid_from
from vtray.scene.scene import Scene
from vtray.transport.scene_arrays import without_light


class Look:
    """Looks at a scene as it was rendered, whatever has become of it since.

    Parameters
    ----------
    scene
        The scene as it was rendered.
    packed
        Its arrays.
    threads
        How many threads to use at the most.
    """

    def __init__(self, scene: Scene, packed: Packed, threads: int) -> None:
        self._scene = scene
        self._packed = packed
        self._threads = threads
        self._found: dict[bool, Surfaces] = {}  # for all pictures of the view

    def __call__(self, *, faint: bool = False) -> Surfaces:
        """Trace the ray through the middle of each pixel, once.

        Parameters
        ----------
        faint
            Whether the first surface counts, however much light it lets through, and not only one
            that is solid.
        """
        faint = faint and self._packed.arrays.world.faded is not None
        if faint not in self._found:
            self._found[faint] = self._trace(faint=faint)
        return self._found[faint]

    def _trace(self, *, faint: bool) -> Surfaces:
        """Trace them."""
        arrays = with_solid_from(self._packed, 0.0).arrays if faint else self._packed.arrays
        film = Tracer(without_light(arrays), self._threads).surfaces()
        with np.errstate(over="ignore"):
            depth = film.distance * self._packed.unit + self._packed.before
        # What is farther away than a double can say is there all the same.
        np.minimum(depth, sys.float_info.max, out=depth, where=film.primitive >= 0)
        ids, copies = find_all(self._scene.objects, film.primitive)
        return Surfaces(depth, film.normal, ids, film.half & SECOND, copies)
