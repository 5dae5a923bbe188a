"""Movies: `vtray.animate` and `vtray.turntable`."""

import math
import os
from collections.abc import Callable, Collection, Iterable, Iterator, Mapping
from contextlib import contextmanager
from inspect import signature
from pathlib import Path
from typing import TYPE_CHECKING, Any, Literal

from vtray.animation.annotating import check_annotate
from vtray.animation.cluster import check_client
from vtray.animation.film import Film, Progress
from vtray.animation.moving import (
    STYLE,
    Moving,
    is_moving,
    last_of,
    way_of_cameras,
    way_of_opacity,
    way_of_part,
)
from vtray.animation.output import Output
from vtray.animation.particle_scenes import Drawing, scenes_of
from vtray.animation.script import Make, Script
from vtray.animation.shooting import shoot
from vtray.animation.shots import SceneShots, TurnedShots, camera_around
from vtray.animation.snapshots import snapshots_of
from vtray.animation.sources import READING, first_of, source_of
from vtray.animation.stage import Look, Shot, Warn
from vtray.base.caller_warning import warn_caller
from vtray.base.errors import SceneError
from vtray.base.file_name import file_name
from vtray.base.file_series import files_of
from vtray.base.function import check_function
from vtray.base.number import number_of
from vtray.base.progress import ProgressBar
from vtray.image.formats.image_format import check_aov
from vtray.scene.camera import Camera
from vtray.scene.checks.choices import is_one_of
from vtray.scene.checks.scene_words import show
from vtray.scene.checks.unknown_names import unknown_argument
from vtray.scene.default_light import has_default_light
from vtray.scene.particles.view import VIEW
from vtray.scene.placing.bounds import middle_in
from vtray.scene.placing.directions import Vec, unit
from vtray.scene.placing.moved import up_of
from vtray.scene.scene import Scene
from vtray.scene.style import PICTURE, check_picture
from vtray.scene.vectors import Vector

if TYPE_CHECKING:
    from distributed import Client

    from vtray.scene.readers.which_frames import Frames

AnyCamera = Camera | Mapping[float, Camera] | Callable[[int], Camera]

LONGEST = 1_000_000
"""Pictures of a turntable at the most."""


