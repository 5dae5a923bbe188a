"""OVITO, from arrays in memory to a PNG: see arrays_clock.py for the arguments.

    python arrays_ovito.py tachyon|ospray THREADS ARRAYS OUTPUT SIDE PICTURES

Its light comes from a place of its own.
"""

import math
import os
import sys
from collections.abc import Callable
from pathlib import Path

import numpy as np

sys.path.append(str(Path(__file__).resolve().parents[2]))  # for `peers`
from peers.arrays_clock import EYE, FIELD_OF_VIEW_DEGREES, Task, hold_to_cores, time_pictures

UPRIGHT = np.array([1, -1, -1])
"""Turns our axes, y down and z forward, into OVITO's, y up and z backward."""


def prepare(threads: int) -> Callable[[Task], None]:
    """Import OVITO; return what makes a picture with the renderer of the first argument."""
    # Its renderers take all cores that they find, whatever they are told.
    hold_to_cores(threads)
    os.environ["OVITO_THREAD_COUNT"] = str(threads)
    from ovito.data import DataCollection
    from ovito.pipeline import Pipeline, StaticSource
    from ovito.vis import OSPRayRenderer, TachyonRenderer, Viewport

    def draw(task: Task) -> None:
        """Make the picture."""
        data = DataCollection()
        particles = data.create_particles(count=len(task.arrays.center))
        particles.create_property("Position", data=task.arrays.center * UPRIGHT)
        particles.create_property("Color", data=task.arrays.color / np.float32(255))
        particles.vis.radius = task.arrays.radius
        pipeline = Pipeline(source=StaticSource(data=data))
        pipeline.add_to_scene()
        view = Viewport(
            type=Viewport.Type.Perspective,
            fov=math.radians(FIELD_OF_VIEW_DEGREES),
            camera_pos=tuple(EYE * UPRIGHT),
            camera_dir=(0, 0, -1),
        )
        if RENDERER == "tachyon":
            renderer = TachyonRenderer(antialiasing=False, ambient_occlusion=False, shadows=True)
        else:
            renderer = OSPRayRenderer(
                samples_per_pixel=1,
                refinement_iterations=1,
                max_ray_recursion=1,
                denoising_enabled=False,
                ambient_light_enabled=False,
            )
        view.render_image(
            size=(task.side, task.side),
            filename=task.output,
            background=(0, 0, 0),
            renderer=renderer,
        )
        pipeline.remove_from_scene()

    return draw


if __name__ == "__main__":
    RENDERER = sys.argv.pop(1)
    time_pictures(prepare)
