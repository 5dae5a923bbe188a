"""What a picture would be with very many rays in each pixel, from pictures with one ray a pixel."""

import functools
import json
from typing import Any

import numpy as np

import vtray
from vtray.transport.sampling.filters import FILTERS

FINE = 48
"""Rays across and down each pixel."""
MARGIN = 2
"""Pixels beyond each side of a picture, as many as the widest filter reaches."""


def dense_picture(document: dict[str, Any], filter_name: str, fine: int = FINE) -> np.ndarray:
    """Return the light of a scene, (height, width, 3), each pixel a mean of fine * fine and more.

    The same view is rendered with pixels as fine as that, and with a margin as wide as the filter,
    which then weighs them.
    """
    kernel = FILTERS[filter_name]
    assert kernel.radius <= MARGIN
    width, height = document["camera"]["size"]
    rays = _fine_rays(json.dumps(document), fine)
    # A pixel lies where its first fine one does; on the edge of a box, rays count half.
    reach = int(np.ceil(kernel.radius)) * fine
    shifts = np.arange(-reach, reach + 1)
    weights = kernel.value(shifts / fine) * (np.abs(shifts / fine) <= kernel.radius)
    weights[np.abs(shifts / fine) == kernel.radius] *= 0.5
    rays = _weighed(rays, weights, height, fine)
    return _weighed(rays.swapaxes(0, 1), weights, width, fine).swapaxes(0, 1)


@functools.lru_cache(maxsize=1)
def _fine_rays(text: str, fine: int) -> np.ndarray:
    """Return the light of all rays, which the pictures of one scene by several filters share."""
    finer = json.loads(text)
    camera = finer["camera"]
    camera["size"] = [(n + 2 * MARGIN) * fine for n in camera["size"]]
    camera["resolution"] = [length / fine for length in camera["resolution"]]
    rays = vtray.render(vtray.loads(json.dumps(finer)), samples=1).linear
    rays.setflags(write=False)
    return rays


def _weighed(rays: np.ndarray, weights: np.ndarray, pixels: int, fine: int) -> np.ndarray:
    """Return the weighted means of the first axis, one for each pixel."""
    weights = weights / weights.sum()
    first = MARGIN * fine - len(weights) // 2
    # The last pixel's filter ends where the picture does.
    rows = np.concatenate([rays, rays[-1:]])
    return np.stack(
        [
            np.tensordot(weights, rows[first + k * fine : first + k * fine + len(weights)], 1)
            for k in range(pixels)
        ]
    )
