"""A cluster grown by random walks, under a portrait painter's light."""

import gallery
import numba
import numpy as np

import vtray as vt

CELL = 2.0
"""Side of the cells in which neighbours are looked for; spheres have a diameter of 1."""


@numba.njit(cache=True)
def grow(count, seed):
    """Let spheres wander in until they touch the cluster: diffusion-limited aggregation.

    Returns
    -------
    array (count, 3)
        The centres in the order in which they came to rest; the first is at the origin.
    """
    np.random.seed(seed)
    half = 120
    first = np.full((2 * half, 2 * half, 2 * half), -1)
    following = np.full(count, -1)
    centers = np.zeros((count, 3))
    first[half, half, half] = 0
    reach = 0.0
    k = 1
    while k < count:
        start = np.random.normal(0, 1, 3)
        place = start / np.sqrt((start**2).sum()) * (reach + 3)
        while True:
            distance = np.sqrt((place**2).sum())
            if distance > 2 * reach + 20:
                break
            # The nearest sphere of the 27 cells around, or a cell's width if there is none.
            nearest, found = CELL + 1.0, -1
            x, y, z = (place / CELL + half).astype(np.int64)
            if distance < reach + 2:
                for i in range(x - 1, x + 2):
                    for j in range(y - 1, y + 2):
                        for m in range(z - 1, z + 2):
                            other = first[i, j, m]
                            while other >= 0:
                                apart = np.sqrt(((centers[other] - place) ** 2).sum())
                                if apart < nearest:
                                    nearest, found = apart, other
                                other = following[other]
            if nearest < 1.05:
                way = place - centers[found]
                place = centers[found] + way / np.sqrt((way**2).sum())
                centers[k] = place
                x, y, z = (place / CELL + half).astype(np.int64)
                following[k], first[x, y, z] = first[x, y, z], k
                reach = max(reach, np.sqrt((place**2).sum()))
                k += 1
                break
            # No sphere is nearer than this, so a step of this length meets none.
            step = max(nearest - 1.0, 0.05, distance - reach - 2)
            way = np.random.normal(0, 1, 3)
            place = place + way / np.sqrt((way**2).sum()) * step
    return centers


def draw(size, count=60_000):
    """Draw a cluster, its youngest spheres the brightest."""
    positions = grow(count, seed=4)
    age = np.arange(count) / count

    scene = vt.Scene()
    scene.add_spheres(positions, radius=0.5, color=age, cmap="magma", clim=(-0.45, 1.05))
    scene.camera = vt.Camera.fit(scene, direction=(1, 2, -0.6), up=(0, 0, 1), size=size)
    scene.lights = vt.lights.rembrandt(scene, ratio=2.5)
    scene.add_ambient(0.6)
    return vt.render(scene, samples=9, exposure=0.9, background="#0d0b10")


if __name__ == "__main__":
    gallery.run(draw, "cluster.jpg", size=(680, 680), small={"count": 500})
