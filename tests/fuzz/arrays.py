"""Files of arrays, damaged or of strange arrays: a picture, or one line of error."""

import io
import json
from pathlib import Path
from random import Random

import numpy as np
from examples import light, scene

from fuzz import copies
from fuzz.damage import damaged_bytes
from fuzz.promises import run_quietly

KINDS = ["f8", "f4", ">f8", "f2", "i4", "u1", "?", "c16", "S3", "U2", "m8[s]", "i8", "f16"]
SHAPES = [(3, 3), (3,), (), (1, 3), (0, 3), (0,), (3, 1), (2, 3), (3, 3, 1), (200, 3), (200,)]


def attempt(random: Random, folder: Path) -> None:
    """Render spheres whose arrays are not what they should be."""
    name = random.choice(["a.npz", "a.npz", "a.npy"])
    memory = io.BytesIO()
    if name == "a.npy":
        np.save(memory, _array(random, "center"))
    else:
        columns = [c for c in ("center", "radius", "color", "lambert") if random.random() < 0.9]
        arrays = {column: _array(random, column) for column in columns}
        random.choice([np.savez, np.savez_compressed])(memory, **arrays)
    data = memory.getvalue()
    (folder / name).write_bytes(damaged_bytes(data, random) if random.random() < 0.6 else data)
    spheres = {"type": "spheres", "data": name}
    if random.random() < 0.5:
        spheres |= {"radius": 0.3, "color": {"r": 9, "g": 99, "b": 255}, "lambert": 1}
    objects = [spheres]
    if copies.SHARE and random.random() < copies.SHARE:
        np.savez(folder / "b.npz", at=_array(random, "center"))
        objects = [{"type": "copies", "objects": [spheres], "data": "b.npz"}]
    document = scene(objects, [light(5, -5, 0)], size=[12, 9], resolution=[0.4, 0.4])
    (folder / "scene.json").write_text(json.dumps(document))
    run_quietly([str(folder / "scene.json"), str(folder / "picture.png")])


def _array(random: Random, column: str) -> np.ndarray:
    """Return an array that is right, often, or strange."""
    numbers = np.random.default_rng(random.randrange(2**32))
    shape = (3, 3) if column in ("center", "color") else (3,)
    found = numbers.uniform(0, 1, shape) if column != "color" else numbers.integers(0, 256, shape)
    if random.random() < 0.2:
        found = np.resize(found, random.choice(SHAPES))
    if random.random() < 0.2:
        with np.errstate(all="ignore"):
            found = found.astype(random.choice(KINDS))
    if random.random() < 0.2:
        found = np.asfortranarray(found)
    if random.random() < 0.2 and found.size and found.dtype.kind == "f":
        with np.errstate(all="ignore"):
            found.reshape(-1)[0] = random.choice([np.nan, np.inf, -1.0, 1e300, 5e-324, 0.0])
    return found
