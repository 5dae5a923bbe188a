"""Copies: a cube full of small spheres alone, and at many places."""

from pathlib import Path

import numpy as np

import vtray
from scenes.cube import make_cube

SIDE = 1024
STEP = 2.5
"""From one place to the next; a cube is 2 wide."""


def make_scene(
    count: int, places: int, side: int = SIDE, *, written_out: bool = False
) -> vtray.Scene:
    """Return a scene of all spheres at all places, which fit into the picture.

    Parameters
    ----------
    count
        How many spheres stand at each place.
    places
        How many places there are along each axis.
    side
        Width and height in pixels.
    written_out
        Whether each sphere has a row of its own, not only each place.
    """
    cube = make_cube(count)
    center = cube.center.astype(np.float64)
    at = STEP * np.indices((places,) * 3, np.float64).reshape(3, -1).T
    scene = vtray.Scene()
    scene.add_copies(vtray.Spheres(center, cube.radius, cube.color), at)
    scene.add_plane((0, -1.1, 0), (0, 1, 0), color=(230, 230, 230))
    scene.camera = vtray.Camera.fit(scene, (-0.5, -0.4, -1), size=(side, side))
    scene.lights = vtray.lights.rembrandt(scene, points=True)[:1]
    if written_out:
        # Seen by the same camera to the last bit, so that the picture is the same.
        moved = (at[:, None] + center).reshape(-1, 3)
        color = np.tile(cube.color, (len(at), 1))
        scene.objects[0] = vtray.Spheres(moved, cube.radius, color)
    return scene


def write_scenes(
    count: int, few: int, many: int, folder: Path, side: int = SIDE
) -> dict[str, Path]:
    """Write the scene files, and arrays beside them; return them by what they are.

    Parameters
    ----------
    count
        How many spheres stand at each place.
    few, many
        How many places there are along each axis: of what is both written out and copied, and of
        what is only copied.
    folder
        Where to write them.
    side
        Width and height in pixels.
    """
    spheres = f"{count:,} spheres"
    kinds = {
        spheres: (1, True),
        f"{spheres} at {few**3:,} places, written out": (few, True),
        f"{spheres} at {few**3:,} places, copied": (few, False),
        f"{spheres} at {many**3:,} places, copied": (many, False),
    }
    paths = {}
    for name, (places, written_out) in kinds.items():
        paths[name] = folder / f"places-{places}{'-written-out' if written_out else ''}.json"
        make_scene(count, places, side, written_out=written_out).save(paths[name])
    return paths
