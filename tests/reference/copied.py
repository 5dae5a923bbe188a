"""A scene with copies of all kinds of objects, beside others."""

from typing import Any

import numpy as np

import vtray

RED, GREEN, BLUE, SAND = (190, 90, 80), (90, 150, 90), (70, 110, 180), (200, 180, 140)


def molecules(**camera: Any) -> vtray.Scene:
    """Return two kinds of molecules at some places each, an atom and a bond alone, and a floor.

    Parameters
    ----------
    camera
        Settings of the camera, beside where it looks.
    """
    random = np.random.default_rng(3)
    water = [
        vtray.Sphere((0, 0, 0), 0.5, RED),
        vtray.Spheres(np.array([(0.7, 0.5, 0), (-0.7, 0.5, 0)], "f4"), 0.3, [SAND, BLUE], 0.9),
        vtray.Cylinder((0, 0, 0), (0.7, 0.5, 0), 0.1, SAND),
        vtray.Cylinders([(0, 0, 0)], [(-0.7, 0.5, 0.1)], 0.12, RED, color_end=GREEN),
    ]
    chain = vtray.Cylinders(
        [(0, 0, 0), (0.9, 0.2, 0)],
        [(0.9, 0.2, 0), (1.2, -0.6, 0.3)],
        [0.2, 0.15],
        [GREEN, BLUE],
        color_end=[SAND, RED],
    )
    scene = vtray.Scene()
    scene.add_plane((0, -3, 0), (0, 1, 0), color=SAND)
    scene.add_copies(water, random.uniform(-2.5, 2.5, (9, 3)).astype(np.float32))
    scene.add_sphere((0, 0, 1), 0.4, color=BLUE)
    scene.add_copies([vtray.Spheres([], 1), chain], random.uniform(-2.5, 2.5, (7, 3)))
    scene.add_copies(vtray.Sphere((0, 0, 0), 1), [])
    scene.add_cylinders([(-2, 1, 0)], [(2, 1.5, 0)], 0.2, color=RED, color_end=BLUE)
    scene.add_light((4, 9, 6))
    scene.add_light((-7, 5, 3), 0.6)
    where: dict[str, Any] = {"fov_degrees": 40, "size": (48, 36), **camera}
    scene.camera = vtray.Camera.look_at((1, 2, 10), (0, 0, 0), **where)
    return scene
