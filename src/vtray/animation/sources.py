"""Where the pictures of a movie come from: a scene, many, a function that makes them, or a file."""

import os
import sys
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from contextlib import AbstractContextManager
from dataclasses import dataclass, replace
from itertools import chain, islice, repeat
from typing import Any

from vtray.animation.frame_errors import of_frame
from vtray.animation.numbered import numbered
from vtray.animation.spool import Spool
from vtray.animation.stored import Stored
from vtray.base.errors import SceneError
from vtray.base.file_series import files_of
from vtray.base.number import is_integer
from vtray.scene.checks.json_tree import short
from vtray.scene.particles.from_objects import is_ase
from vtray.scene.particles.particles import Particles
from vtray.scene.readers.frames import frame_number
from vtray.scene.readers.read import is_slow, numbers_of, read_frames
from vtray.scene.readers.which_frames import which_frames
from vtray.scene.scene import Scene

READING = ("format", "columns", "trajectory")
"""What else `vtray.read` may be told of a file."""


@dataclass(frozen=True)
class Source:
    """What there is for each picture: a scene, or particles.

    Attributes
    ----------
    count
        How many pictures there are; None if that is not known before the last.
    start
        Gives what there is for pictures, from one with a number on.
    some
        Gives what there is for pictures with some numbers, which come in their order; None where
        only `start` can, and but once.
    numbers
        What is the number of each picture where it comes from; those from 0 if it is None.
    stored
        The file that others may read frames from; None if there is none.
    repeats
        Whether there is the same scene for each picture.
    origin
        Where pictures come from, for messages about one of them.
    is_bound
        Whether that is only asked for in the thread that makes the movie: OVITO, which code may
        use, computes in the main thread alone, and ends the process in another.
    """

    count: int | None
    start: Callable[[int], Iterator[Any]]
    some: Callable[[Sequence[int]], Iterator[Any]] | None
    numbers: Sequence[int] | None = None
    stored: Stored | None = None
    repeats: bool = False
    origin: str = "scenes"
    is_bound: bool = False

    def number(self, k: int) -> int:
        """Return what is the number of a picture where it comes from."""
        return k if self.numbers is None else int(self.numbers[k])

    def of_picture(self, k: int) -> AbstractContextManager[None]:
        """Say within of errors which picture they are of."""
        return of_frame(self.origin, self.number(k))


def source_of(
    scenes: Any,  # noqa: ANN401
    frames: Any = None,  # noqa: ANN401
    reading: Mapping[str, Any] | None = None,
    usual: int | None = None,
) -> Source:
    """Return where pictures come from.

    Parameters
    ----------
    scenes, frames
        As for `vtray.animate`.
    reading
        What `vtray.read` is told of a file.
    usual
        How many pictures of a single scene there are, where that is known otherwise.

    Raises
    ------
    SceneError
        They are nothing that pictures can come from.
    """
    if isinstance(scenes, (str, os.PathLike)):
        return _of_file(os.fsdecode(scenes), frames, reading or {})
    return replace(_of_code(scenes, frames, usual), is_bound="ovito" in sys.modules)


def _of_code(scenes: Any, frames: Any, usual: int | None) -> Source:  # noqa: ANN401
    """Return what there is in a program; the parameters are those of `source_of`."""
    if isinstance(scenes, Scene):
        count = _count_of(frames, usual)
        return Source(
            count,
            lambda k: repeat(scenes, count - k),
            lambda ks: repeat(scenes, len(ks)),
            repeats=True,
            origin="",
        )
    if callable(scenes):
        return _of_function(scenes, frames)
    is_one = isinstance(scenes, Particles) or is_ase(scenes)
    found = None if is_one else numbered(scenes)
    if found is not None:
        count = found.length
        numbers = which_frames(frames, lambda: count) if count else []
        if len(numbers):
            frame_number(max(numbers), count)  # raises an error if there is none
        return _listed(found.frame, numbers)
    if isinstance(scenes, Iterable) and not is_one:
        if frames is not None:
            words = "expected None where scenes come one by one; take some by itertools.islice"
            raise SceneError(f"frames: {words}, got {short(repr(frames))}")
        return Source(None, lambda k: islice(scenes, k, None), None)
    words = "expected scenes, a function that makes them, or the name of a trajectory"
    raise SceneError(f"scenes: {words}, got {short(repr(scenes))}")


def _of_file(path: str, frames: Any, reading: Mapping[str, Any]) -> Source:  # noqa: ANN401
    """Return what a trajectory gives."""
    if is_slow(path, **reading):
        spool = Spool(path, read_frames(path, **reading))
        try:
            found = which_frames(frames, spool.count)
        except SceneError as error:
            # What is wrong with a file names it.
            name = "" if str(error).startswith((path, *files_of(path))) else f"{path}: "
            raise SceneError(f"{name}{error}") from None
        return replace(_listed(spool.read, found), origin=path)
    numbers = numbers_of(path, frames, **reading)

    def read(ks: Sequence[int]) -> Iterator[Any]:
        return read_frames(path, [numbers[k] for k in ks], **reading)

    stored = Stored(path, reading)
    return Source(
        len(numbers),
        lambda k: read(range(k, len(numbers))),
        read,
        numbers,
        stored,
        origin=path,
    )


def _of_function(make: Callable[[int], Any], frames: Any) -> Source:  # noqa: ANN401
    """Return what a function makes of numbers."""
    if is_integer(frames):
        frames = range(int(frames))
    if not isinstance(frames, Iterable) or isinstance(frames, (str, Mapping)):
        words = "expected how many pictures a function makes, or what to call it with"
        raise SceneError(f"frames: {words}, such as range(100), got {short(repr(frames))}")
    return _listed(make, [*frames] if not isinstance(frames, range) else frames)


def _listed(make: Callable[[int], Any], numbers: Sequence[int]) -> Source:
    """Return what can be had for any number."""
    if not len(numbers):
        raise SceneError("frames: expected at least one picture, got none")
    whole = all(map(is_integer, numbers))
    return Source(
        len(numbers),
        lambda k: (make(numbers[i]) for i in range(k, len(numbers))),
        lambda ks: (make(numbers[k]) for k in ks),
        numbers if whole else None,
    )


def _count_of(frames: Any, usual: int | None) -> int:  # noqa: ANN401
    """Return how many pictures of a single scene there are."""
    if frames is None and usual is not None:
        return usual
    if is_integer(frames) and int(frames) > 0:
        return int(frames)
    words = "expected how many pictures of the scene there are, such as 100"
    raise SceneError(f"frames: {words}, got {short(repr(frames))}")


def first_of(source: Source) -> tuple[Any, Source]:
    """Return what there is for the first picture, and a source that still has it.

    Raises
    ------
    SceneError
        There is no picture.
    """
    nothing = object()
    items = source.start(0)
    first = next(items, nothing)
    if first is nothing:
        raise SceneError("scenes: expected at least one picture, got none")

    def start(k: int) -> Iterator[Any]:
        # Functions are called once for each picture, and what comes one by one comes but once.
        if k == 0 or source.some is None:
            return islice(chain([first], items), k, None)
        return source.start(k)

    return first, replace(source, start=start)
