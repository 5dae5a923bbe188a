"""Random scenes that are cut, let light through, and lie in fog: what is promised of pictures."""

import random as python_random
from pathlib import Path
from typing import Any

import numpy as np

import vtray
from fuzz import bounces, looks, truth
from vtray.image.exposure import develop

Scene = dict[str, Any]
Random = np.random.Generator

LARGE = [40, 30]
"""The size of pictures with pixels that need no samples."""

OPACITIES = [0.0, 5e-324, 0.01, 0.3, 0.5, 0.5, 1 - 2.0**-53, 1.0]
"""With those at which something changes."""


def attempt(random: python_random.Random, folder: Path) -> None:
    """Take a picture of a random scene in a random style."""
    numbers = np.random.default_rng(random.randrange(2**63))
    if numbers.random() < 0.6:
        scene = _crowd(numbers)
    else:
        scene = truth.random_scene(numbers)
        if numbers.random() < 0.4:
            scene = truth.with_cylinders(numbers, scene)
    scene = bounces.with_copies_and_lamps(numbers, scene, 0.4)
    how = {
        "integrator": str(numbers.choice(["direct", "direct", "direct", "whitted", "path"])),
        "samples": int(numbers.choice([1, 2, 4])),
        "edge_samples": int(numbers.choice([1, 1, 6])),
        "background": str(numbers.choice(["black", "white", "teal", "transparent"])),
        "tolerance": 1e6,
    }
    if how["integrator"] != "direct":
        scene = looks.with_looks(numbers, scene, folder)
        how["depth"] = int(numbers.choice([0, 1, 3]))
    scene = with_style(numbers, scene)
    if numbers.random() < bounces.PADDED:
        scene = looks.padded(numbers, scene)
    bounces.keep(scene, how, folder)
    fault = (
        bounces.fault_of(scene, how, folder)
        or _fault_of_samples(scene, how, folder)
        or _fault_of_pixels(scene, how, folder)
    )
    if fault is not None:
        raise AssertionError(fault)


def _fault_of_samples(scene: Scene, how: Scene, folder: Path) -> str | None:
    """Return whether pixels that need no samples are others than in a picture without any."""
    are_points = all(light.get("type", "point") == "point" for light in scene["lights"])
    if how["samples"] == 1 or how["integrator"] != "direct" or not are_points:
        return None
    scene = {**scene, "render": {"size": LARGE}}
    try:
        sampled = bounces.taken(scene, folder, truth.FEW, how)
        plain = bounces.taken(scene, folder, truth.FEW, how | {"samples": 1})
    except vtray.VtrayError:
        return None
    sure = sampled.samples == 1
    for name in ("linear", "alpha", "with_sky", "depth", "normals", "ids"):
        one, other = (getattr(image, name)[sure] for image in (sampled, plain))
        # Fog is over all that a pixel shows, or over layer by layer, which rounds otherwise.
        if not np.allclose(one, other, rtol=1e-12, atol=0, equal_nan=True):
            return f"{name} of pixels without samples is another in a picture with some"
    return None


def _fault_of_pixels(scene: Scene, how: Scene, folder: Path) -> str | None:
    """Return whether pixels that are made at once are not those that are made step by step."""
    try:
        image = bounces.taken(scene, folder, truth.FEW, how)
    except vtray.VtrayError:
        return None
    background, alpha = image.settings.background, image.alpha
    given = image.with_sky, image.white, background, lambda: alpha, 1, 8, image.overlays
    if (image.pixels == develop(*given)).all():
        return None
    return "pixels are others than step by step"


