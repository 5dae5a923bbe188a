"""Draws a dozen small scenes, and says whether kernels were compiled: run on each machine.

Each is there for a part of the way from what a user writes to the bytes of a file: lights, cameras,
colours, the hierarchy, samples, exposure, the formats. Numbers that the package works out in Python
and NumPy are written down as well, to the last bit, so that a difference is found at its root.

    python drawings.py FOLDER
"""

import hashlib
import sys
from collections.abc import Callable
from pathlib import Path

import cmap
import numpy as np

import vtray
from vtray import Camera, Image, Scene, lights
from vtray.scene.colors.color_scale import color_table
from vtray.scene.placing.directions import camera_axes
from vtray.transport.sampling.filters import FILTERS, filter_places

Drawing = Callable[[], Image]


def cloud(count: int, seed: int = 1) -> np.ndarray:
    """Return places in a cube; uniform numbers are made of integers, and so are the same."""
    return np.random.default_rng(seed).random((count, 3)) * 10


def few(size: tuple[int, int] = (48, 36)) -> Scene:
    """Return some balls on a floor, one behind another, seen at a slant."""
    scene = Scene()
    for k, name in enumerate(("tomato", "#4a90d9", "C2", "gold", "white")):
        scene.add_sphere((1.7 * k, 0.3 + 0.1 * k, (k % 3) * 1.3), 0.4 + 0.11 * k, color=name)
    scene.add_plane((0, -0.3, 0), (0.01, 1, 0.02), color="#c8c0b0")
    scene.camera = Camera.fit(scene, (0.3, -0.4, -1), size=size, fov_degrees=37)
    return scene


def many(count: int = 400, **given: object) -> Scene:
    """Return so many balls that they have a hierarchy."""
    scene = Scene()
    places = cloud(count)
    color = {"color": places[:, 2] * 0.37, "cmap": cmap.Colormap("viridis"), **given}
    scene.add_spheres(places, 0.2 + 0.03 * places[:, 0], **color)
    scene.add_plane((0, 0, -0.5), (0, 0, 1))
    scene.camera = Camera.fit(scene, (0.5, 1, -0.3), size=(64, 48), fov_degrees=29)
    scene.lights = lights.rembrandt(scene, points=True)
    return scene


def by_preset(name: str) -> Image:
    """Draw few balls in ready-made light."""
    scene = few()
    scene.lights = getattr(lights, name)(scene)
    return vtray.render(scene, samples=4)


def by_filter(name: str) -> Image:
    """Draw a hierarchy with samples weighed by a filter."""
    return vtray.render(many(), samples=4, filter=name, seed=7)


def looked_at() -> Image:
    """Draw what a camera sees that looks from one point to another."""
    scene = few()
    scene.camera = Camera.look_at((2.1, 3.3, 9.7), (3, 0.5, 1), fov_degrees=51.3, size=(48, 36))
    scene.lights = lights.loop(scene, side="right", points=True)
    return vtray.render(scene)


def side_by_side() -> Image:
    """Draw an orthographic view, and one that is fitted, of points of float32."""
    scene = many(color="#88aaff", cmap=None)
    places = cloud(300, 2).astype(np.float32)
    scene.add_spheres(places, np.float32(0.15), color=places[:, :1] % 1 * [[1, 0.5, 0.1]])
    scene.camera = Camera.fit(scene, (1, 2, -1), projection="orthographic", size=(50, 40))
    return vtray.render(scene, samples=2)


def from_behind() -> Image:
    """Draw with a camera of the plain format that looks back: its axes follow from its normal."""
    scene = few()
    scene.camera = Camera((3, 1, 30), (-0.1, 0.21, -1), 20, (48, 36), (0.2, 0.21))
    scene.lights = lights.split(scene, points=True)
    return vtray.render(scene)


def on_white() -> Image:
    """Draw over a background, at a given exposure."""
    scene = few()
    scene.lights = lights.ring(scene, points=True, count=7)
    return vtray.render(scene, samples=4, background="#eef0f2", exposure=0.7)


