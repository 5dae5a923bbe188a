"""Errors that say which frame of a movie they are of."""

from collections.abc import Iterator
from contextlib import contextmanager

from vtray.base.errors import VtrayError


@contextmanager
def of_frame(origin: str, number: int) -> Iterator[None]:
    """Say within of errors which frame they are of.

    Parameters
    ----------
    origin
        Where frames come from; nothing more is said where it is "", as they are all the same.
    number
        The number of the frame there.
    """
    try:
        yield
    except VtrayError as error:
        if not origin:
            raise
        words = str(error).removeprefix(f"{origin}: ")
        raise type(error)(f"{origin}: frame {number}: {words}") from error
