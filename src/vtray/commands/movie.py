"""Movies by the command: of the frames of a file, or of a scene that is gone around."""

import argparse
import contextlib
import logging
import sys
from collections.abc import Callable, Iterator
from functools import partial
from typing import TYPE_CHECKING, Any

from vtray.animation.animate import go_around, run
from vtray.animation.annotating import check_annotate
from vtray.animation.cluster import check_client, connect
from vtray.animation.film import Film
from vtray.animation.output import Output
from vtray.animation.particle_scenes import Objects, scenes_of
from vtray.animation.script import Script
from vtray.animation.shots import around_beside, camera_around
from vtray.animation.sources import first_of, source_of
from vtray.animation.stage import Look, Shot
from vtray.animation.swept import upright
from vtray.base.errors import printable
from vtray.base.signals import LastStep
from vtray.commands import data_options
from vtray.commands.annotation_options import annotations_of
from vtray.commands.command import print_note
from vtray.commands.data_scene import draw_data, read_particles, reading_of, shown_data
from vtray.commands.movie_options import FPS
from vtray.commands.options import settings_of
from vtray.rendering.beside import Margin
from vtray.scene.camera import Camera
from vtray.scene.particles.view import SIZE, VIEW, camera_of
from vtray.scene.placing.views import tilt_of

if TYPE_CHECKING:
    from vtray.scene.scene import Scene


def make_movie(
    options: argparse.Namespace,
    load: "Callable[[], Scene] | None",
    warn: Callable[[str], None],
) -> None:
    """Make the movie that options ask for.

    Parameters
    ----------
    options
        The options.
    load
        Reads the scene; None for a file of data.
    warn
        Called with a line about something that is noticed.
    """
    output = Output(options.output)
    fps = getattr(options, "fps", None) or FPS
    aov, annotate = tuple(options.aov or ()), check_annotate(annotations_of(options))
    output.check(fps, options.bits, aov, is_annotated=bool(annotate))
    output.check_spares(data_options.inputs_of(options))
    look = Look(settings_of(options), annotate, options.bits, aov, options.threads)
    film = Film(output, fps, look, bool(getattr(options, "resume", False)), on_warning=warn)
    progress: Any = None
    if not options.quiet and sys.stderr.isatty():
        from vtray.base.progress import ProgressBar

        film.progress = progress = ProgressBar("frame")

    def tell() -> None:
        """Say how another run goes on, where this one ends."""
        if progress is not None:
            progress.close()
        if film.done is not None and film.done.how_to_go_on() and not options.quiet:
            print_note(printable(f"vtray: {film.done.how_to_go_on()}"))
        if film.done is not None:
            film.done.release()

    with LastStep(tell), _cluster_of(options) as film.client:
        try:
            _make(options, film, load)
        except BaseException:
            tell()
            raise
    if progress is not None:
        progress.close()


@contextlib.contextmanager
def _cluster_of(options: argparse.Namespace) -> Iterator[Any]:
    """Give a client of the cluster that is asked for; None if none is."""
    address = getattr(options, "dask", None)
    if address is None:
        yield None
        return
    logging.disable(logging.CRITICAL)  # what is wrong is said once, and in one line
    try:
        with connect(address) as client:
            check_client(client)
            yield client
    finally:
        logging.disable(logging.NOTSET)


def _make(options: argparse.Namespace, film: Film, load: "Callable[[], Scene] | None") -> None:
    """Make the movie."""
    seconds = getattr(options, "turntable", None)
    if seconds is None:
        _go_through(options, film)
    elif load is not None:
        scene = load()
        go_around(film, scene, *camera_around(scene, film.look), seconds)
    else:
        particles = read_particles(options)
        scene, marks = shown_data(options, particles)
        zoom = data_options.given(options).get("zoom", 1.0)
        start = upright(scene.camera, tilt_of(scene, "turntable"))
        camera, about = around_beside(scene, start, {**film.look.annotate, **marks}, zoom)
        shot = Shot(scene, camera, None, particles.frame, particles.time, marks)
        go_around(film, scene, camera, about, seconds, shot=shot)


def _go_through(options: argparse.Namespace, film: Film) -> None:
    """Make a movie of the frames of a file."""
    source = source_of(options.scene, getattr(options, "frames", None), reading_of(options))
    first, source = first_of(source)
    given = data_options.given(options)
    view = {name: given[name] for name in VIEW if name in given}

    def fit(subject: Objects, has_cell: bool, margin: Margin) -> Camera:
        return camera_of(subject, has_cell, options.size or SIZE, margin, **view)

    draw, annotate = partial(draw_data, options), film.look.annotate
    make = scenes_of(source, first, draw, fit, annotate, film.warn, "--select")
    run(film, Script(source, first, make))
