"""The colours of a pattern that is a picture: an array, or a file that holds it."""

import os
from pathlib import Path
from typing import TYPE_CHECKING, Any

from vtray.base.errors import SceneError

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

    Pixels = NDArray[np.uint8]

WORDS = "a uint8 array of shape (height, width, 3 or 4), or the path of a picture"


class PatternImage:
    """A picture that a surface shows.

    Two of the same pixels are equal.

    Parameters
    ----------
    pixels : array (height, width, 3 or 4)
        Red, green and blue, 0 to 255, and maybe how opaque each pixel is; uint8.
    place : str, optional
        What messages begin with; with "", they begin with what was expected.

    Attributes
    ----------
    pixels : array (height, width, 4)
        The same, always with the last; a copy, read-only.
    source : Path or None
        The file that it was read from.
    """

    __slots__ = ("pixels", "source")

    pixels: "Pixels"
    source: Path | None

    def __init__(self, pixels: object, place: str = "PatternImage") -> None:
        try:
            self.pixels = _checked(pixels)
        except SceneError as problem:
            raise SceneError(f"{place}: {problem}" if place else str(problem)) from None
        self.source = None

    def read_from(self, source: Path) -> "PatternImage":
        """Return this picture, which from now on remembers the file that it was read from."""
        self.source = source.absolute()  # the folder may be changed
        return self

    def sources(self) -> list[Path]:
        """Return the file that it was read from, in a list; empty if it comes from code."""
        return [self.source] if self.source else []

    def __reduce__(self) -> tuple[Any, ...]:
        return _rebuild, (self.pixels, self.source)

    def __eq__(self, other: object) -> bool:
        if not isinstance(other, PatternImage):
            return NotImplemented
        import numpy as np

        return self is other or bool(np.array_equal(self.pixels, other.pixels))

    def __hash__(self) -> int:
        return hash(self.pixels.shape)

    def __repr__(self) -> str:
        return f"PatternImage(<{self.pixels.dtype} {self.pixels.shape}>)"


def _rebuild(pixels: "Pixels", source: Path | None) -> PatternImage:
    """Make a picture again after copying or pickling."""
    made = PatternImage(pixels)
    made.source = source
    return made


def pattern_image(given: object, place: str) -> PatternImage:
    """Return a picture given in code: as it is, as an array, or as the path of a file.

    Parameters
    ----------
    given
        The picture, an array (height, width, 3 or 4) of uint8, or a path.
    place
        What messages begin with.

    Raises
    ------
    SceneError
        If it is not right, or cannot be read.
    """
    if isinstance(given, PatternImage):
        return given
    if not isinstance(given, (str, os.PathLike)):
        return PatternImage(given, place)
    return read_pattern_image(Path(os.fsdecode(given)), f"{place}: {os.fsdecode(given)}")


def read_pattern_image(path: Path, place: str) -> PatternImage:
    """Return the picture in a file; messages begin with the place."""
    from vtray.scene.pictures.picture_file import read_picture

    try:
        pixels = read_picture(path)
    except SceneError as problem:
        raise SceneError(f"{place}: {problem}") from None
    return PatternImage(pixels, place).read_from(path)


def _checked(given: object) -> "Pixels":
    """Return an array of colours as a copy that nobody can change."""
    import numpy as np

    from vtray.scene.checks.columns import read_only
    from vtray.scene.checks.given_array import UNCONVERTED, is_masked, show_array

    has_array = hasattr(given, "__array__") or isinstance(given, (list, tuple))
    try:
        array = np.asarray(given) if has_array else np.zeros(0, object)
    except UNCONVERTED:
        array = np.zeros(0, object)
    is_picture = array.ndim == 3 and array.shape[2] in (3, 4) and not is_masked(given)
    if not (is_picture and array.dtype == np.uint8):
        remedy = "turn it into numbers up to 255, as by (255 * image).round().astype(numpy.uint8)"
        hint = f"; {remedy}" if is_picture and array.dtype.kind == "f" else ""
        raise SceneError(f"expected {WORDS}, got {show_array(given)}{hint}")
    if array.size == 0:
        raise SceneError(f"expected at least one pixel, got shape {array.shape}")
    pixels = np.full((*array.shape[:2], 4), 255, np.uint8)
    pixels[..., : array.shape[2]] = array
    return read_only(pixels)
