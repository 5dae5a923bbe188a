"""What a picture knows of its pixels: light, depth, normals, ids, and other lights afterwards."""

import colorsys

import gallery
import numpy as np
from PIL import Image

import vtray as vt

GOLDEN = (np.sqrt(5) - 1) / 2


def sunflower(count):
    """Return a scene: a dome of spheres in the order of a sunflower's seeds."""
    k = np.arange(count) + 0.5
    height = 1 - k / count
    turn = 2 * np.pi * GOLDEN * k
    ring = np.sqrt(1 - height**2)
    positions = np.stack([ring * np.cos(turn), ring * np.sin(turn), 0.8 * height], axis=1)

    scene = vt.Scene()
    scene.add_spheres(positions, radius=2.1 / np.sqrt(count), color=k, cmap="YlOrRd_r")
    scene.add_plane((0, 0, 0), normal=(0, 0, 1), color="#b9c4b0")
    scene.add_sphere_light((-4, -2, 5), 1, intensity=0.8)
    scene.add_sphere_light((2, -5, 4), 1, intensity=0.3)
    scene.add_ambient(0.3)
    return scene


def depth_picture(image):
    """Return the depth of the spheres as grey, near is light."""
    depth = image.depth
    near, far = depth[image.ids[..., 0] == 0].min(), depth[image.ids[..., 0] == 0].max()
    grey = 255 * (1 - np.clip((depth - near) / (far - near), 0, 1)) ** 1.5
    return np.repeat(grey[..., None], 3, axis=2).astype(np.uint8)


def id_picture(image, count):
    """Return a picture with a colour of its own for each sphere."""
    hues = np.arange(count) * 13 % count / count
    palette = np.array([(*colorsys.hls_to_rgb(hue, 0.6, 0.7),) for hue in hues] + [(0.93,) * 3])
    number = np.where(image.ids[..., 0] == 0, image.ids[..., 1], count)
    return (255 * palette[number]).astype(np.uint8)


def draw(size, count=600):
    """Draw a dome of spheres four times, from one render and its layers."""
    width, height = size[0] // 2, size[1] // 2
    scene = sunflower(count)
    scene.camera = vt.Camera.fit(
        scene, direction=(0.3, 1, -0.9), fov_degrees=25, size=(width, height)
    )
    image = vt.render(scene, samples=16, keep_lights=True)
    night = image.relight([0.1, 1.0, 0.1])
    panels = [[image.pixels, depth_picture(image)], [id_picture(image, count), night.pixels]]
    return Image.fromarray(np.vstack([np.hstack(row) for row in panels]))


if __name__ == "__main__":
    gallery.run(draw, "layers.png", size=(680, 510), small={"count": 60})
