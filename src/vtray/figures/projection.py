"""Where points of the world are in a picture."""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from vtray.scene.camera import Camera
from vtray.scene.placing.moved import axes_of
from vtray.scene.placing.panorama import around

Floats = NDArray[np.float64]


class Places(NamedTuple):
    """Where points are in a picture.

    Attributes
    ----------
    column, row
        In pixels from the left and from the top, (n,); those of a pixel itself are integers. NaN
        where a point is not before the eye.
    depth
        How far from the eye along z', in scene units, (n,); along the ray in a panorama.
    """

    column: Floats
    row: Floats
    depth: Floats


def project(camera: Camera, points: Floats) -> Places:
    """Return where points in world space, (n, 3), are in the picture of a camera."""
    center, focus = camera.center, camera.focus
    x, y, z = points[:, 0] - center.x, points[:, 1] - center.y, points[:, 2] - center.z
    across, down, ahead = (x * axis[0] + y * axis[1] + z * axis[2] for axis in axes_of(camera))
    if camera.projection == "panorama":
        return Places(*around(camera, across, down, ahead))
    depth = ahead + focus
    if camera.projection == "perspective":
        with np.errstate(divide="ignore", invalid="ignore"):
            nearer = np.where(depth > 0.0, focus / depth, np.nan)
        across, down = across * nearer, down * nearer
    width, height = camera.size
    return Places(
        across / camera.resolution[0] + width / 2, down / camera.resolution[1] + height / 2, depth
    )
