"""Scale bars: lengths that read well, and how long they are in a picture."""

import math
from dataclasses import dataclass
from decimal import Decimal

import numpy as np
from numpy.typing import NDArray

from vtray.scene.scene import Camera

Floats = NDArray[np.float64]


@dataclass(frozen=True)
class ScaleBar:
    """A scale bar.

    Attributes
    ----------
    length
        In scene units.
    pixels
        In pixels of the picture.
    text
        What is written beside it.
    """

    length: float
    pixels: float
    text: str


def round_length(limit: float) -> float:
    """Return the largest of ..., 0.1, 0.2, 0.5, 1, 2, 5, 10, ... that is at most `limit`."""
    exponent = math.floor(math.log10(limit))
    candidates = (
        float(f"{digit}e{power}") for power in (exponent + 1, exponent) for digit in (5, 2, 1)
    )
    below = float(f"5e{exponent - 1}")
    return next((length for length in candidates if length <= limit), below)


def length_text(length: float) -> str:
    """Return a length as people read it: 0.5, 20, 2e-9."""
    return f"{Decimal(repr(length)).normalize():f}" if 1e-4 < length < 1e6 else f"{length:g}"


def is_orthographic(camera: Camera) -> bool:
    """Tell whether all rays of a camera are parallel."""
    return camera.projection == "orthographic"


def pixel_width(camera: Camera, depth: float) -> float:
    """Return how many scene units a pixel is wide, `depth` units from the eye along z'."""
    width = camera.resolution[0]
    return width if is_orthographic(camera) else width * depth / camera.focus


def depth_along_view(camera: Camera, distance: Floats) -> Floats:
    """Return how far from the eye along z' the hits of all pixels are.

    Parameters
    ----------
    camera
        The camera.
    distance
        From the origin of each pixel's ray to its hit, (height, width).
    """
    if is_orthographic(camera):
        return distance
    height, width = distance.shape
    across = (np.arange(width) - width / 2) * (camera.resolution[0] / camera.focus)
    down = (np.arange(height) - height / 2) * (camera.resolution[1] / camera.focus)
    depth: Floats = distance / np.hypot(np.hypot(across, down[:, None]), 1.0)
    return depth
