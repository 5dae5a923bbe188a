"""The scene files of this repository, antialiased."""

from pathlib import Path

import gallery
import numpy as np
from PIL import Image

import vtray as vt

SCENES = Path(__file__).resolve().parents[1] / "scenes"
NAMES = ("room", "molecule", "packing", "first", "spiral", "inside")


def draw(size):
    """Draw six scene files side by side, in two rows."""
    width, height = size[0] // 3, size[1] // 2
    pictures = [
        vt.render(vt.load(SCENES / f"{name}.json"), samples=16, size=(width, height)).pixels
        for name in NAMES
    ]
    rows = [np.hstack(pictures[:3]), np.hstack(pictures[3:])]
    return Image.fromarray(np.vstack(rows))


if __name__ == "__main__":
    gallery.run(draw, "reference_scenes.jpg", size=(1200, 600))
