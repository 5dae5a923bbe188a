"""The camera that shows all bounded shapes as large as the picture allows.

A sphere is in a perspective picture if it is on the inner side of four planes through the eye, and
a cylinder or a cone if its caps are, which are discs. For a given field of view these planes only
move with the eye, so each gives one bound that is linear in the eye's position: the least of all
bounds of balls and discs. The farthest eye forward that meets all four is the answer.
"""

import math
from collections.abc import Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from vtray.base.errors import SceneError
from vtray.scene.checks.limits import FieldOfView, FlatProjection, Margin, SizePair
from vtray.scene.checks.scene_words import show
from vtray.scene.placing.bounds import balls_of, middle_of, ups_of_planes
from vtray.scene.placing.directions import Vec, along, are_parallel, unit, view_axes
from vtray.scene.placing.look_at import NEAR, argument, orthographic, perspective, pixel_slope
from vtray.scene.placing.seen import Seen, Slopes, least_room, look
from vtray.scene.vectors import Direction

Floats = NDArray[np.float64]

NEARLY_PARALLEL = 1e-3
"""Sine of the angle to the view below which a plane's normal is not taken for up."""

LEAST_GAP = 2.0**-30
"""Distance that is kept from the eye to what it sees, relative to its extent. Points alone need it:
the eye that sees them in the narrowest cone may lie in one of them."""

CLEARANCE = 16.0
"""Distance from an orthographic camera to what is nearest, relative to the size of what is seen:
enough to see a floor before that, if it is looked at from more than 4 degrees above."""


TALL, WIDE = 40.0, 52.0
"""The fields of view, vertical and horizontal in degrees, of which the narrower is taken unless one
is given. Up to 4:3 that is the vertical one; wider, balls at the sides would look like eggs."""

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
        If there is no bounded shape, or an argument is not right.
    """
    call = "Camera.fit"
    forward = unit(argument(call, "direction", direction, Direction))
    free = _margins(call, margin)
    kind = argument(call, "projection", projection, FlatProjection)
    fov = argument(call, "fov_degrees", fov_degrees, FieldOfView | None)
    width, height = pixels = argument(call, "size", size, SizePair)
    parts = balls_of(subject, call)
    middle = middle_of(parts)
    upward = _choose_up(subject, up, forward, middle)
    right, down = view_axes(forward, unit(upward))
    axes = (right, down, forward)
    frames = _frame(int(width), free[0], free[2]), _frame(int(height), free[1], free[3])
    with np.errstate(over="ignore", invalid="ignore"):
        if kind == "perspective":
            slope = _usual_slope(pixels) if fov is None else pixel_slope(fov, pixels)
            edges = [(first * slope, last * slope) for first, last in frames]
            place, focus = _stand([look(part, middle, axes, edges) for part in parts], edges)
            eye = _to_world(place, middle, axes)
            fields = perspective(eye, forward, upward, focus, slope, pixels)
        else:
            seen = [look(part, middle, axes) for part in parts]
            place, focus, pixel = _stand_back(seen, frames, pixels)
            eye = _to_world(place, middle, axes)
            fields = orthographic(eye, forward, upward, focus, pixel, pixels)
    if not all(map(math.isfinite, fields["center"])):
        words = "expected coordinates and radii whose sums and products are doubles"
        raise SceneError(f"{call}: the spheres reach too far; {words}, up to about 1e307")
    return fields


def _usual_slope(size: tuple[int, int]) -> float:
    """Return the width of a pixel at distance 1 from the eye where no field of view is given."""
    return min(pixel_slope(TALL, size), pixel_slope(WIDE, (size[1], size[0])))


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


def _margins(call: str, margin: object) -> list[float]:
    """Return what stays free on the left, at the top, on the right and at the bottom."""
    if not isinstance(margin, Sequence) or isinstance(margin, str):
        return [argument(call, "margin", margin, Margin)] * 4
    if len(margin) != 4:
        words = "expected a number, or four: left, top, right, bottom"
        raise SceneError(f"{call}: margin: {words}, got {show(margin)}")
    return [argument(call, f"margin[{k}]", share, Margin) for k, share in enumerate(margin)]


def _frame(count: int, before: float, after: float) -> tuple[float, float]:
    """Return where silhouettes may begin and end on a row of pixels, in pixels from the axis.

    Pixels lie from -count/2 to count/2 - 1; a row of a single one has no length, and stands for the
    area of that pixel instead.
    """
    first, length = (-count / 2, count - 1) if count > 1 else (-1.0, 1)
    return first + before * length, first + (1 - after) * length


def _stand(seen: Sequence[Seen], edges: Sequence[Slopes]) -> tuple[Vec, float]:
    """Return the eye that is as near to what it sees as can be, and the focus."""
    centers = _ends([part.centers for part in seen])
    front = float(_ends([part.surfaces for part in seen])[0, 2])
    depths = [front - _least_gap(centers, front)]
    for aside, (low, high) in enumerate(edges):
        room = _room(seen, aside, low, -1)[0] + _room(seen, aside, high, 1)[0]
        depths.append(room / (high - low))
    depth = min(depths)
    x, y = (_middle(seen, aside, slopes, depth) for aside, slopes in enumerate(edges))
    distance = float(centers[0, 2] / 2 + centers[1, 2] / 2) - depth
    return (x, y, depth), min(NEAR * distance, (front - depth) / 2)


def _ends(parts: Sequence[Floats]) -> Floats:
    """Return the least and the greatest coordinates of all parts, (2, 3)."""
    return np.array([np.min([p[0] for p in parts], axis=0), np.max([p[1] for p in parts], axis=0)])


def _least_gap(centers: Floats, front: float) -> float:
    """Return the least distance from the eye to what it sees."""
    (left, top, _), (right, bottom, back) = centers.tolist()
    extent = max(right - left, bottom - top, back - front)
    return LEAST_GAP * extent if extent > 0 else 1.0


def _room(seen: Sequence[Seen], aside: int, slope: float, side: int) -> tuple[float, float]:
    """Return the least bound to the eye on one side, and how it changes, as `least_room` does."""
    return min((least_room(part, aside, slope, side) for part in seen), key=lambda found: found[0])


def _middle(seen: Sequence[Seen], aside: int, slopes: Slopes, depth: float) -> float:
    """Return the place across from which the picture has the same free space on both sides.

    The narrowest field of view around the same middle in which all fits is the root of a
    concave function, on which Newton's steps come from one side after the first.
    """
    low, high = slopes
    axis, half = (low + high) / 2, (high - low) / 2
    for _ in range(60):
        left, left_change = _room(seen, aside, axis - half, -1)
        right, right_change = _room(seen, aside, axis + half, 1)
        excess = left + right - 2 * half * depth
        change = right_change - left_change - 2 * depth
        step = excess / change if change > 0 else 0.0
        if abs(step) <= 1e-13 * (high - low):
            break
        half -= step
    # The middle of what both sides leave; they differ by rounding alone.
    return ((axis + half) * depth - right) / 2 + ((axis - half) * depth + left) / 2


def _stand_back(
    seen: Sequence[Seen], frames: Frames, size: tuple[int, int]
) -> tuple[Vec, float, float]:
    """Return the eye, the focus and the width of a pixel of an orthographic picture."""
    (left, top, front), (right, bottom, end) = _ends([part.surfaces for part in seen]).tolist()
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
