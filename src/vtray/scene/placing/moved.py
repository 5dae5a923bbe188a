"""Cameras made of others: turned about what they look at, side by side, nearer; and what they see.

Cameras from `Camera.look_at`, `Camera.orthographic` and, in perspective, `Camera.fit` look at a
point: their focus is a known part of its distance.
"""

from typing import TYPE_CHECKING, Any, Protocol

from vtray.base.errors import SceneError
from vtray.base.exact_math import cosine, sine
from vtray.scene.checks.limits import Positive, Real, Zoom
from vtray.scene.checks.scene_words import show
from vtray.scene.placing.directions import (
    Vec,
    along,
    camera_axes,
    cross,
    dot,
    times,
    unit,
    view_axes,
)
from vtray.scene.placing.look_at import NEAR, argument
from vtray.scene.placing.panorama import around, check_flat
from vtray.scene.vectors import Direction, Vector

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import ArrayLike, NDArray

WORLD: tuple[Vec, ...] = ((0, 0, 1), (0, 1, 0), (1, 0, 0), (0, 0, -1), (0, -1, 0), (-1, 0, 0))
"""Axes of the world that a camera may stand upright on, the usual one first."""

STRAIGHT = 1e-9
"""The cosine of an angle that is taken for a right one."""

LEANING = 0.1
"""The least cosine of the angle between an axis and what is up in the picture."""


class HasView(Protocol):
    """A camera, as far as what it sees goes; see `vtray.Camera`."""

    @property
    def center(self) -> Vector: ...  # noqa: D102

    @property
    def normal(self) -> Direction: ...  # noqa: D102

    @property
    def focus(self) -> float: ...  # noqa: D102

    @property
    def size(self) -> tuple[float, float]: ...  # noqa: D102

    @property
    def resolution(self) -> tuple[float, float]: ...  # noqa: D102

    @property
    def up(self) -> Direction | None: ...  # noqa: D102

    @property
    def projection(self) -> str: ...  # noqa: D102


def axes_of(camera: HasView) -> tuple[Vec, Vec, Vec]:
    """Return the unit axes of a camera: to the right, downwards and forward."""
    forward = unit(camera.normal)
    if camera.up is None:
        return (*camera_axes(forward), forward)
    return (*view_axes(forward, unit(camera.up)), forward)


def up_of(camera: HasView, tilt: float = 0.0) -> Direction:
    """Return what a camera goes around.

    Views that are named or given by angles have as `up` what is up in the picture; the camera
    stands upright on an axis of the world all the same.

    Parameters
    ----------
    camera
        The camera. It goes around an `up` that is not square to its view.
    tilt
        How far the camera is above what it should go around, in degrees, if it stands upright on
        no axis of the world.
    """
    right, down, forward = axes_of(camera)
    if camera.up is not None and abs(dot(unit(camera.up), forward)) > STRAIGHT:
        return camera.up
    up = times(-1.0, down)
    for axis in WORLD:
        if abs(dot(axis, right)) < STRAIGHT and dot(axis, up) > LEANING:
            return Direction(*axis)
    return Direction(*along(times(cosine(tilt), up), -sine(tilt), forward))


def orbiting(camera: HasView, degrees: object, elevation: object, about: object) -> dict[str, Any]:
    """Return the fields of `Camera.orbit` that change."""
    call = "Camera.orbit"
    turn = argument(call, "degrees", degrees, Real)
    rise = argument(call, "elevation", elevation, Real)
    target = _target(camera, about, call)
    forward = unit(camera.normal)
    axis = up_of(camera)
    up = unit(axis)
    eye = along(_vec(camera.center), -camera.focus, forward)
    offset = (eye[0] - target[0], eye[1] - target[1], eye[2] - target[2])
    right = axes_of(camera)[0]
    away = cross(right, up)
    lifted = [turned_about(vector, right, -rise) for vector in (offset, forward)]
    if not dot(lifted[1], away) < 0:
        words = "an elevation that leaves the camera on its side of what is up"
        raise SceneError(f"{call}: elevation: expected {words}, got {show(elevation)}")
    offset, forward = (turned_about(vector, up, turn) for vector in lifted)
    forward = unit(Direction(*forward))
    eye = (target[0] + offset[0], target[1] + offset[1], target[2] + offset[2])
    return {
        "center": Vector(*along(eye, camera.focus, forward)),
        "normal": Direction(*forward),
        "up": axis,
    }


