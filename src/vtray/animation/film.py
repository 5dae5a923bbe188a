"""How a movie is made, and what there is of it."""

from collections.abc import Callable
from dataclasses import dataclass, field
from typing import Any

from vtray.animation.done import Done
from vtray.animation.feed import Feed
from vtray.animation.output import Output
from vtray.animation.stage import Look, Shot, Stage, Warn
from vtray.base.errors import OutputError
from vtray.scene.default_light import settings_of

Progress = Callable[[str, int, int], None]


@dataclass
class Film:
    """How a movie is made, and what there is of it.

    Attributes
    ----------
    output
        Where the movie goes.
    fps
        Pictures in a second.
    look
        How pictures are taken.
    resume
        Whether to go on from pictures that an earlier run has done.
    progress
        Called with ``"frames"``, how many pictures are done, and how many there are, 0 if that is
        not known.
    on_warning
        Called with a line about something that is noticed.
    client
        A client of the Dask cluster whose workers take pictures; None if that is done here.
    done
        The pictures that are done; None until that is looked at.
    feed
        The same on their way into the movie.
    """

    output: Output
    fps: float
    look: Look = field(default_factory=Look)
    resume: bool = False
    progress: Progress | None = None
    on_warning: Warn | None = None
    client: Any = None
    done: Done | None = None
    feed: Feed = field(default_factory=Feed)
    _shape: tuple[int, ...] = ()
    _warned: set[str] = field(default_factory=set)

    def begin(self) -> Done:
        """Return the pictures that are done, which from here on are this run's own."""
        marks = repr(sorted(self.look.annotate.items()))
        self.done = Done(self.output, marks, resume=self.resume)
        self._feed_done(self.done)
        return self.done

    def accept(self, k: int) -> None:
        """Say that the file of a picture is written."""
        assert self.done is not None  # noqa: S101 - made before any picture
        self.done.add(k)
        self._feed_done(self.done)

    def tell(self, count: int, total: int) -> None:
        """Show how many pictures there are, of how many."""
        if self.progress is not None:
            self.progress("frames", count, total)

    def warn(self, message: str) -> None:
        """Warn once, not for each picture."""
        if message not in self._warned:
            self._warned.add(message)
            if self.on_warning is not None:
                self.on_warning(message)

    def check_last(self, stage: Stage, shot: Shot | None) -> None:
        """Raise OutputError if the last picture that is done was not taken of a shot."""
        if shot is None:
            raise OutputError(f"{self.output.path}: more pictures are done than there are")
        assert self.done is not None  # noqa: S101 - made before any picture
        scene = stage.set(shot)
        settings = settings_of(scene, self.look.settings)
        self.done.check_last(scene, settings, stage.style(scene), holds=self.look.holds(scene))

    def check_size(self, shape: tuple[int, ...]) -> None:
        """Raise OutputError if a picture is not as large as the first one."""
        self._shape = self._shape or shape
        if self.output.format is not None and shape != self._shape:
            (height, width), (h, w) = shape[:2], self._shape[:2]
            words = f"expected pictures of {w} x {h} pixels as the first, got {width} x {height}"
            raise OutputError(f"{self.output.path}: {words}; give a size for all")

    def _feed_done(self, done: Done) -> None:
        """Let the pictures into the movie that are done, in their order."""
        while self.feed.count < done.count:
            self.feed.add(self.output.name(self.feed.count))
