"""From scenes to a movie: what comes is made, what is there is traced, what is done is written.

All three go on at the same time, one picture apart, so that memory does not grow with the movie.
"""

import copy
from collections.abc import Callable, Iterator, Mapping
from concurrent.futures import Future, ThreadPoolExecutor
from dataclasses import dataclass, field
from pathlib import Path
from types import MappingProxyType
from typing import Any, NamedTuple, Self

from vtray.animation.annotating import annotated
from vtray.animation.done import PART, Done
from vtray.animation.feed import Feed
from vtray.animation.output import Output
from vtray.base.errors import OutputError
from vtray.image.image import Image
from vtray.rendering.renderer import render
from vtray.rendering.starlight import peak_of
from vtray.scene.camera import Camera
from vtray.scene.default_light import settings_of
from vtray.scene.light_types import AnyLight
from vtray.scene.scene import Scene
from vtray.scene.settings import overridden
from vtray.scene.stars import Stars

Warn = Callable[[str], None]
Progress = Callable[[str, int, int], None]


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
    """

    scene: Scene
    camera: Camera
    lights: list[AnyLight] | None = None
    frame: int | None = None
    time: float | None = None
    marks: Mapping[str, Any] = MappingProxyType({})


class Exposed(NamedTuple):
    """What a picture is locked to: the light that becomes white."""

    white: float


@dataclass
class Film:
    """How all pictures of a movie are taken.

    Attributes
    ----------
    output
        Where the movie goes.
    fps
        Pictures in a second.
    settings
        Settings of the render that are given, by their names.
    annotate
        What is painted on pictures, as keywords of `vtray.Image.annotated`.
    bits, aov
        What files of pictures hold, as for `vtray.Image.save`.
    threads
        How many threads render; None for all cores.
    resume
        Whether to go on from pictures that an earlier run has done.
    progress
        Called with ``"frames"``, how many pictures are done, and how many there are, 0 if that is
        not known.
    warn
        Called with a line about something that is noticed.
    """

    output: Output
    fps: float
    settings: Mapping[str, Any] = field(default_factory=dict)
    annotate: Mapping[str, Any] = field(default_factory=dict)
    bits: int | None = None
    aov: tuple[str, ...] = ()
    threads: int | None = None
    resume: bool = False
    progress: Progress | None = None
    warn: Warn | None = None
    done: Done | None = None

    def holds(self, scene: Scene) -> bool:
        """Tell whether pictures have the exposure of the first: unless it is said otherwise."""
        return "exposure" not in self.settings and settings_of(scene).exposure == "max"


def shoot(film: Film, shots: Callable[[int], Iterator[Shot]], first: Shot, total: int) -> None:
    """Make a movie.

    Parameters
    ----------
    film
        How.
    shots
        Gives what pictures are taken of, from one with a number on; called once.
    first
        The first of these, whose exposure and brightness all others have.
    total
        How many there are; 0 if that is not known.

    Raises
    ------
    OutputError
        A file cannot be written, or pictures of an earlier run are of another movie.
    """
    stage = _Stage(film, first)
    film.output.check_background(
        overridden(settings_of(stage.set(first)), film.settings).background
    )
    film.done = done = Done(film.output, repr(sorted(film.annotate.items())), resume=film.resume)
    feed = Feed()
    for k in range(done.count):
        feed.add(film.output.name(k))
    with (
        ThreadPoolExecutor(1) as reader,
        ThreadPoolExecutor(1) as writer,
        _writing(film, feed) as movie,
    ):
        coming = shots(max(done.count - 1, 0))
        if done.count:
            last = next(coming, None)
            if last is None:
                raise OutputError(f"{film.output.path}: more pictures are done than there are")
            scene = stage.set(last)
            settings = overridden(settings_of(scene), film.settings)
            done.check_last(scene, settings, holds=film.holds(scene))
        written: Future[None] | None = None
        following = reader.submit(next, coming, None)
        k = done.count
        while (shot := following.result()) is not None:
            following = reader.submit(next, coming, None)
            _tell(film, k, total)
            image = stage.take(shot)
            if written is not None:
                written.result()
            movie.check()
            written = writer.submit(_write, film, feed, image, shot, k)
            del image, shot
            k += 1
        if written is not None:
            written.result()
        _tell(film, k, total)
        feed.end()
        done.finish(movie.wait())


class _Stage:
    """Where scenes are put to be taken: one after the other, all in the same light."""

    def __init__(self, film: Film, first: Shot) -> None:
        self._film = film
        self._last: Scene | None = None
        self._scene = first.scene
        self._peaks = _peaks_of(first, film.settings.get("size"))
        self._warned: set[str] = set()
        self._shape: tuple[int, ...] = ()

    def set(self, shot: Shot) -> Scene:
        """Return a scene with the camera and the lights of a picture."""
        # What is kept with a scene stays from one picture of it to the next.
        if self._last is not shot.scene:
            self._scene = copy.copy(shot.scene)
            self._scene.objects = self._with_peaks(shot.scene)
            self._last = shot.scene
        self._scene.camera = shot.camera
        if shot.lights is not None:
            self._scene.lights = shot.lights
        return self._scene

    def take(self, shot: Shot) -> Image:
        """Return the picture, in the exposure that all have."""
        film, scene = self._film, self.set(shot)
        assert film.done is not None  # noqa: S101 - made before any picture
        holds = film.holds(scene)
        white = film.done.white if holds else None
        lock = None if white is None else Exposed(white)
        image = render(scene, film.threads, lock=lock, warn=self._warn, **film.settings)
        if holds and lock is None and image.white > 0:
            film.done.white = float(image.white)
        self._check_size(image)
        return image

    def _check_size(self, image: Image) -> None:
        """Raise OutputError if a picture is not as large as the first one."""
        shape = image.linear.shape
        self._shape = self._shape or shape
        if self._film.output.format is not None and shape != self._shape:
            (height, width), (h, w) = shape[:2], self._shape[:2]
            words = f"expected pictures of {w} x {h} pixels as the first, got {width} x {height}"
            raise OutputError(f"{self._film.output.path}: {words}; give a size for all")

    def _warn(self, message: str) -> None:
        """Warn once, not for each picture."""
        if message not in self._warned:
            self._warned.add(message)
            if self._film.warn is not None:
                self._film.warn(message)

    def _with_peaks(self, scene: Scene) -> list[Any]:
        """Return the objects of a scene; points shine as brightly as in the first."""
        peaks = iter(self._peaks)
        return [
            item.replace(peak=next(peaks, None))
            if isinstance(item, Stars) and item.peak is None
            else item
            for item in scene.objects
        ]


def _peaks_of(first: Shot, size: tuple[int, int] | None) -> list[float | None]:
    """Return what is as bright as can be of points that shine, where that is not said."""
    width, height = map(int, size or first.scene.render.size or first.camera.size)
    camera = first.camera.resized((width, height))
    return [
        peak_of(item, camera)
        for item in first.scene.objects
        if isinstance(item, Stars) and item.peak is None
    ]


def _write(film: Film, feed: Feed, image: Image, shot: Shot, k: int) -> None:
    """Write a picture to its file."""
    assert film.done is not None  # noqa: S101 - made before any picture
    path = film.output.name(k)
    keywords = annotated(film.annotate, shot.frame, shot.time, shot.marks)
    if keywords:
        image.annotated(**keywords).save(path)
    else:
        image.save(path, bits=film.bits, aov=film.aov)
    film.done.add()
    feed.add(path)


def _tell(film: Film, done: int, total: int) -> None:
    if film.progress is not None:
        film.progress("frames", done, total)


class _writing:  # noqa: N801 - used like a function
    """A context in which a movie is written as its pictures are done."""

    def __init__(self, film: Film, feed: Feed) -> None:
        self._film, self._feed = film, feed
        self._pool = ThreadPoolExecutor(1)
        self._movie: Future[None] | None = None
        self._part: Path | None = None

    def __enter__(self) -> Self:
        output = self._film.output
        if output.format is not None:
            self._part = output.folder / PART
            self._movie = self._pool.submit(
                output.format.write, self._part, self._feed, self._film.fps
            )
        return self

    def __exit__(self, *_: object) -> None:
        """Give up what is not whole."""
        self._feed.give_up()
        if self._movie is not None:
            self._movie.exception()
        self._pool.shutdown()

    def check(self) -> None:
        """Raise what went wrong so far."""
        if self._movie is not None and self._movie.done():
            self._movie.result()

    def wait(self) -> Path | None:
        """Return the movie when it is whole; None for numbered pictures."""
        if self._movie is not None:
            self._movie.result()
        return self._part
