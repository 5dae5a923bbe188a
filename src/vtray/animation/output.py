"""Where a movie goes: a file, or numbered pictures; and where these are until it is whole."""

import os
from collections.abc import Callable, Collection, Iterable, Iterator, Mapping
from contextlib import contextmanager, suppress
from pathlib import Path
from types import MappingProxyType
from typing import NamedTuple

from vtray.animation.feed import Feed
from vtray.animation.gif_file import write_gif
from vtray.animation.movie_names import NUMBER, is_numbered
from vtray.animation.mp4_file import find_ffmpeg, write_mp4
from vtray.animation.webp_file import write_webp
from vtray.base.atomic_file import check_spares, check_writable
from vtray.base.errors import OutputError
from vtray.base.number import number_of
from vtray.image.formats.image_format import check_annotated_format, check_format

Write = Callable[[Path, Feed, float], None]


class MovieFormat(NamedTuple):
    """A format of movies, and what it can hold.

    Attributes
    ----------
    write
        Writes a movie: called with a file, its pictures, and how many there are in a second.
    alpha
        Whether a pixel may be transparent.
    slowest, fastest
        How many pictures in a second it can hold at least, and how many at the most it can tell
        apart, or programs show.
    """

    write: Write
    alpha: bool
    slowest: float
    fastest: float


MOVIES: Mapping[str, MovieFormat] = MappingProxyType(
    {
        ".mp4": MovieFormat(write_mp4, alpha=False, slowest=0.001, fastest=1000),
        ".gif": MovieFormat(write_gif, alpha=False, slowest=0.002, fastest=50),
        ".webp": MovieFormat(write_webp, alpha=True, slowest=0.0001, fastest=1000),
    }
)
"""The formats of movies by the endings of files."""

EXPECTED = f"{', '.join(MOVIES)}, or numbered pictures such as frames/%04d.png"


def is_movie(path: Path) -> bool:
    """Tell whether a name can be that of a movie, or of numbered pictures."""
    return is_numbered(path) or path.suffix.lower() in MOVIES


class Output:
    """Where a movie goes.

    Parameters
    ----------
    path
        The file, or a name with the place of a number, such as ``frames/%04d.png``.

    Raises
    ------
    OutputError
        It is no name of a movie.

    Attributes
    ----------
    path : Path
        As given.
    format : MovieFormat or None
        How the movie is written; None for numbered pictures.
    folder : Path
        Where pictures are until the movie is whole, or stay if they are what is wanted.
    record : Path
        The file in that folder that says what these pictures are.
    """

    def __init__(self, path: Path) -> None:
        self.path = path
        if is_numbered(path):
            if "%" in NUMBER.sub("", path.name, count=1):
                message = f"{path}: expected one number such as %04d in the name, and no other %"
                raise OutputError(message)
            self.format = None
            self.folder = path.parent
            self.record = path.with_name(f".{NUMBER.sub('', path.name)}.vtray-movie")
            return
        self.format = MOVIES.get(path.suffix.lower())
        if self.format is None:
            message = f"{path}: is no movie by its name; expected {EXPECTED}"
            raise OutputError(message)
        self.folder = path.with_name(f"{path.name}.frames")
        self.record = self.folder / "movie.json"

    def name(self, k: int) -> Path:
        """Return the file of a picture, by its number from 0."""
        if self.format is None:
            before, number, after = self._parts()
            return self.folder / f"{before}{number % k}{after}"
        return self.folder / f"{k:06d}.png"

    def _parts(self) -> tuple[str, str, str]:
        """Return what stands before the number of a picture, how that is written, and the rest."""
        found = NUMBER.search(self.path.name)
        assert found is not None  # noqa: S101 - that is how it is known to be numbered
        return self.path.name[: found.start()], found[0], self.path.name[found.end() :]

    def check(
        self,
        fps: float,
        bits: int | None = None,
        aov: Collection[str] = (),
        *,
        is_annotated: bool = False,
    ) -> None:
        """Raise an error, before any work is done, if the movie cannot be written.

        Parameters
        ----------
        fps
            Pictures in a second.
        bits, aov
            What files of pictures hold, as for `vtray.Image.save`.
        is_annotated
            Whether something is painted on pictures.
        """
        if self.format is None:
            if is_annotated:
                check_annotated_format(self.name(0), bits)
            check_format(self.name(0), bits, aov)
            with self._folder_made():
                check_writable(self.name(0))
            return
        if aov or (bits is not None and number_of(bits) != 8):
            what = "aov" if aov else f"bits {bits}"
            message = (
                f"{self.path}: {what}: movies have 8 bits and colours alone; expected {EXPECTED}"
            )
            raise OutputError(message)
        if not self.format.slowest <= fps <= self.format.fastest:
            limit = f"at most {self.format.fastest:g}"
            if fps < self.format.slowest:
                limit = f"at least {self.format.slowest:g}"
            message = f"{self.path}: fps: expected {limit} for this format, got {fps:g}"
            raise OutputError(message)
        if self.path.suffix.lower() == ".mp4":
            find_ffmpeg(self.path)
        check_writable(self.path)

    def check_spares(self, inputs: Iterable[str | os.PathLike[str] | None]) -> None:
        """Raise OutputError if the movie, or a picture of it, would destroy a file that is read.

        Parameters
        ----------
        inputs
            The files; None for one that there is not.
        """
        for given in inputs:
            if given is None:
                continue
            source = Path(given)
            for name in dict.fromkeys((source, Path(os.path.realpath(source)))):
                written = self._written_as(name)
                if written is not None:
                    remedy = "choose another name for the movie"
                    check_spares(written, [source], "is what the movie is made from", remedy)

    def _written_as(self, name: Path) -> Path | None:
        """Return what is written, if that may be a file of a name; None if it cannot."""
        if self.format is not None:
            return self.path
        before, _, after = self._parts()
        digits = name.name.removeprefix(before).removesuffix(after)
        return self.name(int(digits)) if digits.isascii() and digits.isdigit() else None

    def check_background(self, background: object) -> None:
        """Raise OutputError if a background is transparent, and the format cannot hold that."""
        if self.format is None:
            check_format(self.name(0), background=background)
        elif background == "transparent" and not self.format.alpha:
            message = (
                f"{self.path}: background: this format cannot be transparent; "
                ".webp and numbered .png can, or choose a color as the background"
            )
            raise OutputError(message)

    @contextmanager
    def _folder_made(self) -> Iterator[None]:
        """Have the folder of numbered pictures within, if that is all that is missing."""
        if self.folder.is_dir():
            yield
            return
        try:
            self.folder.mkdir()
        except OSError as error:
            reason = (error.strerror or str(error)).lower()
            message = f"{self.path}: the folder {self.folder} cannot be made: {reason}"
            raise OutputError(message) from None
        try:
            yield
        finally:  # it is made again for the first picture
            with suppress(OSError):
                self.folder.rmdir()
