"""Random scenes beside their picture as the rules say it, worked out plainly.

Scenes made to provoke rounding are rendered with a hierarchy and without. The light must be that
of the oracle to the last bit; and a pixel that is more than 1 off from what it is in extended
precision must lie at an edge, as near as rounding can tell. Where there are cylinders or cones,
which the oracle works out by other formulas, the picture must be as near to its own as rounding
allows.
"""

import itertools
import json
import math
import random as python_random
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np
import oracle
from cylinder_pictures import assert_near_oracle, load
from soft_pictures import compare_fans
from written_out import written_out_file

import vtray
from fuzz import copies, lights
from vtray.rendering import hierarchy as acceleration

Scene = dict[str, Any]
Random = np.random.Generator

FEW, ALL = 255, 0
"""For ``acceleration.FEW``: no hierarchy, or always one."""

WIDTH, HEIGHT = 12, 9

SEED = 3
"""What chooses the rays to soft lights."""

CONES = 0.4
"""How many of the cylinders are cones, from 0 to 1."""

ONE_FAN = 1e6
"""A tolerance at which each hit has one fan of rays to each soft light."""


def attempt(random: python_random.Random, folder: Path) -> None:
    """Render a random scene; if it has a fault, save it also without what does not matter."""
    scene = random_scene(np.random.default_rng(random.randrange(2**63)))
    if random.random() < 0.3:
        scene = with_cylinders(np.random.default_rng(random.randrange(2**63)), scene)
    if copies.SHARE and random.random() < copies.SHARE:
        scene = copies.with_copies(np.random.default_rng(random.randrange(2**63)), scene)
    if lights.SHARE and random.random() < lights.SHARE:
        scene = lights.with_soft_lights(np.random.default_rng(random.randrange(2**63)), scene)
    (folder / "scene.json").write_text(json.dumps(scene))
    fault = fault_of(scene)
    if fault is not None:
        (folder / "smaller.json").write_text(json.dumps(smaller(scene), indent=1))
        raise AssertionError(fault)


def fault_of(scene: Scene) -> str | None:
    """Return what is wrong with the picture of a scene."""
    if any(item.get("type", "point") != "point" for item in scene["lights"]):
        return _fault_of_soft_lights(scene)
    if any(item["type"] == "copies" for item in scene["objects"]):
        return _fault_of_copies(scene)
    if any(item["type"] in oracle.AXIAL for item in scene["objects"]):
        return _fault_of_cylinders(scene)
    exact = oracle.look(scene)
    for few in (FEW, ALL):
        linear = _render(scene, few).linear
        wrong = np.argwhere((linear != exact.linear).any(axis=2))
        if len(wrong):
            row, column = wrong[0]
            how = "hierarchy" if few == ALL else "few spheres"
            return f"{how}: {len(wrong)} pixels are not the oracle's, first {column},{row}"
    return _off_the_truth(scene, exact)


