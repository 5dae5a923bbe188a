"""Renders scenes of materials with Mitsuba 3, by its integrator `path`.

    python mitsuba_materials.py SCENES OUTPUT

SCENES is a JSON file: for each name a scene as Mitsuba's dictionaries describe it, in which
transformations are matrices, `samples`, and `pictures`, of so many with other random numbers.
OUTPUT is a folder for a .npy file of each, (pictures, height, width, 3), float32.

Runs in the peers' own Python environment, without vtray.
"""

import json
import sys
from pathlib import Path
from typing import Any

import mitsuba as mi
import numpy as np

mi.set_variant("scalar_rgb")


def made(given: Any) -> Any:  # noqa: ANN401
    """Return a dictionary whose transformations are Mitsuba's."""
    if not isinstance(given, dict):
        return given
    return {
        key: mi.ScalarTransform4f(value) if key == "to_world" else made(value)
        for key, value in given.items()
    }


def main() -> None:
    """Do what the arguments say."""
    scenes, output = map(Path, sys.argv[1:])
    for name, given in json.loads(scenes.read_text()).items():
        scene = mi.load_dict(made(given["scene"]))
        found = [
            np.array(mi.render(scene, seed=seed, spp=given["samples"]))
            for seed in range(given["pictures"])
        ]
        np.save(output / f"{name}.npy", np.stack(found))


if __name__ == "__main__":
    main()
