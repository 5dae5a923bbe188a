"""Ready-made lights, as photographers set them up.

Each function looks at a scene's camera and at the sphere around its spheres, the subject, and
returns a list of lights for ``scene.lights``. Angles are seen from the subject: 0 degrees is the
direction to the camera, along its axis; what is up and to the right is so in the picture. So the
subject is lit in the same way from wherever the picture is taken, if the function is called again
when the camera has moved. Key is the light that makes the shadows, fill the one that brightens
them; there is no fall-off with distance, so that the ratio of their intensities is that of the
light they throw.

`studio` is what a scene gets whose lights were never set; `none` leaves it dark.

`cloudy` and `lightbox` are the light of a place, and go by what is up in the world: `up`, if it is
given. Else it is the normal of the scene's first plane, on the side of the spheres, as for
`Camera.fit`, unless the camera's `up` is the normal of another one. Without planes it is the
camera's `up`, or where it has none, up in the picture.

>>> scene.lights = vtray.lights.rembrandt(scene)
"""

from vtray.scene.light_presets import (
    butterfly,
    cloudy,
    lightbox,
    loop,
    none,
    rembrandt,
    ring,
    split,
    studio,
)

__all__ = [
    "butterfly",
    "cloudy",
    "lightbox",
    "loop",
    "none",
    "rembrandt",
    "ring",
    "split",
    "studio",
]
