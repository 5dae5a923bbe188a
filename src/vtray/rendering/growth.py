"""A picture as it grows: what there is of it while the rest is traced.

First a draft of the whole is traced, with one ray for each `STEP` x `STEP` pixels. It takes a
64th of the rays, which are cast as any others and then thrown away: exact pixels spread as thinly
would be as many, but packets of rays far from each other cost several times as much. Then tiles of
the picture take its place, from the middle outwards, and with samples a second time.
"""

import time
from collections.abc import Callable, Sequence
from queue import Empty, SimpleQueue
from types import TracebackType
from typing import Any, NamedTuple, Self

import numpy as np
from numpy.typing import NDArray

from vtray.base.tiles import Tile
from vtray.transport.camera_rays import CameraFrame, turned_by
from vtray.transport.film import Film

STEP = 8
"""Pixels across and down for which a draft has one ray."""

DRAFT_TILE = 16
"""Side of a tile of the draft, so that there are enough of them for all threads."""

SHARES = ("coverage", "fog")
"""What a film may hold beside light."""

REST = 9
"""How many times as long as an update takes the next one waits, so that the work goes on."""


class Part(NamedTuple):
    """What there is of a picture.

    Attributes
    ----------
    linear
        Light, (height, width, 3); that of the draft where nothing else is known yet.
    coverage
        How much of each pixel is covered, (height, width); None if that is not traced.
    fog
        How much of it fog is, (height, width); None if there is none.
    done
        The share of the tiles of all passes that are done, from 0 to 1.
    """

    linear: NDArray[np.float64]
    coverage: NDArray[np.float64] | None
    fog: NDArray[np.float64] | None
    done: float


class Growth:
    """A context in which a picture is traced; tells from time to time what there is of it.

    Only tiles that are done are shown: threads may be writing to the others.

    Parameters
    ----------
    tell
        Called with what there is.
    seconds
        The least time from one call to the next, and before the first.
    """

    def __init__(self, tell: Callable[[Part], object], seconds: float) -> None:
        self._tell = tell
        self._seconds = seconds
        self._next = time.perf_counter() + seconds
        self._film: Film | None = None
        self._linear = np.zeros((0, 0, 3))
        self._shares: dict[str, NDArray[np.float64]] = {}
        self._nearest: tuple[NDArray[np.int64], NDArray[np.int64]] | None = None
        self._has_samples = False
        self._fresh: SimpleQueue[Tile] = SimpleQueue()
        self._is_empty = True
        self._share = 0.0

    def begin_draft(self, film: Film, width: int, height: int) -> None:
        """Begin with the draft of a picture of this size."""
        film.linear.fill(0.0)  # so that all of it can be shown, whatever is done
        for name in SHARES:
            if getattr(film, name) is not None:
                getattr(film, name).fill(0.0)
                self._shares[name] = np.zeros((height, width))
        self._linear = np.zeros((height, width, 3))
        drawn_height, drawn_width = film.linear.shape[:2]
        self._nearest = _nearest(height, drawn_height), _nearest(width, drawn_width)
        self._film = film

    def begin(self, film: Film, tiles: Sequence[Tile], *, has_samples: bool) -> list[Tile]:
        """Go on with a pass; return its tiles in the order in which they shall be traced.

        Parameters
        ----------
        film
            The film of the picture.
        tiles
            The tiles.
        has_samples
            Whether pixels have samples, so that their coverage is written.
        """
        self._collect()
        self._film, self._nearest, self._has_samples = film, None, has_samples
        height, width = self._linear.shape[:2]

        def distance(tile: Tile) -> int:
            across, down = tile.left + tile.right - width, tile.top + tile.bottom - height
            return across * across + down * down

        return sorted(tiles, key=distance)

    def add(self, tile: Tile) -> None:
        """Note that a tile is done; from any thread."""
        self._fresh.put(tile)

    def update(self, done: int, total: int) -> None:
        """Tell what there is, if it is time, and there is something new.

        Parameters
        ----------
        done, total
            How many tiles are done in all passes, and how many there are.
        """
        self._share = done / total
        start = time.perf_counter()
        if start < self._next or self._fresh.empty() or done == total:
            return
        self._show()
        end = time.perf_counter()
        self._next = end + max(self._seconds - (end - start), REST * (end - start))

    def __enter__(self) -> Self:
        return self

    def __exit__(
        self,
        _kind: type[BaseException] | None,
        error: BaseException | None,
        _trace: TracebackType | None,
    ) -> None:
        """Tell what there is for the last time after Ctrl-C, if there is anything."""
        if isinstance(error, KeyboardInterrupt) and not (self._is_empty and self._fresh.empty()):
            self._show()

    def _show(self) -> None:
        """Tell what there is."""
        self._collect()
        shares = {name: self._shares.get(name) for name in SHARES}
        copies = {name: None if rows is None else rows.copy() for name, rows in shares.items()}
        self._tell(Part(self._linear.copy(), done=self._share, **copies))

    def _collect(self) -> None:
        """Take over all tiles that are done."""
        tiles = []
        while True:
            try:
                tiles.append(self._fresh.get_nowait())
            except Empty:
                break
        if not tiles or self._film is None:
            return
        self._is_empty = False
        if self._nearest is not None:
            self._take(self._film, np.ix_(*self._nearest), np.s_[:, :])
            return
        for tile in tiles:
            place = np.s_[tile.top : tile.bottom, tile.left : tile.right]
            self._take(self._film, place, place)

    def _take(self, film: Film, source: tuple[Any, ...], target: tuple[Any, ...]) -> None:
        """Take over pixels of a film; those that wait for samples stay as in the draft."""
        waits = False
        if film.mixed is not None and self._nearest is None and not self._has_samples:
            waits = film.mixed[source]
        keep = np.asarray(waits)[..., None]
        self._linear[target] = np.where(keep, self._linear[target], film.linear[source])
        for name, rows in self._shares.items():
            rows[target] = np.where(waits, rows[target], getattr(film, name)[source])


def draft_camera(camera: CameraFrame) -> CameraFrame:
    """Return a camera with the same view, for the draft of its picture."""
    across, down, distance = camera.pixel
    return camera._replace(
        pixel=(STEP * across, STEP * down, distance),
        shift=(STEP * camera.shift[0], STEP * camera.shift[1]),
        turn=turned_by(camera.turn, STEP),
        width=camera.width // STEP + 1,
        height=camera.height // STEP + 1,
    )


def _nearest(size: int, drawn: int) -> NDArray[np.int64]:
    """Return the number of the nearest pixel of a draft for each column, or row, of a picture."""
    places = (np.arange(size) - size / 2) / STEP + drawn / 2
    return np.floor(places + 0.5).astype(np.int64).clip(0, drawn - 1)
