"""Where ready-made lights are placed: around the subject, by angles seen from it."""

from collections.abc import Iterable
from typing import Annotated, Any, Literal, NamedTuple, Protocol

from msgspec import Meta

from vtray.base.errors import SceneError
from vtray.base.exact_math import cosine, hypotenuse, sine
from vtray.scene.camera import Camera
from vtray.scene.checks.limits import NonNegative, YesOrNo
from vtray.scene.checks.scene_words import show
from vtray.scene.light_types import AnyLight, Light, SphereLight, Sun
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
Count = Annotated[int, Meta(ge=1, le=4096, description="an integer from 1 to 4096")]

DISTANCE = 6.0
"""How far lights are from the middle of the subject, in radii of the sphere around it."""

KEY_DEGREES, FILL_DEGREES = 20.0, 40.0
"""How large a key and a fill are, as seen from there."""


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

    def strength(self, intensity: object) -> float:
        """Return the intensity that was given, checked."""
        strength: float = self.checked("intensity", intensity, NonNegative)
        return strength

    def how_many(self, count: object, usual: int, points: object) -> int:
        """Return how many points there are, or 0 where a lamp has a size instead."""
        if self.checked("points", points, YesOrNo):
            return usual if count is None else int(self.checked("count", count, Count))
        if count is not None:
            words = "how many points there are, only beside points=True"
            raise SceneError(f"lights.{self.call}: count: {words}; leave it out, or add that")
        return 0

    def vector(self, direction: Vec) -> Vec:
        """Return how far in world space a direction leads to the right, up, and to the camera."""
        return self._from((0.0, 0.0, 0.0), direction, self.reach)

    def place(self, direction: Vec) -> Vec:
        """Return where a lamp stands in a direction."""
        return self._from(self.middle, direction, self.reach)

    def _from(self, start: Vec, direction: Vec, length: float) -> Vec:
        for part, axis in zip(direction, (self.right, self.up, self.back), strict=True):
            start = along(start, part * length, axis)
        return start

    def light(self, direction: Vec, intensity: float) -> Light:
        """Return a point; the direction is right, up and towards the camera, of any length."""
        return Light(self.place(direction), intensity)

    def lamp(self, direction: Vec, angle: float, intensity: float) -> SphereLight:
        """Return a shining ball that looks so large from the subject's middle, in degrees."""
        return SphereLight(self.place(direction), self.reach * sine(angle / 2), intensity)

    def sun(self, direction: Vec, angle: float, intensity: float) -> Sun:
        """Return a lamp far away, of an angle in degrees; the direction is that of `light`."""
        return Sun(self._from((0.0, 0.0, 0.0), direction, -1.0), intensity, angle)

    def key_and_fill(
        self,
        intensity: object,
        side: object,
        ratio: object,
        points: object,
        *,
        key: tuple[float, float],
        fill: tuple[float, float],
    ) -> list[AnyLight]:
        """Return two lights, each given by its angles to the key's side and above."""
        strength = self.strength(intensity)
        sign = -1 if self.checked("side", side, Side) == "left" else 1
        weaker = strength / self.checked("ratio", ratio, Ratio)
        to_key, to_fill = (direction(sign * aside, above) for aside, above in (key, fill))
        if self.checked("points", points, YesOrNo):
            return [self.light(to_key, strength), self.light(to_fill, weaker)]
        return [
            self.lamp(to_key, KEY_DEGREES, strength),
            self.lamp(to_fill, FILL_DEGREES, weaker),
        ]

    def share(
        self, intensity: object, parts: Iterable[tuple[Vec, float]], whole: float
    ) -> list[AnyLight]:
        """Return points that share an intensity, each given by its direction and its part."""
        strength = self.strength(intensity)
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
    camera = getattr(scene, "camera", scene)
    if camera is None and scene is not None:
        remedy = "set scene.camera first, for instance to vtray.Camera.fit(scene)"
        raise SceneError(f"lights.{call}: there is no camera to place lights around; {remedy}")
    if not isinstance(camera, Camera):
        words = "expected a vtray.Scene with a camera"
        raise SceneError(f"lights.{call}: scene: {words}, got {show(scene)}")
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


def turned(axis: Vec) -> Vec:
    """Return the opposite direction, without negative zeros."""
    return 0.0 - axis[0], 0.0 - axis[1], 0.0 - axis[2]


def direction(aside: float, above: float) -> Vec:
    """Return the unit vector, right, up and towards the camera, of angles in degrees."""
    across = cosine(above)
    return across * sine(aside), sine(above), across * cosine(aside)
