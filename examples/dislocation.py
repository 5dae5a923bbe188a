"""A screw dislocation in a simple cubic crystal, in parallel projection.

Around the line, a walk of one turn climbs by one layer: the layers are a single spiral staircase.
The displacement of elasticity theory along the line is b θ / 2π.
"""

import gallery
import numpy as np

import vtray as vt


def draw(size, side=30, layers=9):
    """Draw a crystal with a screw dislocation, coloured by how far atoms have moved."""
    grid = np.arange(side) - (side - 1) / 2
    x, y, layer = np.meshgrid(grid, grid, np.arange(layers), indexing="ij")
    # The cut is on the side of the viewer, where the step shows.
    moved = np.arctan2(x, y) / (2 * np.pi)
    positions = np.stack([x, y, layer + moved], axis=-1).reshape(-1, 3)

    scene = vt.Scene()
    scene.add_spheres(positions, radius=0.5, color=moved.ravel(), cmap="coolwarm")
    scene.camera = vt.Camera.fit(
        scene,
        direction=(-0.5, 1, -0.75),
        up=(0, 0, 1),
        projection="orthographic",
        size=size,
    )
    scene.lights = vt.lights.studio(scene)
    return vt.render(scene, samples=16, background="white")


if __name__ == "__main__":
    gallery.run(draw, "dislocation.jpg", size=(960, 640), small={"side": 12, "layers": 4})
