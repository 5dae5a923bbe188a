"""How noisy soft light may be where nobody says it: grain is lost among small things."""

import math
from typing import TYPE_CHECKING

from vtray.base.errors import SceneError
from vtray.scene.camera import Camera
from vtray.scene.objects import Plane
from vtray.scene.settings import TOLERANCE

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

    from vtray.scene.placing.bounds import Balls, HasObjects

FINEST, COARSEST = 0.012, 0.06
"""The tolerance for large things, on which grain is seen, and for the smallest."""

NO_GRAIN, LITTLE_GRAIN = 0.15, 0.081
"""The tolerance is the first of these over the radius in pixels, or the second over the root of it,
whichever is larger: on small things grain is not seen, on larger ones hardly."""

DIGITS = 4
"""To so many the tolerance is rounded, so that it is the same on all machines."""

LOOKED_AT = 4096
"""Things of one kind whose size in the picture is looked at, about, at the most."""

_Sizes = tuple["NDArray[np.float64]", "NDArray[np.float64]"]


def tolerance_of(scene: "HasObjects", camera: Camera) -> float:
    """Return how noisy soft light may be on things of the usual size in a picture.

    Half of the area of all things, apart from what they hide, is that of things of this size or
    larger ones. On planes, grain is seen best of all.

    Parameters
    ----------
    scene
        What is seen.
    camera
        What takes the picture.
    """
    import numpy as np

    from vtray.scene.placing.bounds import balls_of

    if not scene.objects or any(isinstance(item, Plane) for item in scene.objects):
        return TOLERANCE
    try:
        found = [_sizes_of(balls, camera) for balls in balls_of(scene, "tolerance")]
    except SceneError:  # only arrays of none
        return TOLERANCE
    pixels, count = (np.concatenate(part) for part in zip(*found, strict=True))
    order = pixels.argsort(kind="stable")
    area = (count * pixels * pixels)[order].cumsum()
    if not len(area):
        return FINEST
    usual = float(pixels[order[area.searchsorted(0.5 * area[-1])]])
    if usual <= 0.0:
        return COARSEST
    unseen = max(NO_GRAIN / usual, LITTLE_GRAIN / math.sqrt(usual))
    return round(min(max(unseen, FINEST), COARSEST), DIGITS)


def _sizes_of(balls: "Balls", camera: Camera) -> _Sizes:
    """Return radii of some balls in pixels, and of how many each says; of those in sight."""
    import numpy as np

    step = -(-len(balls.center) // LOOKED_AT)
    center = np.asarray(balls.center[::step], np.float64)
    radius = np.broadcast_to(balls.radius, len(balls.center))[::step]
    many = step
    if balls.at is not None:
        center = center + balls.at[len(balls.at) // 2]
        many *= len(balls.at)
    with np.errstate(all="ignore"):
        ends = center[:, None] + radius[:, None, None] * np.eye(3)
        steps = (camera.project(ends) - camera.project(center)[:, None])[..., :2]
        # Three steps at right angles are together seen as long as two that are not foreshortened.
        squares = (steps * steps).reshape(-1, 6).T
        pixels = np.sqrt(sum(squares) / 2)
    seen = pixels[np.isfinite(pixels)]
    return seen, np.full(len(seen), float(many))
