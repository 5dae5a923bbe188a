"""Frames of particles as scenes that have one camera and one scale of colours.

Both are those of some frames, spread over all, which are looked at before: with the camera, all of
them are in the picture, and the scale has all their values.
"""

from collections.abc import Callable, Iterable, Iterator, Mapping
from contextlib import AbstractContextManager
from types import MappingProxyType
from typing import Any

from vtray.animation.fading import Opacity
from vtray.animation.feed import spread
from vtray.animation.sources import Source
from vtray.animation.stage import Shot, Warn
from vtray.base.errors import SceneError
from vtray.rendering.beside import MARGIN, Margin, fit_beside, has_beside
from vtray.scene.array_holder import ArrayHolder
from vtray.scene.camera import Camera
from vtray.scene.colors.color_scale import ColorScale
from vtray.scene.objects import Object
from vtray.scene.particles.drawing import Drawn
from vtray.scene.particles.from_objects import as_particles
from vtray.scene.particles.particles import Particles
from vtray.scene.particles.view import MOVING, SIZE, VIEW, camera_of, places_of
from vtray.scene.placing.bounds import middle_in
from vtray.scene.scene import Scene
from vtray.scene.settings import RenderSettings

LOOKED_AT = 8
"""Frames that are looked at before, the first and the last among them."""

Fixed = Mapping[str, Any]
"""What colours mean in all pictures, as keywords of `Scene.add_particles`."""

Draw = Callable[[Particles, Camera | None, Fixed], tuple[Scene, Drawn, Mapping[str, Any]]]
"""Makes a scene of particles, with a camera where one is given, and with what colours mean, and
says what is in it, and what is painted on its picture."""

Fit = Callable[["Objects", bool, Margin], Camera]
"""Gives the camera that shows objects, by whether there is a cell and what stays free around."""


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
    annotate
        What is painted on each picture, beside what is said of single ones, as keywords of
        `vtray.Image.annotated`.

    Attributes
    ----------
    camera : Camera
        The camera.
    fixed : dict
        The values of the first and the last colour, ``clim``, or the ``categories`` that have a
        colour each; nothing where colours stand for neither.
    is_empty : bool
        Whether there are particles, but none is drawn of the frames that were looked at.
    """

    def __init__(
        self,
        draw: Draw,
        fit: Fit,
        looked_at: Iterable["Looked"],
        annotate: Mapping[str, Any] = MappingProxyType({}),
    ) -> None:
        self._draw = draw
        self.is_empty = True
        shown: Any = None
        marks: Mapping[str, Any] = {}
        seen = Objects([])
        scales: list[ColorScale] = []
        categories: dict[Any, None] = {}
        has_cell = shows_cell = has_some = False
        for given, of_given in looked_at:
            with of_given:
                particles = as_particles(given)
                scene, drawn, of_data = draw(particles, None, {})
            seen.objects += scene.objects
            has_cell |= particles.cell is not None
            shows_cell |= drawn.cell is not None
            has_some |= len(particles) > 0
            if shown is None or len(drawn.indices):
                shown, marks = particles, of_data
            if not len(drawn.indices):
                continue
            self.is_empty = False
            if drawn.color_scale is not None:
                scales.append(drawn.color_scale)
            categories.update(dict.fromkeys(drawn.categories or ()))
        self._shows_cell = shows_cell
        self.fixed: dict[str, Any] = {}
        if scales:
            low, high = min(scale.low for scale in scales), max(scale.high for scale in scales)
            self.fixed["clim"] = low, high
        elif categories:
            # Names come after numbers, which they cannot be compared with.
            in_order = sorted(categories, key=lambda kind: (isinstance(kind, str), kind))
            self.fixed["categories"] = in_order
        self.is_empty &= has_some
        last: list[Object] = []
        if all(len(item) == 0 for item in seen.objects if isinstance(item, ArrayHolder)):
            raise SceneError("frames: expected particles, got none")
        if has_beside({**annotate, **marks}):
            scene, _, marks = draw(shown, None, self.fixed)
            last = scene.objects
        self._middle = middle_in(seen, "Camera.fit")
        self.camera = fit_beside(
            lambda margin: fit(seen, has_cell, margin), last, {**annotate, **marks}
        )

    def __call__(self, given: Any, _: int, opacity: Opacity | None = None) -> Shot:  # noqa: ANN401
        """Return what a picture is taken of."""
        particles = as_particles(given)
        has_cell = particles.cell is not None
        fixed = {**self.fixed, "cell": self._shows_cell and has_cell}
        if opacity is not None:
            fixed["opacity"] = opacity
        scene, _drawn, marks = self._draw(particles, self.camera, fixed)
        frame = None if particles.source is None else particles.frame
        return Shot(scene, self.camera, None, frame, particles.time, marks, middle=self._middle)


Looked = tuple[Any, AbstractContextManager[None]]
"""A frame, and what says of errors that they are of it."""


def looked_at(source: Source, first: Any) -> Iterator[Looked]:  # noqa: ANN401
    """Give the frames of a source that are looked at before; the first where it goes by once."""
    if source.some is None or source.count is None:
        yield first, source.of_picture(0)
        return
    numbers = spread(source.count, LOOKED_AT)
    for k, item in zip(numbers, source.some(numbers), strict=True):
        yield item, source.of_picture(k)


def scenes_of(
    source: Source,
    first: Any,  # noqa: ANN401
    draw: Draw,
    fit: Fit,
    annotate: Mapping[str, Any],
    warn: Warn,
    select: str,
) -> ParticleScenes:
    """Return what makes scenes of the particles of a source.

    Parameters
    ----------
    source, first
        Where the particles come from, and those of the first picture.
    draw, fit, annotate
        As for `ParticleScenes`.
    warn
        Called with a line where none of the particles that are looked at are drawn.
    select
        What may have chosen none, which the line begins with.
    """
    found = ParticleScenes(draw, fit, looked_at(source, first), annotate)
    if found.is_empty:
        words = "none of the particles in the frames that were looked at; the cell alone is shown"
        warn(f"{select}: {words}")
    return found


class Drawing:
    """Makes scenes of particles, and their camera, by keywords.

    Parameters
    ----------
    given
        Those of `Scene.add_particles`, and ``view``, ``zoom`` and ``orthographic``.
    size, background
        Those of the picture, if they are given.
    """

    def __init__(
        self, given: Mapping[str, Any], size: tuple[int, int] | None, background: object
    ) -> None:
        self._size = size or SIZE
        self._view = {name: given[name] for name in VIEW if name in given}
        self._drawn = {name: value for name, value in given.items() if name not in VIEW}
        is_word = isinstance(background, str) and background in ("transparent", "sky")
        if background is not None and not is_word:
            self._drawn.setdefault("background", background)

    def draw(
        self, particles: Particles, camera: Camera | None, fixed: Fixed
    ) -> tuple[Scene, Drawn, Mapping[str, Any]]:
        """Make a scene; see `Draw`."""
        scene = Scene(render=RenderSettings(tolerance=MOVING))
        if camera is not None:
            scene.camera = camera
        elif self._drawn.get("style") == "points":
            scene.camera = self.fit(places_of(particles), particles.cell is not None, MARGIN)
        drawn = {name: value for name, value in self._drawn.items() if value is not None}
        return scene, scene.add_particles(particles, **{**fixed, **drawn}), {}

    def fit(self, subject: Any, has_cell: bool, margin: Margin) -> Camera:  # noqa: ANN401
        """Return the camera that shows objects, or places; see `Fit`."""
        return camera_of(subject, has_cell, self._size, margin, **self._view)
