"""The end of the Evergreen Game, Anderssen against Dufresne, Berlin 1852: mate by two bishops."""

import gallery
import numpy as np

import vtray as vt

POSITION = "1r3kr1/pbpBBp1p/1b3P2/8/8/2P2q2/P4PPP/3R2K1"
"""From the eighth rank to the first: White's men are capitals, numbers are empty squares."""
HEIGHT = {"p": 0.62, "r": 0.72, "b": 0.95, "q": 1.15, "k": 1.25}
"""How high the body of each man is, in squares."""
HEADS = {
    "p": [(0, 0, 0.1, 0.18)],
    "b": [(0, 0, 0.12, 0.19), (0, 0, 0.33, 0.06)],
    "q": [(0, 0, 0.27, 0.1)]
    + [(0.22 * np.cos(a), 0.22 * np.sin(a), 0.24, 0.055) for a in np.arange(9) * np.pi / 4.5],
}
"""The balls on top of them: the places of their middles, and their radii."""


def add_man(scene, man, square):
    """Add a man, turned on a lathe: cones from one height to another, with a radius at each."""
    kind, top = man.lower(), HEIGHT[man.lower()]
    slim, head = (
        (0.22, (top, top + 0.2, 0.29, 0.29))
        if kind == "r"
        else (0.12, (top - 0.1, top - 0.05, 0.24, 0.24))
    )
    cones = [(0, 0.09, 0.37, 0.37), (0.09, 0.16, 0.37, 0.28), (0.16, top, 0.27, slim), head]
    if kind in "qk":
        cones.append((top - 0.05, top + 0.22, 0.14, 0.25))
    if kind == "k":
        cones += [(top + 0.22, top + 0.28, 0.25, 0.1), (top + 0.2, top + 0.55, 0.05, 0.05)]
    low, high, radius, other = np.array(cones)[..., None].transpose(1, 0, 2)
    wood = (240, 226, 200) if man.isupper() else (58, 30, 22)
    looks = {"color": wood, "material": vt.Plastic(roughness=0.12)}
    up = np.array((0, 0, 1))
    scene.add_cones(square + low * up, square + high * up, radius[:, 0], other[:, 0], **looks)
    if kind == "k":
        ends = [np.add(square, (x, 0, top + 0.42)) for x in (-0.14, 0.14)]
        scene.add_cylinder(*ends, 0.05, **looks)
    for x, y, z, size in HEADS.get(kind, ()):
        scene.add_sphere(np.add(square, (x, y, top + z)), size, **looks)


def draw(size, samples=56):
    """Draw the board, with the lens on the king that is mated."""
    scene = vt.Scene()
    # A picture of a table, 32 squares wide, with a board and its golden edge in the middle.
    table = np.full((1280, 1280, 3), (46, 58, 60), np.uint8)
    table[468:812, 468:812] = (196, 150, 70)
    woods = np.array([(222, 196, 152), (104, 60, 38)], np.uint8)[np.indices((8, 8)).sum(axis=0) % 2]
    table[480:800, 480:800] = woods.repeat(40, axis=0).repeat(40, axis=1)
    board = vt.ImagePattern(table, size=32, up=(0, 1, 0))
    scene.add_plane((-12, 20, 0), (0, 0, 1), material=vt.Plastic(roughness=0.15, pattern=board))
    for y, rank in enumerate(reversed(POSITION.split("/"))):
        for x, man in enumerate("".join(" " * int(c) if c.isdigit() else c for c in rank)):
            if man != " ":
                add_man(scene, man, np.array((x + 0.5, y + 0.5, 0)))
    scene.add_sphere_light((-5, 3, 10), 1.6, radiance=44, color="#ffd9a8")
    scene.add_light(
        vt.Sky(0.3, gradient=vt.Gradient((120, 150, 210), (210, 205, 200), (60, 60, 60)))
    )
    scene.camera = vt.Camera.look_at(
        (9.6, -1.6, 4.6),
        target=(4.6, 5.4, 0.35),
        up=(0, 0, 1),
        fov_degrees=30,
        size=size,
        lens=vt.Lens(radius=0.12, focus_on=(5.5, 7.5, 1)),
    )
    return vt.render(
        scene,
        integrator="path",
        samples=samples,
        exposure="auto",
        stops=0.8,
        tonemap="agx",
        denoise=True,
    )


if __name__ == "__main__":
    gallery.run(draw, "chess.jpg", size=(900, 600), small={"samples": 2})
