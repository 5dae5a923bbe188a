"""Random scenes with lights that are no points."""

from typing import Any

import numpy as np
from examples import cylinder, light, plane, sphere, xyz

Scene = dict[str, Any]
Random = np.random.Generator

KINDS = ["few", "many", "bonds", "copies", "inside"]


def soft_scene(seed: int, kind: str, by: float = 0.0, **camera: Any) -> Scene:
    """Return a scene of some kind, moved as a whole, with lights of all kinds."""
    random = np.random.default_rng([seed, KINDS.index(kind)])
    shift = by * np.array([1.0, -0.7, 0.4])

    def at(place: Any) -> tuple[float, ...]:
        return tuple((np.asarray(place) + shift).tolist())

    def color() -> dict[str, int]:
        return dict(zip("rgb", random.integers(0, 256, 3).tolist(), strict=True))

    count = {"few": 5, "many": 90, "bonds": 8, "copies": 3, "inside": 6}[kind]
    largest = 0.35 if kind == "many" else 0.9
    centers = random.uniform(-2, 2, (count, 3))
    radii = random.uniform(0.05, largest, count)
    objects = [
        sphere(at(center), float(radius), color=color(), lambert=float(random.uniform(0.2, 1)))
        for center, radius in zip(centers, radii, strict=True)
    ]
    if kind in ("bonds", "copies"):
        for start in centers:
            end = start + random.normal(size=3)
            objects.append(cylinder(at(start), at(end), float(random.uniform(0.05, 0.5))))
    if kind == "copies":
        places = random.uniform(-1.5, 1.5, (5, 3)).tolist()
        objects = [{"type": "copies", "objects": objects, "at": [xyz(*place) for place in places]}]
    if kind == "inside":  # all of it in a ball
        objects.append(sphere(at((0, 0, 0)), 9.0))
    for _ in range(random.integers(1, 4)):
        normal = random.normal(size=3)
        place = 3 * normal / np.sqrt(normal @ normal)
        objects.append(plane(at(place), tuple(normal.tolist())))
    way = random.normal(size=3)
    back = 6 * way / np.sqrt(way @ way)
    view: Scene = {
        "center": xyz(*at(-back / 2)),
        "normal": xyz(*way.tolist()),
        "focus": 4.0,
        "size": [24, 18],
        "resolution": [0.15, 0.15],
        **camera,
    }
    lights = [soft_light(random, at, centers, radii) for _ in range(6)]
    lights.append(colorful_sky(random))
    lights.insert(int(random.integers(4)), {**light(*at((4, 4, -5)), intensity=0.3)})
    for item in lights:
        if random.random() < 0.5:
            item["color"] = color()
    return {"camera": view, "lights": lights, "objects": objects}


def soft_light(random: Random, at: Any, centers: np.ndarray, radii: np.ndarray) -> Scene:
    """Return a light of any kind and size, often in an object or around the scene."""
    kind = random.integers(9)
    measure = "radiance" if kind > 2 and random.random() < 0.3 else "intensity"
    power = {measure: float(random.uniform(0.1, 1))}
    if kind == 0:
        angle = random.choice([0.0, 1e-6, 0.53, 8.0, 60.0, 120.0, 180.0])
        return {
            "type": "sun",
            "direction": xyz(*random.normal(size=3).tolist()),
            "angle": float(angle),
            **power,
        }
    if kind == 1:
        return {"type": "sky", "radiance": float(random.uniform(0.1, 1))}
    if kind == 2:
        distance = {"distance": float(random.choice([0.0, 1e-9, 0.1, 1.0, 2.5, 100.0]))}
        return {"type": "ambient", **power, **(distance if random.random() < 0.8 else {})}
    which = random.integers(len(centers))
    place = (
        centers[which],  # in an object, or around it
        random.uniform(-3, 3, 3),
        random.normal(size=3) * random.choice([5.0, 1e3]),
    )[kind % 3]
    if kind > 5:
        one, other = edges(random)
        return {"type": "rectangle", "location": xyz(*at(place)), "edges": [one, other], **power}
    size = float(random.choice([0.0, 1e-9, 0.1, 0.5, 1.5, 7.0, 50.0]))
    size = float(radii[which]) * 0.8 if kind == 3 and random.random() < 0.5 else size
    return {"type": "sphere", "location": xyz(*at(place)), "radius": size, **power}


def colorful_sky(random: Random) -> Scene:
    """Return a sky with a gradient, or with a picture, smooth or with bright spots."""
    sky: Scene = {"type": "sky", "radiance": float(random.uniform(0.1, 1))}
    if random.random() < 0.6:
        sky["up"] = xyz(*random.normal(size=3).tolist())
    if random.random() < 0.4:
        names = ("zenith", "horizon", "ground")
        given = [name for name in names if random.random() < 0.7]
        values = random.integers(0, 256, (3, 3)).tolist()
        colors = (dict(zip("rgb", value, strict=True)) for value in values)
        return {**sky, "gradient": dict(zip(given, colors, strict=False))}
    height, width = random.integers(1, 12, 2).tolist()
    spread = float(random.choice([0.3, 1.0, 3.0]))
    picture = random.lognormal(sigma=spread, size=(height, width, 3))
    picture[random.random((height, width)) < random.choice([0.0, 0.5])] = 0.0
    picture[0, 0] = 1.0
    picture = picture.astype(np.float32).tolist()
    return {**sky, "image": picture, "rotation": float(random.uniform(-400, 400))}


def edges(random: Random) -> tuple[Scene, Scene]:
    """Return edges of a rectangle of any size, often along axes."""
    one, other = random.normal(size=(2, 3)) if random.random() < 0.7 else np.eye(3)[:2]
    other = other - (one @ other) / (one @ one) * one
    sizes = random.choice([1e-9, 0.1, 0.5, 1.5, 7.0, 50.0], 2)
    return xyz(*(sizes[0] * one).tolist()), xyz(*(sizes[1] * other).tolist())
