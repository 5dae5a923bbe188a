"""The ready-made lights of `vtray.lights`."""

import math
from collections.abc import Iterator
from typing import TYPE_CHECKING

from vtray.base.exact_math import cosine, sine
from vtray.scene.checks.limits import NonNegative
from vtray.scene.checks.unknown_names import explain_unknown
from vtray.scene.light_types import Ambient, AnyLight, RectangleLight, Sky
from vtray.scene.placing.directions import Vec, along, cross, unit
from vtray.scene.sky_types import Gradient
from vtray.scene.studio import HasCamera, Side, Studio, direction, studio_of
from vtray.scene.vectors import Color, Direction

if TYPE_CHECKING:
    from vtray.scene.vectors import Triple, Vector

SKY = 1000.0
"""How far the points of the sky are, so that they come from the same direction everywhere."""

OVERCAST = Gradient(zenith=Color(255, 255, 255), horizon=Color(85, 85, 85), ground=Color(0, 0, 0))
"""Three times as bright straight above as at the horizon."""

UPWARD = 8 / 9
"""What a white surface shows that faces straight up, under an `OVERCAST` sky of radiance 1: the
mean over the half sphere of ``1/3 + 2/3 h (2 - h)``, weighed by h."""

RING_DEGREES = 12.0
"""Radius of a ring light, as seen from the subject."""

GOLDEN_ANGLE = 180 * (3 - math.sqrt(5))
"""In degrees: points that turn by it from one to the next never line up."""


KEY, FILL, RIM, FRONT, AROUND, BOUNCED = 0.33, 0.17, 0.27, 0.33, 0.24, 0.20
"""The parts of studio light: what faces the camera, with nothing near, shows 1.05, what faces the
key 0.98, and what faces the middle of both 1.10. In hollows and packings, where little comes from
around, colours are told apart by what has bounced and what comes from the front."""


@explain_unknown
def studio(scene: HasCamera, intensity: float = 1.0) -> list[AnyLight]:
    """Return the light of a studio: soft, and from all sides; that of scenes without lights.

    A large lamp, the key, is 40 degrees to the left and 45 above, a weaker one to the right fills
    its shadows, one from the camera reaches whatever is seen, and one from behind draws rims;
    ambient light shows what is deep and what is open, and some of it, in place of what bounces, is
    in all hollows, too. With an exposure of 1, surfaces that face the camera or the key show their
    own colour. Scenes without lights have other settings, too: the ``settings`` of their picture as
    ``scene.render`` make this light the same.

    Parameters
    ----------
    scene
        A scene with a camera and at least one sphere.
    intensity
        How bright the brightest white surface is, about.

    Returns
    -------
    list
        Four `Sun`, so that a floor is lit evenly as far as it goes, and two `Ambient`.

    Raises
    ------
    SceneError
        If the scene has no camera or no sphere, or an argument is not right.
    """
    studio = studio_of("studio", scene)
    strength = studio.checked("intensity", intensity, NonNegative)
    return [
        studio.sun(direction(-40, 45), 20.0, KEY * strength),
        studio.sun(direction(50, 15), 40.0, FILL * strength),
        studio.sun(direction(140, 40), 20.0, RIM * strength),
        studio.sun(direction(0, 0), 10.0, FRONT * strength),
        Ambient(BOUNCED * strength, distance=0),
        Ambient(AROUND * strength),
    ]


def none(scene: HasCamera | None = None) -> list[AnyLight]:  # noqa: ARG001 - as all others
    """Return no lights at all, so that a scene is black on purpose."""
    return []


