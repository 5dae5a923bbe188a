"""Where ready-made lights are placed: around the subject, by angles seen from it."""

from collections.abc import Iterable
from typing import Annotated, Any, Literal, NamedTuple, Protocol

from msgspec import Meta

from vtray.base.errors import SceneError
from vtray.base.exact_math import cosine, hypotenuse, sine
from vtray.scene.camera import Camera
from vtray.scene.checks.limits import NonNegative
from vtray.scene.light_types import Light, Sun
from vtray.scene.objects import Object
from vtray.scene.placing.bounding_sphere import bounding_sphere
from vtray.scene.placing.bounds import balls_of, ups_of_planes
from vtray.scene.placing.directions import (
    Vec,
    along,
    are_parallel,
    camera_axes,
    cross,
    dot,
    unit,
    view_axes,
)
from vtray.scene.placing.look_at import argument
from vtray.scene.vectors import Direction

Side = Literal["left", "right"]
Ratio = Annotated[float, Meta(ge=1, description="a number ≥ 1")]

DISTANCE = 6.0
"""How far lights are from the middle of the subject, in radii of the sphere around it."""


class HasCamera(Protocol):
    """A scene, as far as lights are concerned."""

    @property
    def camera(self) -> Camera: ...  # noqa: D102

    @property
    def objects(self) -> list[Object]: ...  # noqa: D102


class Studio(NamedTuple):
    """Where lights are placed.

    Attributes
    ----------
    call
        The function that places them, for messages.
    middle
        The middle of the subject, in world space.
    reach
        Distance of lights from it, in scene units.
    right, up, back
        Unit axes to the right and up in the picture, and towards the camera.
    sky
        What the camera has for up in the world, a unit vector.
    """

    call: str
    middle: Vec
    reach: float
    right: Vec
    up: Vec
    back: Vec
    sky: Vec

    def checked(self, name: str, value: object, kind: Any) -> Any:  # noqa: ANN401
        """Return an argument of the function, or raise SceneError."""
        return argument(f"lights.{self.call}", name, value, kind)

    def light(self, direction: Vec, intensity: float) -> Light:
        """Return a light; the direction is right, up and towards the camera, of any length."""
        place = self.middle
        for part, axis in zip(direction, (self.right, self.up, self.back), strict=True):
            place = along(place, part * self.reach, axis)
        return Light(place, intensity)

    def sun(self, direction: Vec, angle: float, intensity: float) -> Sun:
        """Return a lamp far away, of an angle in degrees; the direction is that of `light`."""
        place: Vec = (0.0, 0.0, 0.0)
        for part, axis in zip(direction, (self.right, self.up, self.back), strict=True):
            place = along(place, -part, axis)
        return Sun(place, intensity, angle)

    def key_and_fill(
        self,
        intensity: object,
        side: object,
        ratio: object,
        *,
        key: tuple[float, float],
        fill: tuple[float, float],
    ) -> list[Light]:
        """Return two lights, each given by its angles to the key's side and above."""
        strength = self.checked("intensity", intensity, NonNegative)
        sign = -1 if self.checked("side", side, Side) == "left" else 1
        weaker = strength / self.checked("ratio", ratio, Ratio)
        return [
            self.light(direction(sign * aside, above), light)
            for (aside, above), light in ((key, strength), (fill, weaker))
        ]

    def share(
        self, intensity: object, parts: Iterable[tuple[Vec, float]], whole: float
    ) -> list[Light]:
        """Return lights that share an intensity, each given by its direction and its part."""
        strength = self.checked("intensity", intensity, NonNegative)
        return [self.light(direction, strength * part / whole) for direction, part in parts]

    def upright(self, scene: HasCamera, up: object) -> "Studio":
        """Return the same with what is up in the world as `up`, given or found in the scene."""
        if up is None:
            ups = ups_of_planes(scene, self.middle)
            is_sure = not ups or any(are_parallel(other, self.sky) for other in ups)
            sky = self.sky if is_sure else ups[0]
        else:
            sky = unit(self.checked("up", up, Direction))
        # Turned by what of the direction to the camera is level, or of up in the picture.
        level = next(axis for axis in (self.back, self.up) if hypotenuse(*cross(axis, sky)) > 1e-3)
        level = unit(Direction(*along(level, -dot(level, sky), sky)))
        return self._replace(right=cross(sky, level), up=sky, back=level)

    def at(self, distance: float) -> "Studio":
        """Return the same with lights at a distance in radii of the subject."""
        return self._replace(reach=self.reach / DISTANCE * distance)


def studio_of(call: str, scene: HasCamera) -> Studio:
    """Return where the lights of a scene are placed."""
    camera = scene.camera
    if _is_none(camera):
        remedy = "set scene.camera first, for instance to vtray.Camera.fit(scene)"
        raise SceneError(f"lights.{call}: there is no camera to place lights around; {remedy}")
    middle, radius = bounding_sphere(*balls_of(scene, f"lights.{call}"))
    forward = unit(camera.normal)
    if camera.up is None:
        right, down = camera_axes(forward)
    else:
        right, down = view_axes(forward, unit(camera.up))
    x, y, z = (float(part) for part in middle)
    up = turned(down)
    sky = up if camera.up is None else unit(camera.up)
    reach = DISTANCE * (radius or 1.0)
    return Studio(call, (x, y, z), reach, right, up, turned(forward), sky)


def _is_none(value: object) -> bool:
    return value is None


def turned(axis: Vec) -> Vec:
    """Return the opposite direction, without negative zeros."""
    return 0.0 - axis[0], 0.0 - axis[1], 0.0 - axis[2]


def direction(aside: float, above: float) -> Vec:
    """Return the unit vector, right, up and towards the camera, of angles in degrees."""
    across = cosine(above)
    return across * sine(aside), sine(above), across * cosine(aside)
