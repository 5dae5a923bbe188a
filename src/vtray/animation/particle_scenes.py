"""Frames of particles as scenes that have one camera and one scale of colours.

Both are those of some frames, spread over all, which are looked at before: with the camera, all of
them are in the picture, and the scale has all their values.
"""

from collections.abc import Callable, Iterable, Mapping
from typing import Any

from vtray.animation.feed import spread
from vtray.animation.shooting import Shot
from vtray.animation.sources import Source
from vtray.scene.camera import Camera
from vtray.scene.objects import Object
from vtray.scene.particles.drawing import Drawn
from vtray.scene.particles.from_objects import as_particles
from vtray.scene.particles.particles import Particles
from vtray.scene.particles.view import MOVING, SAMPLES, SIZE, VIEW, camera_of
from vtray.scene.scene import Scene
from vtray.scene.settings import RenderSettings

LOOKED_AT = 8
"""Frames that are looked at before, the first and the last among them."""

Limits = tuple[float, float]

Draw = Callable[[Particles, Camera | None, Limits | None], tuple[Scene, Drawn, Mapping[str, Any]]]
"""Makes a scene of particles, with a camera and limits of the scale of colours where these are
given, and says what is in it, and what is painted on its picture."""

Fit = Callable[["Objects", bool], Camera]
"""Gives the camera that shows objects, by whether there is a cell."""


class Objects:
    """What is seen in several frames, as a subject for `Camera.fit`."""

    def __init__(self, objects: Iterable[Object]) -> None:
        self.objects = [*objects]


class ParticleScenes:
    """Makes scenes of particles, all with the same camera and scale of colours.

    Parameters
    ----------
    draw
        Makes one.
    fit
        Gives the camera.
    looked_at
        The frames that both are taken from.

    Attributes
    ----------
    camera : Camera
        The camera.
    clim : tuple of float or None
        The values of the first and the last colour; None where colours are not those of values.
    """

    def __init__(self, draw: Draw, fit: Fit, looked_at: Iterable[Any]) -> None:
        self._draw = draw
        seen = Objects([])
        limits: list[Limits] = []
        has_cell = False
        for given in looked_at:
            particles = as_particles(given)
            scene, drawn, _ = draw(particles, None, None)
            seen.objects += scene.objects
            has_cell |= particles.cell is not None
            if drawn.color_scale is not None:
                limits.append((drawn.color_scale.low, drawn.color_scale.high))
        self.camera = fit(seen, has_cell)
        self.clim = (
            (min(low for low, _ in limits), max(high for _, high in limits)) if limits else None
        )

    def __call__(self, given: Any, _: int) -> Shot:  # noqa: ANN401
        """Return what a picture is taken of."""
        particles = as_particles(given)
        scene, _drawn, marks = self._draw(particles, self.camera, self.clim)
        frame = None if particles.source is None else particles.frame
        return Shot(scene, self.camera, None, frame, particles.time, marks)


def looked_at(source: Source, first: Any) -> Iterable[Any]:  # noqa: ANN401
    """Return the frames of a source that are looked at before; the first where it goes by once."""
    if source.some is None or source.count is None:
        return [first]
    return source.some(spread(source.count, LOOKED_AT))


def drawing(
    given: Mapping[str, Any], size: tuple[int, int] | None, background: object
) -> tuple[Draw, Fit]:
    """Return what makes scenes, and their camera, by keywords.

    Parameters
    ----------
    given
        Those of `Scene.add_particles`, and ``view``, ``zoom`` and ``orthographic``.
    size, background
        Those of the picture, if they are given.
    """
    view = {name: given[name] for name in VIEW if name in given}
    drawn = {name: value for name, value in given.items() if name not in VIEW}
    if background is not None and background not in ("transparent", "sky"):
        drawn.setdefault("background", background)

    def draw(
        particles: Particles, camera: Camera | None, clim: Limits | None
    ) -> tuple[Scene, Drawn, Mapping[str, Any]]:
        scene = Scene(render=RenderSettings(samples=SAMPLES, tolerance=MOVING))
        if camera is not None:
            scene.camera = camera
        elif drawn.get("style") == "points":
            scene.camera = fit(particles.positions, particles.cell is not None)
        limits = {} if clim is None or drawn.get("clim") is not None else {"clim": clim}
        keywords: dict[str, Any] = {**drawn, **limits}
        return scene, scene.add_particles(particles, **keywords), {}

    def fit(subject: Any, has_cell: bool) -> Camera:  # noqa: ANN401
        return camera_of(subject, has_cell, size or SIZE, **view)

    return draw, fit