def _fault_of_soft_lights(scene: Scene) -> str | None:
    """Return what is wrong with the picture of a scene with lights that are no points."""
    plain = written_out_file(scene)
    for samples in (1, 2):
        first = _render(plain, FEW, samples=samples, seed=SEED)
        if not np.isfinite(first.linear).all() or (first.linear < 0).any():
            return "light is not finite, or below 0"
        for item, few in ((plain, ALL), (scene, FEW), (scene, ALL)):
            other = _render(item, few, samples=samples, seed=SEED)
            if not np.array_equal(first.linear, other.linear):
                return "soft lights: not the picture of few objects written out"
    if any(item.get("type") == "sky" for item in scene["lights"]):
        seen = _render(scene, ALL, background="sky").with_sky
        if not np.isfinite(seen).all() or (seen < 0).any():
            return "the sky is not finite, or below 0"
    image = _render(scene, ALL, seed=SEED, tolerance=ONE_FAN)
    hits = np.argwhere(image.ids[..., 0] >= 0)
    pixels = [(int(column), int(row)) for row, column in hits[:: max(len(hits) // 3, 1)]]
    try:
        compare_fans(scene, pixels, SEED, image)
    except AssertionError as error:
        return f"soft lights: not the oracle's: {error}"
    only_points = [item for item in scene["lights"] if item.get("type", "point") == "point"]
    return fault_of({**scene, "lights": only_points}) if only_points else None


def _fault_of_copies(scene: Scene) -> str | None:
    """Return what is wrong with the picture of a scene with copies."""
    plain = written_out_file(scene)
    for few, samples in itertools.product((FEW, ALL), (1, 2)):
        one, other = (_render(item, few, samples=samples) for item in (scene, plain))
        for name in ("linear", "depth", "normals"):
            if not np.array_equal(getattr(one, name), getattr(other, name), equal_nan=True):
                return f"{name} of copies are not those of the objects written out"
    return fault_of(plain)


def _fault_of_cylinders(scene: Scene) -> str | None:
    """Return what is wrong with the picture of a scene with cylinders or cones."""
    image, with_tree = (_render(scene, few) for few in (FEW, ALL))
    if (image.linear != with_tree.linear).any() or (image.ids != with_tree.ids).any():
        return "hierarchy: not the picture of few"
    sampled = [_render(scene, few, samples=2).linear for few in (FEW, ALL)]
    if (sampled[0] != sampled[1]).any():
        return "hierarchy: other pixels have samples"
    try:
        assert_near_oracle(scene, image)
    except AssertionError as error:
        return f"not near the oracle: {error}"
    return None


def smaller(scene: Scene) -> Scene:
    """Return a scene with a fault without the objects and lights that do not matter for it."""
    for kind in ("objects", "lights"):
        for item in list(scene[kind]):
            less = {**scene, kind: [other for other in scene[kind] if other is not item]}
            if fault_of(less) is not None:
                scene = less
    return scene


def _render(scene: Scene, few: int, **settings: Any) -> vtray.Image:
    """Return the picture of a scene, rendered with a hierarchy from so many shapes on."""
    # Where there are soft lights, LEAF says from how many shapes on there is a hierarchy.
    before = acceleration.FEW, acceleration.LEAF
    acceleration.FEW = acceleration.LEAF = few
    try:
        return vtray.render(load(scene), threads=1, warn=str, **settings)
    finally:
        acceleration.FEW, acceleration.LEAF = before


def _off_the_truth(scene: Scene, exact: oracle.Seen) -> str | None:
    """Return which pixels are off the oracle in extended precision, other than at an edge."""
    truth = oracle.look(scene, dtype=np.longdouble)
    white = float(truth.linear.max())
    step = white / 255 or 1.0
    rows, columns = np.nonzero(np.abs(exact.linear - truth.linear).max(axis=2) > step)
    if len(rows) == 0:
        return None
    light = exact.linear[rows, columns]
    depth = np.where(exact.ids >= 0, exact.depth, truth.depth)[rows, columns]
    reach = _rounding_in_pixels(scene, depth.astype(float))
    low, high = truth.linear[rows, columns], truth.linear[rows, columns]
    for far, way in itertools.product((1, 8, 64), range(8)):
        across, below = (far * reach * f(way * math.pi / 4) for f in (math.cos, math.sin))
        near = oracle.look(scene, columns + across, rows + below, np.longdouble).linear
        low, high = np.minimum(low, near), np.maximum(high, near)
    off = ((light < low - step) | (light > high + step)).any(axis=1) & (reach < 1e-3)
    # Where two surfaces touch, rounding may decide which of them is nearer.
    hit, other = exact.ids[rows, columns], truth.ids[rows, columns]
    both = (hit != other) & (hit >= 0) & (other >= 0)
    gap = np.abs(depth[both] - truth.depth[rows, columns][both])
    bound = reach[both] * max(scene["camera"]["resolution"]) + np.spacing(depth[both].astype(float))
    off[both] &= gap > bound
    if not off.any():
        return None
    first = int(np.argmax(off))
    place = f"{columns[first]},{rows[first]}"
    return f"{off.sum()} pixels are off the truth, first {place}: {light[first]}, {low[first]}"


def _rounding_in_pixels(scene: Scene, depth: np.ndarray) -> np.ndarray:
    """Return how far rounding may move what is seen at some depths, in pixels, (n,)."""
    camera = scene["camera"]
    objects, middle = scene["objects"], camera["center"]
    sizes = [abs(item["center"][axis] - middle[axis]) for item in objects for axis in "xyz"]
    sizes += [item.get("radius", 0.0) for item in objects]
    view = WIDTH * camera["resolution"][0] + HEIGHT * camera["resolution"][1]
    start = camera["focus"] if camera["focus"] <= 2.0**30 * view else view
    depth = np.where(np.isfinite(depth), depth - (camera["focus"] - start), start)
    pixel = min(camera["resolution"])
    if camera.get("projection") != "orthographic":
        pixel = pixel * np.maximum(depth, start) / start
    return oracle.ROUNDING * (max(sizes, default=0.0) + start + view + depth) / pixel


# From here on: how scenes are made.


def random_scene(random: Random) -> Scene:
    """Return a scene: things of all sizes that touch, coincide, and are cut by the image plane."""
    size = 10.0 ** random.choice([0, 0, 0, -6, 3, 9])
    world = size * random.choice([0.0, 0.0, 0.0, 1.0, 1e3, 1e6]) * random.normal(size=3)
    count = int(random.choice([1, 3, 6, 40], p=[0.3, 0.3, 0.3, 0.1]))
    spheres = [_sphere(random, size) for _ in range(count)]
    planes = [_plane(random, size, spheres) for _ in range(random.integers(0, 3))]
    for item in spheres[1:]:
        _bring_together(random, item, spheres[0])
    objects = [*spheres, *planes]
    points = [_light(random, size, objects) for _ in range(random.integers(1, 4))]
    scene = {"camera": _camera(random, size, objects), "lights": points, "objects": objects}
    for place in _places(scene):
        np.add(place, world, out=place)
    return {
        "camera": written(scene["camera"]),
        "lights": [written(item) for item in points],
        "objects": [written(objects[k]) for k in random.permutation(len(objects))],
    }


def with_cylinders(random: Random, scene: Scene) -> Scene:
    """Return a scene with cylinders and cones: beside, in, around what is there, and cut open."""
    camera = scene["camera"]
    center, size = array_of(camera["center"]), WIDTH * camera["resolution"][0]
    objects = list(scene["objects"]) if random.random() < 0.4 else []
    cylinders: list[Scene] = []
    for _ in range(random.choice([1, 2, 5, 20])):
        item = _cylinder(random, size, center, [*objects, *cylinders])
        cylinders += [item, item] if random.random() < 0.15 else [item]
    points = [
        {**light, "location": _beside(random, size, center, cylinders)} for light in scene["lights"]
    ]
    start = array_of(cylinders[0]["start"])
    if random.random() < 0.6 and np.any(start != center):
        camera = {**camera, **written({"normal": start - center})}
        camera.pop("up", None)
    return {"camera": camera, "lights": points, "objects": [*objects, *cylinders]}


def array_of(xyz: dict[str, float]) -> np.ndarray:
    """Return a point of a file as an array."""
    return np.array([xyz[axis] for axis in "xyz"])


def _cylinder(random: Random, size: float, center: np.ndarray, others: list[Scene]) -> Scene:
    """Return a cylinder or a cone of any size and shape, often where other things are."""
    sizes = [0.0, 1e-9, 1e-3, 0.1, 0.5, 1.0, 2.0, 1e3, 1e7]
    length, radius = (
        float(size * random.choice(sizes, p=_OFTEN) * random.choice([1.0, random.uniform(0.5, 2)]))
        for _ in range(2)
    )
    start, way = center + _point(random, size), _way(random)
    kind = random.integers(6)
    if kind == 0 and others:
        other = others[random.integers(len(others))]
        start = array_of(other.get("center") or other["start"])
    elif kind == 1:  # the image plane cuts it
        start = center - random.choice([0.0, 0.5, 1.0]) * length * way
    elif kind == 2:  # or touches it
        start = center + radius * np.cross(way, _way(random))
    end = start + length * way
    item = {"type": "cylinder", "start": start, "end": end, "radius": radius, **_material(random)}
    if random.random() < 0.5:
        item["color_end"] = random.integers(0, 256, 3)
    if random.random() < CONES:
        other = size * random.choice(sizes, p=_OFTEN)
        radius_end = float(random.choice([0.0, radius, 0.5 * radius, other]))
        item |= {"type": "cone", "radius_end": radius_end}
    return written(item)


def _beside(
    random: Random, size: float, center: np.ndarray, cylinders: list[Scene]
) -> dict[str, float]:
    """Return a place for a light: on a cylinder, in it, or elsewhere."""
    item = cylinders[random.integers(len(cylinders))]
    start, way = array_of(item["start"]), array_of(item["end"]) - array_of(item["start"])
    aside = np.cross(way, _way(random))
    aside = aside / max(np.sqrt(aside @ aside), 1e-300)
    place = {
        0: start + random.choice([0.0, 0.5, 1.0]) * way,
        1: start + random.uniform(0, 1) * way + item["radius"] * aside,
        2: start + random.choice([0.0, 1.0]) * way + random.uniform(0, 3) * size * aside,
    }.get(int(random.integers(5)), center + size * _way(random) * random.choice([1, 3, 100]))
    location: dict[str, float] = written({"location": place})["location"]
    return location


def _places(scene: Scene) -> Iterator[np.ndarray]:
    """Give all points of a scene that is being made."""
    yield scene["camera"]["center"]
    yield from (item["center"] for item in scene["objects"])
    yield from (item["location"] for item in scene["lights"])


def written(item: dict[str, Any]) -> dict[str, Any]:
    """Return a part of a scene as a file has it."""

    def plain(key: str, value: object) -> object:
        if not isinstance(value, np.ndarray):
            return value
        return dict(zip("rgb" if "color" in key else "xyz", value.tolist(), strict=True))

    return {key: plain(key, value) for key, value in item.items()}


def _point(random: Random, size: float) -> np.ndarray:
    """Return a place, often one with round numbers."""
    if random.random() < 0.3:
        return size * random.integers(-8, 9, 3) / 4
    return size * random.uniform(-2, 2, 3)


def _way(random: Random) -> np.ndarray:
    """Return a unit vector, often along an axis."""
    if random.random() < 0.3:
        return np.roll([0.0, 0.0, random.choice([-1.0, 1.0])], random.integers(3))
    way = random.normal(size=3)
    return way / np.sqrt(way @ way)


def _material(random: Random) -> dict[str, Any]:
    return {"color": random.integers(0, 256, 3), "lambert": float(random.uniform(0.2, 1))}


def _sphere(random: Random, size: float) -> dict[str, Any]:
    radius = random.choice([0.0, 1e-9, 1e-3, 0.1, 0.5, 1.0, 1.0, 1e3, 1e7], p=_OFTEN)
    radius = float(size * radius * random.choice([1.0, random.uniform(0.5, 2)]))
    return {"type": "sphere", "center": _point(random, size), "radius": radius, **_material(random)}


_OFTEN = [0.03, 0.02, 0.05, 0.2, 0.3, 0.2, 0.1, 0.05, 0.05]


def _bring_together(random: Random, item: dict[str, Any], other: dict[str, Any]) -> None:
    """Sometimes let two spheres touch from outside or inside, or coincide."""
    kind = random.integers(12)
    if kind < 2:
        away = other["radius"] + item["radius"] * (1 if kind == 0 else -1)
        item["center"] = other["center"] + away * _way(random)
    elif kind == 2:
        item["center"], item["radius"] = other["center"].copy(), other["radius"]


def _plane(random: Random, size: float, spheres: list[dict[str, Any]]) -> dict[str, Any]:
    center, normal = _point(random, size), _way(random)
    ball = spheres[random.integers(len(spheres))]
    if random.random() < 0.5:  # through a ball's centre, or touching it
        center = ball["center"] + random.choice([0.0, ball["radius"]]) * normal
    return {"type": "plane", "center": center, "normal": normal, **_material(random)}


def _light(random: Random, size: float, objects: list[dict[str, Any]]) -> dict[str, Any]:
    item = objects[random.integers(len(objects))]
    kind = random.integers(6)
    place = _point(random, size * random.choice([2, 2, 2, 1e3, 1e10]))
    if kind < 3 and item.get("radius", 0.0) > 1e-6 * size:  # on it, inside of it, in its centre
        place = item["center"] + (1.0, 0.5, 0.0)[kind] * item["radius"] * _way(random)
    elif kind < 3 and item["type"] == "plane":
        across = np.cross(item["normal"], _way(random))
        place = item["center"] + size * random.uniform(0, 3) * across
    return {"location": place, "intensity": float(random.uniform(0.2, 1))}


def _camera(random: Random, size: float, objects: list[dict[str, Any]]) -> dict[str, Any]:
    item = objects[random.integers(len(objects))]
    center, normal = _point(random, 2 * size), _way(random)
    kind = random.integers(8)
    if kind == 0:  # the image plane cuts an object in half
        center = item["center"].copy()
    elif kind == 1 and item["type"] == "sphere":  # or touches it
        center = item["center"] + item["radius"] * normal
    elif kind < 6 and np.any(item["center"] != center):  # or looks at it
        normal = item["center"] - center
    focus = size * random.choice([0.01, 0.5, 2.0, 2.0, 100.0, 1e5, 1e8, 1e11, 1e16])
    view = size * random.choice([0.2, 1.0, 3.0])
    camera = {
        "center": center,
        "normal": normal,
        "focus": float(focus),
        "size": [WIDTH, HEIGHT],
        "resolution": [float(view / WIDTH), float(view / HEIGHT)],
    }
    if random.random() < 0.3:
        camera["projection"] = "orthographic"
    up = _way(random)
    if random.random() < 0.3 and np.abs(np.cross(up, normal)).max() > 1e-3 * np.abs(normal).max():
        camera["up"] = up
    return camera
