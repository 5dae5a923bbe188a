"""What an engine is: it traces the tiles of a picture, with whatever it has to work with."""

from collections.abc import Callable, Sequence
from typing import Any, NamedTuple, Protocol

import numpy as np
from numpy.typing import NDArray

from vtray.base.compiler.compiled import compile_ahead
from vtray.base.pool import Progress
from vtray.base.tiles import NO_TILE, Tile
from vtray.transport.film import Film, new_film
from vtray.transport.integrators.direct import trace_tile
from vtray.transport.sampling.pixel_samples import Sampling
from vtray.transport.scene_arrays import SceneArrays, new_memory

Done = Callable[[Tile], object]
"""What is told that a tile is done."""


class Cast(NamedTuple):
    """What casting rays came to.

    Attributes
    ----------
    peak
        The largest channel of light.
    rays
        How many rays were cast.
    """

    peak: float
    rays: int


class Plan(NamedTuple):
    """What is traced.

    Attributes
    ----------
    sampling
        Which rays are cast for which pixels.
    wanted
        The parts of a film that are recorded.
    """

    sampling: Sampling
    wanted: tuple[str, ...]


class Engine(Protocol):
    """Traces the tiles of a picture, in any order: none depends on another."""

    def trace(
        self,
        scene: SceneArrays,
        sampling: Sampling,
        tiles: Sequence[Tile],
        film: Film,
        progress: Progress | None = None,
        done: Done | None = None,
    ) -> Cast:
        """Trace tiles, and write them to the film of the picture.

        Parameters
        ----------
        scene
            The scene.
        sampling
            Which rays are cast for which pixels.
        tiles
            The tiles.
        film
            Out: what is wanted of the picture.
        progress
            Called from time to time with the tiles done and their number.
        done
            Called from any thread with each tile that is done, not with one that was given up.
        """


def trace(scene: SceneArrays, plan: Plan, tile: Tile) -> tuple[Film, Cast]:
    """Trace one tile on its own, as an engine does that works elsewhere; return its film.

    Nothing but the arguments is read, and nothing else is written. All bits are those of the tile
    in the whole picture.
    """
    width, height = tile.right - tile.left, tile.bottom - tile.top
    film = new_film(width, height, *plan.wanted, left=tile.left, top=tile.top)
    return film, trace_to(film, scene, plan.sampling, tile)


def trace_to(film: Film, scene: SceneArrays, sampling: Sampling, tile: Tile) -> Cast:
    """Trace one tile on its own, to a film that there is."""
    return Cast(*trace_tile(*_arguments(film, scene, sampling, tile)))


def begin_compiling(film: Film, scene: SceneArrays, sampling: Sampling) -> None:
    """Compile what traces tiles before its turn; its parts are left to other processes."""
    compile_ahead(trace_tile, *_arguments(film, scene, sampling, NO_TILE))


def _arguments(film: Film, scene: SceneArrays, sampling: Sampling, tile: Tile) -> tuple[Any, ...]:
    """Return what traces one tile, in memory of its own."""
    return scene, sampling, *tile, film, *new_memory(scene), np.zeros(1, np.bool_)


def paste(tile: Tile, part: Film, marks: NDArray[np.bool_], film: Film) -> None:
    """Put the film of a tile into that of the picture.

    Parameters
    ----------
    tile, part
        The tile, and its film.
    marks
        The pixels of the picture that were traced, or (0, 0) for all, as in `Sampling`.
    film
        Out: the film of the picture.
    """
    place = np.s_[tile.top : tile.bottom, tile.left : tile.right]
    traced = marks[place] if marks.size else np.ones((1, 1), np.bool_)
    for name in set(Film._fields) - {"left", "top", "kept"}:
        source, target = getattr(part, name), getattr(film, name)
        if source is not None and target is not None and target.size > 0:
            where = traced[..., np.newaxis] if source.ndim > traced.ndim else traced
            np.copyto(target[place], source, where=where)
