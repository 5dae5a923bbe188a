"""A million spheres in the closest packing, cut to a gyroid and coloured by height."""

import gallery
import numpy as np

import vtray as vt


def closest_packing(count):
    """Return the centres of about `count` spheres of radius 1/2 that fill a cube around 0."""
    side = round((count / 4) ** (1 / 3))  # in cells of four spheres
    cells = np.stack(np.meshgrid(*3 * [np.arange(side)], indexing="ij"), axis=-1).reshape(-1, 1, 3)
    corner_and_faces = np.array([(0, 0, 0), (0, 0.5, 0.5), (0.5, 0, 0.5), (0.5, 0.5, 0)])
    centers = (cells + corner_and_faces).reshape(-1, 3)
    return np.sqrt(2) * (centers - centers.mean(axis=0))


def gyroid(positions, period):
    """Return how far inside of a gyroid's labyrinth points are."""
    sine, cosine = np.sin(positions * 2 * np.pi / period), np.cos(positions * 2 * np.pi / period)
    return (sine * np.roll(cosine, -1, axis=1)).sum(axis=1)


def draw(size, count=2_050_000):
    """Draw the half of a packing that lies inside of a gyroid."""
    positions = closest_packing(count)
    width = np.ptp(positions[:, 0])
    positions = positions[gyroid(positions, width / 1.5) > 0]

    scene = vt.Scene()
    scene.add_spheres(positions, radius=0.5, color=positions[:, 2], cmap="viridis")
    scene.add_plane((0, 0, -width / 2 - 0.5), normal=(0, 0, 1), color="#f4f1ea")
    scene.camera = vt.Camera.fit(scene, direction=(-3, 4, -2.4), size=size)
    scene.add_sphere_light((1.7 * width, -1.4 * width, 2.3 * width), 0.4 * width, intensity=0.6)
    scene.add_ambient(0.6)
    return vt.render(scene, samples=9)


if __name__ == "__main__":
    gallery.run(draw, "packing.jpg", size=(880, 660), small={"count": 5000})
