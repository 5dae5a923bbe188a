"""Small scenes with parts that are smaller than a pixel, or seen from one pixel alone."""

from random import Random
from typing import Any

from examples import cylinder, light, plane, scene, sphere

Scene = dict[str, Any]


def checkered_shadows() -> Scene:
    """Return a floor on which a grid of bars far away throws a checker finer than a pixel."""
    bars: list[Scene] = []
    for k in range(-20, 21):
        bars.append(cylinder((10 + 0.011 * k, -3, -3), (10 + 0.011 * k, 3, -3), 0.0027))
        bars.append(cylinder((7, 0.011 * k, -3.1), (13, 0.011 * k, -3.1), 0.0027))
    floor = plane((0, 0, 5), (0, 0, -1))
    size = {"center": {"x": 0, "y": 0, "z": -4}, "size": [36, 26], "resolution": [0.006, 0.006]}
    return scene([*bars, floor], [light(20, 0, -11)], **size, projection="orthographic")


def caps_through_a_plane() -> Scene:
    """Return spheres that rise through a plane by less than a pixel."""
    random = Random(1)
    balls = [
        sphere((0.4 * x + random.random() / 9, 0.4 * y, 5.2), 0.2 + 0.02 * random.random())
        for x in range(-4, 5)
        for y in range(-3, 4)
    ]
    floor = plane((0, 0, 5), (0, 0.3, -1), color={"r": 20, "g": 60, "b": 90})
    return scene([*balls, floor], [light(5, -5, 0)], size=[36, 26], resolution=[0.07, 0.07])


def cut_by_the_image_plane() -> Scene:
    """Return a sphere that the image plane cuts, with a lamp within and one behind the eye."""
    ball = sphere((0.03, 0.02, 0.4), 1.0)
    size = {"size": [36, 26], "resolution": [0.08, 0.08]}
    return scene([ball], [light(0, 0, -30), light(9, -9, -20)], **size)


def just_outside_the_picture() -> Scene:
    """Return a ball and a shadow whose edges lie beside the picture, within reach of the filter."""
    wall = plane((0, 0, 5), (0, 0, -1), color={"r": 40, "g": 40, "b": 90})
    ball = sphere((1e3 - 10 * 0.1 - 0.06, 0, 4.0), 1e3 - 1.8)
    return scene(
        [wall, ball],
        [light(-3, 0, -9)],
        size=[36, 26],
        resolution=[0.1, 0.1],
        projection="orthographic",
    )


def small_balls() -> Scene:
    """Return spheres of a few pixels, lit from the side."""
    balls = [
        sphere((0.7 * x + 0.013 * y, 0.7 * y, 5), 0.02 * (2 + (x + 5 * y) % 14))
        for x in range(-2, 3)
        for y in range(-2, 3)
    ]
    return scene(balls, [light(30, -20, -4)], size=[40, 34], resolution=[0.07, 0.07])


def many_lights() -> Scene:
    """Return a ball over a floor that keeps one half of 108 lights from a place, or the other."""
    lights = []
    for k in range(108):
        side = -1 if k < 54 else 1
        lights.append(light(6 * side, 0.001 * k, -20, intensity=1 / 54))
    bars = [cylinder((3 * side, -9, -4), (3 * side, 9, -4), 1.0) for side in (-1, 1)]
    floor = plane((0, 0, 5), (0, 0, -1))
    size = {"center": {"x": 0, "y": 0, "z": -5}, "size": [36, 26], "resolution": [0.2, 0.2]}
    return scene([*bars, floor], lights, **size, projection="orthographic")


SCENES = {
    make.__name__: make
    for make in (
        checkered_shadows,
        caps_through_a_plane,
        cut_by_the_image_plane,
        just_outside_the_picture,
        small_balls,
        many_lights,
    )
}
