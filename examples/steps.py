"""One room by five ways of working out its light, in the order in which one would learn them."""

import gallery
import numpy as np
import room
from PIL import Image

import vtray as vt


def draw(size, samples=40, fontsize=34):
    """Draw the room five times, side by side."""
    scene = room.furnished()
    panel, sky = scene.lights
    middle = panel.location
    point = vt.Light((middle.x, middle.y + 0.05, middle.z), 0.8, color=panel.color)
    ambient = vt.Ambient(0.1, distance=1.5)
    steps = [
        ("a point", "direct", [point]),
        ("a lamp", "direct", [panel]),
        ("ambient light", "direct", [panel, ambient]),
        ("mirrors, glass", "whitted", [panel, ambient]),
        ("all light", "path", [panel, sky]),
    ]
    strip, warnings = [], []
    for title, integrator, scene.lights in steps:
        image = vt.render(
            scene,
            size=(round(2 * size[0] / len(steps)), 2 * size[1]),
            integrator=integrator,
            samples=samples if integrator == "path" else 16,
            exposure=1,
            tonemap="agx",
            denoise=integrator == "path",
            warn=warnings.append,  # that "direct" shows all as matt
        )
        strip.append(image.annotated(title=title, fontsize=fontsize).pixels)
    # Twice as large as shown: so the edges of the lamp, far brighter than white, are smooth, too.
    return Image.fromarray(np.hstack(strip)).reduce(2)


if __name__ == "__main__":
    gallery.run(draw, "steps.jpg", size=(1500, 225), small={"fontsize": 6, "samples": 2})
