"""The room of `scenes/room.json` with balls of gold and glass, by all the light in it."""

from pathlib import Path

import gallery

import vtray as vt

ROOM = Path(__file__).resolve().parents[1] / "scenes" / "room.json"
FLOOR = 1.52
"""Where the floor is: y points down in this scene."""


def furnished():
    """Return the room with other balls in it, and with its lamp as bright as a real one."""
    scene = vt.load(ROOM)
    scene.objects = [thing for thing in scene.objects if isinstance(thing, vt.Plane)]
    for x, z, radius, color, material in [
        (-0.92, 2.95, 0.8, "white", vt.Metal("gold", roughness=0.1)),
        (0.72, 2.25, 0.62, "white", vt.Glass(1.5)),
        (-0.28, 1.75, 0.3, "white", vt.Glass(1.5, absorption=(2.6, 0.9, 0.25))),
        (1.45, 1.55, 0.24, "white", vt.Metal("copper", roughness=0.3)),
        (1.4, 3.5, 0.5, "#f4efe6", vt.Plastic()),
        (-1.3, 1.6, 0.2, "#c8324a", vt.Plastic()),
    ]:
        scene.add_sphere((x, FLOOR - radius, z), radius, color=color, material=material)
    for x, y, z, radius in [
        (-0.45, -0.5, 2.4, 0.17),
        (0.2, -0.85, 2.8, 0.22),
        (0.85, -0.3, 2.2, 0.12),
    ]:
        scene.add_sphere((x, y, z), radius, material=vt.Glass(1.33, thin=True))  # a bubble
    panel = scene.lights[0].replace(intensity=None, radiance=9, color=(255, 226, 184))
    evening = vt.Sky(0.25, color=(150, 180, 235))  # through the open front, where the viewer is
    scene.lights = [panel, evening]
    return scene


def draw(size, samples=48):
    """Draw the room with other balls in it."""
    return vt.render(
        furnished(),
        size=size,
        integrator="path",
        samples=samples,
        exposure=1.3,
        tonemap="agx",
        denoise=True,
    )


if __name__ == "__main__":
    gallery.run(draw, "room.jpg", size=(900, 675), small={"samples": 2})
