"""Embree: how it is given a scene, run and timed, by a small program of ours."""

import struct
from pathlib import Path

import numpy as np
from camera_space import Cloud, Surface, View
from numpy.typing import NDArray

MAGIC = b"VTS1"


def write_scene(view: View, path: Path) -> None:
    """Write a scene as `embree_spheres.cpp` reads it: numbers of 4 bytes, then colours of 3."""
    balls = [surface for surface in view.surfaces if not isinstance(surface.shape, tuple)]
    clouds = [_cloud(balls), *view.clouds] if balls else view.clouds
    planes = [_plane(surface) for surface in view.surfaces if isinstance(surface.shape, tuple)]
    lights = [(*place, power) for place, power in view.lights]
    counts = len(planes), len(lights), sum(len(cloud.spheres) for cloud in clouds)
    lambert = clouds[0].lambert if clouds else 1.0
    if any(cloud.lambert != lambert for cloud in clouds):
        raise ValueError("all spheres must have the same Lambert coefficient")
    sizes = view.pixel_width, view.pixel_height, lambert
    with path.open("wb") as file:
        file.write(
            struct.pack("<4s5i3f3i", MAGIC, view.width, view.height, *counts, *sizes, 0, 0, 0)
        )
        file.write(np.array(planes, "<f4").tobytes())
        file.write(np.array(lights, "<f4").tobytes())
        for cloud in clouds:
            cloud.spheres.tofile(file)
        for cloud in clouds:
            cloud.color.tofile(file)


def _plane(surface: Surface) -> list[float]:
    """Return the unit normal of a plane, its product with a point of it, and the colour."""
    normal = np.array(surface.shape)
    return [*normal, float(normal @ surface.center), *(255 * c for c in surface.color), 0.0]


def _cloud(balls: list[Surface]) -> Cloud:
    """Return spheres as arrays; their colours are rounded to 8 bits."""
    spheres = np.array([(*ball.center, ball.shape) for ball in balls], np.float32)
    color = np.array([ball.color for ball in balls])
    return Cloud(spheres, np.rint(255 * color).astype(np.uint8), 1.0)


def read_colors(cloud: Cloud) -> NDArray[np.float32]:
    """Return reflectances from 0 to 1."""
    return cloud.color * np.float32(cloud.lambert / 255)
