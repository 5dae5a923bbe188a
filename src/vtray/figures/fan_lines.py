"""Where the rays of a fan go in a drawing: all the way to their light, or as far as is shown."""

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from vtray.figures.drawn.objects import where_met
from vtray.figures.traced_rays import Hit, ShadowFan
from vtray.scene.light_types import Lamp, RectangleLight
from vtray.scene.scene import Scene

Floats = NDArray[np.float64]

DOME = 0.35
"""Rays to all sides that have no end are drawn as long as this share of the camera ray."""


@dataclass(frozen=True)
class FanLines:
    """Ends of lines from a hit, in world space, (n, 3) each.

    Attributes
    ----------
    arriving
        Of rays that arrive.
    stopped
        Of rays that something stops, up to there.
    stops
        Those of `stopped` where a ray is stopped, (m, 3); it may be so farther away than is drawn.
    """

    arriving: Floats
    stopped: Floats
    stops: Floats


def fan_lines(scene: Scene, hit: Hit, fan: ShadowFan, share: float, longest: float) -> FanLines:
    """Return the lines of a fan; rays that go below the surface have none.

    Parameters
    ----------
    scene, hit
        The scene, and where the fan starts.
    fan
        The fan.
    share
        How much of each ray's length is drawn, if it has an end.
    longest
        The longest line.
    """
    start = np.array(hit.point)
    arriving, stopped, stops = [], [], []
    for ray in fan.rays:
        way = np.array(ray.direction)
        length = longest if math.isinf(ray.length) else min(share * ray.length, longest)
        if ray.arrives:
            arriving.append(start + length * way)
        elif ray.blocker is not None:
            stop = where_met(scene, ray.blocker, hit.point, ray.direction)
            is_near = float(np.linalg.norm(stop - start)) < length
            stopped.append(stop if is_near else start + length * way)
            if is_near:
                stops.append(stop)
    return FanLines(*(np.reshape(ends, (-1, 3)) for ends in (arriving, stopped, stops)))


def is_around(fan: ShadowFan) -> bool:
    """Tell whether the light comes from all sides, from no place of its own."""
    return fan.kind in ("sky", "ambient")


@dataclass(frozen=True)
class LampShape:
    """Where a lamp is.

    Attributes
    ----------
    place
        Its middle in world space, (3,).
    radius
        That of the ball that it is, or that is around it.
    corners
        Those of a rectangle, one after the other around it, (4, 3); None for a ball.
    """

    place: Floats
    radius: float
    corners: Floats | None


def lamp_shape(scene: Scene, fan: ShadowFan) -> LampShape | None:
    """Return where a lamp is; None for lights that are at no place."""
    light = scene.lights[fan.light]
    if not isinstance(light, Lamp):
        return None
    place = np.array([light.location.x, light.location.y, light.location.z])
    if not isinstance(light, RectangleLight):
        return LampShape(place, light.radius, None)
    one, other = (np.array([edge.x, edge.y, edge.z]) / 2 for edge in light.edges)
    corners = place + np.array([one + other, one - other, -one - other, other - one])
    return LampShape(place, float(np.linalg.norm(one + other)), corners)
