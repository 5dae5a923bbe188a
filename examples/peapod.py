"""Buckyballs in a carbon nanotube, drawn to scale: a "peapod", its wall opened to look inside."""

import itertools

import gallery
import numpy as np

import vtray as vt

BOND = 1.42
"""The distance between neighbouring atoms, in ångströms."""
ATOM = 0.68
"""The radius that atoms are drawn with: neighbours nearly touch."""


def buckyball():
    """Return the 60 corners of a truncated icosahedron with edges of one bond, (60, 3)."""
    golden = (1 + np.sqrt(5)) / 2
    corners = []
    for corner in [(0, 1, 3 * golden), (1, 2 + golden, 2 * golden), (golden, 2, 2 * golden + 1)]:
        for signs in itertools.product((-1, 1), repeat=3):
            signed = np.multiply(corner, signs)
            corners += [np.roll(signed, shift) for shift in range(3)]
    return np.unique(np.round(corners, 9), axis=0) * BOND / 2


def nanotube(n, length):
    """Return the atoms of an armchair nanotube (n, n) along x, about 0, (m, 3)."""
    radius = 3 * n * BOND / (2 * np.pi)
    step = np.sqrt(3) * BOND / 2
    rings = np.arange(-round(length / 2 / step), round(length / 2 / step) + 1)
    # Around a ring, bonds and gaps take turns: atoms at 0, 1, 3, 4, 6, 7, ... thirds of a cell.
    around = np.sort(np.concatenate([3 * np.arange(n), 3 * np.arange(n) + 1]))
    ring, place = np.meshgrid(rings, around, indexing="ij")
    angle = (place + 1.5 * (ring % 2)) * 2 * np.pi / (3 * n)
    return np.stack([ring * step, radius * np.cos(angle), radius * np.sin(angle)], -1).reshape(
        -1, 3
    )


def turned(points, generator):
    """Return points turned about 0 at random."""
    turn, _ = np.linalg.qr(generator.normal(size=(3, 3)))
    return points @ turn


def draw(size):
    """Draw seven buckyballs, 9.7 ångströms apart, in a (10, 10) nanotube."""
    scene = vt.Scene()
    generator = np.random.default_rng(3)
    for k in range(-3, 4):
        place = (9.7 * k, 0, 0)
        scene.add_spheres(turned(buckyball(), generator) + place, ATOM, color="#f08a24")
    tube = nanotube(10, 74)
    x, y, z = tube.T
    # A window in the wall: the rim of an ellipse, in degrees from where the viewer is.
    angle = np.degrees(np.arctan2(z, -y)) - 32
    tube = tube[(x / 27) ** 2 + (angle / 78) ** 2 > 1]
    scene.add_spheres(tube, ATOM, color="#9aa6b2")
    scene.add_plane((0, 0, -9.5), normal=(0, 0, 1), color="#d3e0e8")
    scene.camera = vt.Camera.look_at(
        eye=(-30, -84, 46), target=(-1, 0, -1), up=(0, 0, 1), fov_degrees=20, size=size
    )
    scene.add_ambient(0.5)
    scene.add_sphere_light((-70, -60, 110), 20, intensity=0.5)
    scene.add_sphere_light((-20, -95, 40), 12, intensity=0.5)
    return vt.render(scene, samples=16)


if __name__ == "__main__":
    gallery.run(draw, "peapod.jpg", size=(1000, 600))
