"""Mitsuba 3, from arrays in memory to a PNG: see arrays_clock.py for the arguments.

Spheres are Mitsuba's `ellipsoids`, with a texture that takes the colour of each from an array. All
lengths are in radii, as `mitsuba_spheres.py` says why. One sample in the middle of each pixel, and
the image moved by half a pixel, as vtray's rays go through the corners.
"""

import sys
from collections.abc import Callable
from pathlib import Path

import numpy as np

sys.path.append(str(Path(__file__).resolve().parents[2]))  # for `peers`
from peers.arrays_clock import EYE, FIELD_OF_VIEW_DEGREES, TO_LIGHT, Task, time_pictures


def prepare(threads: int) -> Callable[[Task], None]:
    """Import Mitsuba; return what makes a picture with it."""
    import drjit as dr
    import mitsuba as mi

    mi.set_variant("llvm_ad_rgb")
    dr.set_thread_count(threads)

    class ColorOfEach(mi.Texture):
        """The colour of the ellipsoid that was hit."""

        colors = mi.Float(0)

        def eval(self, si: mi.SurfaceInteraction3f, active: mi.Bool = True) -> mi.Color3f:
            return dr.gather(mi.Color3f, self.colors, si.prim_index, active)

        def to_string(self) -> str:
            return "ColorOfEach"

    mi.register_texture("color_of_each", ColorOfEach)

    def draw(task: Task) -> None:
        """Make the picture."""
        arrays = task.arrays
        count = len(arrays.center)
        ColorOfEach.colors = mi.Float((arrays.color / np.float32(255)).ravel())
        center = (arrays.center / arrays.radius).astype(np.float32)
        eye = [part / arrays.radius for part in EYE]
        moved = -0.5 / task.side
        scene = mi.load_dict(
            {
                "type": "scene",
                "spheres": {
                    "type": "ellipsoids",
                    "centers": mi.TensorXf(center),
                    "scales": dr.ones(mi.TensorXf, (count, 3)),
                    "quaternions": mi.TensorXf(np.tile(np.float32([0, 0, 0, 1]), (count, 1))),
                    "extent": 1.0,
                    "bsdf": {"type": "diffuse", "reflectance": {"type": "color_of_each"}},
                },
                "light": {
                    "type": "directional",
                    "direction": [-part for part in TO_LIGHT],
                    "irradiance": {"type": "rgb", "value": np.pi},
                },
                "sensor": {
                    "type": "perspective",
                    "fov": FIELD_OF_VIEW_DEGREES,
                    "principal_point_offset_x": moved,
                    "principal_point_offset_y": moved,
                    "to_world": mi.ScalarTransform4f().look_at(
                        origin=eye, target=[eye[0], eye[1], eye[2] + 1], up=[0, -1, 0]
                    ),
                    "film": {
                        "type": "hdrfilm",
                        "width": task.side,
                        "height": task.side,
                        "rfilter": {"type": "box"},
                    },
                    "sampler": {"type": "stratified", "sample_count": 1, "jitter": False},
                },
                "integrator": {"type": "direct"},
            }
        )
        image = mi.Bitmap(mi.render(scene))
        image.convert(mi.Bitmap.PixelFormat.RGB, mi.Struct.Type.UInt8, False).write(task.output)

    return draw


if __name__ == "__main__":
    time_pictures(prepare)
