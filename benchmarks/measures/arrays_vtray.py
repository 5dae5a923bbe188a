"""vtray, from arrays in memory to a PNG: see arrays_clock.py for the arguments."""

import sys
from collections.abc import Callable
from pathlib import Path

sys.path.append(str(Path(__file__).resolve().parents[1]))  # for `peers`
from peers.arrays_clock import EYE, FIELD_OF_VIEW_DEGREES, TO_LIGHT, Task, time_pictures

FAR = 1e4


def prepare(_threads: int) -> Callable[[Task], None]:
    """Import vtray; return what makes a picture with it."""
    import vtray as vt

    # Names of the package are loaded when they are first used.
    render = vt.render

    def draw(task: Task) -> None:
        """Make the picture."""
        scene = vt.Scene()
        scene.add_spheres(task.arrays.center, task.arrays.radius, color=task.arrays.color)
        scene.add_light([FAR * part for part in TO_LIGHT])
        scene.camera = vt.Camera.look_at(
            EYE,
            target=(0, 0, 0),
            up=(0, -1, 0),
            fov_degrees=FIELD_OF_VIEW_DEGREES,
            size=(task.side, task.side),
        )
        render(scene, threads=task.threads).save(task.output)

    return draw


if __name__ == "__main__":
    time_pictures(prepare)
