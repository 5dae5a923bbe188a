"""Random looks: what surfaces are made of, their patterns, cameras with lenses, and settings."""

from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np

Scene = dict[str, Any]
Random = np.random.Generator

SHARE = 0.5
"""How many of the scene files and commands hold such, from 0 to 1."""

EDGES = [0.0, 5e-324, 0.0099, 0.01, 0.3, 1.0]
"""Numbers from 0 to 1, with those at which something changes."""

INDICES = [0.1, 0.999999999999, 1.0, 1.0000000000000002, 1.5, 1.5, 2.4, 10.0]
"""Indices of refraction."""

SIZES = [5e-324, 1e-300, 1e-12, 1e-3, 0.1, 0.5, 1.0, 3.0, 1e3, 1e12, 1e300]
"""Of patterns and lengths, beside the size of a scene."""

METALS = ["gold", "silver", "copper", "aluminium", "tungsten", "mercury"]


def with_looks(random: Random, scene: Scene, folder: Path) -> Scene:
    """Return a scene some of whose objects have materials, and are brought into each other.

    Pictures of patterns are written into the folder.
    """
    size = scene["camera"]["resolution"][0] * scene["camera"]["size"][0]
    names = ["sharp.npy", "soft.npy", "dot.npy"]
    for name, shape in zip(names, [(2, 3, 3), (3, 5, 4), (1, 1, 4)], strict=True):
        np.save(folder / name, random.integers(0, 256, shape).astype(np.uint8))
    patterns = [lambda: _pattern(random, size, names), lambda: None]
    share = random.choice([0.0, 0.4])

    def looked(item: Scene) -> Scene:
        if item["type"] == "copies":
            return {**item, "objects": [looked(part) for part in item["objects"]]}
        found = dict(item)
        if random.random() < 0.2:
            found["color"] = dict(zip("rgb", random.choice([0, 255], 3).tolist(), strict=True))
        if random.random() < 0.75:
            found["material"] = _material(random, size)
        if random.random() < share:
            pattern = random.choice(patterns)()
            found["material"] = _with_pattern(found.get("material", "lambert"), pattern)
        return found

    objects = [looked(item) for item in scene["objects"]]
    return {**scene, "objects": _brought_together(random, objects, scene["camera"], size)}


def _with_pattern(material: Any, pattern: Scene | None) -> Any:
    """Return a material with a pattern."""
    if pattern is None:
        return material
    plain = {"type": material} if isinstance(material, str) else material
    return {**plain, "pattern": pattern}


def _material(random: Random, size: float) -> Any:
    """Return a material of any kind, by its name or with its numbers."""
    kinds = ["lambert", "mirror", "metal", "glass", "plastic", "emissive"]
    if random.random() < 0.25:
        return str(random.choice(kinds))
    if random.random() < 0.2:
        first, second = _single(random, size), _single(random, size)
        return {"type": "blend", "first": first, "second": second, "weight": _edge(random)}
    return _single(random, size)


def _single(random: Random, size: float) -> Scene:
    """Return a material that is no blend."""
    kind = str(random.choice(["mirror", "metal", "glass", "glass", "glass", "plastic", "emissive"]))
    rough = {"roughness": _edge(random)} if random.random() < 0.5 else {}
    index = {"ior": float(random.choice(INDICES))}
    if kind == "metal":
        name = {"name": str(random.choice(METALS))} if random.random() < 0.5 else {}
        return {"type": kind, **name, **rough}
    if kind == "plastic":
        return {"type": kind, **index, **rough}
    if kind == "emissive":
        return {"type": kind, "radiance": float(random.choice([0.0, 5e-324, 0.5, 1.0, 3.0, 1e9]))}
    if kind == "glass":
        if random.random() < 0.2:
            return {"type": kind, **index, "thin": True}
        if random.random() < 0.4:
            per_length = random.choice([0.0, 1e-320, 1e-3, 1.0, 30.0, 1e6], 3) / size
            index["absorption"] = np.minimum(per_length, 1e308).tolist()
        return {"type": kind, **index, **rough}
    return {"type": kind}


def _pattern(random: Random, size: float, images: list[str]) -> Scene:
    """Return a pattern."""
    kind = str(random.choice(["checker", "stripes", "image"]))
    found: Scene = {"type": kind}
    if kind == "image":
        found["image"] = str(random.choice(images))
    elif random.random() < 0.7:
        black, own = {"r": 0, "g": 0, "b": 0}, None
        some = [black, own, dict(zip("rgb", random.integers(0, 256, 3).tolist(), strict=True))]
        found["colors"] = [some[random.integers(3)] for _ in range(2)]
    if random.random() < 0.8:
        found["size"] = max(float(min(size * random.choice(SIZES), 1e308)), 5e-324)
    if random.random() < 0.5:
        found["up"] = dict(zip("xyz", random.normal(size=3).tolist(), strict=True))
    elif random.random() < 0.3:
        found["up"] = {"x": 0.0, "y": 0.0, "z": float(random.choice([1.0, -1.0, 1e300]))}
    if random.random() < 0.5:
        found["rotation"] = float(random.choice([0.0, 90.0, -45.5, 1e9, 1e300]))
    if kind == "stripes" and random.random() < 0.5:
        found["run"] = "along"
    return found


def _edge(random: Random) -> float:
    """Return a number from 0 to 1, often one at which something changes."""
    return float(random.choice(EDGES) if random.random() < 0.9 else random.uniform(0, 1))


