"""A small scene for each kind of lamp, for vtray and for Mitsuba; and the cube under a sky.

The cameras stand so far away that nothing is behind the image plane, which Mitsuba does not have.
Lamps are out of their view, as rays from the eye end at those of Mitsuba.
"""

import json
import math
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

import vtray
from peers.host.soft_scene import SoftScene
from scenes.cube import FLOOR, make_cube
from vtray.scene.light_types import AnyLight
from vtray.scene.placing.directions import unit, view_axes

Json = dict[str, Any]

SEED = 7
SIZE = (128, 96)
BALLS = 60
REFLECTANCE = 0.8
FAR = 1e5
"""How far away the camera is, in heights of the picture."""
NEAR = 5.0
"""How far from the middle Mitsuba's rays start, in such heights: it has fewer digits."""
TO_EYE = (-0.3, 0.7, 0.65)
SUN_DEGREES, SUN_FAR = 20.0, 1e6
NO_PICTURE = np.zeros((0, 0, 3), np.float32)


class Lamp(NamedTuple):
    """A lamp.

    Attributes
    ----------
    light
        For vtray.
    plugin
        For Mitsuba, as `SoftScene.lamp`.
    sky
        As `SoftScene.sky`.
    """

    light: AnyLight
    plugin: Json
    sky: NDArray[np.float32] = NO_PICTURE


def lamps() -> dict[str, Lamp]:
    """Return a lamp of each kind, by what it is."""
    sky = {"type": "constant", "radiance": _rgb(1.0)}
    return {
        f"sun, {SUN_DEGREES:g} degrees": _sun((0.6, -0.7, 0.4)),
        "ball, near": _ball((-5.0, 6.0, -3.0), 1.5, 20.0),
        "rectangle, near": _rectangle((1.0, 5.0, -6.5), (4.0, 0.0, 0.0), (0.0, 1.5, 3.0), 12.0),
        "sky": Lamp(vtray.Sky(), sky),
        "ambient light": Lamp(vtray.Ambient(), sky),
        "picture of a sky": _picture(_clouds()),
        "picture of a sky with a sun": _picture(_with_sun(_clouds())),
    }


def lamp_scene(light: AnyLight) -> vtray.Scene:
    """Return balls over a floor in some light, some of them on it, seen from above."""
    generator = np.random.default_rng(SEED)
    number = np.arange(1, BALLS + 1)
    radius = 0.3 + 0.006 * number
    # Where the seeds of a sunflower are.
    turn, from_middle = 2.39996 * number, 0.85 * np.sqrt(number)
    height = radius * generator.choice([1.0, 1.0, 3.0], BALLS)
    places = np.stack([from_middle * np.cos(turn), height, from_middle * np.sin(turn)], axis=1)
    return _scene(places, radius, 0.0, light, SIZE, height=13.0)


def sky_scene(count: int, side: int) -> vtray.Scene:
    """Return the cube of spheres under a sky; all lengths are in radii."""
    cube = make_cube(count)
    unit_length = 1 / cube.radius
    places = cube.center.astype(np.float64) * unit_length
    floor, height = -FLOOR * unit_length, 3.2 * unit_length
    return _scene(places, np.ones(count), floor, vtray.Sky(), (side, side), height)


def for_mitsuba(scene: vtray.Scene, lamp: Lamp, emitter_samples: int = 1) -> SoftScene:
    """Return a scene of this module with a lamp as Mitsuba gets it."""
    balls, floor = scene.objects
    camera = scene.camera
    height = camera.size[1] * camera.resolution[1]
    return SoftScene(
        spheres=np.column_stack([balls.center, balls.radius]),
        floor=floor.center.y,
        size=height,
        reflectance=REFLECTANCE,
        starts=_starts(camera, (FAR - NEAR) * height),
        way=np.array(unit(camera.normal)),
        lamp=json.dumps(lamp.plugin),
        sky=lamp.sky,
        emitter_samples=emitter_samples,
    )


def _scene(
    places: NDArray[np.float64],
    radius: NDArray[np.float64],
    floor: float,
    light: AnyLight,
    size: tuple[int, int],
    height: float,
) -> vtray.Scene:
    """Return spheres over a floor, in parallel rays, with y upwards."""
    scene = vtray.Scene()
    scene.add_spheres(places, radius, lambert=REFLECTANCE)
    scene.add_plane((0, floor, 0), normal=(0, 1, 0), lambert=REFLECTANCE)
    scene.lights = [light]
    eye = [FAR * height * part / math.hypot(*TO_EYE) for part in TO_EYE]
    scene.camera = vtray.Camera.orthographic(eye, (0, 0, 0), height, size=size)
    scene.render = vtray.RenderSettings(exposure=1.0)
    return scene


