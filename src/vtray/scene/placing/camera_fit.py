"""The camera that shows all spheres as large as the picture allows.

A sphere is in a perspective picture if it is on the inner side of four planes through the eye. For
a given field of view these planes only move with the eye, so each gives one bound that is linear in
the eye's position: the least of all spheres' bounds. The farthest eye forward that meets all four
is the answer.
"""

import math
from collections.abc import Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from vtray.base.errors import SceneError
from vtray.scene.checks.limits import FieldOfView, Margin, Projection, SizePair
from vtray.scene.checks.scene_words import show
from vtray.scene.placing.bounds import balls_of, middle_of, ups_of_planes
from vtray.scene.placing.directions import Vec, along, are_parallel, unit, view_axes
from vtray.scene.placing.look_at import NEAR, argument, orthographic, perspective, pixel_slope
from vtray.scene.placing.seen import Seen, Slopes, look, rooms
from vtray.scene.vectors import Direction

Floats = NDArray[np.float64]

NEARLY_PARALLEL = 1e-3
"""Sine of the angle to the view below which a plane's normal is not taken for up."""

LEAST_GAP = 2.0**-30
"""Distance that is kept from eye to spheres, relative to their extent. Points alone need it: the
eye that sees them in the narrowest cone may lie in one of them."""

CLEARANCE = 16.0
"""Distance from an orthographic camera to the first sphere, relative to the size of what is seen:
enough to see a floor before the spheres, if it is looked at from more than 4 degrees above."""


Frames = tuple[tuple[float, float], tuple[float, float]]
"""Where silhouettes may begin and end, across and down, in pixels from the axis."""


def fitting(
    subject: object,
    direction: object,
    up: object,
    margin: object,
    projection: object,
    fov_degrees: object,
    size: object,
) -> dict[str, Any]:
    """Return the fields of the camera of `Camera.fit`, with the same parameters.

    Raises
    ------
    SceneError
        If there is no sphere, or an argument is not right.
    """
    call = "Camera.fit"
    forward = unit(argument(call, "direction", direction, Direction))
    share = argument(call, "margin", margin, Margin)
    kind = argument(call, "projection", projection, Projection)
    fov = argument(call, "fov_degrees", fov_degrees, FieldOfView)
    width, height = pixels = argument(call, "size", size, SizePair)
    balls = balls_of(subject, call)
    middle = middle_of(balls.center)
    upward = _choose_up(subject, up, forward, middle)
    right, down = view_axes(forward, unit(upward))
    axes = (right, down, forward)
    frames = _frame(int(width), share), _frame(int(height), share)
    with np.errstate(over="ignore", invalid="ignore"):
        if kind == "perspective":
            slope = pixel_slope(fov, pixels)
            edges = [(first * slope, last * slope) for first, last in frames]
            place, focus = _stand(look(balls, middle, axes, edges), edges)
            eye = _to_world(place, middle, axes)
            fields = perspective(eye, forward, upward, focus, slope, pixels)
        else:
            place, focus, pixel = _stand_back(look(balls, middle, axes), frames, pixels)
            eye = _to_world(place, middle, axes)
            fields = orthographic(eye, forward, upward, focus, pixel, pixels)
    if not all(map(math.isfinite, fields["center"])):
        words = "expected coordinates and radii whose sums and products are doubles"
        raise SceneError(f"{call}: the spheres reach too far; {words}, up to about 1e307")
    return fields


def _choose_up(subject: object, up: object, forward: Vec, middle: Floats) -> Direction:
    """Return what points up in the picture."""
    if up is not None:
        given: Direction = argument("Camera.fit", "up", up, Direction)
        if are_parallel(unit(given), forward):
            words = "expected a direction that is not parallel to direction, or None"
            shown = show((given.x, given.y, given.z))
            raise SceneError(f"Camera.fit: up: {words}, got {shown}")
        return given
    choices = [*ups_of_planes(subject, middle)[:1], (0.0, 1.0, 0.0), (0.0, 0.0, 1.0)]
    free = [choice for choice in choices if not are_parallel(choice, forward, NEARLY_PARALLEL)]
    return Direction(*free[0])


