"""How a picture of particles is taken, unless it is said otherwise."""

from typing import Any

from vtray.scene.camera import Camera

SIZE = (1024, 1024)
"""Width and height of a picture of data, unless they are given."""

SAMPLES = 4
"""Rays for each pixel that needs them: pictures of data are figures, whose edges are smooth."""

TOLERANCE = 0.02
"""How noisy soft light may be: twice to five times fewer rays than scenes have among many atoms."""

USUAL = (-65.0, 20.0)
"""Azimuth and elevation of the view of a cell: three faces are seen, that in front most."""

VIEW = ("view", "zoom", "orthographic")
"""What says from where particles are seen."""


def camera_of(
    subject: Any,  # noqa: ANN401
    has_cell: bool,
    size: tuple[int, int],
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
    view, zoom
        As for `Camera.fit`; by default, that of a cell, or the one that shows the shape.
    orthographic
        Whether there is no perspective.
    """
    return Camera.fit(
        subject,
        projection="orthographic" if orthographic else "perspective",
        size=size,
        view=(USUAL if has_cell else "auto") if view is None else view,
        zoom=zoom,
    )
