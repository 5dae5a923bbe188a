"""Captions of frames: which one of a simulation a picture shows."""

import math

from vtray.base.number import is_integer, number_of
from vtray.figures.sheet import FigureError


def frame_caption(time: str | float | None, frame: int | None) -> str:
    """Return what says which frame a picture shows, "" for nothing.

    Parameters
    ----------
    time
        When it is: a number, or a text with a unit such as ``"12.5 ps"``.
    frame
        Its number.

    Raises
    ------
    FigureError
        An argument is neither.
    """
    parts = []
    if time is not None:
        number = number_of(time)
        text = f"{number:g}" if math.isfinite(number) else time
        if not isinstance(text, str) or not text.strip():
            message = f'time: expected a number or a text such as "12.5 ps", got {time!r}'
            raise FigureError(message)
        parts.append(f"t = {text}")
    if frame is not None:
        if not is_integer(frame):
            message = f"frame: expected an integer or None, got {frame!r}"
            raise FigureError(message)
        parts.append(f"frame {frame}")
    return ", ".join(parts)
