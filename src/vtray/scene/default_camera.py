"""From where scenes are seen whose camera was never set."""

import os
from collections.abc import Sequence
from copy import copy
from typing import TYPE_CHECKING, Any

from vtray.base.errors import SceneError
from vtray.base.exact_math import cosine, sine
from vtray.scene.camera import Camera
from vtray.scene.default_light import has_end
from vtray.scene.studio import HasCamera

if TYPE_CHECKING:
    from vtray.scene.placing.directions import Vec
    from vtray.scene.scene import Scene

AHEAD, BACK = (0.0, 0.0, -1.0), (0.0, 1.0, 0.0)
"""Where `Camera.fit` looks unless it is told, and where from the front, with the z axis up."""

ABOVE = 25.0
"""How far above a floor the viewer is, in degrees: the horizon is not in the picture."""


def with_camera(scene: "Scene", size: Sequence[int] | None) -> "Scene":
    """Return a scene, checked, with a camera: its own, or one that shows all that has an end.

    The camera shows the shape of the objects, as ``view="auto"`` of `Camera.fit` does, and
    particles that have a cell from where cells are seen. With a plane, the first is the floor, and
    the camera looks down on it a little.

    Parameters
    ----------
    scene
        The scene; it stays as it is.
    size
        Width and height of the picture in pixels, None for those of `Camera.fit`.

    Raises
    ------
    SceneError
        The scene is not valid, or has no camera, and nothing that has an end.
    """
    check_is_scene(scene)
    seen = scene
    if not _has_camera(scene):
        type(scene)(None, scene.lights, scene.objects, scene.render, scene.style)  # checks the rest
        if has_end(scene):
            asked: dict[str, Any] = {} if size is None else {"size": size}
            seen = copy(scene)
            seen.camera = Camera.fit(scene, **_view_of(scene), **asked)
    seen.check()
    return seen


def check_is_scene(given: object) -> None:
    """Raise SceneError if something is no scene."""
    from vtray.scene.checks.scene_words import show
    from vtray.scene.scene import Scene

    if not isinstance(given, Scene):
        remedy = "; vtray.load reads scene files" if isinstance(given, (str, os.PathLike)) else ""
        raise SceneError(f"scene: expected a vtray.Scene, got {show(given)}{remedy}")


def _has_camera(scene: HasCamera) -> bool:
    """Tell whether a scene has a camera."""
    return scene.camera is not None


def _view_of(scene: "Scene") -> dict[str, Any]:
    """Return where the camera looks, as arguments of `Camera.fit`."""
    from vtray.scene.particles.made_of import has_cell
    from vtray.scene.particles.view import USUAL
    from vtray.scene.placing.bounds import balls_of, middle_of, ups_of_planes

    floors = ups_of_planes(scene, middle_of(balls_of(scene, "Camera.fit")))
    if floors:
        return {"direction": _down_to(floors[0])}
    return {"view": USUAL if has_cell(scene.objects) else "auto"}


def _down_to(up: "Vec") -> "Vec":
    """Return a direction that leads down a little: ahead, or to the back where that is up."""
    from vtray.scene.placing.directions import along, are_parallel, view_axes

    ahead = BACK if are_parallel(up, AHEAD) else AHEAD
    _, toward = view_axes(up, ahead)
    return along(along((0.0, 0.0, 0.0), -cosine(ABOVE), toward), -sine(ABOVE), up)
