"""Cameras between others: each turns, moves and zooms evenly from one to the next.

A turn is the shortest one, about a pivot, so that a camera that goes around something keeps its
distance.
"""

import math

from vtray.animation.keyframes import BEFORE, ApartError, part_way
from vtray.scene.camera import Camera
from vtray.scene.lens import Lens, sharp_distance
from vtray.scene.placing.directions import Vec, along, dot
from vtray.scene.placing.moved import axes_of
from vtray.scene.vectors import Direction, Vector

Turn = tuple[float, float, float, float]
"""A unit quaternion."""


def between_cameras(one: Camera, other: Camera, share: float, pivot: Vec) -> Camera:
    """Return the camera at a share of the way from one to another, from 0 to 1.

    Parameters
    ----------
    one, other
        The cameras.
    share
        The share.
    pivot
        The point that they turn about, in world space.

    Raises
    ------
    ApartError
        They differ in size or projection, or in the shape of their lenses.
    """
    if (one.size, one.projection) != (other.size, other.projection):
        words = f"a {one.projection} camera of size {one.size}, as {BEFORE} is"
        raise ApartError(f"expected {words}, got {other.projection} and {other.size}")
    if share <= 0.0 or one == other:
        return one
    if share >= 1.0:
        return other
    axes, others = axes_of(one), axes_of(other)
    turn, end = _turn_of(axes), _turn_of(others)
    if sum(a * b for a, b in zip(turn, end, strict=True)) < 0:
        end = (-end[0], -end[1], -end[2], -end[3])
    right, down, forward = _axes_of(part_way(turn, end, share, _middle_turn))
    # Where the pivot is, as the camera sees it.
    start, stop = _seen(one, axes, pivot), _seen(other, others, pivot)
    x, y = (a + (b - a) * share for a, b in zip(start[:2], stop[:2], strict=True))
    if start[2] > 0 and stop[2] > 0:
        z = part_way(start[2], stop[2], share, _mean)
    else:
        z = start[2] + (stop[2] - start[2]) * share
    eye = along(along(along(pivot, -x, right), -y, down), -z, forward)
    focus = part_way(one.focus, other.focus, share, _mean)
    across, below = (
        part_way(a / one.focus, b / other.focus, share, _mean) * focus
        if one.projection == "perspective"
        else part_way(a, b, share, _mean)
        for a, b in zip(one.resolution, other.resolution, strict=True)
    )
    return one.replace(
        center=Vector(*along(eye, focus, forward)),
        normal=Direction(*forward),
        up=Direction(-down[0], -down[1], -down[2]),
        focus=focus,
        resolution=(across, below),
        lens=_between_lenses(one, other, share),
    )


def _between_lenses(one: Camera, other: Camera, share: float) -> Lens | None:
    """Return the lens at a share of the way from one camera to another; a pinhole has radius 0."""
    first, last = one.lens or other.lens, other.lens or one.lens
    if first is None or last is None:
        return None
    if first.blades != last.blades:
        words = f"a lens of {_blades(first)}, as {BEFORE} has"
        raise ApartError(f"expected {words}, got one of {_blades(last)}")
    start, stop = (camera.lens.radius if camera.lens else 0.0 for camera in (one, other))
    radius = start + (stop - start) * share
    if first.focus_on is not None and first.focus_on == last.focus_on:
        return first.replace(radius=radius)
    near = sharp_distance(first, one if one.lens else other)
    far = sharp_distance(last, other if other.lens else one)
    distance = part_way(near, far, share, _mean)
    return first.replace(radius=min(radius, distance), focus_distance=distance, focus_on=None)


def _blades(lens: Lens) -> str:
    """Say of what shape an opening is."""
    return f"{lens.blades} blades" if lens.blades else "a disc"


def _seen(camera: Camera, axes: tuple[Vec, Vec, Vec], point: Vec) -> Vec:
    """Return where a point is relative to the eye: to the right, below and ahead."""
    center = camera.center
    x, y, z = along((center.x, center.y, center.z), -camera.focus, axes[2])
    way = point[0] - x, point[1] - y, point[2] - z
    return dot(way, axes[0]), dot(way, axes[1]), dot(way, axes[2])


def _mean(one: float, other: float) -> float:
    """Return the geometric mean of two numbers > 0."""
    return math.sqrt(one) * math.sqrt(other)


def _middle_turn(one: Turn, other: Turn) -> Turn:
    """Return the turn in the middle of two that are less than half a turn apart."""
    a, b, c, d = (x + y for x, y in zip(one, other, strict=True))
    length = math.sqrt(a * a + b * b + c * c + d * d)
    return a / length, b / length, c / length, d / length


def _turn_of(axes: tuple[Vec, Vec, Vec]) -> Turn:
    """Return the turn that takes x, y and z to right-handed unit axes.

    References
    ----------
    S. W. Shepperd, "Quaternion from rotation matrix", Journal of Guidance and Control 1, 1978.
    """
    (a, d, g), (b, e, h), (c, f, i) = axes  # rows a b c, d e f, g h i
    trace = a + e + i
    squares = [1 + trace, 1 + 2 * a - trace, 1 + 2 * e - trace, 1 + 2 * i - trace]
    largest = max(range(4), key=squares.__getitem__)
    rows = [
        (squares[0], h - f, c - g, d - b),
        (h - f, squares[1], b + d, c + g),
        (c - g, b + d, squares[2], f + h),
        (d - b, c + g, f + h, squares[3]),
    ]
    half = 2 * math.sqrt(squares[largest])
    w, x, y, z = rows[largest]
    return w / half, x / half, y / half, z / half


def _axes_of(turn: Turn) -> tuple[Vec, Vec, Vec]:
    """Return where a turn takes x, y and z."""
    w, x, y, z = turn
    return (
        (1 - 2 * (y * y + z * z), 2 * (x * y + w * z), 2 * (x * z - w * y)),
        (2 * (x * y - w * z), 1 - 2 * (x * x + z * z), 2 * (y * z + w * x)),
        (2 * (x * z + w * y), 2 * (y * z - w * x), 1 - 2 * (x * x + y * y)),
    )
