"""A ball of glass on a ring of golden beads: the light that it gathers, and what is seen in it."""

import gallery
import numpy as np

import vtray as vt


def draw(size, samples=80):
    """Draw a large ball of glass, and what is around it."""
    scene = vt.Scene()
    tiles = vt.Checker(((226, 216, 198), (150, 164, 170)), size=0.9, rotation=31)
    scene.add_plane((0, 0, 0), normal=(0, 0, 1), material=vt.Lambert(pattern=tiles))
    scene.add_plane((0, 6, 0), normal=(0, -1, 0), color="#54707e")
    scene.add_sphere((0, 0, 1.32), 1.2, material=vt.Glass(1.5))
    angle = np.linspace(0, 2 * np.pi, 24, endpoint=False)
    ring = np.stack([np.cos(angle), np.sin(angle), 0.15 + 0 * angle], axis=1) * (0.68, 0.68, 0.6)
    scene.add_spheres(ring, 0.09, material=vt.Metal("gold", roughness=0.15))
    scene.add_sphere((-2.5, 1.9, 0.7), 0.7, color="#d2572f", material=vt.Plastic())
    scene.add_sphere((2.3, 1.5, 0.5), 0.5, material=vt.Metal("copper", roughness=0.25))
    scene.add_sphere((1.75, -0.7, 0.3), 0.3, material=vt.Glass(1.5, absorption=(0.3, 2.2, 4.5)))
    scene.add_sphere((-1.9, 0.0, 0.27), 0.27, material=vt.Glass(1.5, absorption=(4.5, 1.6, 0.4)))
    scene.add_sphere_light((5, 4.5, 8), 0.6, radiance=420, color="#ffdcae")
    scene.add_light(
        vt.Sky(0.25, gradient=vt.Gradient((110, 150, 230), (235, 225, 215), (90, 90, 90)))
    )
    scene.camera = vt.Camera.look_at(
        (-0.15, -9, 4.9), target=(-0.15, -0.1, 0.75), up=(0, 0, 1), fov_degrees=25, size=size
    )
    return vt.render(
        scene,
        integrator="path",
        samples=samples,
        exposure="auto",
        stops=0.6,
        tonemap="agx",
        denoise=True,
    )


if __name__ == "__main__":
    gallery.run(draw, "glass_ball.jpg", size=(900, 600), small={"samples": 2})
