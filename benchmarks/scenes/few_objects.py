"""The scenes that are measured, each made anew and the same every time."""

import random
from collections.abc import Callable
from typing import Any

Json = dict[str, Any]


def room(side: int) -> Json:
    """Make a room of 5 planes with 4 spheres and 64 lights, an 8 by 8 grid under the ceiling."""
    ceiling, floor = -4.0, 4.0
    walls = [
        _plane((0, floor, 0), (0, -1, 0), (200, 200, 200)),
        _plane((0, ceiling, 0), (0, 1, 0), (220, 220, 220)),
        _plane((-5, 0, 0), (1, 0, 0), (220, 60, 40)),
        _plane((5, 0, 0), (-1, 0, 0), (40, 160, 80)),
        _plane((0, 0, 14), (0, 0, -1), (180, 180, 230)),
    ]
    spheres = [
        _sphere((-2, 2.5, 9), 1.5, (255, 210, 60)),
        _sphere((2, 2.8, 7), 1.2, (80, 140, 255)),
        _sphere((0.3, 3.2, 5), 0.8, (255, 255, 255)),
        _sphere((1.5, 0, 11), 1.0, (240, 80, 200)),
    ]
    grid = range(8)
    lights = [
        _light((-2.1 + 0.6 * column, ceiling + 0.1, 4 + 0.6 * row), 1 / 64)
        for row in grid
        for column in grid
    ]
    return _scene(side, walls + spheres, lights, width=7.5)


def one_sphere(side: int) -> Json:
    """Make one sphere on a floor, with one light."""
    objects = [
        _plane((0, 3, 0), (0, -1, 0), (200, 200, 200)),
        _sphere((0, 1, 6), 2, (230, 90, 60)),
    ]
    return _scene(side, objects, [_light((-6, -8, 1), 1)], width=6)


def many_spheres(side: int) -> Json:
    """Make 1,000 spheres at random places over a floor, with two lights."""
    generator = random.Random(1000)

    def sphere() -> Json:
        z = generator.uniform(4, 40)
        spread = 0.4 * (z + 10)
        center = (generator.uniform(-spread, spread), generator.uniform(-spread, 4), z)
        color = (generator.randint(60, 255), generator.randint(60, 255), generator.randint(60, 255))
        return _sphere(center, generator.uniform(0.1, 0.6), color)

    objects = [_plane((0, 5, 0), (0, -1, 0), (200, 200, 200)), *(sphere() for _ in range(1000))]
    return _scene(side, objects, [_light((-20, -30, 1), 1), _light((25, -20, 5), 0.5)], width=7.5)


def empty(side: int) -> Json:
    """Make a scene of nothing: what is left is overhead."""
    return _scene(side, [], [], width=7.5)


def small(side: int) -> Json:
    """Make one sphere and one light, as in a user's first scene."""
    return _scene(side, [_sphere((0, 0, 6), 2, (230, 90, 60))], [_light((-6, -8, 1), 1)], width=6)


SCENES: dict[str, tuple[str, Callable[[int], Json], int]] = {
    "room": ("room: 4 spheres, 5 planes, 64 lights", room, 1024),
    "sphere": ("a sphere on a floor, 1 light", one_sphere, 1024),
    "spheres": ("1,000 spheres over a floor, 2 lights", many_spheres, 1024),
    "empty": ("nothing at all", empty, 256),
}
"""For each name: what it is, the function that makes it, and the side of the image in pixels."""

FOCUS = 10.0


def _scene(side: int, objects: list[Json], lights: list[Json], width: float) -> Json:
    """Make a scene whose camera is at the origin, looks along z and sees `width` of its plane."""
    camera = {
        "center": _xyz((0, 0, 0)),
        "normal": _xyz((0, 0, 1)),
        "focus": FOCUS,
        "size": [side, side],
        "resolution": [width / side, width / side],
    }
    return {"camera": camera, "lights": lights, "objects": objects}


def _plane(center: tuple[float, ...], normal: tuple[float, ...], color: tuple[int, ...]) -> Json:
    look = {"color": dict(zip("rgb", color, strict=True)), "lambert": 0.9}
    return {"type": "plane", "center": _xyz(center), "normal": _xyz(normal), **look}


def _sphere(center: tuple[float, ...], radius: float, color: tuple[int, ...]) -> Json:
    look = {"color": dict(zip("rgb", color, strict=True)), "lambert": 1}
    return {"type": "sphere", "center": _xyz(center), "radius": radius, **look}


def _light(location: tuple[float, ...], intensity: float) -> Json:
    return {"location": _xyz(location), "intensity": intensity}


def _xyz(numbers: tuple[float, ...]) -> Json:
    return dict(zip("xyz", numbers, strict=True))
