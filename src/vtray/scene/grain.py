"""How noisy soft light may be where nobody says it: grain is lost among small things."""

from typing import Any

from vtray.base.errors import SceneError
from vtray.scene.camera import Camera

FINEST, COARSEST = 0.012, 0.06
"""The tolerance for large things, on which grain is seen, and for the smallest."""

NO_GRAIN = 0.15
"""The tolerance for things with a radius of a pixel, and for larger ones a part of that."""

DIGITS = 4
"""To so many the tolerance is rounded, so that it is the same on all machines."""

LOOKED_AT = 4096
"""Things whose size in the picture is looked at, about, at the most."""


def tolerance_of(subject: Any, camera: Camera) -> float:  # noqa: ANN401
    """Return how noisy soft light may be on things of the usual size in a picture.

    Parameters
    ----------
    subject
        A scene, or arrays of objects: of that of which there is most, the size counts.
    camera
        What takes the picture.
    """
    import numpy as np

    from vtray.scene.placing.bounds import balls_of

    try:
        balls = max(balls_of(subject, "tolerance"), key=lambda balls: len(balls.center))
    except SceneError:  # nothing but planes
        return FINEST
    step = -(-len(balls.center) // LOOKED_AT)
    center = np.asarray(balls.center[::step], np.float64)
    radius = np.broadcast_to(balls.radius, len(balls.center))[::step]
    if balls.at is not None:
        center = center + np.mean(balls.at, axis=0)
    with np.errstate(all="ignore"):
        ends = center[:, None] + radius[:, None, None] * np.eye(3)
        steps = (camera.project(ends) - camera.project(center)[:, None])[..., :2]
        # Three steps at right angles are together seen as long as two that are not foreshortened.
        sizes = np.sqrt((steps * steps).sum(axis=(1, 2)) / 2)
    seen = np.sort(sizes[np.isfinite(sizes)])
    if not len(seen):
        return FINEST
    pixels = float(seen[len(seen) // 2])
    largest = NO_GRAIN / pixels if pixels > 0 else COARSEST
    return round(min(max(largest, FINEST), COARSEST), DIGITS)
