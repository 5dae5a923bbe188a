"""Caffeine in plastic, as a photographer of small things would take it: with a wide lens."""

from pathlib import Path

import gallery
import numpy as np

import vtray as vt

MOLECULE = vt.read(Path(__file__).resolve().parents[1] / "scenes" / "caffeine.xyz")
LOOKS = {  # radius in ångströms, colour
    "H": (0.36, (244, 244, 240)),
    "C": (0.52, (62, 68, 78)),
    "N": (0.52, (46, 110, 214)),
    "O": (0.5, (222, 52, 38)),
}


def turn(azimuth, tilt, spin):
    """Return the matrix that turns by three angles in degrees, about z, x and y."""
    (a, b, c), (sa, sb, sc) = (f(np.radians((azimuth, tilt, spin))) for f in (np.cos, np.sin))
    about_z = np.array([(a, -sa, 0), (sa, a, 0), (0, 0, 1)])
    about_x = np.array([(1, 0, 0), (0, b, -sb), (0, sb, b)])
    return about_z @ about_x @ np.array([(c, 0, sc), (0, 1, 0), (-sc, 0, c)])


def add_molecule(scene, place, angles):
    """Add a molecule of balls and sticks."""
    atoms = MOLECULE.positions @ turn(*angles).T + place
    radius, color = zip(*(LOOKS[name] for name in MOLECULE["element"]), strict=True)
    radius, color, plastic = np.array(radius), np.array(color), vt.Plastic(roughness=0.1)
    scene.add_spheres(atoms, radius, color=color, material=plastic)
    one, other = np.triu_indices(len(atoms), 1)
    # These radii are so that bound atoms are nearer than one and a half times their sum.
    bound = np.linalg.norm(atoms[one] - atoms[other], axis=1) < 1.5 * (radius[one] + radius[other])
    one, other = one[bound], other[bound]
    scene.add_cylinders(
        atoms[one],
        atoms[other],
        0.17,
        color=color[one],
        color_end=color[other],
        material=plastic,
    )


def draw(size, samples=48):
    """Draw one molecule that is sharp, and others that are not."""
    scene = vt.Scene()
    add_molecule(scene, (0, 0, 0), (12, 62, 20))
    generator = np.random.default_rng(8)
    places = """-8 13 3.5, 7.5 10 4, 9.5 21 -4, -3 24 -5, -14 20 -4.5, 0 30 6, 16 30 3, -20 34 4,
        5 40 -8, -9 38 11, -6.2 -10 -4.2, 24 42 -6"""
    for place in places.split(","):
        add_molecule(scene, np.array(place.split(), float), generator.uniform(0, 360, 3))
    scene.add_light(vt.Sky(0.6, gradient=vt.Gradient((74, 116, 148), (20, 58, 84), (10, 22, 36))))
    for middle, edges, radiance, color in [
        ((-10, -12, 14), ((9, 9, 0), (5, -5, 8)), 7, (255, 226, 190)),
        ((14, 6, 6), ((0, 8, 0), (3, 0, 8)), 5, (170, 210, 255)),
    ]:
        scene.add_light(vt.RectangleLight(middle, edges, radiance=radiance, color=color))
    scene.camera = vt.Camera.look_at(
        (0, -24, 2),
        target=(0, 0, 0),
        up=(0, 0, 1),
        fov_degrees=22,
        size=size,
        lens=vt.Lens(radius=0.9, focus_on=(0, -0.6, 0)),
    )
    return vt.render(
        scene,
        integrator="path",
        samples=samples,
        exposure="auto",
        stops=0.8,
        tonemap="agx",
        background="sky",
        denoise=True,
    )


if __name__ == "__main__":
    gallery.run(draw, "caffeine.jpg", size=(900, 600), small={"samples": 2})
