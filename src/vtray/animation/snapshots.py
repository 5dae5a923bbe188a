"""What code gives for the pictures of a movie, as it was when it was given.

While a picture is traced, code already makes the next, and a simulation does so in the same arrays
again and again. So all that may change then is copied before code goes on.
"""

import copy
import os
from collections.abc import Iterable, Iterator
from dataclasses import replace
from itertools import count
from typing import Any

import numpy as np

from vtray.animation.sources import Source
from vtray.scene.array_holder import ArrayHolder
from vtray.scene.objects import Object
from vtray.scene.particles.from_objects import as_particles
from vtray.scene.particles.particles import Particles
from vtray.scene.scene import Scene


def snapshots_of(source: Source, scenes: Any) -> Source:  # noqa: ANN401
    """Return a source of what another gives, in arrays that nobody else has.

    Parameters
    ----------
    source
        The source.
    scenes
        What it is made of. Of one scene, a list or a file, all stays as it is: no code runs.
    """
    if isinstance(scenes, (str, os.PathLike, Scene, list, tuple)):
        return source
    taken = _Snapshots()

    def each(numbers: Iterable[int], items: Iterable[Any]) -> Iterator[Any]:
        for k, item in zip(numbers, items, strict=False):
            with source.of_picture(k):
                found = taken.of(item)
            yield found

    some = source.some
    return replace(
        source,
        start=lambda k: each(count(k), source.start(k)),
        some=None if some is None else lambda ks: each(ks, some(ks)),
    )


class _Snapshots:
    """Copies scenes and particles; objects that have not changed since are the same again."""

    def __init__(self) -> None:
        self._are_scenes = False
        self._last: dict[int, tuple[Object, Object]] = {}

    def of(self, given: Any) -> Any:  # noqa: ANN401
        """Return a scene, or the particles of all else; what is wrong among scenes, as it is."""
        if isinstance(given, Scene):
            self._are_scenes = True
            return self._of_scene(given)
        return given if self._are_scenes else _of_particles(as_particles(given))

    def _of_scene(self, given: Scene) -> Scene:
        """Return a scene that has what another has now; one that is wrong, as it is."""
        objects: Any = given.objects
        if not isinstance(objects, list):
            return given
        found = copy.copy(given)
        found.lights = copy.copy(given.lights)
        found.objects = list(map(self._of_object, objects))
        pairs = zip(objects, found.objects, strict=True)
        self._last = {id(item): (item, own) for item, own in pairs}
        return found

    def _of_object(self, item: Object) -> Object:
        """Return an object, in arrays of its own if it has any."""
        if not isinstance(item, ArrayHolder):
            return item
        # What is kept here is alive, so nothing else has its identity.
        _, own = self._last.get(id(item), (None, None))
        if own is not None and _are_equal(item, own):
            return own
        known = vars(item)
        return copy.deepcopy(item, {id(known): known})


def _are_equal(item: ArrayHolder, own: Any) -> bool:  # noqa: ANN401
    """Tell whether the arrays of an object are what they were when it was copied."""
    return all(map(np.array_equal, item.arrays(), own.arrays()))


def _of_particles(given: Particles) -> Particles:
    """Return the same particles in arrays of their own."""
    return replace(
        given,
        positions=given.positions.copy(),
        columns={name: column.copy() for name, column in given.columns.items()},
        bonds=None if given.bonds is None else given.bonds.copy(),
        cell=None if given.cell is None else given.cell.copy(),
        origin=given.origin.copy(),
    )
