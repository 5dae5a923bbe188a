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
    """Return two walls whose edge is a third of a pixel beside the last column of the picture."""
    black = {"r": 0, "g": 0, "b": 0}
    walls = [plane((0, 0, 5), (0, 0, -1)), plane((1.73, 0, 5), (-2, 0, -1), color=black)]
    view = {"size": [36, 26], "resolution": [0.1, 0.1], "projection": "orthographic"}
    return scene(walls, [light(-3, 0, -9)], **view)


def small_balls() -> Scene:
    """Return spheres of a few pixels, lit from the side."""
    balls = [
        sphere((0.7 * x + 0.013 * y, 0.7 * y, 5), 0.02 * (2 + (x + 5 * y) % 14))
        for x in range(-2, 3)
        for y in range(-2, 3)
    ]
    return scene(balls, [light(30, -20, -4)], size=[40, 34], resolution=[0.07, 0.07])


def many_lights() -> Scene:
    """Return a bar over a floor, the first of 107 lights, and two more within a ball."""
    lights = [light(-6, 0.001 * k, -20, intensity=1e-3) for k in range(107)]
    lights[0] = light(6, 0, -20)
    for k in (52, 105):
        lights[k] = light(-9, 0, -3)
    bar, floor = cylinder((3, -9, -3.5), (3, 9, -3.5), 0.8), plane((0, 0, 5), (0, 0, -1))
    size = {"center": {"x": 0, "y": 0, "z": -5}, "size": [36, 26], "resolution": [0.2, 0.2]}
    ball = sphere((-9, 0, -3), 0.3)
    return scene([bar, ball, floor], lights, **size, projection="orthographic")


def mixture(seed: int) -> Scene:
    """Return a random scene of all kinds of shapes, some of them copied, and lights."""
    random = Random(seed)

    def place(size: float, z: float) -> tuple[float, float, float]:
        return random.uniform(-size, size), random.uniform(-size, size), z + random.uniform(-2, 2)

    def color() -> dict[str, int]:
        return {c: random.randrange(60, 256) for c in "rgb"}

    def solids(count: int) -> list[Scene]:
        found: list[Scene] = []
        for _ in range(count):
            radius, at = 10 ** random.uniform(-2, 0), place(2.5, 5)
            if random.random() < 0.5:
                found.append(sphere(at, radius, color=color()))
            else:
                end = tuple(a + random.uniform(-2, 2) for a in at)
                found.append(cylinder(at, end, radius / 2, color=color()))
        return found

    shifts = [dict(zip("xyz", place(2, 0), strict=True)) for _ in range(3)]
    copies = {"type": "copies", "objects": solids(3), "at": shifts}
    normal = random.uniform(-1, 1), random.uniform(-1, 1), -1
    wall = plane((0, 0, 8), normal, color=color())
    lights = [light(*place(9, random.choice([-12, -2, 3])), intensity=0.5) for _ in range(2)]
    view = {"projection": random.choice(["perspective", "orthographic"])}
    objects = [*solids(6), wall, *([copies] if seed % 2 else [])]
    return scene(objects, lights, size=[30, 22], resolution=[0.15, 0.15], **view)


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
