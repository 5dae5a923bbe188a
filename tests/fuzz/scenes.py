"""Scene files with some parts exchanged: a picture, or one line of error."""

import json
from pathlib import Path
from random import Random
from typing import Any

import numpy as np
from examples import light, plane, scene, sphere, xyz
from PIL import Image

from fuzz import copies, looks
from fuzz.damage import damaged_json
from fuzz.promises import run_quietly

MOST_PIXELS = 10_000
"""Of a picture that is rendered; larger ones would take all the time."""

LIGHTS: list[dict[str, Any]] = [
    light(5, -5, 0),
    {**light(0, -1, 5), "type": "point", "color": {"r": 255, "g": 200, "b": 9}},
    {"type": "sun", "direction": xyz(1, 2, 0.5), "angle": 9},
    {"type": "sun", "direction": xyz(0, 1, 0), "intensity": 0.5, "color": {"r": 1, "g": 2, "b": 3}},
    {"type": "sphere", "location": xyz(1, -4, 3), "radius": 2},
    {"type": "sky", "radiance": 0.5, "color": {"r": 160, "g": 192, "b": 255}},
    {"type": "ambient", "intensity": 0.3, "distance": 2},
    {"type": "ambient"},
]
"""Lights of all kinds, with all of their keys and with few."""


MATERIALS: list[Any] = [
    *("mirror", "glass", "plastic", "water"),
    {"type": "lambert", "pattern": {"type": "checker", "colors": [None, None], "size": 0.3}},
    {"type": "glass", "ior": 1.33, "absorption": [0.5, 0, 1], "roughness": 0.2},
    {"type": "glass", "thin": True, "pattern": {"type": "image", "image": "a.png"}},
    {"type": "metal", "name": "gold", "roughness": 0.3},
    {"type": "plastic", "ior": 1.6, "roughness": 0},
    {"type": "emissive", "radiance": 2},
    {"type": "blend", "first": "water", "second": {"type": "mirror"}, "weight": 0.3},
    {
        "type": "mirror",
        "pattern": {
            "type": "stripes",
            "colors": [{"r": 1, "g": 2, "b": 3}, None],
            "size": 0.2,
            "up": xyz(0, 1, 1),
            "rotation": 30,
            "run": "along",
        },
    },
    {"type": "metal", "pattern": {"type": "image", "image": "b.npy", "size": 0.5, "rotation": -9}},
]
"""Materials of all kinds, with all of their keys and with few."""

LENSES: list[dict[str, Any]] = [
    {"radius": 0.2, "focus_distance": 6},
    {"radius": 0.1, "focus_on": xyz(0, 0, 5), "blades": 5},
]
"""Lenses by all of their keys."""


def attempt(random: Random, folder: Path) -> None:
    """Render a scene file that is wrong, or strange."""
    file = folder / "scene.json"
    file.write_bytes(damaged_json(_document(random, folder), random))
    if not _is_huge(file):
        threads = random.choice(["1", "2", "7"])
        run_quietly(["-t", threads, str(file), str(folder / "picture.png")])


def _document(random: Random, folder: Path) -> dict[str, Any]:
    """Return a right scene with most of what a file may hold."""
    np.savez(folder / "a.npz", center=[(0, 0, 4), (1, 0, 4)], radius=[0.3, 0.4])
    many = {"type": "spheres", "data": "a.npz", "color": {"r": 9, "g": 99, "b": 255}, "lambert": 1}
    objects = [sphere((0, 0, 5), 1), plane((0, 1, 0), (0, -1, 0)), many]
    if copies.SHARE and random.random() < copies.SHARE:
        np.save(folder / "b.npy", [(0, 0, 1), (0, -1, 1)])
        places = random.choice([{"at": [xyz(0, 0, 1), xyz(1, 0, 2)]}, {"data": "b.npy"}])
        objects.append({"type": "copies", "objects": [objects[0], many], **places})
    found = scene(
        [item for item in objects if random.random() < 0.8],
        random.sample(LIGHTS, random.randrange(1, 5)),
        size=[12, 9],
        resolution=[0.4, 0.4],
    )
    if random.random() < 0.5:
        found["camera"]["up"] = xyz(0.1, -1, 0)
    if random.random() < 0.5:
        found["camera"]["projection"] = random.choice(["orthographic", "perspective"])
    if random.random() < 0.5:
        found["render"] = {
            "samples": random.choice([1, 4]),
            "filter": random.choice(["box", "mitchell", "gaussian"]),
            "seed": 7,
            "size": [10, 10],
            "exposure": random.choice(["max", "auto", 0.5, 1e308]),
            "stops": random.choice([0, 1, -100, 0.3]),
            "tonemap": random.choice(["linear", "srgb", "filmic", "agx"]),
            "background": random.choice(["transparent", {"r": 1, "g": 2, "b": 3}]),
        }
    if looks.SHARE and random.random() < looks.SHARE:
        _give_looks(random, found, folder)
    return found


def _give_looks(random: Random, found: dict[str, Any], folder: Path) -> None:
    """Let objects of a scene be made of something, and be taken in other ways."""
    render = found.setdefault("render", {})
    if random.random() < 0.3:
        render["firefly"] = random.choice(["off", 2, 1e-9])
    if random.random() < 0.5:
        render["tolerance"] = random.choice([0.008, 1e9])
    if random.random() < 0.1:
        render["denoise"] = True
    if random.random() < 0.3:
        found["camera"]["projection"] = "panorama"
    elif random.random() < 0.3:
        found["camera"]["lens"] = random.choice(LENSES)
    np.save(folder / "b.npy", np.full((1, 1, 4), 99, np.uint8))
    Image.new("RGB", (3, 2), (9, 99, 255)).save(folder / "a.png")
    found["materials"] = {"water": {"type": "glass", "ior": 1.33}}
    found["integrator"] = random.choice(
        ["direct", "whitted", "path", {"type": "path", "depth": 2}, {"type": "whitted", "depth": 0}]
    )
    for item in found["objects"]:
        if random.random() < 0.7:
            item["material"] = random.choice(MATERIALS)
        if item["type"] == "spheres" and random.random() < 0.3:
            name = random.choice(["material_index", "roughness", "metalness"])
            arrays = dict(np.load(folder / "a.npz"))
            np.savez(folder / "a.npz", **arrays, **{name: [0, 1]})
            item["material"] = random.sample(MATERIALS, 2) if name[0] != "r" else "plastic"


def _is_huge(file: Path) -> bool:
    """Tell whether a scene, if it is one, has very many pixels or samples."""
    try:
        found = json.loads(file.read_bytes())
        render = found.get("render", {})
        width, height = render.get("size", found["camera"]["size"])
        return MOST_PIXELS < width * height * render.get("samples", 1) < 1e12
    except Exception:  # noqa: BLE001 - it is no scene
        return False
