"""The scene file of the hosts: programs of ours that render with another renderer's library.

It holds numbers of 4 bytes, little-endian, and at the end the colours of the spheres, 3 bytes each:
the header, then for each plane its unit normal, the product of this with a point of the plane,
its colour and a 0; for each light where it is and its intensity; for each sphere its centre and
radius. All are in camera space: the eye at the origin, x to the right, y up, z forward. Colours
reach from 0 to 255. Lights that a plane hides from the eye are left out: they reach nothing that it
sees, and so planes block no light.

Needs only NumPy, as the peers' own Python environment has no vtray.
"""

from pathlib import Path
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

MAGIC = b"VTS1"
HEADER = np.dtype(
    [
        ("magic", "S4"),
        ("width", "<i4"),
        ("height", "<i4"),
        ("planes", "<i4"),
        ("lights", "<i4"),
        ("spheres", "<i4"),
        ("pixel_width", "<f4"),
        ("pixel_height", "<f4"),
        ("lambert", "<f4"),
        ("unused", "<i4", 3),
    ]
)


class HostScene(NamedTuple):
    """A scene.

    Attributes
    ----------
    width, height
        Size of the image in pixels.
    pixel_width, pixel_height
        Size of a pixel at distance 1 from the eye.
    lambert
        What the colours of all spheres are multiplied with.
    planes
        Normal, offset and colour of each, and a 0, (n, 8).
    lights
        Place and intensity of each, (n, 4).
    spheres
        Centre and radius of each, (n, 4).
    color
        The colour of each sphere, (n, 3).
    """

    width: int
    height: int
    pixel_width: float
    pixel_height: float
    lambert: float
    planes: NDArray[np.float32]
    lights: NDArray[np.float32]
    spheres: NDArray[np.float32]
    color: NDArray[np.uint8]


def write_scene(scene: HostScene, path: Path) -> None:
    """Write a scene file."""
    header = np.zeros((), HEADER)
    header["magic"] = MAGIC
    for name in ("width", "height", "pixel_width", "pixel_height", "lambert"):
        header[name] = getattr(scene, name)
    for name in ("planes", "lights", "spheres"):
        header[name] = len(getattr(scene, name))
    with path.open("wb") as file:
        file.write(header.tobytes())
        for array in (scene.planes, scene.lights, scene.spheres):
            array.astype("<f4", copy=False).tofile(file)
        scene.color.tofile(file)


def read_scene(path: Path) -> HostScene:
    """Read a scene file."""
    with path.open("rb") as file:
        header = np.fromfile(file, HEADER, 1)[0]

        def rows(name: str, width: int) -> NDArray[np.float32]:
            return np.fromfile(file, "<f4", header[name] * width).reshape(-1, width)

        return HostScene(
            width=int(header["width"]),
            height=int(header["height"]),
            pixel_width=float(header["pixel_width"]),
            pixel_height=float(header["pixel_height"]),
            lambert=float(header["lambert"]),
            planes=rows("planes", 8),
            lights=rows("lights", 4),
            spheres=rows("spheres", 4),
            color=np.fromfile(file, np.uint8, header["spheres"] * 3).reshape(-1, 3),
        )
