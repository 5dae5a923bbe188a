"""From scenes to a movie: what comes is made, what is there is traced, what is done is written.

All three go on at the same time, one picture apart, so that memory does not grow with the movie.
"""

from collections.abc import Callable, Mapping
from concurrent.futures import Future, ThreadPoolExecutor
from pathlib import Path
from typing import Any, Self

from vtray.animation.coming import Coming
from vtray.animation.done import PART, Done
from vtray.animation.film import Film
from vtray.animation.output import Output
from vtray.animation.script import Script
from vtray.animation.stage import Stage, common_of
from vtray.base.atomic_file import explained
from vtray.image.image import Image
from vtray.scene.default_light import settings_of


def shoot(film: Film, script: Script) -> None:
    """Make a movie.

    Parameters
    ----------
    film
        How. All pictures have the exposure and the brightness of the first.
    script
        What pictures are taken of.

    Raises
    ------
    OutputError
        A file cannot be written, pictures of an earlier run are of another movie, or another run is
        at work on it.
    """
    first = script.first_shot()
    stage = Stage(film.look, common_of(first, film.look.settings))
    background = settings_of(stage.set(first), film.look.settings).background
    film.output.check_background(background)
    done = film.begin()
    try:
        with _writing(film) as movie:
            if film.client is None:
                _take_here(film, script, done, stage, movie.check)
            else:
                from vtray.animation.cluster import take_elsewhere

                take_elsewhere(film, script, done, stage, movie.check)
            film.tell(len(done), script.total)
            film.feed.end()
            done.finish(movie.wait())
    finally:
        done.release()


def _take_here(
    film: Film, script: Script, done: Done, stage: Stage, check: Callable[[], None]
) -> None:
    """Take all pictures that are missing; `check` raises what goes wrong with the movie."""
    with ThreadPoolExecutor(1) as maker, ThreadPoolExecutor(1) as writer:
        shots = script.shots(max(done.count - 1, 0))
        if done.count:
            film.check_last(stage, next(shots, None))
        written: Future[None] | None = None
        coming = Coming(shots, None if script.source.is_bound else maker)
        k, count = done.count, len(done)
        while (shot := coming.take()) is not None:
            if k not in done:
                film.tell(count, script.total)
                with script.source.of_picture(k):
                    keywords = film.look.painted(shot)
                    image, white = stage.take(shot, done.white, film.warn)
                    film.check_size(image.linear.shape)
                if white is not None:
                    done.white = white
                if written is not None:
                    written.result()
                check()
                written = writer.submit(_write, film, image, keywords, k)
                count += 1
                del image
            del shot
            k += 1
        if written is not None:
            written.result()


def _write(film: Film, image: Image, keywords: Mapping[str, Any], k: int) -> None:
    """Write a picture, and what is painted on it, to its file."""
    film.look.save(image, keywords, film.output.name(k))
    film.accept(k)


class _writing:  # noqa: N801 - used like a function
    """A context in which a movie is written as its pictures are done."""

    def __init__(self, film: Film) -> None:
        self._film = film
        self._pool = ThreadPoolExecutor(1)
        self._movie: Future[None] | None = None
        self._part: Path | None = None

    def __enter__(self) -> Self:
        output = self._film.output
        if output.format is not None:
            self._part = output.folder / PART
            self._movie = self._pool.submit(self._write, output, self._part)
        return self

    def _write(self, output: Output, part: Path) -> None:
        """Write the movie; what keeps that from being done is said of its own name."""
        assert output.format is not None  # noqa: S101 - numbered pictures are not put together
        with explained(output.path):
            output.format.write(part, self._film.feed, self._film.fps)

    def __exit__(self, *_: object) -> None:
        """Give up what is not whole."""
        self._film.feed.give_up()
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
