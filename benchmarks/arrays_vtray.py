"""vtray, from arrays in memory to a PNG: see arrays_clock.py for the arguments."""

from collections.abc import Callable

from arrays_clock import EYE, TO_LIGHT, Task, image_plane, time_pictures

FAR = 1e4


def prepare(_threads: int) -> Callable[[Task], None]:
    """Import vtray; return what makes a picture with it."""
    import vtray

    # Names of the package are loaded when they are first used.
    render = vtray.render

    def draw(task: Task) -> None:
        """Make the picture."""
        arrays, (_, pixel) = task.arrays, image_plane(task.side)
        x, y, z = EYE
        scene = vtray.Scene(
            camera=vtray.Camera(
                (x, y, z + 1), (0, 0, 1), 1, (task.side, task.side), (pixel, pixel)
            ),
            lights=[vtray.Light([FAR * part for part in TO_LIGHT], 1)],
            objects=[vtray.Spheres(arrays.center, arrays.radius, arrays.color, lambert=1)],
        )
        render(scene, threads=task.threads).save(task.output)

    return draw


if __name__ == "__main__":
    time_pictures(prepare)
