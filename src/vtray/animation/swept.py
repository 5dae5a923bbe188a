"""What objects sweep as they turn about an axis: what a camera must show that goes around them."""

import numpy as np
from numpy.typing import NDArray

from vtray.base.errors import SceneError
from vtray.rendering.beside import MARGIN, Margin
from vtray.scene.camera import Camera
from vtray.scene.cylinders import Cylinders
from vtray.scene.placing.bounding_sphere import bounding_sphere
from vtray.scene.placing.bounds import Balls, balls_of, middle_of
from vtray.scene.placing.directions import Vec, unit
from vtray.scene.placing.moved import up_of
from vtray.scene.placing.panorama import check_flat
from vtray.scene.vectors import Vector

Floats = NDArray[np.float64]

SLICES = 64
"""Discs, one above the other, that stand for what is swept."""


def fit_around(
    subject: object, camera: Camera, zoom: float = 1.0, margin: Margin = MARGIN
) -> tuple[Camera, Vector]:
    """Return a camera that shows objects from all sides as it orbits, and what it orbits about.

    Parameters
    ----------
    subject
        A scene, or what else `Camera.fit` takes.
    camera
        Whose direction, size and projection it has; it turns about what that stands upright on.
    zoom, margin
        As for `Camera.fit`.
    """
    axis, forward = unit(up_of(camera)), unit(camera.normal)
    width, height = map(int, camera.size)
    check_flat(camera, "turntable", "take a camera that looks one way")
    parts = balls_of(subject, "turntable")
    x, y, z = map(float, middle_of(parts))
    found = Camera.fit(
        swept(parts, (x, y, z), axis),
        forward,
        up=axis,
        projection="orthographic" if camera.projection == "orthographic" else "perspective",
        size=(width, height),
        margin=margin,
        zoom=zoom,
    )
    return found, Vector(x, y, z)


def upright(camera: Camera, tilt: float = 0.0) -> Camera:
    """Return the same view with an `up` to go around; see `up_of`."""
    return camera.replace(up=up_of(camera, tilt))


def swept(parts: list[Balls], middle: Vec, axis: Vec) -> Cylinders:
    """Return discs around a unit axis through a point that hold what balls sweep."""
    columns = [_heights_of(part, middle, axis) for part in parts]
    low, high, reach = (np.concatenate(column) for column in zip(*columns, strict=True))
    bottom, top = float(low.min()), float(high.max())
    if not np.isfinite([bottom, top, reach.max()]).all():
        raise SceneError("turntable: the objects reach too far to be gone around")
    tall = (top - bottom) or 1.0
    # Each ball is in the slice of its middle, which is made as high as it needs.
    slices = np.minimum(((low / 2 + high / 2 - bottom) / tall * SLICES).astype(int), SLICES - 1)
    used = np.unique(slices)
    wide, below, above = np.zeros(SLICES), np.full(SLICES, np.inf), np.full(SLICES, -np.inf)
    np.maximum.at(wide, slices, reach)
    np.minimum.at(below, slices, low)
    np.maximum.at(above, slices, high)
    line, start = np.array(axis), np.array(middle)
    least = 2.0**-40 * tall  # a cylinder needs a length
    return Cylinders(
        start + below[used, None] * line,
        start + np.maximum(above, below + least)[used, None] * line,
        wide[used],
        (0, 0, 0),
    )


def _heights_of(part: Balls, middle: Vec, axis: Vec) -> tuple[Floats, Floats, Floats]:
    """Return how low and how high balls reach along an axis, and how far from it, each (n,)."""
    center, radius = part.center, part.radius
    if part.at is not None:  # one ball around what stands at each place
        inner, far = bounding_sphere(part._replace(at=None))
        center, radius = part.at + inner, far
    x, y, z = (column - m for column, m in zip(center.T.astype(np.float64), middle, strict=True))
    height = x * axis[0] + y * axis[1] + z * axis[2]
    x, y, z = x - height * axis[0], y - height * axis[1], z - height * axis[2]
    return height - radius, height + radius, np.sqrt(x * x + y * y + z * z) + radius
