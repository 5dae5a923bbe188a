"""A rope of three strings of pearls, tied to a trefoil knot."""

import gallery
import numpy as np

import vtray as vt

RADIUS = 0.21
"""That of a pearl."""


def trefoil(t):
    """Return points of a trefoil knot, (n, 3)."""
    ring = 2 + np.cos(3 * t)
    return np.stack([ring * np.cos(2 * t), ring * np.sin(2 * t), np.sin(3 * t)], axis=1)


def frame(t):
    """Return two unit vectors square to the knot and to each other, (n, 3) each."""
    along = trefoil(t + 1e-4) - trefoil(t - 1e-4)
    along /= np.linalg.norm(along, axis=1)[:, None]
    # Away from the ring in whose surface the knot lies.
    out = trefoil(t) - 2 * np.stack([np.cos(2 * t), np.sin(2 * t), 0 * t], axis=1)
    out -= (out * along).sum(axis=1)[:, None] * along
    out /= np.linalg.norm(out, axis=1)[:, None]
    return out, np.cross(along, out)


def string_of_pearls(curve, diameter):
    """Return places on a closed curve, given as many points, about a diameter apart."""
    steps = np.linalg.norm(np.diff(curve, axis=0), axis=1)
    way = np.concatenate([[0], np.cumsum(steps)])
    places = np.linspace(0, way[-1], round(way[-1] / diameter), endpoint=False)
    return np.stack([np.interp(places, way, curve[:, axis]) for axis in range(3)], axis=1)


def draw(size):
    """Draw three strings of pearls that wind around a trefoil knot."""
    scene = vt.Scene()
    t = np.linspace(0, 2 * np.pi, 20_001)
    out, aside = frame(t)
    for string, color in enumerate(["#e8553a", "#f6ead2", "#2b7a9b"]):
        turn = (19 * t + 2 * np.pi * string / 3)[:, None]
        curve = trefoil(t) + 1.16 * RADIUS * (np.cos(turn) * out + np.sin(turn) * aside)
        scene.add_spheres(string_of_pearls(curve, 2 * RADIUS), RADIUS, color=color)
    scene.add_plane((0, 0, -1.5), normal=(0, 0, 1), color="#e6ecea")
    scene.camera = vt.Camera.fit(scene, direction=(-0.4, 2, -2.2), fov_degrees=30, size=size)
    scene.add_sphere_light((-5, -4, 9), 2.5, intensity=0.7)
    scene.add_ambient(0.6)
    return vt.render(scene, samples=16)


if __name__ == "__main__":
    gallery.run(draw, "knot.jpg", size=(1000, 750))
