"""Which frames of a sequence are meant: all, a slice of them, or their numbers."""

import re
from collections.abc import Callable, Iterable, Sequence
from operator import index

from vtray.base.errors import SceneError
from vtray.scene.checks.json_tree import short
from vtray.scene.readers.frames import frame_number

Frames = str | slice | range | Iterable[int] | None

EXPECTED = "START:STOP:STEP such as 0:500:5, or numbers such as 3 or -1"

_NUMBER = "[-+]?[0-9]{1,15}"
_SLICE = re.compile(rf"({_NUMBER})?:({_NUMBER})?(?::({_NUMBER})?)?")


def which_frames(frames: Frames, count: Callable[[], int]) -> Sequence[int]:
    """Return the numbers of the frames that are meant, from 0.

    Parameters
    ----------
    frames
        ``"0:500:5"``, a slice or a range, for those that there are among them; numbers, negative
        ones from the end; or None for all.
    count
        Gives how many frames there are; called only where that matters.

    Raises
    ------
    SceneError
        There is no such frame, or none at all, or `frames` are none of these.
    """
    part = as_slice(frames)
    if part is not None:
        total = count()
        found: Sequence[int] = range(*part.indices(total))
        if not found:
            there = "there is one frame" if total == 1 else f"there are {total} frames"
            raise SceneError(f"frames {_shown(frames)}: {there}, none of which is among these")
        return found
    try:
        numbers = [*map(index, frames)]  # type: ignore[arg-type]
    except TypeError:
        raise SceneError(f"frames: expected {EXPECTED}, got {_shown(frames)}") from None
    if not numbers:
        raise SceneError(f"frames: expected {EXPECTED}, got no number")
    if min(numbers) >= 0:  # one that is not there is found out when it is read
        return numbers
    total = count()
    return [frame_number(number, total) for number in numbers]


def as_slice(frames: object) -> slice | None:
    """Return what stands for a slice as one; None if it is something else.

    Raises
    ------
    SceneError
        It is a text that is no slice, or its step is 0.
    """
    if frames is None:
        return slice(None)
    if isinstance(frames, range):
        # What a range leaves out at its ends is what a slice counts from the other end.
        if min(frames, default=0) < 0:
            return None
        stop = None if frames.stop < 0 else frames.stop
        return slice(frames.start, stop, frames.step)
    if isinstance(frames, slice):
        if frames.step == 0:
            raise SceneError("frames: expected a step other than 0, got 0")
        return frames
    if not isinstance(frames, str):
        return None
    text = frames.strip()
    if re.fullmatch(_NUMBER, text):
        number = int(text)
        return slice(number, number + 1 or None)
    found = _SLICE.fullmatch(text)
    if found is None:
        raise SceneError(f"frames: expected {EXPECTED}, got {_shown(frames)}")
    start, stop, step = (None if part is None else int(part) for part in found.groups())
    if step == 0:
        raise SceneError(f"frames: expected a step other than 0, got {_shown(frames)}")
    return slice(start, stop, step)


def _shown(frames: object) -> str:
    """Return how frames are shown in messages."""
    if isinstance(frames, slice):
        ends = ("" if part is None else str(part) for part in (frames.start, frames.stop))
        return ":".join(ends) + ("" if frames.step is None else f":{frames.step}")
    return short(frames if isinstance(frames, str) else repr(frames))
