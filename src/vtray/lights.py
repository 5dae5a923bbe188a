"""Ready-made lights, as photographers set them up, made of point lights.

Each function looks at a scene's camera and at the sphere around its spheres, the subject, and
returns a list of lights for ``scene.lights``. Angles are seen from the subject: 0 degrees is the
direction to the camera, along its axis; what is up and to the right is so in the picture. So the
subject is lit in the same way from wherever the picture is taken, if the function is called again
when the camera has moved. Key is the light that makes the shadows, fill the one that brightens
them; there is no fall-off with distance, so that the ratio of their intensities is that of the
light they throw.

`cloudy` and `lightbox` are the light of a place, and go by what is up in the world: `up`, if it is
given. Else it is the normal of the scene's first plane, on the side of the spheres, as for
`Camera.fit`, unless the camera's `up` is the normal of another one. Without planes it is the
camera's `up`, or where it has none, up in the picture.

>>> scene.lights = vtray.lights.rembrandt(scene)
"""

import math
from collections.abc import Iterable, Iterator
from typing import TYPE_CHECKING, Annotated, Any, Literal, NamedTuple, Protocol

from msgspec import Meta

from vtray.bounds import balls_of, bounding_sphere, ups_of_planes
from vtray.camera import camera_axes
from vtray.cameras import Camera
from vtray.directions import Vec, along, are_parallel, cross, dot, unit, view_axes
from vtray.errors import SceneError
from vtray.exact_math import cosine, hypotenuse, sine
from vtray.kinds import NonNegative
from vtray.objects import Light, Object
from vtray.triples import Direction
from vtray.views import argument

if TYPE_CHECKING:
    from vtray.triples import Triple, Vector

Side = Literal["left", "right"]
Ratio = Annotated[float, Meta(ge=1, description="a number ≥ 1")]
Count = Annotated[int, Meta(ge=1, le=4096, description="an integer from 1 to 4096")]

DISTANCE = 6.0
"""How far lights are from the middle of the subject, in radii of the sphere around it."""

SKY = 1000.0
"""How far the lights of the sky are, so that they come from the same direction everywhere."""

GOLDEN_ANGLE = 180 * (3 - math.sqrt(5))
"""In degrees: points that turn by it from one to the next never line up."""


class HasCamera(Protocol):
    """A scene, as far as lights are concerned."""

    @property
    def camera(self) -> Camera: ...  # noqa: D102

    @property
    def objects(self) -> list[Object]: ...  # noqa: D102


def rembrandt(
    scene: HasCamera, intensity: float = 1.0, *, side: Side = "left", ratio: float = 4.0
) -> list[Light]:
    """Return Rembrandt light: a key high on one side, and a weak fill on the other.

    The key is 45 degrees to the side and 45 above; on a face it leaves a triangle of light on the
    cheek in shadow. The fill is 30 degrees to the other side and 10 above, two stops weaker (4:1).

    Parameters
    ----------
    scene
        A scene with a camera and at least one sphere.
    intensity
        Intensity of the key.
    side
        Where the key stands in the picture, "left" or "right".
    ratio
        Key to fill, ≥ 1; a larger one gives darker shadows.

    Returns
    -------
    list of Light
        The key and the fill.

    Raises
    ------
    SceneError
        If the scene has no camera or no sphere, or an argument is not right.
    """
    studio = _studio("rembrandt", scene)
    return studio.key_and_fill(intensity, side, ratio, key=(45, 45), fill=(-30, 10))


def loop(
    scene: HasCamera, intensity: float = 1.0, *, side: Side = "left", ratio: float = 3.0
) -> list[Light]:
    """Return loop light, the portrait photographer's usual one: softer shadows than Rembrandt's.

    The key is 35 degrees to the side and 30 above; on a face the nose throws a small loop of
    shadow. The fill is 30 degrees to the other side and 10 above, at 3:1.

    Parameters, result and errors are those of `rembrandt`.
    """
    studio = _studio("loop", scene)
    return studio.key_and_fill(intensity, side, ratio, key=(35, 30), fill=(-30, 10))


def split(
    scene: HasCamera, intensity: float = 1.0, *, side: Side = "left", ratio: float = 8.0
) -> list[Light]:
    """Return split light: one half bright, the other dark.

    The key is 90 degrees to the side and 10 above; the fill comes from the camera, three stops
    weaker (8:1).

    Parameters, result and errors are those of `rembrandt`.
    """
    studio = _studio("split", scene)
    return studio.key_and_fill(intensity, side, ratio, key=(90, 10), fill=(0, 5))


def butterfly(scene: HasCamera, intensity: float = 1.0, *, ratio: float = 3.0) -> list[Light]:
    """Return butterfly light, also called Paramount light: a key straight above the camera.

    The key is 50 degrees above; on a face the nose throws a shadow like a butterfly below it. The
    fill comes from the camera, at 3:1. (In a studio it is a reflector below, which a floor in the
    scene would hide.)

    Parameters
    ----------
    scene
        A scene with a camera and at least one sphere.
    intensity
        Intensity of the key.
    ratio
        Key to fill, ≥ 1.

    Returns
    -------
    list of Light
        The key and the fill.

    Raises
    ------
    SceneError
        If the scene has no camera or no sphere, or an argument is not right.
    """
    studio = _studio("butterfly", scene)
    return studio.key_and_fill(intensity, "right", ratio, key=(0, 50), fill=(0, 5))


