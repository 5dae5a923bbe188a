"""The seam of a panorama, whose left edge goes on at the right one.

What asks pixels what those beside them see asks across it: the picture is made wider by what goes
on there, and cut again.
"""

from typing import Any

import numpy as np
from numpy.typing import NDArray

from vtray.scene.camera import Camera

Pixels = NDArray[Any]


def seam_margin(camera: Camera, width: int, reach: int) -> int:
    """Return how many columns there should be beside a picture on both sides.

    Parameters
    ----------
    camera
        Its camera: only panoramas go on beside their picture.
    width
        How many columns it has.
    reach
        How far pixels look.
    """
    return reach if camera.projection == "panorama" and width else 0


def widened(pixels: Pixels, margin: int) -> Pixels:
    """Return pixels, (height, width, ...), with so many columns more on both sides."""
    if not margin:
        return pixels
    columns = np.arange(-margin, pixels.shape[1] + margin)
    wide: Pixels = np.take(pixels, columns, axis=1, mode="wrap")
    return wide


def cut(pixels: Pixels, margin: int) -> Pixels:
    """Return pixels without so many columns on both sides."""
    return np.ascontiguousarray(pixels[:, margin : pixels.shape[1] - margin])
