"""What the pictures of a movie are taken of, one after the other."""

from collections.abc import Callable, Iterator
from dataclasses import dataclass, field
from typing import Any, NamedTuple

from vtray.animation.fading import Opacity
from vtray.animation.frame_errors import of_frame
from vtray.animation.moving import Moved, Moving
from vtray.animation.sources import Source
from vtray.animation.stage import Shot
from vtray.scene.particles.from_objects import as_particles
from vtray.scene.scene import Scene

Make = Callable[[Any, int, Opacity | None], Shot]
"""Makes what a picture is taken of, by what there is for it, its number, and how opaque its objects
are where that is said."""


class Take(NamedTuple):
    """A picture that is to be taken.

    Attributes
    ----------
    k
        The number of the picture, from 0.
    item
        What there is for it: a scene, or particles; None where these are still in their file.
    number
        Its number where it comes from.
    moved
        What is said of it alone.
    origin
        Where it comes from, for messages.
    """

    k: int
    item: Any
    number: int
    moved: Moved
    origin: str

    def shot(self, make: Make) -> Shot:
        """Return what it is taken of."""
        with of_frame(self.origin, self.number):
            found = make(self.item, self.k, self.moved.opacity)._replace(style=self.moved.style)
        if self.moved.camera is not None:
            found = found._replace(camera=self.moved.camera)
        return found if found.frame is not None else found._replace(frame=self.number)


@dataclass(frozen=True)
class Script:
    """What the pictures of a movie are taken of.

    Attributes
    ----------
    source
        What there is for each picture.
    first
        What there is for the first.
    make
        Makes what a picture is taken of.
    moving
        What moves.
    """

    source: Source
    first: Any
    make: Make
    moving: Moving = field(default_factory=Moving)

    @property
    def total(self) -> int:
        """How many pictures there are; 0 if that is not known."""
        return self.source.count or 0

    def shots(self, start: int) -> Iterator[Shot]:
        """Give what pictures are taken of, from one with a number on; called once."""
        for k, item in enumerate(self.source.start(start), start):
            yield self._take(k, item).shot(self.make)

    def first_shot(self) -> Shot:
        """Return what the first picture is taken of."""
        return self._take(0, self.first).shot(self.make)

    def takes(self, start: int) -> Iterator[Take]:
        """Give what others need to take pictures, from one with a number on; called once."""
        for k, item in enumerate(self.source.start(start), start):
            # What goes through a trajectory may give the same object again and again.
            with self.source.of_picture(k):
                found = item if isinstance(self.first, Scene) else as_particles(item)
            yield self._take(k, found)

    def takes_in_file(self, start: int) -> Iterator[Take]:
        """Give the same for those who read the file themselves."""
        assert self.source.count is not None  # noqa: S101 - that of a file is known
        for k in range(start, self.source.count):
            yield self._take(k, None)

    def take_again(self, k: int) -> Take:
        """Return a picture of a file with its particles."""
        assert self.source.some is not None  # noqa: S101 - a file can be read again
        (item,) = self.source.some([k])
        return self._take(k, item)

    def _take(self, k: int, item: Any) -> Take:  # noqa: ANN401
        return Take(k, item, self.source.number(k), self.moving(k), self.source.origin)
