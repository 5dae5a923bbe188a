"""Panoramas: pictures of all directions, as wide as a turn and as high as half of one."""

import math
from typing import TYPE_CHECKING, Any, Protocol

from vtray.base.errors import SceneError

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray


class HasPicture(Protocol):
    """A camera, as far as its picture goes; see `vtray.Camera`."""

    @property
    def size(self) -> tuple[float, float]: ...  # noqa: D102

    @property
    def projection(self) -> str: ...  # noqa: D102


def looking_around(
    call: str, eye: object, target: object, up: object, size: object
) -> dict[str, Any]:
    """Return the fields of `Camera.panorama`."""
    from vtray.scene.placing.look_at import argument, looking
    from vtray.scene.vectors import Vector

    fields = looking(call, eye, target, up, size, None, 1.0)
    center = argument(call, "eye", eye, Vector)
    return {**fields, "center": center, "resolution": (1.0, 1.0), "projection": "panorama"}


def check_flat(camera: HasPicture, call: str, remedy: str) -> None:
    """Raise SceneError if a camera is that of a panorama."""
    if camera.projection == "panorama":
        raise SceneError(f"{call}: not for a panorama, which shows all around; {remedy}")


def pixel_angle(camera: HasPicture) -> float:
    """Return the larger side of a pixel of a panorama in its middle, in radians."""
    width, height = camera.size
    return max(2.0 * math.pi / width, math.pi / height)


def around(
    camera: HasPicture,
    across: "NDArray[np.float64]",
    below: "NDArray[np.float64]",
    ahead: "NDArray[np.float64]",
) -> "tuple[NDArray[np.float64], NDArray[np.float64], NDArray[np.float64]]":
    """Return columns, rows and distances of points in a panorama.

    Parameters
    ----------
    camera
        The camera.
    across, below, ahead
        Where the points are from it, to the right, downwards and forward.
    """
    import numpy as np

    from vtray.base.exact_math import angle

    width, height = camera.size
    level = np.sqrt(across * across + ahead * ahead)
    column = (angle(ahead, across) / (2.0 * math.pi) + 0.5) * width - 0.5
    row = (angle(level, below) / math.pi + 0.5) * height - 0.5
    return column, row, np.sqrt(level * level + below * below)
