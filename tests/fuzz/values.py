"""Strange values in code: an object or a picture, or one line that names place and value."""

import json
import math
from collections.abc import Callable
from pathlib import Path
from random import Random
from typing import Any

import numpy as np

import vtray

STRANGE: list[Any] = [
    *(math.nan, math.inf, -math.inf, -0.0, 0, 1, -1, 2, 5e-324, 1e-320, 1e-30, 1e300, 1.7e308),
    *(10**400, 2**63, 64, 65, 0.5, None, True, False, "", "path", "off", "max", "gold", "glass"),
    *("a\nb", "\x1b[2J", "é", b"x", [], {}, (), (1, 2), (0, 0, 0), (1, 2, 3), (math.nan, 0, 0)),
    *((0, 0, 1), (None, None), ((1, 2, 3), None), [[[1, 2, 3]]], np.zeros(3), np.float64(0.5)),
    *(np.float32("nan"), np.int64(3), np.zeros((1, 1, 3), np.uint8), np.zeros((0, 3, 3), np.uint8)),
    *(np.full((2, 2, 3), np.nan), vtray.Glass(), vtray.Checker(), vtray.Lens(1, 2), object()),
]
"""What is given in the place of a value."""

IMAGE = np.full((1, 1, 3), 99, np.uint8)

MADE: dict[Callable[..., Any], dict[str, Any]] = {
    vtray.Glass: {"ior": 1.5, "absorption": (0, 1, 2), "roughness": 0, "thin": False},
    vtray.Metal: {"name": "gold", "roughness": 0.5, "pattern": vtray.Checker()},
    vtray.Plastic: {"ior": 1.5, "roughness": 0.2, "pattern": None},
    vtray.Emissive: {"radiance": 2},
    vtray.Blend: {"first": "mirror", "second": vtray.Glass(), "weight": 0.5},
    vtray.Checker: {"colors": (None, (1, 2, 3)), "size": 1, "up": (0, 0, 1), "rotation": 3},
    vtray.Stripes: {"colors": (None, None), "size": 1, "up": None, "rotation": 3, "run": "along"},
    vtray.ImagePattern: {"image": IMAGE, "size": 1, "up": None, "rotation": 3},
    vtray.Lens: {"radius": 0.1, "focus_distance": 5, "blades": 5},
    vtray.RenderSettings: {"samples": 2, "integrator": "path", "depth": 3, "edge_samples": 9},
    vtray.Camera.panorama: {"eye": (0, 0, 0), "target": (0, 0, 1), "up": (0, 1, 0), "size": (4, 2)},
}
"""What is made in code, and right values for it."""

SETTINGS: dict[str, Any] = {
    "integrator": "path",
    "depth": 2,
    "firefly": 2.0,
    "samples": 2,
    "exposure": "auto",
    "stops": 0.5,
    "tonemap": "agx",
    "tolerance": 1.0,
    "seed": 3,
    "filter": "box",
    "background": "orange",
    "fog": True,
}
"""What a render takes."""


def attempt(random: Random, folder: Path) -> None:
    """Make something in code, or take a picture, of which one value is strange."""
    make = random.choice([*MADE, None])
    given = dict(SETTINGS if make is None else MADE[make])
    given = {name: value for name, value in given.items() if random.random() < 0.8}
    name = random.choice(list(SETTINGS if make is None else MADE[make]))
    given[name] = random.choice(STRANGE)
    what = "render" if make is None else getattr(make, "__name__", str(make))
    (folder / "given.txt").write_text(f"{what}: {given!r}")
    try:
        if make is None:
            pictured(vtray.Lambert(), **given)
        else:
            made = make(**given)
            if isinstance(made, vtray.Lambert | vtray.Glass | vtray.Emissive | vtray.Plastic):
                pictured(made)
    except vtray.VtrayError as error:
        words = str(error)
        assert words.isprintable(), words
        assert ": " in words, words
    except TypeError as error:
        assert " lacks the argument" in str(error) or " missing " in str(error), error


def pictured(material: Any, **how: Any) -> None:
    """Take a picture of a ball of a material, read from a file that was written of it."""
    scene = vtray.Scene()
    scene.add_sphere((0, 0, 5), 1, color="gold", material=material)
    scene.add_light((5, -5, 0))
    scene.camera = vtray.Camera.look_at((0, 0, 0), (0, 0, 5), up=(0, -1, 0), size=(3, 2))
    how = {"integrator": "whitted", **how}
    image = vtray.render(scene, threads=1, warn=str, **how)
    assert np.isfinite(image.linear).all()
    assert json.dumps(image.pixels.tolist())
