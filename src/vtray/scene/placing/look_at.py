"""Where a camera stands and what it sees, as the fields of `vtray.Camera`."""

import math
from typing import Any

from vtray.base.errors import SceneError
from vtray.base.exact_math import hypotenuse, tangent
from vtray.scene.checks.limits import FieldOfView, Positive, SizePair
from vtray.scene.placing.directions import Vec, along, are_parallel, unit
from vtray.scene.vectors import Direction, Vector

NEAR = 2.0**-20
"""Distance from eye to image plane, relative to that of what is looked at.

Only what is nearer to the eye is lost. Rounding carries a point by less than 2**-47 of the
distances in the scene, and rays are made of ratios of lengths, so it could be far less; but a
camera can be written down and read by people only if its numbers are not too small.
"""


def argument(call: str, name: str, value: object, kind: Any) -> Any:  # noqa: ANN401
    """Return an argument of a call as an object of a kind.

    Raises
    ------
    SceneError
        If it is not of the kind.
    """
    from vtray.scene.checks.scene_check import from_code

    is_kind = isinstance(kind, type) and isinstance(value, kind)
    return value if is_kind else from_code(value, kind, f"{call}: {name}")


def looking(
    call: str,
    eye: object,
    target: object,
    up: object,
    size: object,
    fov_degrees: object,
    height: object,
) -> dict[str, Any]:
    """Return the fields of a camera that looks from one point to another.

    Parameters
    ----------
    call
        What messages begin with.
    eye, target, up, size
        As for `Camera.look_at`.
    fov_degrees
        The vertical field of view for a perspective, None for an orthographic picture.
    height
        The height of the picture in scene units for an orthographic one.

    Raises
    ------
    SceneError
        If an argument is not right.
    """
    start = argument(call, "eye", eye, Vector)
    end = argument(call, "target", target, Vector)
    upward = argument(call, "up", up, Direction)
    pixels = argument(call, "size", size, SizePair)
    offset = (end.x - start.x, end.y - start.y, end.z - start.z)
    distance = hypotenuse(*offset)
    if distance == 0:
        words = f"expected a point other than eye, got {_triple(end)}"
        raise SceneError(f"{call}: target: {words}")
    if not math.isfinite(distance):
        words = "a point at a distance from eye that is a double"
        raise SceneError(f"{call}: target: expected {words}, got {_triple(end)}")
    forward = unit(Direction(*offset))
    if are_parallel(forward, unit(upward)):
        words = "expected a direction that is not parallel to the line from eye to target"
        remedy = "(0, 0, 1)" if abs(forward[2]) < 0.5 else "(0, 1, 0)"
        got = f"got {_triple(upward)}; take for instance {remedy}"
        raise SceneError(f"{call}: up: {words}, {got}")
    if height is None:
        angle = argument(call, "fov_degrees", fov_degrees, FieldOfView)
        return perspective(
            _triple(start), forward, upward, distance * NEAR, pixel_slope(angle, pixels), pixels
        )
    pixel = argument(call, "height", height, Positive) / pixels[1]
    return orthographic(_triple(start), forward, upward, distance * NEAR, pixel, pixels)


def pixel_slope(fov_degrees: float, size: tuple[int, int]) -> float:
    """Return the width of a pixel at distance 1 from the eye for a vertical field of view."""
    return 2 * tangent(fov_degrees / 2) / size[1]


def perspective(
    eye: Vec,
    forward: Vec,
    up: Direction,
    focus: float,
    slope: float,
    size: tuple[int, int],
) -> dict[str, Any]:
    """Return the fields of a perspective camera; `slope` is that of one pixel."""
    return {**_fields(eye, forward, up, focus, size), "resolution": (focus * slope, focus * slope)}


def orthographic(
    eye: Vec,
    forward: Vec,
    up: Direction,
    focus: float,
    pixel: float,
    size: tuple[int, int],
) -> dict[str, Any]:
    """Return the fields of an orthographic camera; `pixel` is the width of one."""
    fields = _fields(eye, forward, up, focus, size)
    return {**fields, "resolution": (pixel, pixel), "projection": "orthographic"}


def _fields(
    eye: Vec, forward: Vec, up: Direction, focus: float, size: tuple[int, int]
) -> dict[str, Any]:
    """Return the fields that do not depend on the projection."""
    center = along(eye, focus, forward)
    return {"center": center, "normal": forward, "focus": focus, "size": size, "up": up}


def _triple(vector: Vector | Direction) -> Vec:
    return vector.x, vector.y, vector.z