def _brought_together(
    random: Random, objects: list[Scene], camera: Scene, size: float
) -> list[Scene]:
    """Return objects with some more: around the camera, in a ball, on it, or the same again."""
    balls = [item for item in objects if item["type"] == "sphere"]
    more: list[Scene] = []
    if balls and random.random() < 0.5:
        ball = balls[random.integers(len(balls))]
        within = random.choice([0.5, 1 - 2.0**-52, 1.0, 1 + 2.0**-52, 2.0])
        other = {**ball, "radius": float(ball["radius"] * within)}
        more.append(other | {"material": _material(random, size)})
    if random.random() < 0.25:
        middle = camera["center"]
        more.append(
            {
                "type": "sphere",
                "center": middle,
                "radius": float(size * random.choice([0.3, 2.0, 30.0])),
                "color": {"r": 255, "g": 255, "b": 255},
                "lambert": 1.0,
                "material": _material(random, size),
            }
        )
    return [*objects, *more]


def padded(random: Random, scene: Scene) -> Scene:
    """Return a scene with something of each kind that is not seen, or hardly.

    So the same kernels serve many scenes.
    """
    camera = scene["camera"]
    center, normal, size = camera["center"], camera["normal"], camera["resolution"][0]
    black = {"color": {"r": 0, "g": 0, "b": 0}, "lambert": 1.0}
    striped = {"type": "stripes", "size": size}
    behind = {"type": "plane", "center": center, "normal": normal, **black}
    ball = {"type": "sphere", "center": center, "radius": 0.0, **black}
    end = {axis: value + size * (axis == "x") for axis, value in center.items()}
    stick = {"type": "cylinder", "start": center, "end": end, "radius": 0.0, **black}
    cone = stick | {"type": "cone", "radius_end": 0.0}
    plastic = {"material": {"type": "plastic", "pattern": striped}}
    copies = {"type": "copies", "objects": [ball, stick, cone], "at": [{"x": 0, "y": 0, "z": 0}]}
    sides = [{"x": size, "y": 0.0, "z": 0.0}, {"x": 0.0, "y": size, "z": 0.0}]
    lamps = [
        {"type": "sphere", "location": center, "radius": size, "intensity": 0.01, "visible": True},
        {"type": "rectangle", "location": center, "edges": sides, "intensity": 0.01},
        {"type": "sky", "radiance": 0.01, "gradient": {}},
        {"location": center, "intensity": 0.01},
    ]
    objects = [*scene["objects"], behind, ball | plastic, stick, cone]
    if random.random() < 0.5:
        objects.append(copies)
    return {**scene, "objects": objects, "lights": [*scene["lights"], *lamps]}


def with_camera(random: Random, scene: Scene) -> Scene:
    """Return a scene whose camera has a lens, or is a panorama, sometimes."""
    camera = scene["camera"]
    kind = random.integers(6)
    if kind == 0:
        camera = {**camera, "projection": "panorama"}
    elif kind < 3:
        camera = {**camera, "lens": _lens(random, camera)}
    return {**scene, "camera": camera}


def _lens(random: Random, camera: Scene) -> Scene:
    """Return a lens of any size."""
    distance = float(camera["focus"] * random.choice([1e-6, 0.5, 1.0, 1.5, 3.0, 1e6, 1e250]))
    width = camera["resolution"][0] * camera["size"][0]
    radius = random.choice([0.0, 5e-324, 1e-9, 0.05, 1.0, 1e3]) * width
    lens: Scene = {"radius": float(min(radius, distance)), "focus_distance": distance}
    if random.random() < 0.3:
        lens["blades"] = int(random.choice([3, 5, 6, 64]))
    return lens


def settings(random: Random, scene: Scene) -> dict[str, Any]:
    """Return how a picture is taken, in the words of `vtray.render`."""
    found: dict[str, Any] = {
        "integrator": str(random.choice(["direct", "whitted", "whitted", "path", "path", "path"])),
        "samples": int(random.choice([1, 1, 2, 5])),
        "seed": int(random.choice([0, 7, 2**32 - 1])),
    }
    chances: list[tuple[float, str, Callable[[], Any]]] = [
        (0.7, "depth", lambda: int(random.choice([0, 1, 2, 3, 8, 64]))),
        (0.3, "firefly", lambda: float(random.choice([5e-324, 0.01, 1.0, 1e308]))),
        (0.3, "filter", lambda: str(random.choice(["box", "tent", "mitchell", "gaussian"]))),
        (0.4, "exposure", lambda: random.choice(["max", "auto"])),
        (0.1, "exposure", lambda: float(random.choice([5e-324, 1.0, 1e308]))),
        (0.3, "stops", lambda: float(random.choice([-100, -1, 0.5, 100]))),
        (0.5, "tonemap", lambda: str(random.choice(["linear", "srgb", "filmic", "agx"]))),
        (0.3, "background", lambda: random.choice(["transparent", "black", "orange"])),
        (0.9, "tolerance", lambda: float(random.choice([0.05, 1e6, 1e6, 1e6]))),
        (0.1, "fog", lambda: True),
        (0.1, "outline", lambda: 1.5),
        (0.3, "edge_samples", lambda: int(random.choice([1, 3, 8, 16]))),
    ]
    for chance, name, value in chances:
        if random.random() < chance:
            found[name] = value()
    if any(item.get("type") == "sky" for item in scene["lights"]) and random.random() < 0.5:
        found["background"] = "sky"
    return {name: str(v) if isinstance(v, np.str_) else v for name, v in found.items()}
