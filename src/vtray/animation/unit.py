"""What a worker of a cluster has of a movie, and what it does: it takes pictures.

It travels to each worker once. While a picture is traced, a worker of several threads reads and
makes the next scene, or packs the last picture.
"""

import pickle
import tempfile
from pathlib import Path
from threading import Lock
from typing import Any, NamedTuple

from vtray.animation.frame_errors import of_frame
from vtray.animation.script import Make, Take
from vtray.animation.stage import Common, Look, Stage
from vtray.animation.stored import Stored
from vtray.base.errors import RenderError
from vtray.base.version import __version__
from vtray.scene.scene import Scene


class Taken(NamedTuple):
    """A picture that was taken.

    Attributes
    ----------
    content
        The file.
    shape
        Height, width and channels.
    white
        The light that becomes white in all others, if this one decides that.
    warnings
        What was noticed.
    """

    content: bytes
    shape: tuple[int, ...]
    white: float | None
    warnings: list[str]


class Unit:
    """Takes pictures of a movie.

    Parameters
    ----------
    look
        How they are taken.
    make
        Makes what a picture is taken of.
    common
        What all pictures take from the first.
    ending
        That of the names of files.
    stored
        The file that frames are read from, if there is one.
    """

    def __init__(
        self,
        look: Look,
        make: Make,
        common: Common,
        ending: str,
        stored: Stored | None,
    ) -> None:
        self._given = look, make, common, ending, stored
        self._stage = Stage(look, common)
        self._lock = Lock()

    def __reduce__(self) -> tuple[Any, ...]:
        return Unit, self._given

    def take(self, take: Take, white: float | None) -> Taken | None:
        """Return a picture; None if its frame is in a file that is not seen from here.

        Parameters
        ----------
        take
            What it is taken of.
        white
            The light that becomes white in all pictures; None if that is not known yet.
        """
        look, make, _, ending, stored = self._given
        if take.item is None:
            assert stored is not None  # noqa: S101 - or there would be an item
            take = take._replace(item=stored.read(take.number))
            if take.item is None:
                return None
        shot = take.shot(make)
        warnings: list[str] = []
        with of_frame(take.origin, take.number), self._lock:
            keywords = look.painted(shot)
            threads = look.threads or threads_here()
            image, found = self._stage.take(shot, white, warnings.append, threads)
        with tempfile.TemporaryDirectory() as folder:
            path = Path(folder, f"picture{ending}")
            look.save(image, keywords, path)
            return Taken(path.read_bytes(), image.linear.shape, found, warnings)


def take_picture(
    version: str, unit: Unit, packed: bytes, scene: Scene | None, white: float | None
) -> Taken | None:
    """Do the task of a cluster: take a picture.

    Parameters
    ----------
    version
        The version of vtray that asks for it.
    unit, white
        See `Unit.take`.
    packed
        The same for what is to be taken, as a pickle.
    scene
        The scene of all pictures, if there is but one.

    Raises
    ------
    RenderError
        Here is another version.
    """
    if version != __version__:
        raise RenderError(f"a worker has vtray {__version__}, and this is {version}")
    take: Take = pickle.loads(packed)
    return unit.take(take if scene is None else take._replace(item=scene), white)


def unpacked(packed: bytes) -> Any:  # noqa: ANN401
    """Do the task of a cluster: keep what is in a pickle where it is needed."""
    return pickle.loads(packed)


def threads_here() -> int:
    """Return how many threads the worker that runs a task has."""
    from distributed import get_worker

    return int(get_worker().state.nthreads)
