"""Balls that touch, and smaller ones in all the gaps: the packing of Apollonius and Soddy."""

import gallery
import numpy as np

import vtray as vt


def packing(smallest):
    """Return the centres and radii of all balls of a packing in a ball of radius 1.

    A row is the curvature of a ball, 1 over its radius, and its centre times that. Five balls
    that all touch have a twin of each: the sum of the four others, less the ball itself.
    """
    bend = 1 + np.sqrt(1.5)
    corners = np.array([(1, 1, 1), (1, -1, -1), (-1, 1, -1), (-1, -1, 1)]) / np.sqrt(3)
    first = np.vstack([[-1, 0, 0, 0], np.column_stack([np.full(4, bend), corners * (bend - 1)])])
    found = {tuple(np.round(ball, 6)) for ball in first}
    rows, tasks = list(first[1:]), [first]
    while tasks:
        five = tasks.pop()
        for k in range(5):
            twin = five.sum(axis=0) - 2 * five[k]
            key = tuple(np.round(twin, 6))
            if twin[0] * smallest < 1 and key not in found:
                found.add(key)
                rows.append(twin)
                tasks.append(np.vstack([np.delete(five, k, axis=0), twin]))
    rows = np.array(rows)
    return rows[:, 1:] / rows[:, :1], 1 / rows[:, 0]


LOOKS = [  # of balls of less than these radii: colour, material
    (0.03, "white", vt.Metal("gold", roughness=0.25)),
    (0.06, "#ece4d4", vt.Plastic(roughness=0.1)),
    (0.1, "white", vt.Metal("copper", roughness=0.3)),
    (0.2, "#1c4e7a", vt.Plastic(roughness=0.1)),
    (1.0, "white", vt.Metal("copper", roughness=0.2)),
]


def draw(size, samples=40, smallest=0.012):
    """Draw a packing of balls of copper, gold and plastic."""
    scene = vt.Scene()
    places, radius = packing(smallest)
    places[:, 2] += 1
    limits, colors, materials = zip(*LOOKS, strict=True)
    kind = np.digitize(radius, limits)
    scene.add_spheres(
        places,
        radius,
        color=np.array(colors)[kind],
        material=materials,
        material_index=kind,
    )
    floor = vt.Plastic(roughness=0.3)
    scene.add_plane((0, 0, 0), normal=(0, 0, 1), color="#38414c", material=floor)
    scene.add_light(
        vt.Sky(0.5, gradient=vt.Gradient((140, 170, 220), (240, 226, 205), (90, 85, 80)))
    )
    scene.add_sphere_light((-4, -4, 6), 1.2, radiance=16, color="#ffe0b8")
    scene.camera = vt.Camera.look_at(
        (0, -9, 2.6), target=(0, 0, 0.92), up=(0, 0, 1), fov_degrees=16, size=size
    )
    return vt.render(
        scene,
        integrator="path",
        samples=samples,
        exposure="auto",
        stops=0.5,
        tonemap="agx",
        denoise=True,
    )


if __name__ == "__main__":
    gallery.run(draw, "sphere_packing.jpg", size=(800, 720), small={"samples": 2})
