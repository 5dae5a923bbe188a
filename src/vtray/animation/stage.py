"""Where scenes are put to be taken: one after the other, all in the same light."""

import copy
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from functools import partial
from pathlib import Path
from typing import Any, NamedTuple

import msgspec

from vtray.animation.annotating import annotated
from vtray.animation.fading import Opacity, faded
from vtray.image.finished import save_finished
from vtray.image.image import Image
from vtray.image.white import Exposed
from vtray.rendering.fog import Ball, ball_around, fitted
from vtray.rendering.hierarchy import are_same
from vtray.rendering.passes import depends_on_white
from vtray.rendering.renderer import render
from vtray.rendering.starlight import peak_of
from vtray.scene.camera import Camera
from vtray.scene.default_light import settings_of
from vtray.scene.light_types import AnyLight
from vtray.scene.objects import Object
from vtray.scene.placing.directions import Vec
from vtray.scene.scene import Scene
from vtray.scene.settings import overridden
from vtray.scene.stars import Stars
from vtray.scene.style import Fog, Style

Warn = Callable[[str], None]


class Shot(NamedTuple):
    """What a picture of a movie is taken of.

    Attributes
    ----------
    scene
        The scene, which is not changed.
    camera
        The camera of this picture.
    lights
        Its lights; None for those of the scene.
    frame, time
        Which frame of a simulation it is, and when that was, as far as that is known.
    marks
        What else is painted on it, as keywords of `vtray.Image.annotated`.
    opacity
        How opaque its objects are; None for as they are.
    style
        The parts of its style that are its own, by their names.
    middle
        That of what all pictures show, at whose distance a scale bar is right; None for that of
        what is seen in each.
    """

    scene: Scene
    camera: Camera
    lights: list[AnyLight] | None = None
    frame: int | None = None
    time: float | None = None
    marks: Mapping[str, Any] | None = None
    opacity: Opacity | None = None
    style: Mapping[str, Any] = {}
    middle: Vec | None = None

    @property
    def is_ahead(self) -> bool:
        """Whether the middle is known and in front of the camera."""
        if self.middle is None or self.camera.projection == "panorama":
            return False
        return bool(self.camera.project(self.middle)[2] > 0)


class Common(NamedTuple):
    """What all pictures of a movie take from the first.

    Attributes
    ----------
    peaks
        What is as bright as can be of points that shine, where that is not said.
    ball
        The ball around its scene, to which fog is fitted; None where nothing asks for it.
    """

    peaks: Sequence[float | None]
    ball: Ball | None


@dataclass(frozen=True)
class Look:
    """How each picture of a movie is taken.

    Attributes
    ----------
    settings
        Settings of the render that are given, by their names.
    annotate
        What is painted on pictures, as keywords of `vtray.Image.annotated`.
    bits, aov
        What files of pictures hold, as for `vtray.Image.save`.
    threads
        How many threads render; None for all cores.
    """

    settings: Mapping[str, Any] = field(default_factory=dict)
    annotate: Mapping[str, Any] = field(default_factory=dict)
    bits: int | None = None
    aov: tuple[str, ...] = ()
    threads: int | None = None

    def holds(self, scene: Scene) -> bool:
        """Tell whether pictures have the exposure of the first: unless it is said otherwise."""
        return "exposure" not in self.settings and isinstance(settings_of(scene).exposure, str)

    def painted(self, shot: Shot) -> dict[str, Any]:
        """Return what is painted on a picture, as keywords of `vtray.Image.annotated`."""
        marks = dict(shot.marks or {})
        if self.annotate.get("scalebar") and self.annotate.get("at") is None and shot.is_ahead:
            marks["at"] = shot.middle
        return annotated(self.annotate, shot.frame, shot.time, marks)

    def save(self, image: Image, keywords: Mapping[str, Any], path: Path) -> None:
        """Write a picture, and what is painted on it, to a file."""
        save_finished(image, path, keywords, self.bits, self.aov)


class Stage:
    """Where scenes are put to be taken.

    Parameters
    ----------
    look
        How pictures are taken.
    common
        What they take from the first; see `common_of`.

    Attributes
    ----------
    common
        As given.
    """

    def __init__(self, look: Look, common: Common) -> None:
        self.common = common
        self._look = look
        self._scene = Scene()
        self._given: list[Object] = []
        self._objects: list[Object] = []
        self._opacity: Opacity | None = None
        self._style: Mapping[str, Any] = {}

    def holds(self) -> bool:
        """Tell whether the picture of the scene that is set has the exposure of the first."""
        return self._look.holds(self._scene)

    def set(self, shot: Shot) -> Scene:
        """Return a scene with the camera, the lights and the opacities of a picture."""
        scene = copy.copy(shot.scene)
        if self._opacity != shot.opacity or not are_same(self._given, scene.objects):
            objects = self._with_peaks(scene)
            self._given, self._opacity = [*scene.objects], shot.opacity
            self._objects = objects if shot.opacity is None else faded(objects, shot.opacity)
        else:  # what is kept with a scene stays from one picture of its objects to the next
            vars(scene).update(vars(self._scene))
        scene.objects, self._scene = self._objects, scene
        self._style = shot.style
        self._scene.camera = shot.camera
        if shot.lights is not None:
            self._scene.lights = shot.lights
        return self._scene

    def take(
        self, shot: Shot, white: float | None, warn: Warn, threads: int | None = None
    ) -> tuple[Image, float | None]:
        """Return a picture, and the light that becomes white in all others, if it decides that.

        Where rays depend on that light, those of the picture that decides are cast once more, now
        that it is known, so that they are the same as in all others.

        Parameters
        ----------
        shot
            What it is taken of.
        white
            The light that becomes white in all pictures; None if that is not known yet.
        warn
            Called with a line about something that is noticed.
        threads
            How many threads render; by default, as the look says.
        """
        scene, look = self.set(shot), self._look
        holds = look.holds(scene)
        given = {**look.settings, **msgspec.structs.asdict(self.style(scene))}
        take = partial(render, scene, threads or look.threads, warn=warn, **given)
        if not holds:
            return take(), None
        if white is not None:
            return take(lock=Exposed(white)), None
        image = take()
        if not image.white > 0:
            return image, None
        white = float(image.white)
        if depends_on_white(image.settings, image.noise):
            image = take(lock=Exposed(white))
        return image, white

    def style(self, scene: Scene) -> Style:
        """Return how pictures are drawn, with fog that is fitted to what the first one shows."""
        style = overridden(scene.style, {**self._look.settings, **self._style})
        return fitted(style, scene.camera, lambda: self.common.ball)

    def _with_peaks(self, scene: Scene) -> list[Any]:
        """Return the objects of a scene; points shine as brightly as in the first."""
        peaks = iter(self.common.peaks)
        return [
            item.replace(peak=next(peaks, None))
            if isinstance(item, Stars) and item.peak is None
            else item
            for item in scene.objects
        ]


def common_of(first: Shot, settings: Mapping[str, Any]) -> Common:
    """Return what all pictures take from the first, given the settings for all."""
    width, height = map(int, settings.get("size") or first.scene.render.size or first.camera.size)
    camera = first.camera.resized((width, height))
    peaks = [
        peak_of(item, camera)
        for item in first.scene.objects
        if isinstance(item, Stars) and item.peak is None
    ]
    fog = overridden(first.scene.style, settings).fog
    is_fitted = isinstance(fog, Fog) and (fog.start is None or fog.end is None)
    return Common(peaks, ball_around(first.scene) if is_fitted else None)