def _to_world(point: Vec, middle: Floats, axes: tuple[Vec, Vec, Vec]) -> Vec:
    """Bring a point from the space of the camera into the world."""
    place = (0.0, 0.0, 0.0)
    for part, axis in zip(point, axes, strict=True):
        place = along(place, part, axis)
    return place[0] + float(middle[0]), place[1] + float(middle[1]), place[2] + float(middle[2])


def _frame(count: int, margin: float) -> tuple[float, float]:
    """Return where silhouettes may begin and end on a row of pixels, in pixels from the axis.

    Pixels lie from -count/2 to count/2 - 1; a row of a single one has no length, and stands for the
    area of that pixel instead.
    """
    first, length = (-count / 2, count - 1) if count > 1 else (-1.0, 1)
    return first + margin * length, first + (1 - margin) * length


def _stand(seen: Seen, edges: Sequence[Slopes]) -> tuple[Vec, float]:
    """Return the eye that is as near to the spheres as can be, and the focus."""
    front = float(seen.surfaces[0, 2])
    sides = list(zip((seen.x, seen.y), edges, strict=True))
    depths = [front - _least_gap(seen, front)]
    for place, (low, high) in sides:
        room = _room(place, seen, low, -1)[0] + _room(place, seen, high, 1)[0]
        depths.append(room / (high - low))
    depth = min(depths)
    x, y = (_middle(place, seen, slopes, depth) for place, slopes in sides)
    distance = float(seen.centers[0, 2] / 2 + seen.centers[1, 2] / 2) - depth
    return (x, y, depth), min(NEAR * distance, (front - depth) / 2)


def _least_gap(seen: Seen, front: float) -> float:
    """Return the least distance from the eye to the spheres."""
    (left, top, _), (right, bottom, back) = seen.centers.tolist()
    extent = max(right - left, bottom - top, back - front)
    return LEAST_GAP * extent if extent > 0 else 1.0


def _room(place: Floats, seen: Seen, slope: float, side: int) -> tuple[float, float]:
    """Return the least bound that the spheres set to the eye on one side, as `rooms` does.

    Returns
    -------
    bound, change
        The bound, and how it changes with the slope.
    """
    length = math.sqrt(1.0 + slope * slope)
    bounds = rooms(place, seen.z, slope, side)
    bounds -= seen.radius * length
    k = int(bounds.argmin())
    radius = float(np.broadcast_to(seen.radius, bounds.shape)[k])
    return float(bounds[k]), side * float(seen.z[k]) - radius * slope / length


def _middle(place: Floats, seen: Seen, slopes: Slopes, depth: float) -> float:
    """Return the place across from which the picture has the same free space on both sides.

    The narrowest field of view around the same middle in which all spheres fit is the root of a
    concave function, on which Newton's steps come from one side after the first.
    """
    low, high = slopes
    axis, half = (low + high) / 2, (high - low) / 2
    for _ in range(60):
        left, left_change = _room(place, seen, axis - half, -1)
        right, right_change = _room(place, seen, axis + half, 1)
        excess = left + right - 2 * half * depth
        change = right_change - left_change - 2 * depth
        step = excess / change if change > 0 else 0.0
        if abs(step) <= 1e-13 * (high - low):
            break
        half -= step
    # The middle of what both sides leave; they differ by rounding alone.
    return ((axis + half) * depth - right) / 2 + ((axis - half) * depth + left) / 2


def _stand_back(seen: Seen, frames: Frames, size: tuple[int, int]) -> tuple[Vec, float, float]:
    """Return the eye, the focus and the width of a pixel of an orthographic picture."""
    (left, top, front), (right, bottom, end) = seen.surfaces.tolist()
    pairs = list(zip(((left, right), (top, bottom)), frames, strict=True))
    pixel = max((high - low) / (last - first) for (low, high), (first, last) in pairs)
    # Points on a line along the view have no extent: any pixel will do.
    pixel = pixel or 1.0 / max(size)
    x, y = (
        (low / 2 + high / 2) - pixel * (first + last) / 2 for (low, high), (first, last) in pairs
    )
    extent = max(pixel * max(size), end - front)
    back = CLEARANCE * extent
    return (x, y, front - back), NEAR * back, pixel
