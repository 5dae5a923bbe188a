"""How much of each pixel a shape covers: with smooth edges, from its distance to each pixel."""

from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

Floats = NDArray[np.float64]


class Cover(NamedTuple):
    """How much of pixels is covered.

    Attributes
    ----------
    left, top
        Where the pixels begin in the picture.
    parts
        From 0 to 255, uint8, (height, width).
    """

    left: int
    top: int
    parts: NDArray[np.uint8]


def polygon(corners: ArrayLike, grown: float = 0.0) -> Cover:
    """Return what a convex polygon covers.

    Parameters
    ----------
    corners
        In their order around it, clockwise as seen in the picture, (n, 2): columns and rows, where
        the first pixel goes from 0 to 1.
    grown
        By how much it is made larger on all sides, in pixels.
    """
    points = np.asarray(corners, np.float64)
    left, top = (int(v) for v in np.floor(points.min(axis=0) - grown - 1.0))
    right, bottom = (int(v) for v in np.ceil(points.max(axis=0) + grown + 1.0))
    across, down = np.meshgrid(np.arange(left, right) + 0.5, np.arange(top, bottom) + 0.5)
    outside = np.full(across.shape, -np.inf)
    for (x, y), (next_x, next_y) in zip(points, np.roll(points, -1, axis=0), strict=True):
        way_x, way_y = next_x - x, next_y - y
        length = np.sqrt(way_x * way_x + way_y * way_y)
        if length > 0.0:
            off = ((across - x) * way_y - (down - y) * way_x) / length
            outside = np.maximum(outside, off)
    return Cover(left, top, _smooth(outside - grown))


def rectangle(left: int, top: int, width: int, height: int, grown: float = 0.0) -> Cover:
    """Return what a rectangle of whole pixels covers."""
    right, bottom = left + width, top + height
    return polygon([(left, top), (right, top), (right, bottom), (left, bottom)], grown)


def _smooth(outside: Floats) -> NDArray[np.uint8]:
    """Return how much pixels are covered that are so far outside of a shape, in pixels."""
    parts: NDArray[np.uint8] = np.floor(255.0 * np.clip(0.5 - outside, 0.0, 1.0) + 0.5).astype(
        np.uint8
    )
    return parts
