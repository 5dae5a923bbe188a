"""From skies whose colour changes with the direction to the maps that kernels read."""

from collections.abc import Sequence
from functools import cache

import numpy as np
from numpy.typing import NDArray

from vtray.base.exact_math import cosine, sine
from vtray.geometry.vector import Vec
from vtray.rendering.pack_brightness import pack_brightness, starts_of
from vtray.scene.camera import Camera
from vtray.scene.colors.color_light import light_of
from vtray.scene.colors.tone_map_names import ToneMapName
from vtray.scene.light_types import AnyLight, Sky
from vtray.scene.placing.directions import along, beside, camera_axes, cross, unit
from vtray.scene.sky_types import Gradient
from vtray.transport.lights.sky import Skies

Floats = NDArray[np.float64]
Pictures = NDArray[np.float32]

ROWS = 1025
"""Rows of the map of a gradient: an odd number, so that the horizon is in the middle of one."""


def changes_color(light: AnyLight) -> bool:
    """Tell whether the colour of a light changes with the direction from which it comes."""
    return isinstance(light, Sky) and (light.gradient is not None or light.image is not None)


def pack_skies(skies: Sequence[Sky], up: Vec, tonemap: ToneMapName = "linear") -> Skies:
    """Return the maps of skies.

    Parameters
    ----------
    skies
        Those whose colour changes, any number.
    up
        What is up where they do not say it.
    tonemap
        The tone map, which says what the colours of gradients are as light. Pictures are light.
    """
    pictures = [_picture_of(sky, tonemap) for sky in skies]
    nodes = [_nodes_of(picture) for picture in pictures]
    return Skies(
        np.array([_axes_of(sky, up) for sky in skies], float).reshape(-1, 9),
        np.array([picture.shape[1] for picture in pictures], np.int64),
        np.array([picture.shape[0] for picture in pictures], np.int64),
        starts_of([rows.shape[0] * rows.shape[1] for rows in nodes]),
        np.concatenate([np.zeros((0, 3), np.float32), *(rows.reshape(-1, 3) for rows in nodes)]),
        pack_brightness(nodes),
    )


def up_of(camera: Camera) -> Vec:
    """Return what is up for skies that do not say it: for the camera, or in the picture."""
    if camera.up is not None:
        return unit(camera.up)
    _, down = camera_axes(unit(camera.normal))
    return -down[0], -down[1], -down[2]


def _picture_of(sky: Sky, tonemap: ToneMapName) -> Pictures:
    """Return the light of a sky as a picture, (height, width, 3)."""
    if sky.image is not None:
        return sky.image.pixels
    return _gradient_picture(sky.gradient or Gradient(), tonemap)


def _gradient_picture(gradient: Gradient, tonemap: ToneMapName) -> Pictures:
    """Return the light of a gradient as a picture of one column, (ROWS, 1, 3)."""
    height = _heights()
    depth = np.minimum(-height, 1.0)
    below = 1.0 - np.maximum(depth, 0.0)
    for _ in range(3):
        below = below * below
    above = np.maximum(height, 0.0)
    zenith, horizon, ground = (
        np.array(light_of(color, tonemap)) / 255.0
        for color in (gradient.zenith, gradient.horizon, gradient.ground)
    )
    rising = horizon + (zenith - horizon) * (above * (2.0 - above))[:, None]
    falling = ground + (horizon - ground) * below[:, None]
    picture = np.where(height[:, None] >= 0.0, rising, falling)
    return picture[:, None].astype(np.float32)


@cache
def _heights() -> Floats:
    """Return the sines of the heights of the rows of a gradient, from the top, (ROWS,)."""
    return np.array([cosine((row + 0.5) * 180.0 / ROWS) for row in range(ROWS)])


def _nodes_of(picture: Pictures) -> Pictures:
    """Return the nodes of a picture's map, (height + 2, width + 1, 3)."""
    rows = np.concatenate([picture[:1], picture, picture[-1:]])
    return np.concatenate([rows, rows[:, :1]], axis=1)


def _axes_of(sky: Sky, up: Vec) -> tuple[float, ...]:
    """Return the axes of the map of a sky: away from its middle, to the left of it, and up.

    The middle is towards `beside` what is up.
    """
    upward = up if sky.up is None else unit(sky.up)
    x, y, z = beside(upward)
    behind = -x, -y, -z
    left = cross(behind, upward)
    a, b = cosine(sky.rotation), sine(sky.rotation)
    nowhere = 0.0, 0.0, 0.0
    turned_behind = along(along(nowhere, a, behind), -b, left)
    turned_left = along(along(nowhere, a, left), b, behind)
    return *turned_behind, *turned_left, *upward