def animate(
    scenes: "Scene | Iterable[Any] | Callable[[Any], Any] | str | os.PathLike[str]",
    path: str | os.PathLike[str],
    *,
    frames: "Frames | int" = None,
    fps: float = 30.0,
    camera: AnyCamera | None = None,
    opacity: Any = None,  # noqa: ANN401
    annotate: Mapping[str, Any] | None = None,
    resume: bool = False,
    threads: int | None = None,
    client: "Client | None" = None,
    progress: Progress | bool | None = None,
    bits: int | None = None,
    aov: Collection[str] = (),
    warn: Warn | None = None,
    **options: Any,  # noqa: ANN401
) -> Path:
    """Render scenes to a movie.

    All pictures have one exposure, that of the first; seeds stay, so that nothing flickers that
    does not change. While a picture is traced, the next scene is made, and the last picture is
    written: one of each is in memory, however many there are. So what code gives is copied, and it
    may write to the same arrays again.

    Parameters
    ----------
    scenes
        Scenes or particles, as a list or one by one; a function that makes one of each of `frames`;
        one scene, for a `camera` that moves; the name of a trajectory, as `read` takes it; or a
        trajectory at hand: a universe or a group of atoms of MDAnalysis, a pipeline of OVITO, a
        trajectory of MDTraj. Particles are what `Scene.add_particles` takes.
    path
        The movie: ``.mp4`` (which needs ``pip install imageio-ffmpeg``), ``.gif`` or ``.webp``; or
        numbered pictures such as ``frames/%04d.png``, in any format of `Image.save`.
    frames
        Which frames of a trajectory or a list: ``"0:500:5"``, a slice, a range, or numbers. What a
        function is called with, such as ``range(100)``, or 100 for the same. How many pictures
        there are of one scene; with keyframes, as far as the last by default.
    fps
        Pictures in a second.
    camera
        Of all pictures, a `Camera`, a function that gives one by the number of the picture, from 0;
        or keyframes, cameras by such numbers, between which it turns and moves smoothly. By default
        that of each scene; of scenes without one, the one that fits the first. Of particles, the
        one that shows eight frames, spread over all.
    opacity
        How opaque objects are: a number from 0 to 1, or one for each of the scene's objects, of
        which None leaves one as it is; or, as for `camera`, a function or keyframes of these. Of
        particles, that of `Scene.add_particles`, which may move too.
    annotate
        What is painted on each picture, as keywords of `Image.annotated`. In the texts ``title``
        and ``time``, ``{frame}`` and ``{time}`` stand for those of the frame.
    resume
        Whether to go on where an earlier run has ended. Until the movie is whole, its pictures are
        in a folder beside it, ``movie.mp4.frames``; those that are done stay there whatever
        happens.
    threads, warn
        As for `render`; each warning is given once.
    client
        A ``distributed.Client`` of a Dask cluster, whose workers then take the pictures, each with
        as many threads as it has; they are the same. What a worker had that dies is done by
        another.
    progress
        Called with ``"frames"``, how many pictures are done, and how many there are, 0 if that is
        not known. True shows a bar.
    bits, aov
        What numbered pictures hold, as for `Image.save`; with `annotate`, 8 bits and nothing else.
    options
        Settings of the render and parts of the style, such as ``samples=16`` or ``fog=True``, as
        for `render`. `clip` and `slice` may also be functions of the number of the picture, or
        keyframes, between which planes turn and move smoothly. With `exposure`, that is the
        exposure of each picture. Of particles, also the keywords of `Scene.add_particles`, and
        ``view``, ``zoom`` and ``orthographic``: see `Camera.fit`. Of a trajectory, also those of
        `read`. Colours by values have one scale, that of eight frames, spread over all, unless
        ``clim`` is given.

    Returns
    -------
    Path
        The movie.

    Raises
    ------
    SceneError
        A scene, a camera, a frame or a setting is not right.
    OutputError
        The movie cannot be written, or pictures that are done are of another movie.
    RenderError
        A picture cannot be rendered, see `render`; or the cluster cannot be used.
    ValueError
        `progress` or `warn` is no function, or `threads` is not right.
    ExtraError
        A package is needed that is not installed.
    KeyboardInterrupt
        After Ctrl-C. Pictures that are done stay.

    Examples
    --------
    >>> import vtray
    >>> vtray.animate("run.xyz", "run.mp4", frames="::5", bonds=True)  # doctest: +SKIP
    """
    settings, parts = _of_picture(options)
    reading = {name: options.pop(name) for name in READING if name in options}
    look = Look(settings, check_annotate(annotate), bits, check_aov(aov), threads)
    film = _film(path, fps, look, resume, client, progress, warn)
    ways = {name: way_of_part(name, part) for name, part in parts.items()}
    last = last_of(camera=camera, opacity=opacity, **parts)
    is_file = isinstance(scenes, (str, os.PathLike))
    if is_file:
        files = files_of(file_name(scenes, SceneError))
        film.output.check_spares([*files, reading.get("trajectory")])
    elif reading:
        message = f"{next(iter(reading))}: expected the name of a trajectory beside it"
        raise SceneError(message)
    source = source_of(scenes, frames, reading, None if last is None else last + 1)
    if not is_file and source.count is not None:
        _check_count("frames", source.count)
    first, source = first_of(snapshots_of(source, scenes))
    if isinstance(first, Scene):
        if options:
            name = next(iter(options))
            if name in VIEW or name in signature(Scene.add_particles).parameters:
                message = f"animate() argument {name!r} is for particles, or unknown"
                raise TypeError(message)
            raise _unknown(animate, name)
        make: Make = SceneShots(first, look)
    else:
        if opacity is not None and not is_moving(opacity):
            options["opacity"], opacity = opacity, None  # may be the name of a column
        drawing = Drawing(options, settings.get("size"), settings.get("background"))
        draw, fit = drawing.draw, drawing.fit
        select = f"{source.origin}: select"
        make = scenes_of(source, first, draw, fit, look.annotate, film.warn, select)
    if opacity is not None:
        ways["opacity"] = way_of_opacity(opacity)
    if camera is not None:
        ways["camera"] = way_of_cameras(camera, lambda: _pivot(make(first, 0, None).scene))
    with _shown(film, progress):
        run(film, Script(source, first, make, Moving(ways)))
    return film.output.path


def turntable(
    scene: Scene,
    path: str | os.PathLike[str],
    *,
    seconds: float = 6.0,
    fps: float = 30.0,
    degrees: float = 360.0,
    lights: Literal["turn", "still"] = "turn",
    opacity: Any = None,  # noqa: ANN401
    annotate: Mapping[str, Any] | None = None,
    resume: bool = False,
    threads: int | None = None,
    client: "Client | None" = None,
    progress: Progress | bool | None = None,
    bits: int | None = None,
    aov: Collection[str] = (),
    warn: Warn | None = None,
    **settings: Any,  # noqa: ANN401
) -> Path:
    """Render a movie for which the camera goes around a scene.

    It goes about the middle of all objects, to its right, around the axis of the world that is
    upright in the picture, or around the camera's `up`. After a whole turn, the movie goes on with
    its first picture.

    Parameters
    ----------
    scene
        The scene. If it has no camera, one is made that shows it from all sides; a camera that it
        has stays as far away, with the same field of view.
    path, fps, annotate, resume, threads, client, progress, bits, aov, warn
        As for `animate`.
    seconds
        How long it takes.
    degrees
        How far the camera goes; below 0 the other way.
    lights
        ``"turn"``: the lights go with the camera, as if the scene turned before it. ``"still"``:
        they stay, but for those of a scene whose lights were never set.
    opacity, settings
        As for `animate`, for which settings of the render may move too.

    Returns
    -------
    Path
        The movie.

    Raises
    ------
    SceneError, OutputError, RenderError, ValueError, ExtraError, KeyboardInterrupt
        As for `animate`.

    Examples
    --------
    >>> import vtray
    >>> vtray.turntable(scene, "turn.mp4", seconds=6)  # doctest: +SKIP
    """
    given, parts = _of_picture(settings)
    if settings:
        raise _unknown(turntable, next(iter(settings)))
    look = Look(given, check_annotate(annotate), bits, check_aov(aov), threads)
    film = _film(path, fps, look, resume, client, progress, warn)
    ways = {name: way_of_part(name, part) for name, part in parts.items()}
    if opacity is not None:
        ways["opacity"] = way_of_opacity(opacity)
    camera, about = camera_around(scene, look)
    with _shown(film, progress):
        go_around(film, scene, camera, about, seconds, degrees, lights, moving=Moving(ways))
    return film.output.path