def ring(scene: HasCamera, intensity: float = 1.0, *, count: int = 24) -> list[Light]:
    """Return a ring light: lamps in a circle around the camera's lens.

    The circle is 12 degrees from the camera's axis. Everything is lit from the front, without
    strong shadows but for a soft rim around what is in front of something else.

    Parameters
    ----------
    scene
        A scene with a camera and at least one sphere.
    intensity
        Intensity of all lights together.
    count
        How many lights there are, from 1 to 4096; more give softer shadows, and take longer.

    Returns
    -------
    list of Light
        Lights of the same intensity.

    Raises
    ------
    SceneError
        If the scene has no camera or no sphere, or an argument is not right.
    """
    studio = _studio("ring", scene)
    number = studio.checked("count", count, Count)
    aside, ahead = sine(12), cosine(12)
    turns = (360 * (k + 0.5) / number for k in range(number))
    directions = ((aside * sine(turn), aside * cosine(turn), ahead) for turn in turns)
    return studio.share(intensity, ((direction, 1.0) for direction in directions), number)


def cloudy(
    scene: HasCamera,
    intensity: float = 1.0,
    *,
    count: int = 64,
    up: "Direction | Vector | Triple | None" = None,
) -> list[Light]:
    """Return the light of an overcast sky: from all sides above, with the softest shadows.

    The lights are spread evenly over half a sphere. The sky is three times as bright straight above
    as at the horizon, as that of the CIE's standard overcast sky.

    Parameters
    ----------
    scene
        A scene with a camera and at least one sphere.
    intensity
        Light on a surface that faces straight up with nothing above it, as that of a single light
        there.
    count
        How many lights there are, from 1 to 4096; more give softer shadows, and take longer.
    up
        What is up in the world. By default the normal of the scene's first plane, on the side of
        the spheres, unless the camera's `up` is the normal of another one; without planes, the
        camera's `up`, or where it has none, up in the picture.

    Returns
    -------
    list of Light
        Lights of different intensities.

    Raises
    ------
    SceneError
        If the scene has no camera or no sphere, or an argument is not right.

    References
    ----------
    P. Moon, D. E. Spencer: *Illumination from a non-uniform sky*, 1942.
    """
    studio = _studio("cloudy", scene).upright(scene, up)
    number = studio.checked("count", count, Count)
    sky = []
    for k in range(number):
        height = (k + 0.5) / number  # equal steps of height are equal areas of a sphere
        across = math.sqrt(1 - height * height)
        turn = k * GOLDEN_ANGLE
        direction = (across * sine(turn), height, across * cosine(turn))
        sky.append((direction, (1 + 2 * height) / 3))
    upward = math.fsum(light * direction[1] for direction, light in sky)
    return studio.at(SKY).share(intensity, sky, upward)


def lightbox(
    scene: HasCamera,
    intensity: float = 1.0,
    *,
    count: int = 48,
    up: "Direction | Vector | Triple | None" = None,
) -> list[Light]:
    """Return the light of a tent for product photographs: large white panels on three sides.

    One panel is on each side, 60 degrees from the camera and 20 above the horizon, and one
    overhead, 75 degrees above it, all equally bright and as wide as they are far. They leave weak,
    soft shadows below.

    Parameters
    ----------
    scene
        A scene with a camera and at least one sphere.
    intensity
        Intensity of each panel, all its lights together.
    count
        How many lights there are at least, from 1 to 4096, in three square grids.
    up
        What is up in the world, as for `cloudy`.

    Returns
    -------
    list of Light
        Lights of the same intensity.

    Raises
    ------
    SceneError
        If the scene has no camera or no sphere, or an argument is not right.
    """
    studio = _studio("lightbox", scene).upright(scene, up)
    number = studio.checked("count", count, Count)
    rows = math.isqrt(math.ceil(number / 3) - 1) + 1
    panels = [_direction(-60, 20), _direction(60, 20), _direction(0, 75)]
    grid = [point for panel in panels for point in _panel(panel, rows)]
    return studio.share(intensity, ((point, 1.0) for point in grid), rows * rows)


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
            self.light(_direction(sign * aside, above), light)
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


def _studio(call: str, scene: HasCamera) -> Studio:
    """Return where the lights of a scene are placed."""
    camera = scene.camera
    if _is_none(camera):
        remedy = "set scene.camera first, for instance to vtray.Camera.fit(scene)"
        raise SceneError(f"lights.{call}: there is no camera to place lights around; {remedy}")
    middle, radius = bounding_sphere(balls_of(scene, f"lights.{call}"))
    forward = unit(camera.normal)
    if camera.up is None:
        right, down = camera_axes(forward)
    else:
        right, down = view_axes(forward, unit(camera.up))
    x, y, z = (float(part) for part in middle)
    up = _turned(down)
    sky = up if camera.up is None else unit(camera.up)
    reach = DISTANCE * (radius or 1.0)
    return Studio(call, (x, y, z), reach, right, up, _turned(forward), sky)


def _is_none(value: object) -> bool:
    return value is None


def _turned(axis: Vec) -> Vec:
    """Return the opposite direction, without negative zeros."""
    return 0.0 - axis[0], 0.0 - axis[1], 0.0 - axis[2]


def _direction(aside: float, above: float) -> Vec:
    """Return the unit vector, right, up and towards the camera, of angles in degrees."""
    across = cosine(above)
    return across * sine(aside), sine(above), across * cosine(aside)


def _panel(middle: Vec, rows: int) -> Iterator[Vec]:
    """Give the places of lights in a square panel that faces the subject, as wide as it is far."""
    level = cross((0.0, 1.0, 0.0), middle)
    level = unit(Direction(*level))
    steep = cross(middle, level)
    offsets = [(k + 0.5) / rows - 0.5 for k in range(rows)]
    for a in offsets:
        for b in offsets:
            yield along(along(middle, a, level), b, steep)
