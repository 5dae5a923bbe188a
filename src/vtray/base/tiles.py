"""Tiles: the parts of an image that threads take from a queue."""

from typing import NamedTuple

TILE = 64
"""Side of a tile in pixels: large enough that the call of a kernel (4 microseconds) does not count,
small enough that all threads end at about the same time."""


class Tile(NamedTuple):
    """A rectangle of pixels; right and bottom are the first that no longer belong to it."""

    left: int
    top: int
    right: int
    bottom: int


NO_TILE = Tile(0, 0, 0, 0)
"""A tile without pixels."""


def split_into_tiles(width: int, height: int, side: int = TILE) -> list[Tile]:
    """Return the tiles of an image, row by row."""
    return [
        Tile(left, top, min(left + side, width), min(top + side, height))
        for top in range(0, height, side)
        for left in range(0, width, side)
    ]
