"""How a picture of particles is taken, unless it is said otherwise."""

from typing import TYPE_CHECKING, Any

from vtray.scene.camera import Camera

if TYPE_CHECKING:
    from vtray.scene.particles.particles import Particles

SIZE = (1024, 1024)
"""Width and height of a picture of data, unless they are given."""

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
