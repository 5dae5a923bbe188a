"""Puts pictures of vtray beside those of OVITO, each with nothing but its own settings.

    python benchmarks/looks/sheets.py FOLDER [NAME ...]

Writes FOLDER/NAME.jpg for each set of particles: OVITO on the left, vtray on the right, and tells
how long each took. OVITO is that of `make peers`, and wants a driver for Vulkan (CONTRIBUTING.md).
"""

import math
import subprocess
import sys
import tempfile
import time
from pathlib import Path

import numpy as np
from PIL import Image

sys.path.append(str(Path(__file__).resolve().parents[1]))  # for `peers` and `looks`

import vtray
from looks.data_sets import DATA_SETS, Particles
from peers.peer import python_of_peers

SIZE = (720, 600)


def main() -> None:
    """Do what the arguments say."""
    folder, *names = sys.argv[1:]
    for name in names or DATA_SETS:
        particles = DATA_SETS[name]()
        scene = vtray.Scene()
        scene.add_spheres(particles.places, particles.radii, color=particles.colors / 255)
        scene.camera = vtray.Camera.fit(scene, direction=(-0.5, 1, -0.6), up=(0, 0, 1), size=SIZE)
        with tempfile.TemporaryDirectory() as temporary:
            theirs, seconds = render_with_ovito(particles, scene.camera, Path(temporary))
        start = time.perf_counter()
        image = vtray.render(scene)
        print(f"{name}: OVITO {seconds} s, vtray {time.perf_counter() - start:.2f} s")
        both = np.hstack([theirs, image.pixels])
        Image.fromarray(both).save(Path(folder) / f"{name}.jpg", quality=92)


def render_with_ovito(
    particles: Particles, camera: vtray.Camera, folder: Path
) -> tuple[np.ndarray, str]:
    """Return the pixels of OVITO's picture, and how many seconds it took."""
    forward = np.array([camera.normal.x, camera.normal.y, camera.normal.z], float)
    forward /= np.linalg.norm(forward)
    center = np.array([camera.center.x, camera.center.y, camera.center.z])
    height = camera.size[1] * camera.resolution[1]
    np.savez(
        folder / "particles.npz",
        **particles._asdict(),
        eye=center - camera.focus * forward,
        forward=forward,
        up=(0.0, 0.0, 1.0),
        fov=2 * math.atan(height / 2 / camera.focus),
        size=camera.size,
    )
    script = Path(__file__).with_name("ovito_look.py")
    command = [python_of_peers(), script, folder / "particles.npz", folder / "picture.png"]
    done = subprocess.run(command, check=True, stdout=subprocess.PIPE, text=True)
    with Image.open(folder / "picture.png") as picture:
        return np.asarray(picture.convert("RGB")), done.stdout.split()[-1]


if __name__ == "__main__":
    main()
