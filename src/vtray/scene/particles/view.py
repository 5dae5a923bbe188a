"""How a picture of particles is taken, unless it is said otherwise."""

import math
from typing import TYPE_CHECKING, Any

from vtray.scene.camera import Camera

if TYPE_CHECKING:
    from vtray.scene.particles.particles import Particles
    from vtray.scene.spheres import Spheres

SIZE = (1024, 1024)
"""Width and height of a picture of data, unless they are given."""

SAMPLES = 4
"""Rays for each pixel that needs them: pictures of data are figures, whose edges are smooth."""

FINEST, COARSEST = 0.012, 0.03
"""How noisy soft light may be: grain is seen on large balls, and lost among small ones."""

NO_GRAIN = 0.15
"""The tolerance for a ball with a radius of a pixel, and for larger ones a part of that."""

MOVING = 0.02
"""The tolerance of all pictures of a movie, so that what does not move stays as it is."""

USUAL = (-65.0, 20.0)
"""Azimuth and elevation of the view of a cell: three faces are seen, that in front most."""

VIEW = ("view", "zoom", "orthographic")
"""What says from where particles are seen."""


def camera_of(
    subject: Any,  # noqa: ANN401
    has_cell: bool,
    size: tuple[int, int],
    margin: float | tuple[float, float, float, float],
    *,
    view: str | tuple[float, float] | None = None,
    zoom: float = 1.0,
    orthographic: bool = False,
) -> Camera:
    """Return the camera that shows everything.

    Parameters
    ----------
    subject
        A scene, or positions.
    has_cell
        Whether there is a cell: a box is known by its faces, and what has none by its shape.
    size
        Width and height of the picture in pixels.
    margin
        What stays free at the sides of the picture, as for `Camera.fit`.
    view, zoom
        As for `Camera.fit`; by default, that of a cell, or the one that shows the shape.
    orthographic
        Whether there is no perspective.
    """
    return Camera.fit(
        subject,
        margin=margin,
        projection="orthographic" if orthographic else "perspective",
        size=size,
        view=(USUAL if has_cell else "auto") if view is None else view,
        zoom=zoom,
    )


def places_of(particles: "Particles") -> Any:  # noqa: ANN401
    """Return where particles are, as a subject for `camera_of`; any point if there are none."""
    return particles.positions if len(particles) else [(0.0, 0.0, 0.0)]


def taken(camera: Camera, spheres: "Spheres", *, is_alone: bool) -> dict[str, Any]:
    """Return the settings of a picture of particles.

    Parameters
    ----------
    camera, spheres
        What it shows, and from where.
    is_alone
        Whether it is no part of a movie.
    """
    tolerance = _tolerance(camera, spheres) if is_alone else MOVING
    return {"samples": SAMPLES, "tolerance": tolerance}


def _tolerance(camera: Camera, spheres: "Spheres") -> float:
    """Return how noisy soft light may be on balls of the usual size."""
    import numpy as np

    if not len(spheres.center):
        return COARSEST
    middle = 0.5 * (spheres.center.min(axis=0) + spheres.center.max(axis=0))
    radius = np.sort(np.atleast_1d(spheres.radius))[np.size(spheres.radius) // 2]
    steps = camera.project(middle + radius * np.eye(3)) - camera.project(middle)
    # Three steps at right angles are together seen as long as two that are not foreshortened.
    pixels = math.sqrt(sum(part * part for part in steps[:, :2].ravel().tolist()) / 2)
    return min(max(NO_GRAIN / pixels, FINEST), COARSEST) if pixels > 0 else COARSEST
