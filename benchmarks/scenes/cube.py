"""The scene that grows: a cube full of small spheres over a floor, with one light.

    python benchmarks/scenes/cube.py FOLDER COUNT [COUNT ...]

Writes for each count a scene file and its arrays, cube-COUNT.json and cube-COUNT.npz.
"""

import json
import math
import sys
from collections.abc import Iterable
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

Json = dict[str, Any]

SEED = 1000
SIDE = 1024
FIELD_OF_VIEW_DEGREES = 40
FLOOR = 1.1
"""How far below the middle of the cube the floor is; y points down."""
EYE = (-0.8, -1.0, -3.9)
TARGET = (0.15, 0.17, 0.0)
FOCUS = 0.25
LIGHT = (-2.5, -3.0, -2.5)


class Cube(NamedTuple):
    """The spheres.

    Attributes
    ----------
    center
        Their centres, (n, 3), uniform in the cube from -1 to 1.
    radius
        The radius of them all. It shrinks so that they always fill a twelfth of the cube.
    color
        Their colours, (n, 3), from 0 to 255.
    lambert
        The Lambert coefficient of them all.
    """

    center: NDArray[np.float32]
    radius: float
    color: NDArray[np.uint8]
    lambert: float


def make_cube(count: int) -> Cube:
    """Make spheres at random, the same every time."""
    generator = np.random.default_rng(SEED)
    center = generator.random((count, 3), dtype=np.float32)
    center *= 2
    center -= 1
    color = generator.integers(0, 256, (count, 3), dtype=np.uint8)
    return Cube(center, 0.56 * max(count, 1) ** (-1 / 3), color, 1.0)


def scene_around(objects: list[Json], side: int = SIDE) -> Json:
    """Make the scene around the spheres: camera, light and floor, and `objects` beside them.

    The whole cube and the light are in front of the image plane.
    """
    normal = [(t - e) / math.dist(TARGET, EYE) for e, t in zip(EYE, TARGET, strict=True)]
    pixel = 2 * FOCUS * math.tan(math.radians(FIELD_OF_VIEW_DEGREES / 2)) / side
    camera = {
        "center": _xyz([e + FOCUS * n for e, n in zip(EYE, normal, strict=True)]),
        "normal": _xyz(normal),
        "focus": FOCUS,
        "size": [side, side],
        "resolution": [pixel, pixel],
    }
    floor = {
        "type": "plane",
        "center": _xyz((0, FLOOR, 0)),
        "normal": _xyz((0, -1, 0)),
        "color": {"r": 230, "g": 230, "b": 230},
        "lambert": 0.9,
    }
    light = {"location": _xyz(LIGHT), "intensity": 1}
    return {"camera": camera, "lights": [light], "objects": [floor, *objects]}


def write_cube(count: int, folder: Path, side: int = SIDE) -> Path:
    """Write the scene file and the arrays beside it; return the scene file."""
    cube = make_cube(count)
    data = folder / f"cube-{count}.npz"
    np.savez(data, **cube._asdict())
    scene = data.with_suffix(".json")
    scene.write_text(json.dumps(scene_around([{"type": "spheres", "data": data.name}], side)))
    return scene


def list_text(count: int, side: int = SIDE) -> str:
    """Return the same scene with an object for each sphere."""
    cube = make_cube(count)
    spheres = [
        {
            "type": "sphere",
            "center": _xyz(center),
            "radius": cube.radius,
            "color": dict(zip("rgb", color, strict=True)),
            "lambert": cube.lambert,
        }
        for center, color in zip(cube.center.tolist(), cube.color.tolist(), strict=True)
    ]
    return json.dumps(scene_around(spheres, side))


def _xyz(numbers: Iterable[float]) -> Json:
    return dict(zip("xyz", numbers, strict=True))


if __name__ == "__main__":
    for number in sys.argv[2:]:
        print(write_cube(int(float(number)), Path(sys.argv[1])))
