"""Renders particles with OVITO's own settings.

    python ovito_look.py PARTICLES OUTPUT

PARTICLES is an .npz with places, radii, colors, and of the view eye, forward, up, fov (vertical, in
radians) and size. Runs in the peers' own Python environment, without vtray.
"""

import sys
import time

import numpy as np


def main() -> None:
    """Do what the arguments say."""
    from ovito.data import DataCollection
    from ovito.pipeline import Pipeline, StaticSource
    from ovito.vis import TachyonRenderer, Viewport

    with np.load(sys.argv[1]) as given:
        view = {name: given[name] for name in given.files}
    data = DataCollection()
    particles = data.create_particles(count=len(view["places"]))
    particles.create_property("Position", data=view["places"])
    particles.create_property("Radius", data=view["radii"])
    particles.create_property("Color", data=view["colors"] / 255)
    Pipeline(source=StaticSource(data=data)).add_to_scene()
    viewport = Viewport(
        type=Viewport.Type.Perspective,
        fov=float(view["fov"]),
        camera_pos=tuple(view["eye"]),
        camera_dir=tuple(view["forward"]),
        camera_up=tuple(view["up"]),
    )
    start = time.perf_counter()
    size = tuple(int(side) for side in view["size"])
    viewport.render_image(size=size, filename=sys.argv[2], renderer=TachyonRenderer())
    print(f"{time.perf_counter() - start:.2f}")


if __name__ == "__main__":
    main()