def go_around(
    film: Film,
    scene: Scene,
    camera: Camera,
    about: Vector,
    seconds: float,
    degrees: float = 360.0,
    lights: str = "turn",
    shot: Shot | None = None,
    moving: Moving | None = None,
) -> None:
    """Make a movie of a scene as a camera goes around it; see `turntable`.

    `shot` says what is painted on each picture, and `moving` what else moves.
    """
    length, angle = _number("seconds", seconds), _number("degrees", degrees, positive=False)
    pictures = length * film.fps
    _check_count("seconds", pictures)
    count = max(round(pictures), 1)
    if not is_one_of(lights, ("turn", "still")):
        raise SceneError(f"lights: expected 'turn' or 'still', got {show(lights)}")
    turns = lights == "turn" and not has_default_light(scene)
    axis = unit(up_of(camera))
    shots = TurnedShots(shot or Shot(Scene(), camera), camera, about, axis, angle, count, turns)
    run(film, Script(source_of(scene, count), scene, shots, moving or Moving()))


def run(film: Film, script: Script) -> None:
    """Make a movie; say of errors how another run goes on."""
    try:
        shoot(film, script)
    except BaseException as error:
        if film.done is not None and film.done.how_to_go_on():
            error.add_note(film.done.how_to_go_on())
        raise


@contextmanager
def _shown(film: Film, progress: Progress | bool | None) -> Iterator[None]:
    """Tell within how far a movie is, to a function or by a bar, as `animate` is asked to."""
    if progress is not True:
        film.progress = progress or None
        yield
        return
    film.progress = bar = ProgressBar("frame", stays=True)
    try:
        yield
    finally:
        bar.close()


def _of_picture(options: dict[str, Any]) -> tuple[dict[str, Any], dict[str, Any]]:
    """Take from keywords what `render` takes, and of that what moves; None is as if not given."""
    given = {name: options.pop(name) for name in PICTURE if name in options}
    settings = {name: value for name, value in given.items() if value is not None}
    parts = {name: settings.pop(name) for name in STYLE if is_moving(settings.get(name))}
    return settings, parts


def _unknown(function: Callable[..., Path], name: str) -> TypeError:
    """Return the error for a keyword that a function does not know; it says what may be meant."""
    *named, _others = signature(function).parameters
    return TypeError(unknown_argument(function.__name__, name, [*named, *PICTURE]))


def _film(
    path: str | os.PathLike[str],
    fps: float,
    look: Look,
    resume: bool,
    client: "Client | None",
    progress: Progress | bool | None,
    warn: Warn | None,
) -> Film:
    """Return how a movie is made, checked as far as can be without a scene."""
    check_function("warn", warn, "a line of text")
    if not isinstance(progress, bool):
        takes = 'the word "frames", and how many of how many are done'
        check_function("progress", progress, takes, "True or ")
    check_picture(look.settings)
    output = Output(Path(path))
    rate = _number("fps", fps)
    output.check(rate, look.bits, look.aov, is_annotated=bool(look.annotate))
    if client is not None:
        check_client(client)
    return Film(output, rate, look, resume, on_warning=warn or warn_caller, client=client)


def _pivot(scene: Scene) -> Vec:
    """Return the middle of a scene; the origin if nothing has one."""
    try:
        return middle_in(scene, "")
    except SceneError:
        return 0.0, 0.0, 0.0


def _check_count(name: str, pictures: float) -> None:
    """Raise SceneError if there are too many pictures for any movie."""
    if not pictures <= LONGEST + 0.5:
        words = f"expected at most {LONGEST} pictures, got {pictures:.15g}"
        raise SceneError(f"{name}: {words}")


def _number(name: str, value: object, *, positive: bool = True) -> float:
    """Return an argument that must be a finite number, > 0 unless said otherwise."""
    number = number_of(value)
    if math.isfinite(number) and (number > 0 or not positive):
        return number
    words = "a number > 0" if positive else "a number"
    raise SceneError(f"{name}: expected {words}, got {show(value)}")
