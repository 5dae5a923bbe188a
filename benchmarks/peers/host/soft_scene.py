"""A scene file of scripts that render spheres over a floor, in soft light or by paths.

Needs only NumPy, as the peers' own Python environment has no vtray.
"""

from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

REACH = 300.0
"""How far the floor reaches to each side, in sizes of the picture.

Mitsuba works places out from their share of its edges: with 100,000, they would be off by more than
a pixel; with a second floor around a small one, a part of the rays to a sky pass through both.
"""


class SoftScene(NamedTuple):
    """A scene; it holds the rays of its picture, so that both programs ask along the same ones.

    Attributes
    ----------
    spheres
        Centre and radius of each, (n, 4). Mitsuba's ellipsoids, which stand for more than a few,
        are only right with radii of about 1.
    floor
        How high the floor is, which is square to y; the spheres are above.
    size
        How large the picture is, in scene units.
    reflectance
        Of all surfaces, from 0 to 1.
    starts
        Where the ray of each pixel starts, (height, width, 3).
    way
        Where all of them go, a unit vector.
    lamp
        The lamp as Mitsuba's dictionaries describe it, in JSON; the transformation "to_world" is
        a matrix.
    sky
        The picture of a lamp that is an environment map, (rows, columns, 3); else empty.
    emitter_samples
        For each ray, how many others are chosen by the lamp, beside one that is chosen by the
        surface: 1, or 0 where that would only add noise.
    """

    spheres: NDArray[np.float64]
    floor: float
    size: float
    reflectance: float
    starts: NDArray[np.float64]
    way: NDArray[np.float64]
    lamp: str
    sky: NDArray[np.float32]
    emitter_samples: int


def write_scene(scene: SoftScene, path: Path) -> None:
    """Write a scene file, .npz."""
    np.savez(path, **scene._asdict())


def read_scene(path: Path) -> SoftScene:
    """Read a scene file."""

    def value(array: NDArray[Any]) -> Any:  # noqa: ANN401
        return array if array.ndim else array.item()

    with np.load(path) as found:
        return SoftScene(**{name: value(found[name]) for name in SoftScene._fields})