@explain_unknown
def rembrandt(
    scene: HasCamera,
    intensity: float = 1.0,
    *,
    side: Side = "left",
    ratio: float = 4.0,
    points: bool = False,
) -> list[AnyLight]:
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
    points
        Whether the lamps are points, for hard shadows.

    Returns
    -------
    list
        The key and the fill: two `SphereLight`, or two `Light`.

    Raises
    ------
    SceneError
        If the scene has no camera or no sphere, or an argument is not right.
    """
    studio = studio_of("rembrandt", scene)
    return studio.key_and_fill(intensity, side, ratio, points, key=(45, 45), fill=(-30, 10))


@explain_unknown
def loop(
    scene: HasCamera,
    intensity: float = 1.0,
    *,
    side: Side = "left",
    ratio: float = 3.0,
    points: bool = False,
) -> list[AnyLight]:
    """Return loop light, the portrait photographer's usual one: softer shadows than Rembrandt's.

    The key is 35 degrees to the side and 30 above; on a face the nose throws a small loop of
    shadow. The fill is 30 degrees to the other side and 10 above, at 3:1.

    Parameters, result and errors are those of `rembrandt`.
    """
    studio = studio_of("loop", scene)
    return studio.key_and_fill(intensity, side, ratio, points, key=(35, 30), fill=(-30, 10))


@explain_unknown
def split(
    scene: HasCamera,
    intensity: float = 1.0,
    *,
    side: Side = "left",
    ratio: float = 8.0,
    points: bool = False,
) -> list[AnyLight]:
    """Return split light: one half bright, the other dark.

    The key is 90 degrees to the side and 10 above; the fill comes from the camera, three stops
    weaker (8:1).

    Parameters, result and errors are those of `rembrandt`.
    """
    studio = studio_of("split", scene)
    return studio.key_and_fill(intensity, side, ratio, points, key=(90, 10), fill=(0, 5))


@explain_unknown
def butterfly(
    scene: HasCamera, intensity: float = 1.0, *, ratio: float = 3.0, points: bool = False
) -> list[AnyLight]:
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
    points
        Whether the lamps are points, for hard shadows.

    Returns
    -------
    list
        The key and the fill: two `SphereLight`, or two `Light`.

    Raises
    ------
    SceneError
        If the scene has no camera or no sphere, or an argument is not right.
    """
    studio = studio_of("butterfly", scene)
    return studio.key_and_fill(intensity, "right", ratio, points, key=(0, 50), fill=(0, 5))


@explain_unknown
def ring(
    scene: HasCamera, intensity: float = 1.0, *, points: bool = False, count: int | None = None
) -> list[AnyLight]:
    """Return a ring light: a large lamp around the camera's lens.

    Its edge is 12 degrees from the camera's axis. Everything is lit from the front, without strong
    shadows but for a soft rim around what is in front of something else.

    Parameters
    ----------
    scene
        A scene with a camera and at least one sphere.
    intensity
        Intensity of all of it.
    points
        Whether it is a circle of points instead, whose shadows have steps.
    count
        How many points there are, from 1 to 4096, 24 by default; only with `points`.

    Returns
    -------
    list
        A `SphereLight`, or `Light` of the same intensity.

    Raises
    ------
    SceneError
        If the scene has no camera or no sphere, or an argument is not right.
    """
    studio = studio_of("ring", scene)
    number = studio.how_many(count, 24, points)
    if not number:
        return [studio.lamp(direction(0, 0), 2 * RING_DEGREES, studio.strength(intensity))]
    aside, ahead = sine(RING_DEGREES), cosine(RING_DEGREES)
    turns = (360 * (k + 0.5) / number for k in range(number))
    directions = ((aside * sine(turn), aside * cosine(turn), ahead) for turn in turns)
    return studio.share(intensity, ((place, 1.0) for place in directions), number)