def _starts(camera: vtray.Camera, distance: float) -> NDArray[np.float64]:
    """Return the places of all pixels, (height, width, 3), moved along the view."""
    forward = unit(camera.normal)
    right, down = view_axes(forward, unit(camera.up))
    (width, height), (across, along) = camera.size, camera.resolution
    middle = camera.center
    start = np.array([middle.x, middle.y, middle.z]) + distance * np.array(forward)
    columns = (np.arange(width) - width / 2) * across
    rows = (np.arange(height) - height / 2) * along
    return start + rows[:, None, None] * np.array(down) + columns[:, None] * np.array(right)


def _sun(direction: tuple[float, float, float]) -> Lamp:
    """Return a sun of intensity 1; for Mitsuba, a ball so far away that it is one."""
    sine = math.sin(math.radians(SUN_DEGREES / 2))
    place = [-SUN_FAR * part / math.hypot(*direction) for part in direction]
    # What is square below it gets 1 of its radiance times the square of the sine.
    plugin = _ball_plugin(place, SUN_FAR * sine, 1 / sine**2)
    return Lamp(vtray.Sun(direction, angle=SUN_DEGREES), plugin)


def _ball(place: tuple[float, float, float], radius: float, radiance: float) -> Lamp:
    light = vtray.SphereLight(place, radius, radiance=radiance)
    return Lamp(light, _ball_plugin(list(place), radius, radiance))


def _ball_plugin(place: list[float], radius: float, radiance: float) -> Json:
    return {"type": "sphere", "center": place, "radius": radius, "emitter": _area(radiance)}


def _rectangle(
    place: tuple[float, float, float],
    one: tuple[float, float, float],
    other: tuple[float, float, float],
    radiance: float,
) -> Lamp:
    """Return a rectangle; Mitsuba's shine to one side, that of the product of the edges."""
    light = vtray.RectangleLight(place, (one, other), radiance=radiance)
    columns = [np.array(one) / 2, np.array(other) / 2, np.cross(one, other), np.array(place)]
    matrix = np.eye(4)
    matrix[:3] = np.stack(columns, axis=1)
    plugin = {"type": "rectangle", "to_world": matrix.tolist(), "emitter": _area(radiance)}
    return Lamp(light, plugin)


def _picture(pixels: NDArray[np.float32]) -> Lamp:
    """Return a sky with a picture.

    Both take the light between pixels from a straight line. But Mitsuba's first row is straight
    above, not half a row below it: it gets the values in the middles of rows and halfway between.
    """
    padded = np.concatenate([pixels[:1], pixels, pixels[-1:]])
    halfway = (padded[1:] + padded[:-1]) / 2
    rows = np.empty((2 * len(pixels) + 1, *pixels.shape[1:]), np.float32)
    rows[::2], rows[1::2] = halfway, pixels
    return Lamp(vtray.Sky(image=pixels, up=(0, 1, 0)), {"type": "envmap"}, rows)


def _clouds() -> NDArray[np.float32]:
    """Return a sky that is coloured, without symmetry, and nowhere far brighter than elsewhere."""
    rows, columns = 24, 48
    above = 1 - 2 * (np.arange(rows)[:, None, None] + 0.5) / rows
    turn = 2 * np.pi * (np.arange(columns)[:, None] + 0.5) / columns
    phase = np.array([0.0, 0.4, 0.8])
    pixels = 0.7 + 0.2 * above + 0.25 * np.sin(turn + phase) + 0.15 * np.cos(3 * turn + 5 * above)
    return pixels.astype(np.float32)


def _with_sun(pixels: NDArray[np.float32]) -> NDArray[np.float32]:
    """Return the same with something bright in it."""
    pixels = 0.5 * pixels
    pixels[5, 30] = (150, 120, 90)
    return pixels


def _area(radiance: float) -> Json:
    return {"type": "area", "radiance": _rgb(radiance)}


def _rgb(value: float) -> Json:
    return {"type": "rgb", "value": value}
