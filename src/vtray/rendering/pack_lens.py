"""The lens of a camera as kernels see it."""

import numpy as np

from vtray.base.exact_math import cosine, sine
from vtray.scene.camera import Camera
from vtray.scene.lens import sharp_ahead, sharp_distance
from vtray.transport.camera_rays import LensFrame


def pack_lens(camera: Camera, start: float, unit: float) -> LensFrame | None:
    """Return the lens of a camera; None for a pinhole.

    Parameters
    ----------
    camera
        The camera.
    start
        How far before its image plane rays start in the arrays, in scene units.
    unit
        The length in scene units of length 1 in the arrays.
    """
    lens = camera.lens
    if lens is None or lens.radius == 0.0:
        return None
    distance = sharp_distance(lens, camera)
    # Of lines that meet where it is sharp, there are fewer digits from where the eye is far away.
    radius = lens.radius * ((sharp_ahead(lens, camera) + start) / distance) / unit
    blades = int(lens.blades or 0)
    turns = [360.0 * (k % blades) / blades for k in range(blades + 1)] if blades else []
    corners = np.array([(sine(turn), -cosine(turn)) for turn in turns]).reshape(-1, 2)
    return LensFrame(radius, lens.radius / distance, corners)