@explain_unknown
def cloudy(
    scene: HasCamera,
    intensity: float = 1.0,
    *,
    up: "Direction | Vector | Triple | None" = None,
    points: bool = False,
    count: int | None = None,
) -> list[AnyLight]:
    """Return the light of an overcast sky: from all sides above, with the softest shadows.

    The sky is three times as bright straight above as at the horizon, as the CIE's standard
    overcast sky, and black below.

    Parameters
    ----------
    scene
        A scene with a camera and at least one sphere.
    intensity
        Light on a surface that faces straight up with nothing above it, as that of a single light
        there.
    up
        What is up in the world. By default the normal of the scene's first plane, on the side of
        the spheres, unless the camera's `up` is the normal of another one; without planes, the
        camera's `up`, or where it has none, up in the picture.
    points
        Whether the sky is of points instead, spread evenly over half a sphere, whose shadows have
        steps.
    count
        How many points there are, from 1 to 4096, 64 by default; only with `points`.

    Returns
    -------
    list
        A `Sky`, or `Light` of different intensities.

    Raises
    ------
    SceneError
        If the scene has no camera or no sphere, or an argument is not right.

    References
    ----------
    P. Moon, D. E. Spencer: *Illumination from a non-uniform sky*, 1942.
    """
    studio = studio_of("cloudy", scene).upright(scene, up)
    number = studio.how_many(count, 64, points)
    if not number:
        return [Sky(studio.strength(intensity) / UPWARD, gradient=OVERCAST, up=studio.up)]
    sky = []
    for k in range(number):
        height = (k + 0.5) / number  # equal steps of height are equal areas of a sphere
        across = math.sqrt(1 - height * height)
        turn = k * GOLDEN_ANGLE
        place = (across * sine(turn), height, across * cosine(turn))
        sky.append((place, (1 + 2 * height) / 3))
    upward = math.fsum(light * place[1] for place, light in sky)
    return studio.at(SKY).share(intensity, sky, upward)


@explain_unknown
def lightbox(
    scene: HasCamera,
    intensity: float = 1.0,
    *,
    up: "Direction | Vector | Triple | None" = None,
    points: bool = False,
    count: int | None = None,
) -> list[AnyLight]:
    """Return the light of a tent for product photographs: large white panels on three sides.

    One panel is on each side, 60 degrees from the camera and 20 above the horizon, and one
    overhead, 75 degrees above it, all equally bright and as wide as they are far. They leave weak,
    soft shadows below.

    Parameters
    ----------
    scene
        A scene with a camera and at least one sphere.
    intensity
        Intensity of each panel.
    up
        What is up in the world, as for `cloudy`.
    points
        Whether each panel is a square grid of points instead, whose shadows have steps.
    count
        How many points there are at least, from 1 to 4096, 48 by default; only with `points`.

    Returns
    -------
    list
        Three `RectangleLight`, or `Light` of the same intensity.

    Raises
    ------
    SceneError
        If the scene has no camera or no sphere, or an argument is not right.
    """
    studio = studio_of("lightbox", scene).upright(scene, up)
    number = studio.how_many(count, 48, points)
    panels = [direction(-60, 20), direction(60, 20), direction(0, 75)]
    if not number:
        return [_panel(studio, middle, studio.strength(intensity)) for middle in panels]
    rows = math.isqrt(math.ceil(number / 3) - 1) + 1
    grid = [point for panel in panels for point in _panel_points(panel, rows)]
    return studio.share(intensity, ((point, 1.0) for point in grid), rows * rows)


def _panel(studio: Studio, middle: Vec, intensity: float) -> RectangleLight:
    """Return a square panel that faces the subject, as wide as it is far."""
    edges = tuple(studio.vector(way) for way in _ways_along(middle))
    return RectangleLight(studio.place(middle), edges, intensity)


def _panel_points(middle: Vec, rows: int) -> Iterator[Vec]:
    """Give the places of lights in a square panel that faces the subject, as wide as it is far."""
    level, steep = _ways_along(middle)
    offsets = [(k + 0.5) / rows - 0.5 for k in range(rows)]
    for a in offsets:
        for b in offsets:
            yield along(along(middle, a, level), b, steep)


def _ways_along(middle: Vec) -> tuple[Vec, Vec]:
    """Return the unit vectors along a panel that faces the subject: level, and upwards."""
    level = unit(Direction(*cross((0.0, 1.0, 0.0), middle)))
    return level, cross(middle, level)
