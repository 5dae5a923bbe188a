"""The butterfly of Lorenz over a lake: a million beads on 200 strings, under a morning sky."""

import gallery
import numpy as np

import vtray as vt


def speed(places):
    """Return how fast the air of Lorenz's model moves, (n, 3)."""
    x, y, z = places.T
    return np.stack([10 * (y - x), x * (28 - z) - y, x * y - 8 / 3 * z], axis=1)


def strings(count, beads, step=0.002):
    """Follow some starts by the method of Runge and Kutta; return all places, (n, 3)."""
    places = np.random.default_rng(3).normal((0, 0, 25), 8, (count, 3))
    found = []
    for k in range(2000 + beads):  # the first lead to the butterfly
        a = speed(places)
        b = speed(places + step / 2 * a)
        c = speed(places + step / 2 * b)
        places = places + step / 6 * (a + 2 * b + 2 * c + speed(places + step * c))
        if k >= 2000:
            found.append(places)
    return np.concatenate(found)


def draw(size, samples=40, beads=5000):
    """Draw the butterfly and its image in the water."""
    scene = vt.Scene()
    places = strings(200, beads)
    fast = np.linalg.norm(speed(places), axis=1)
    scene.add_spheres(
        places,
        0.06,
        color=fast,
        cmap="plasma",
        clim=(-30, 300),
        material=vt.Metal(roughness=0.35),
    )
    scene.add_plane((0, 0, -1.5), normal=(0, 0, 1), color="#0b2230", material="plastic")
    scene.add_light(
        vt.Sky(0.9, gradient=vt.Gradient((60, 120, 220), (255, 214, 190), (60, 60, 70)))
    )
    scene.add_sun((0.75, 0.5, -0.5), intensity=3.5, angle=3, color="#ffd2a0")
    scene.camera = vt.Camera.look_at(
        (38, -130, 7), target=(0, 0, 12), up=(0, 0, 1), fov_degrees=32, size=size
    )
    return vt.render(
        scene,
        integrator="path",
        samples=samples,
        exposure="auto",
        stops=0.4,
        tonemap="filmic",
        background="sky",
        denoise=True,
    )


if __name__ == "__main__":
    gallery.run(draw, "butterfly.jpg", size=(900, 720), small={"samples": 2, "beads": 100})
