"""Frames of a file: those that there are."""

from vtray.base.errors import SceneError


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
    if count == 1:
        return SceneError(f"frame {frame}: there is one frame; expected 0 or -1")
    last = count - 1
    return SceneError(f"frame {frame}: there are {count} frames; expected {-count} to {last}")