def _crowd(random: Random) -> Scene:
    """Return a scene of balls and sticks that overlap, and fill the picture."""
    objects = []
    for _ in range(random.integers(1, 7)):
        center = random.uniform((-3, -2, 5), (3, 2, 12))
        item: Scene = {"type": "sphere", "center": center, "radius": random.uniform(0.5, 3)}
        if random.random() < 0.3:
            end = center + random.normal(size=3)
            item = {"type": "cylinder", "start": center, "end": end, "radius": 0.3}
        color = {name: int(random.integers(256)) for name in "rgb"}
        objects.append(truth.written(item) | {"color": color, "lambert": 1.0})
    if random.random() < 0.5:
        square = np.array([0.3, 0.2, -1.0])
        wall = {"type": "plane", "center": np.array([0.0, 0.0, 9.0]), "normal": square}
        color = {"r": 99, "g": 200, "b": 80}
        objects.append(truth.written(wall) | {"color": color, "lambert": 1.0})
    scale = 9.0 / LARGE[0]
    camera = {"center": np.zeros(3), "normal": np.array([0.0, 0, 1]), "focus": 7.0}
    camera |= {"resolution": [scale, scale], "size": LARGE}
    points = [{"location": random.uniform(-9, 9, 3), "intensity": 1.0} for _ in range(2)]
    return {
        "camera": truth.written(camera),
        "lights": [truth.written(point) for point in points],
        "objects": objects,
    }


def with_style(random: Random, scene: Scene) -> Scene:
    """Return a scene some of whose objects let light through, or are cut, in a style."""
    size = scene["camera"]["resolution"][0] * scene["camera"]["size"][0]
    share = random.choice([0.0, 0.4, 1.0])

    def faded(item: Scene) -> Scene:
        if item["type"] == "copies":
            return {**item, "objects": [faded(part) for part in item["objects"]]}
        if random.random() >= share:
            return item
        return {**item, "opacity": float(random.choice(OPACITIES))}

    objects = [faded(item) for item in scene["objects"]]
    style: Scene = {}
    if random.random() < 0.6:
        style["clip"] = [_plane(random, scene, size) for _ in range(random.integers(1, 4))]
        style["cap"] = [False, True, {"r": 255, "g": 0, "b": 99}][random.integers(3)]
    if random.random() < 0.2:
        thickness = float(size * random.choice([1e-6, 0.3, 1.0, 3.0]))
        style["slice"] = _plane(random, scene, size) | {"thickness": thickness}
    if random.random() < 0.3:
        focus = scene["camera"]["focus"]
        start = float(size * random.choice([0.0, 0.5, 1.0]))
        style["fog"] = {"start": start, "end": start + float(random.choice([size, focus]))}
    if random.random() < 0.3:
        borders = str(random.choice(["none", "objects", "particles"]))
        style["outline"] = {"width": float(random.choice([0.3, 1.0, 3.0])), "borders": borders}
        style["outline"]["normals"] = bool(random.random() < 0.5)
    if random.random() < 0.2:
        style["eye_dome"] = True
    if random.random() < 0.2:
        style["solid_from"] = float(random.choice([0.0, 0.3, 1 - 2.0**-53]))
    return {**scene, "objects": objects, "style": style}


def _plane(random: Random, scene: Scene, size: float) -> Scene:
    """Return a clip plane: through a sphere, at its side, or anywhere."""
    normal = random.normal(size=3)
    if random.random() < 0.3:
        normal = np.roll([float(random.choice([-1.0, 1.0])), 0.0, 0.0], random.integers(3))
    balls = [item for item in scene["objects"] if item["type"] == "sphere"]
    camera = scene["camera"]
    center = truth.array_of(camera["center"])
    if balls:
        ball = balls[random.integers(len(balls))]
        unit = normal / np.linalg.norm(normal)
        reach = ball["radius"] * random.choice([0.0, 0.0, 0.5, -0.5, 1.0, -1.0])
        center = truth.array_of(ball["center"]) + reach * unit
    if random.random() < 0.2:
        center = center + size * random.normal(size=3)
    found = truth.written({"normal": normal, "center": center})
    if random.random() < 0.3:
        count = len(scene["objects"])
        found["objects"] = sorted({int(random.integers(count)) for _ in range(2)})
    return found
