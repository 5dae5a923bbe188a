"""Frames of a file: those that there are."""

import sys
from collections import deque
from collections.abc import Callable, Iterator
from functools import partial
from typing import Protocol, TypeVar

from vtray.base.errors import SceneError
from vtray.scene.particles.particles import Particles
from vtray.scene.readers.lines import Lines

Steps = Iterator[Callable[[], Particles]]
"""For each frame of a file what reads it; a frame that is not asked for is passed over fast."""


class Head(Protocol):
    """What stands before the rows of a frame in a text."""

    @property
    def size(self) -> int:
        """How many rows follow."""


AnyHead = TypeVar("AnyHead", bound=Head)


def find_frame(
    lines: Lines, frame: int, read_head: Callable[[Lines], AnyHead | None], first: str
) -> tuple[int, AnyHead]:
    """Go to the rows of a frame.

    Parameters
    ----------
    lines
        The file, at its beginning.
    frame
        From 0; or from -1, the last, backwards.
    read_head
        Reads what stands before the rows; None at the end of the file.
    first
        What is expected in the first line.

    Returns
    -------
    number : int
        That of the frame, from 0.
    head : AnyHead
        What stands before its rows.

    Raises
    ------
    SceneError
        There is no such frame.
    """
    # Of the frames that were met, only those that may be asked for are kept.
    met: deque[tuple[tuple[int, int], AnyHead]] = deque(maxlen=min(max(-frame, 1), sys.maxsize))
    count = 0
    while (head := read_head(lines)) is not None:
        if count == frame:
            return frame, head
        met.append((lines.place(), head))
        count += 1
        if lines.skip(head.size) < head.size:
            break
    if count == 0:
        raise SceneError(f"is empty; expected {first} in the first line")
    if frame >= 0 or -frame > count:
        raise no_such_frame(frame, count)
    place, found = met[0]
    lines.go(place)
    return count + frame, found


def steps_of(
    lines: Lines,
    read_head: Callable[[Lines], AnyHead | None],
    read_frame: Callable[[Lines, int, AnyHead], Particles],
) -> Steps:
    """Give what reads each frame of a text, one after the other.

    Parameters
    ----------
    lines
        The file, at its beginning.
    read_head
        Reads what stands before the rows; None at the end of the file.
    read_frame
        Reads the rows that come next, of the frame with a number from 0, and what stood before.
    """

    def read(place: tuple[int, int], number: int, head: AnyHead) -> Particles:
        lines.go(place)
        return read_frame(lines, number, head)

    number = 0
    while (head := read_head(lines)) is not None:
        place = lines.place()
        yield partial(read, place, number, head)
        lines.go(place)
        if lines.skip(head.size) < head.size:
            break
        number += 1


def frame_number(frame: int, count: int) -> int:
    """Return the number of a frame from 0; a negative one counts from the end.

    Raises
    ------
    SceneError
        There is no such frame.
    """
    if not -count <= frame < count:
        raise no_such_frame(frame, count)
    return frame % count


def no_such_frame(frame: int, count: int) -> SceneError:
    """Give the error for a frame that a file does not have."""
    if count == 0:
        return SceneError("holds no frame; expected at least one")
    if count == 1:
        return SceneError(f"frame {frame}: there is one frame; expected 0 or -1")
    last = count - 1
    return SceneError(f"frame {frame}: there are {count} frames; expected {-count} to {last}")
