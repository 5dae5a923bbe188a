"""What comes one after the other, each made while the one before is at work on."""

from collections.abc import Iterator
from concurrent.futures import Future, ThreadPoolExecutor
from typing import Generic, TypeVar

Item = TypeVar("Item")


class Coming(Generic[Item]):
    """Items, of which the next is made when one is taken.

    Parameters
    ----------
    items
        Gives them.
    maker
        What makes the next in another thread; None to make each when it is taken.
    """

    def __init__(self, items: Iterator[Item], maker: ThreadPoolExecutor | None) -> None:
        self._items, self._maker = items, maker
        self._next: Future[Item | None] | None = None

    def take(self) -> Item | None:
        """Return the next item; None behind the last."""
        if self._maker is None:
            return next(self._items, None)
        following = self._next or self._maker.submit(next, self._items, None)
        found = following.result()
        if found is not None:
            self._next = self._maker.submit(next, self._items, None)
        return found
