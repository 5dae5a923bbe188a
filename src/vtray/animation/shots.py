"""Cameras of scenes that have none, and what pictures are taken of from there."""

from collections.abc import Mapping
from dataclasses import dataclass
from functools import partial
from typing import Any

from vtray.animation.fading import Opacity
from vtray.animation.stage import Look, Shot
from vtray.animation.swept import fit_around, upright
from vtray.animation.turned_lights import turned_light
from vtray.base.errors import SceneError
from vtray.rendering.beside import MARGIN, Margin, fit_beside
from vtray.scene.camera import Camera
from vtray.scene.checks.scene_words import show
from vtray.scene.default_camera import check_is_scene
from vtray.scene.particles.view import USUAL
from vtray.scene.placing.bounds import middle_in
from vtray.scene.placing.directions import Vec
from vtray.scene.scene import Scene
from vtray.scene.vectors import Vector


class SceneShots:
    """Makes shots of scenes, of which those without a camera get that of the first."""

    def __init__(self, first: Scene, look: Look) -> None:
        _check_objects(first)
        self._fitted = first.camera
        self._middle: Vec | None = None
        if _is_none(first.camera):
            self._middle = middle_in(first, "Camera.fit")
            fit = partial(_usual_camera, first, look)
            self._fitted = fit_beside(fit, first.objects, look.annotate)

    def __call__(self, scene: Any, _: int, opacity: Opacity | None = None) -> Shot:  # noqa: ANN401
        """Return what a picture is taken of."""
        if not isinstance(scene, Scene):
            raise SceneError(f"expected a Scene, got {show(scene)}")
        _check_objects(scene)
        if not _is_none(scene.camera):
            return Shot(scene, scene.camera, opacity=opacity)
        return Shot(scene, self._fitted, opacity=opacity, middle=self._middle)


@dataclass(frozen=True)
class TurnedShots:
    """Makes shots of a scene that a camera goes around.

    Attributes
    ----------
    usual
        What is painted on each picture.
    camera, about, axis
        The first camera, and the point and the unit axis that it goes about.
    degrees, count
        How far it goes, and in how many pictures.
    turns_lights
        Whether the lights of the scene go with it.
    """

    usual: Shot
    camera: Camera
    about: Vector
    axis: Vec
    degrees: float
    count: int
    turns_lights: bool

    def __call__(self, scene: Scene, k: int, opacity: Opacity | None = None) -> Shot:
        """Return what a picture is taken of."""
        turn = self.degrees * k / self.count
        middle = (self.about.x, self.about.y, self.about.z)
        # Not all lights can be turned, which is no matter where they stay.
        lights = (
            [turned_light(light, turn, middle, self.axis) for light in scene.lights]
            if self.turns_lights
            else None
        )
        return self.usual._replace(
            scene=scene,
            camera=self.camera.orbit(turn, about=self.about),
            lights=lights,
            opacity=opacity,
            middle=middle,
        )


def camera_around(scene: Scene, look: Look) -> tuple[Camera, Vector]:
    """Return the camera of a scene, or one that shows it from all sides, and what it goes about."""
    check_is_scene(scene)
    if _is_none(scene.camera):
        return around_beside(scene, _usual_camera(scene, look), look.annotate)
    return upright(scene.camera), Vector(*middle_in(scene, "turntable"))


def around_beside(
    scene: Scene, start: Camera, annotate: Mapping[str, Any], zoom: float = 1.0
) -> tuple[Camera, Vector]:
    """Return what `fit_around` does, with room for what is painted beside what is shown."""
    _, about = fit_around(scene, start, zoom)
    fit = lambda margin: fit_around(scene, start, zoom, margin)[0]  # noqa: E731
    return fit_beside(fit, scene.objects, annotate), about


def _usual_camera(scene: Scene, look: Look, margin: Margin = MARGIN) -> Camera:
    """Return the camera of scenes that have none."""
    size = look.settings.get("size") or scene.render.size
    more: dict[str, Any] = {} if size is None else {"size": size}
    return Camera.fit(scene, view=USUAL, margin=margin, **more)


def _check_objects(scene: Scene) -> None:
    """Raise SceneError if the objects of a scene are none: they are looked at before it is."""
    Scene(objects=scene.objects)


def _is_none(value: object) -> bool:
    return value is None
