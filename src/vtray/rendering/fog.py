"""Fog between its two distances, and as kernels see it."""

from collections.abc import Callable
from dataclasses import replace
from typing import NamedTuple

import numpy as np

from vtray.base.errors import SceneError
from vtray.rendering.pack import Packed
from vtray.scene.camera import Camera
from vtray.scene.placing.bounding_sphere import bounding_sphere
from vtray.scene.placing.bounds import Balls, balls_of
from vtray.scene.placing.depths import depths_of
from vtray.scene.placing.directions import Vec
from vtray.scene.scene import Scene
from vtray.scene.style import Fog, Style
from vtray.transport.fog import FogFrame

LARGEST = 2.0**900
"""Lengths in units of the arrays that are as good as any longer one."""


class Ball(NamedTuple):
    """A ball in world space: it is as far away however a camera is turned or goes around it."""

    middle: Vec
    radius: float

    def depths(self, camera: Camera) -> tuple[float, float]:
        """Return the distances of its nearest and its farthest point from a camera."""
        return depths_of(camera, [Balls(np.array([self.middle]), self.radius)])


class Shapes(NamedTuple):
    """The bounded shapes of a scene, as `Balls`."""

    parts: list[Balls]

    def depths(self, camera: Camera) -> tuple[float, float]:
        """Return the distances of the nearest and the farthest point of all from a camera.

        Where all are as far away, as points of a sheet may be, they are those of the ball around.
        """
        nearest, farthest = depths_of(camera, self.parts)
        return (nearest, farthest) if farthest > nearest else self.ball.depths(camera)

    @property
    def ball(self) -> Ball:
        """The ball around all."""
        middle, radius = bounding_sphere(*self.parts)
        x, y, z = map(float, middle)
        return Ball((x, y, z), radius)


def ball_around(scene: Scene) -> Ball | None:
    """Return the ball around all bounded objects of a scene; None if there are none."""
    shapes = shapes_of(scene)
    return None if shapes is None else shapes.ball


def shapes_of(scene: Scene) -> Shapes | None:
    """Return the bounded objects of a scene; None if there are none."""
    try:
        return Shapes(balls_of(scene, "fog"))
    except SceneError:
        return None


def fitted(style: Style, camera: Camera, around: Callable[[], Ball | Shapes | None]) -> Style:
    """Return a style whose fog has both its distances.

    What is not given is that of the bounded objects, whichever of them are seen: from the nearest
    of their points to the farthest or, in a movie, those of the ball around them all, which stay
    when the camera goes around it; so frames do not flicker.

    Parameters
    ----------
    style, camera
        The style, and the camera.
    around
        Gives the objects or the ball; only called where it is needed.

    Raises
    ------
    SceneError
        There is nothing to fit it to, or it ends where it begins.
    """
    fog = style.fog
    if not isinstance(fog, Fog) or not (fog.start is None or fog.end is None):
        return style
    found = around()
    if found is None:
        words = "there is nothing that it could be fitted to, as planes have no edge"
        raise SceneError(f"fog: {words}; give its two distances")
    nearest, farthest = found.depths(camera)
    start = max(nearest, 0.0) if fog.start is None else fog.start
    end = farthest if fog.end is None else fog.end
    if not end > start:
        words = f"expected a start before its end, got {start:g} and {end:g}, fitted to the scene"
        raise SceneError(f"fog: {words}; give both")
    return style.replace(fog=fog.replace(start=start, end=end))


def with_fog(packed: Packed, style: Style) -> Packed:
    """Return the arrays of a scene with the fog of a style whose distances are known."""
    fog = style.fog
    if not isinstance(fog, Fog):
        return packed
    assert fog.start is not None  # noqa: S101 - it was fitted
    assert fog.end is not None  # noqa: S101
    with np.errstate(over="ignore"):
        start = np.float64(fog.start - packed.before) / packed.unit
        length = np.float64(fog.end - fog.start) / packed.unit
    start, length = np.clip((start, length), (-LARGEST, 1.0 / LARGEST), LARGEST)
    frame = FogFrame(float(start), float(length))
    return replace(packed, arrays=packed.arrays._replace(fog=frame))
