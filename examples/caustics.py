"""Marbles on paper: light that glass gathers, traced as it goes."""

import gallery
import numpy as np

import vtray as vt

GLASS = {
    "clear": (0.02, 0.01, 0.015),
    "green": (1.3, 0.12, 0.75),
    "amber": (0.06, 0.5, 2.2),
    "blue": (1.6, 0.7, 0.08),
    "rose": (0.08, 0.95, 0.5),
}
"""How much of red, green and blue light is absorbed in glass of each colour."""


def draw(size, samples=96):
    """Draw nine marbles in the evening sun."""
    scene = vt.Scene()
    scene.add_plane((0, 0, 0), normal=(0, 0, 1), color="#efe9df")
    marbles = [
        ((-2.1, 1.0), 0.8, "green"),
        ((-0.5, 1.7), 0.6, "amber"),
        ((1.2, 1.2), 0.9, "clear"),
        ((2.9, 1.5), 0.55, "rose"),
        ((-1.3, -0.6), 0.5, "blue"),
        ((0.3, -0.3), 0.65, "rose"),
        ((1.9, -0.7), 0.6, "amber"),
        ((-0.4, -1.7), 0.4, "clear"),
        ((3.3, -0.1), 0.45, "green"),
    ]
    for (x, y), radius, name in marbles:
        glass = vt.Glass(1.52, absorption=np.divide(GLASS[name], radius).tolist())
        scene.add_sphere((x, y, radius), radius, material=glass)
    scene.add_sphere_light((9, 7, 8), 1.1, radiance=110, color="#ffe2b8")
    scene.add_light(
        vt.Sky(0.25, gradient=vt.Gradient((120, 160, 235), (235, 225, 215), (120, 110, 100)))
    )
    scene.camera = vt.Camera.look_at(
        eye=(-1.5, -10, 7), target=(0.2, 0.1, 0.2), up=(0, 0, 1), fov_degrees=25, size=size
    )
    return vt.render(
        scene,
        integrator="path",
        samples=samples,
        exposure="auto",
        tonemap="agx",
        stops=0.6,
        denoise=True,
    )


if __name__ == "__main__":
    gallery.run(draw, "caustics.jpg", size=(960, 600), small={"samples": 2})