def side_by_side(
    camera: HasView, separation: object, about: object
) -> tuple[dict[str, Any], dict[str, Any]]:
    """Return the fields of the cameras of `Camera.stereo` that change."""
    call = "Camera.stereo"
    check_flat(camera, call, "take cameras that look one way, by Camera.look_at")
    apart = argument(call, "separation", separation, Positive)
    target = _target(camera, about, call)
    right, down, forward = axes_of(camera)
    middle = along(_vec(camera.center), -camera.focus, forward)
    found = []
    for side in (-0.5, 0.5):
        eye = along(middle, side * apart, right)
        way = (target[0] - eye[0], target[1] - eye[1], target[2] - eye[2])
        if not dot(way, forward) > 0:
            words = "expected a point in front of the camera"
            raise SceneError(f"{call}: about: {words}, got {show(target)}")
        toward = unit(Direction(*way))
        center = Vector(*along(eye, camera.focus, toward))
        up = Direction(*times(-1.0, down))
        found.append({"center": center, "normal": Direction(*toward), "up": up})
    return found[0], found[1]


def zoomed(camera: HasView, factor: object, place: str) -> dict[str, Any]:
    """Return the fields that change of a camera whose picture shows all so many times as large."""
    from vtray.scene.checks.scene_check import from_code

    check_flat(camera, place.partition(":")[0], "take a camera that looks one way")
    ratio = from_code(factor, Zoom, place)
    width, height = camera.resolution
    return {"resolution": (width / ratio, height / ratio)}


def projected(camera: HasView, points: "ArrayLike") -> "NDArray[np.float64]":
    """Return where points are in a picture, as `Camera.project` does."""
    import numpy as np

    from vtray.scene.checks.given_array import array_of, show_array

    place, words = "Camera.project: points", "expected numbers of shape (n, 3)"
    found = array_of(points, place, words)
    try:
        given = np.asarray(found, None if found.dtype.kind == "c" else np.float64)
    except (TypeError, ValueError, OverflowError):
        given = found
    if given.dtype != np.float64:
        raise SceneError(f"{place}: {words}, got {show_array(found)}")
    if given.ndim == 0 or given.shape[-1] != 3:
        raise SceneError(f"{place}: {words}, got shape {given.shape}")
    right, down, forward = axes_of(camera)
    center = camera.center
    with np.errstate(all="ignore"):
        x, y, z = (given[..., k] - c for k, c in enumerate((center.x, center.y, center.z)))
        across, below, ahead = (x * a + y * b + z * c for a, b, c in (right, down, forward))
        if camera.projection == "panorama":
            places = np.stack(around(camera, across, below, ahead), axis=-1)
            places[~(places[..., 2] > 0)] = np.nan
            return places
        if camera.projection == "perspective":
            far = ahead + camera.focus
            share = camera.focus / far  # of the way from the eye, what lies before the image plane
            depth = np.sqrt(across * across + below * below + far * far)
        else:
            share, depth = np.ones_like(ahead), ahead + camera.focus
        column = across * share / camera.resolution[0] + camera.size[0] / 2
        row = below * share / camera.resolution[1] + camera.size[1] / 2
    found = np.stack([column, row, depth], axis=-1)
    found[~(ahead > 0)] = np.nan
    return found


def _target(camera: HasView, about: object, call: str) -> Vec:
    """Return the point that a camera looks at, or that is given, or the middle of what is."""
    if about is None and camera.projection == "panorama":
        return along(_vec(camera.center), camera.focus / NEAR, unit(camera.normal))
    if about is None:
        return along(_vec(camera.center), camera.focus / NEAR - camera.focus, unit(camera.normal))
    if hasattr(about, "objects") or hasattr(about, "hull"):
        from vtray.scene.placing.bounds import middle_in

        return middle_in(about, call)
    return _vec(argument(call, "about", about, Vector))


def turned_about(vector: Vec, axis: Vec, degrees: float) -> Vec:
    """Return a vector turned about a unit axis: seen against it, counterclockwise.

    References
    ----------
    Rodrigues' rotation formula.
    """
    c, s = cosine(degrees), sine(degrees)
    beside = cross(axis, vector)
    rest = (1.0 - c) * dot(axis, vector)
    return (
        c * vector[0] + s * beside[0] + rest * axis[0],
        c * vector[1] + s * beside[1] + rest * axis[1],
        c * vector[2] + s * beside[2] + rest * axis[2],
    )


def _vec(point: Vector) -> Vec:
    return point.x, point.y, point.z