def cut_out() -> Image:
    """Draw without a background."""
    scene = many(200)
    return vtray.render(scene, samples=4, background="transparent")


def lit_again() -> Image:
    """Draw, and change the lights and the colours of the picture."""
    image = vtray.render(few_lit(), samples=4, keep_lights=True)
    return image.relight([0.3, 0.9]).recolor(0, "teal")


def few_lit() -> Scene:
    """Return few balls between two lamps."""
    scene = few()
    scene.lights = [vtray.Light((-5, 9, 7), 0.8), vtray.Light((9, 4, 3), 0.4)]
    return scene


def at_places() -> Image:
    """Draw a ball and two sticks at many places."""
    scene = few()
    sticks = vtray.Cylinders(
        [(0, 0, 0)] * 2, [(0.5, 0.2, 0.1), (0, -0.4, 0.3)], 0.1, (200, 30, 20), 1.0, (9, 40, 250)
    )
    scene.add_copies([vtray.Sphere((0, 0, 0), 0.2), sticks], cloud(40, 5))
    scene.camera = Camera.fit(scene, (0.3, -0.4, -1), size=(48, 36), fov_degrees=37)
    scene.lights = lights.rembrandt(scene, points=True)
    return vtray.render(scene, samples=2)


def from_file() -> Image:
    """Draw a scene of the examples, smaller."""
    scene = vtray.load(Path(__file__).parents[2] / "scenes" / "inside.json")
    return vtray.render(scene, size=(40, 40))


DRAWINGS: dict[str, Drawing] = {
    "looked-at": looked_at,
    "orthographic": side_by_side,
    "from-behind": from_behind,
    "on-white": on_white,
    "cut-out": cut_out,
    "lit-again": lit_again,
    "at-places": at_places,
    "from-file": from_file,
    **{name: lambda name=name: by_preset(name) for name in ("cloudy", "lightbox", "butterfly")},
    **{f"filter-{name}": lambda name=name: by_filter(name) for name in FILTERS},
}


def numbers() -> dict[str, np.ndarray]:
    """Return what is worked out before the first ray."""
    scene = few()
    found = {f"filter {name}": filter_places(name) for name in FILTERS}
    for name in ("rembrandt", "loop", "split", "butterfly", "ring", "cloudy", "lightbox"):
        lamps = getattr(lights, name)(scene, points=True)
        places = [(p.location.x, p.location.y, p.location.z, p.intensity) for p in lamps]
        found[f"lights {name}"] = np.array(places)
    for fov in (0.01, 1, 33.3, 90, 179.9):
        camera = Camera.look_at((1, 2, 3), (-3, 1, 0.7), fov_degrees=fov)
        found[f"camera {fov}"] = np.array([camera.focus, *camera.resolution])
    normals = cloud(100, 3) - [[5, 5, 11]]
    normals /= np.sqrt(normals[:, :1] ** 2 + normals[:, 1:2] ** 2 + normals[:, 2:] ** 2)
    found["axes"] = np.array([camera_axes(tuple(map(float, normal))) for normal in normals])
    for name in ("viridis", "matplotlib:twilight", "gnuplot:rainbow", "cubehelix", "gnuplot:ocean"):
        found[f"colours {name}"] = color_table(cmap.Colormap(name))
    return found


def main(folder: Path) -> None:
    """Write each drawing as a PNG of 8 and of 16 bits and as numbers."""
    folder.mkdir(parents=True, exist_ok=True)
    np.savez(folder / "numbers.npz", **numbers())
    for name, draw in DRAWINGS.items():
        image = draw()
        image.save(folder / f"{name}.png")
        image.save(folder / f"{name}-16.png", bits=16)
        image.save(folder / f"{name}.npz", aov=("depth", "normals", "ids", "copies"))
        light = hashlib.sha256(image.linear.tobytes()).hexdigest()[:16]
        print(f"{name:24} {light}", flush=True)
    print("compiled" if "numba" in sys.modules else "loaded")


if __name__ == "__main__":
    main(Path(sys.argv[1]))
