"""The picture of a sky: an array of light, or a file that holds it."""

import os
from collections.abc import Mapping
from pathlib import Path
from types import MappingProxyType
from typing import TYPE_CHECKING, Any, Self

from vtray.base.errors import SceneError
from vtray.scene.array_holder import ArrayHolder
from vtray.scene.checks.checked import make_unchecked

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

    Pictures = NDArray[np.float32]
else:
    Pictures = Any

CHANNELS = ("red", "green", "blue")

_MOST = 3.4028234663852886e38
"""The largest float32."""


class SkyImage(ArrayHolder, frozen=True, eq=False, dict=True):
    """The light of a sky from all around, as a map of the globe: from above to below, all around.

    The middle of the first row is straight above but for half a row, that of the last straight
    below; columns go once around, from left to right as seen from within.

    Attributes
    ----------
    pixels : array (height, width, 3)
        Red, green and blue, ≥ 0, 1 for the radiance of the sky; float32, a copy, read-only.
    """

    pixels: Pictures

    COLUMNS = MappingProxyType({})

    @classmethod
    def from_arrays(cls, values: Mapping[str, object], place: str) -> Self:
        """Make a picture as calling the class does, as `ArrayHolder.from_arrays` says."""
        pixels = _checked(values["pixels"], place.rstrip("."))
        made: Self = make_unchecked(cls, pixels=pixels)
        return made

    @property
    def peak(self) -> float:
        """The largest channel."""
        return float(self.pixels.max())

    def arrays(self) -> "list[NDArray[Any]]":
        """Return the pixels."""
        return [self.pixels]

    def _check_again(self, place: str) -> None:
        """Do nothing: nobody can change the copy."""

    def __copy__(self) -> Self:
        return self

    def __len__(self) -> int:
        return len(self.pixels)

    __hash__ = None  # type: ignore[assignment]  # arrays are compared

    def __eq__(self, other: object) -> bool:
        if not isinstance(other, SkyImage):
            return NotImplemented
        import numpy as np

        return bool(np.array_equal(self.pixels, other.pixels))

    def __repr__(self) -> str:
        return f"SkyImage(<{self.pixels.dtype} {self.pixels.shape}>)"


def sky_image(given: object, place: str) -> SkyImage:
    """Return a picture given in code: as it is, as an array, or as the path of a file.

    Parameters
    ----------
    given
        The picture, an array (height, width, 3) of floats, or a path.
    place
        What messages begin with.

    Raises
    ------
    SceneError
        If it is not right, or cannot be read.
    """
    if isinstance(given, SkyImage):
        return given
    if isinstance(given, (str, os.PathLike)):
        return read_sky_image(Path(os.fsdecode(given)), f"{place}: {os.fsdecode(given)}")
    return SkyImage.from_arrays({"pixels": given}, place)


def read_sky_image(path: Path, place: str) -> SkyImage:
    """Return the picture in a file; messages begin with the place."""
    from vtray.scene.pictures.sky_file import read_sky

    try:
        pixels = read_sky(path)
    except SceneError as problem:
        raise SceneError(f"{place}: {problem}") from None
    return SkyImage.from_arrays({"pixels": pixels}, place).read_from(path)


def _checked(given: object, place: str) -> Pictures:
    """Return an array of light as a copy that nobody can change."""
    import numpy as np

    from vtray.scene.checks.columns import read_only
    from vtray.scene.checks.given_array import UNCONVERTED, is_masked, show_array

    words = "an array of floats of shape (height, width, 3), or the path of a picture"
    has_array = hasattr(given, "__array__") or isinstance(given, (list, tuple))
    try:
        array = np.asarray(given) if has_array else np.zeros(0, object)
    except UNCONVERTED:
        array = np.zeros(0, object)
    if array.dtype.kind in "iu":
        remedy = "divide whole numbers by the one that stands for 1, such as 255"
        raise SceneError(f"{place}: expected {words}, got {show_array(given)}; {remedy}")
    if array.dtype.kind != "f" or array.ndim != 3 or array.shape[2] != 3 or is_masked(given):
        raise SceneError(f"{place}: expected {words}, got {show_array(given)}")
    if array.size == 0:
        raise SceneError(f"{place}: expected at least one pixel, got shape {array.shape}")
    _check_numbers(array, place)
    return read_only(array.astype(np.float32, order="C"))


def _check_numbers(array: Any, place: str) -> None:  # noqa: ANN401
    """Raise SceneError if a number of a picture is not right, or if all are 0."""
    import numpy as np

    # NaN is the least and the greatest where there is one.
    least, greatest = float(array.min()), float(array.max())
    if not (least >= 0.0 and greatest <= _MOST):
        is_right = (array >= 0.0) & (array <= _MOST)
        row, column, channel = (int(k[0]) for k in np.nonzero(~is_right))
        where = f"row {row}, column {column}, {CHANNELS[channel]}"
        value = float(array[row, column, channel])
        words, remedy = "a finite number ≥ 0", "mend it in the program that made the picture"
        if value > 0.0:
            words, remedy = "a number up to 3.4e38", "clip it, as by numpy.minimum(image, 1e6)"
        elif value < 0.0:
            remedy = "clip it, as by numpy.maximum(image, 0)"
        raise SceneError(f"{place}: {where}: expected {words}, got {value:g}; {remedy}")
    if float(np.float32(greatest)) == 0.0:
        remedy = "leave out the sky if it shall give no light"
        raise SceneError(f"{place}: expected some light, got a picture that is black; {remedy}")
