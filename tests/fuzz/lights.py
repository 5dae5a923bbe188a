"""Random lights that are no points: of all kinds, and of odd sizes at odd places."""

from typing import Any

import numpy as np
from soft_scenes import colorful_sky

SHARE = 0.4
"""How many of the random scenes hold them, from 0 to 1."""

Scene = dict[str, Any]
Random = np.random.Generator

SIZES = [0.0, 5e-324, 1e-200, 1e-12, 1e-3, 0.1, 0.5, 1.0, 3.0, 1e3, 1e10, 1e60]
"""Of lamps, and how far ambient light reaches, beside the size of a scene."""


def with_soft_lights(random: Random, scene: Scene) -> Scene:
    """Return a scene with one to three such lights, and colours for some of all."""
    lights = [
        *scene["lights"][: random.integers(len(scene["lights"]) + 1)],
        *(_light(random, scene) for _ in range(random.integers(1, 4))),
    ]
    lights = [_colored(random, item) for item in lights]
    return {**scene, "lights": [lights[k] for k in random.permutation(len(lights))]}


def _light(random: Random, scene: Scene) -> Scene:
    """Return a light of any kind."""
    camera = scene["camera"]
    size = camera["resolution"][0] * camera["size"][0]
    power = {"intensity": float(random.uniform(0.2, 1))} if random.random() < 0.8 else {}
    kind = random.choice(["sun", "sphere", "rectangle", "sky", "colorful sky", "ambient"])
    if kind == "colorful sky":
        return colorful_sky(random)
    if kind == "sun":
        angle = random.choice([0.0, 1e-300, 1e-9, 0.53, 5.0, 60.0, 179.0, 180.0])
        way = random.choice([1.0, 1e-3, 1e9]) * _way(random)
        return {"type": "sun", "direction": _xyz(way), "angle": float(angle), **power}
    if kind == "sky":
        return {"type": "sky", "radiance": float(random.uniform(0, 1))}
    if kind == "ambient":
        distance = float(size * random.choice(SIZES))
        is_near = random.random() < 0.8
        return {"type": "ambient", **power, **({"distance": distance} if is_near else {})}
    place, radius = _place(random, scene, size)
    if power and random.random() < 0.3:
        power = {"radiance": power["intensity"]}
    if random.random() < 0.3:
        power["visible"] = True
    if kind == "rectangle":
        one, other = _edges(random, size)
        return {"type": "rectangle", "location": _xyz(place), "edges": [one, other], **power}
    return {"type": "sphere", "location": _xyz(place), "radius": radius, **power}


def _place(random: Random, scene: Scene, size: float) -> tuple[np.ndarray, float]:
    """Return middle and radius of a lamp: in or on an object, as large as it, or elsewhere."""
    radius = float(size * random.choice(SIZES))
    near = _array(scene["camera"]["center"])
    item = scene["objects"][random.integers(len(scene["objects"]))]
    if "objects" in item:
        item = item["objects"][0]
    center, own = _array(item.get("center") or item["start"]), float(item.get("radius", size))
    kind = random.integers(7)
    if kind == 0:  # in its middle
        return center, radius
    if kind == 1:  # within it, or around it
        return center, float(own * random.choice([0.5, 0.999, 1.5]))
    if kind == 2:  # on its surface
        return center + own * _way(random), radius
    away = size * random.choice([1.0, 3.0, 1e3, 1e10]) * random.uniform(0, 2)
    return near + away * _way(random), radius


def _edges(random: Random, size: float) -> tuple[Scene, Scene]:
    """Return edges of a rectangle, not so slender that the oracle sees no width.

    Nor is it so large that all of it is at the horizon, where rounding moves its rays.
    """
    one = _way(random)
    other = np.cross(one, _way(random))
    if not other.any():
        other = np.cross(one, np.roll(one, 1))
    length = max(size * random.choice(SIZES[2:-2]), 1e-300)
    return _xyz(length * one), _xyz(length * random.choice([1.0, 0.3, 0.01]) * other)


def _colored(random: Random, light: Scene) -> Scene:
    """Return a light that sometimes has a colour."""
    if random.random() < 0.5:
        return light
    values = random.integers(0, 256, 3).tolist()
    return {**light, "color": dict(zip("rgb", values, strict=True))}


def _way(random: Random) -> np.ndarray:
    """Return a unit vector, often along an axis."""
    if random.random() < 0.3:
        return np.roll([0.0, 0.0, random.choice([-1.0, 1.0])], random.integers(3))
    way = random.normal(size=3)
    return way / np.sqrt(way @ way)


def _array(xyz: dict[str, float]) -> np.ndarray:
    """Return a point of a file as an array."""
    return np.array([xyz[axis] for axis in "xyz"])


def _xyz(vector: np.ndarray) -> dict[str, float]:
    """Return a vector as a file has it."""
    return dict(zip("xyz", vector.tolist(), strict=True))
