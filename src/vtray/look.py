"""What the picture's rays meet, beside light: traced only when it is asked for."""

import sys
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from vtray.acceleration import Acceleration, locate_all
from vtray.scene import Scene
from vtray.scene_arrays import Packed
from vtray.tracing import Tracer

Floats = NDArray[np.float64]


class Surfaces(NamedTuple):
    """What the ray through the middle of each pixel meets.

    Attributes
    ----------
    depth
        Distance along the ray in scene units, infinite where nothing is, (height, width).
    normals
        Unit normals in world space on the ray's side, 0 where nothing is, (height, width, 3).
    ids
        Place in ``scene.objects``, and place in the arrays of that object, 0 if it has none; both
        -1 where nothing is; int32, (height, width, 2).
    """

    depth: Floats
    normals: Floats
    ids: NDArray[np.int32]


class Look:
    """Looks at a scene as it was rendered, whatever has become of it since.

    Parameters
    ----------
    scene
        The scene as it was rendered.
    kept
        Its spheres.
    packed
        Its arrays.
    threads
        How many threads to use at the most.
    """

    def __init__(self, scene: Scene, kept: Acceleration, packed: Packed, threads: int) -> None:
        self._scene = scene
        self._kept = kept
        self._packed = packed
        self._threads = threads

    def __call__(self) -> Surfaces:
        """Trace the ray through the middle of each pixel."""
        film = Tracer(self._packed.arrays, self._threads).surfaces()
        with np.errstate(over="ignore"):
            depth = film.distance * self._packed.unit + self._packed.before
        # What is farther away than a double can say is there all the same.
        np.minimum(depth, sys.float_info.max, out=depth, where=film.primitive >= 0)
        return Surfaces(
            depth,
            film.normal,
            locate_all(self._scene, self._kept, film.primitive),
        )
