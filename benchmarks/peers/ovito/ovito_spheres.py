"""Renders spheres with OVITO: the host of a peer beside which vtray is measured.

    python ovito_spheres.py tachyon|ospray THREADS SCENE OUTPUT

SCENE is a file as `host_scene.py` describes it; OUTPUT is a PNG. What took how long goes to
standard output: OVITO does not tell building from tracing. Its light comes from a place of its own,
so lights are left out, and so are planes, which it does not have.

Runs in the peers' own Python environment, without vtray.
"""

import math
import os
import sys
import tempfile
import time
from pathlib import Path

sys.path.append(str(Path(__file__).resolve().parents[2]))  # for `peers`


def main() -> None:
    """Do what the arguments say."""
    if sys.argv[1:] == ["--version"]:
        import ovito

        with tempfile.TemporaryDirectory() as folder:  # fails without Vulkan
            render("tachyon", (8, 8), 1.0, str(Path(folder) / "nothing.png"))
        print(ovito.version_string)
        return
    renderer, threads, path, output = sys.argv[1:]
    # Its renderers take all cores that they find, whatever they are told.
    if hasattr(os, "sched_setaffinity"):
        os.sched_setaffinity(0, sorted(os.sched_getaffinity(0))[: int(threads)])
    os.environ["OVITO_THREAD_COUNT"] = threads
    import ovito.data
    import ovito.pipeline
    import ovito.vis

    start = time.perf_counter()
    size, fov = load(Path(path))
    loaded = time.perf_counter()
    render(renderer, size, fov, output)
    print(f"load  {loaded - start:8.4f} s")
    print(f"render{time.perf_counter() - loaded:8.4f} s")


def load(path: Path) -> tuple[tuple[int, int], float]:
    """Read a scene and show its spheres; return the size in pixels and the field of view."""
    import numpy as np
    from ovito.data import DataCollection
    from ovito.pipeline import Pipeline, StaticSource

    from peers.host.host_scene import read_scene

    scene = read_scene(path)
    data = DataCollection()
    particles = data.create_particles(count=len(scene.spheres))
    # Its axes are right-handed.
    particles.create_property("Position", data=scene.spheres[:, :3] * np.float32([1, 1, -1]))
    particles.create_property("Radius", data=scene.spheres[:, 3])
    particles.create_property("Color", data=scene.color / np.float32(255))
    Pipeline(source=StaticSource(data=data)).add_to_scene()
    size = scene.width, scene.height
    return size, 2 * math.atan(scene.height * scene.pixel_height / 2)


def render(renderer: str, size: tuple[int, int], fov: float, output: str) -> None:
    """Render what is shown, from the origin."""
    from ovito.vis import OSPRayRenderer, TachyonRenderer, Viewport

    if renderer == "tachyon":
        chosen = TachyonRenderer(antialiasing=False, ambient_occlusion=False, shadows=True)
    else:
        chosen = OSPRayRenderer(
            samples_per_pixel=1,
            refinement_iterations=1,
            max_ray_recursion=1,
            denoising_enabled=False,
            ambient_light_enabled=False,
        )
    view = Viewport(
        type=Viewport.Type.Perspective, fov=fov, camera_pos=(0, 0, 0), camera_dir=(0, 0, -1)
    )
    view.render_image(size=size, filename=output, background=(0, 0, 0), renderer=chosen)


if __name__ == "__main__":
    main()
