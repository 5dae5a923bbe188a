"""Two pictures side by side: where and by how much they differ."""

import html
import math
from base64 import b64encode
from dataclasses import dataclass, field
from functools import cached_property
from os import PathLike, fspath
from pathlib import Path
from typing import TYPE_CHECKING, Any, TypeAlias

from vtray.base.errors import UnfitFileError, VtrayError, why_unreadable
from vtray.base.input_file import open_input
from vtray.base.memory import lack_of_memory
from vtray.figures.deep_picture import is_deep, read_deep
from vtray.scene.checks.unknown_names import explain_unknown

if TYPE_CHECKING:
    import numpy as np
    from matplotlib.figure import Figure
    from numpy.typing import NDArray
    from PIL import Image as PillowImage

    from vtray.figures.subject import HasPixels, Pixels

    Channels: TypeAlias = NDArray[Any]
    Picture: TypeAlias = HasPixels | Channels | str | PathLike[str]

OF_LIGHT = (".exr", ".npz")
"""The endings of files in which light and arrays are written, not pixels alone."""

NOT_READ = (
    "it holds light and arrays, and pixels are compared; save the picture as .png, .tif, .webp or "
    ".jpg too"
)

MODES = ("1", "L", "LA", "P", "PA", "RGB", "RGBA")
"""Pillow's names for images in colours of a monitor."""

BYTES_PER_PIXEL = 4 + 4 + 4
"""A picture as Pillow reads it, as RGBA, and as an array; of 16 bits, twice as many."""

DEEP = 65535
"""The largest value of 16 bits."""

LEAST_SHOWN = 64
"""The least value in a difference picture of what is not equal."""


class DiffError(VtrayError, ValueError):
    """Two pictures cannot be compared."""


@dataclass(frozen=True, eq=False)
class Comparison:
    """How two pictures of the same size differ; ``print`` says it, and a notebook shows it.

    Attributes
    ----------
    a, b
        Their pixels, (height, width, 3), what is transparent on black: uint8, or uint16 where one
        of them has 16 bits per channel.
    names
        What they are called: their files, or "a" and "b".
    largest
        The largest difference of a channel, of `maximum`.
    mean
        The mean of the differences of all channels, of `maximum`.
    rmse
        The root of the mean of their squares, of `maximum`.
    differing
        How many pixels are not equal.
    box
        Left, top, right and bottom of the rectangle in which pixels differ, the last two
        exclusive: it is ``a[top:bottom, left:right]``. None if all are equal.
    on_white
        Both on white, where any is transparent: they differ by what they do on black or on white,
        whichever is more.
    """

    a: "Channels" = field(repr=False)
    b: "Channels" = field(repr=False)
    names: tuple[str, str]
    largest: int
    mean: float
    rmse: float
    differing: int
    box: tuple[int, int, int, int] | None
    on_white: "tuple[Channels, Channels] | None" = field(default=None, repr=False)

    @property
    def maximum(self) -> int:
        """The largest value of a channel: 255, or 65535 of 16 bits."""
        return _maximum_of(self.a)

    @property
    def pixels(self) -> int:
        """How many pixels each picture has."""
        return int(self.a.shape[0] * self.a.shape[1])

    @property
    def share(self) -> float:
        """The share of pixels that are not equal, from 0 to 1."""
        return self.differing / self.pixels

    @property
    def psnr(self) -> float:
        """Peak signal-to-noise ratio in decibels, infinite for equal pictures."""
        return 20 * math.log10(self.maximum / self.rmse) if self.rmse else math.inf

    @cached_property
    def flip(self) -> float:
        """Mean FLIP error, as ``vtray-diff`` prints it: 0 for pictures that look equal, at most 1.

        Where any is transparent, it is that on black or on white, whichever is more.

        Raises
        ------
        ExtraError
            The package ``flip-evaluator`` is not installed.
        """
        return self.flip_error("Comparison.flip")[0]

    def flip_error(self, user: str) -> "tuple[float, Pixels]":
        """Return the mean FLIP error, and its map in magma colours; see `flip_error` of ``flip``.

        Parameters
        ----------
        user
            What needs this, for the message if the package is missing.
        """
        from vtray.figures.flip import flip_error

        on_black = flip_error(self.a, self.b, user)
        if self.on_white is None:
            return on_black
        return max(on_black, flip_error(*self.on_white, user), key=lambda found: found[0])

    @cached_property
    def difference(self) -> "Pixels":
        """Where the pictures differ, made visible, uint8, (height, width, 3).

        A channel is 0 where both have the same value. Where they differ by d, it is
        ``64 + 191 * d / largest``: so the least difference can be seen, and the largest is 255.
        """
        import numpy as np

        steps = _steps(self.a, self.b, self.on_white)
        levels = np.arange(self.maximum + 1)
        shown = LEAST_SHOWN + (255 - LEAST_SHOWN) * levels / max(self.largest, 1)
        shown[0] = 0
        table: Pixels = np.minimum(shown, 255).astype(np.uint8)
        return table[steps]

    def __str__(self) -> str:
        """Say it in some lines."""
        height, width = self.a.shape[:2]
        if self.box is None:
            return f"all {self.pixels:,} pixels are equal ({width} x {height})"
        left, top, right, bottom = self.box
        place = f"columns {left} to {right - 1}, rows {top} to {bottom - 1} of {width} x {height}"
        share = f"{100 * self.share:.3g} %"
        return "\n".join(
            [
                f"differing    {self.differing:,} of {self.pixels:,} pixels ({share})",
                f"where        {place}",
                f"largest      {self.largest} of {self.maximum}",
                f"mean         {self.mean:.4g}",
                f"RMSE         {self.rmse:.4g}",
                f"PSNR         {self.psnr:.4g} dB",
            ]
        )

    def figure(self, *, dpi: float | None = None) -> "Figure":
        """Return both pictures and their difference side by side as a Matplotlib figure.

        No pixel of them is changed. Needs Matplotlib: ``pip install matplotlib``.

        Parameters
        ----------
        dpi
            Dots per inch; None for a figure of a usual size.

        Raises
        ------
        ExtraError
            Matplotlib is not installed.
        FigureError
            `dpi` is not right.
        """
        from vtray.figures.figure import compare_figure

        captions = [*self.names, self._caption()]
        return compare_figure(self._shown(), captions, str(self), dpi)

    def _shown(self) -> "list[Pixels]":
        """Return both pictures and their difference with 8 bits per channel."""
        step = self.maximum // 255
        both: list[Pixels] = [(pixels // step).astype("uint8") for pixels in (self.a, self.b)]
        return [*both, self.difference]

    def _caption(self) -> str:
        """Say what the difference picture shows."""
        if not self.largest:
            return "no difference"
        return f"difference, up to {self.largest} of {self.maximum}"

    def _repr_html_(self) -> str:
        """Return pictures, difference and figures as HTML, by which notebooks show them."""
        cells = []
        captions = (*self.names, self._caption())
        for caption, pixels in zip(captions, self._shown(), strict=True):
            source = f"data:image/png;base64,{b64encode(_as_png(pixels)).decode()}"
            text = html.escape(caption)
            image = f'<img src="{source}" alt="{text}" style="max-width: 100%">'
            cells.append(f'<figure style="margin: 0; flex: 1">{image}<div>{text}</div></figure>')
        text = html.escape(str(self))
        return f'<div style="display: flex; gap: 8px">{"".join(cells)}</div><pre>{text}</pre>'


@explain_unknown
def compare(a: "Picture", b: "Picture") -> Comparison:
    """Compare two pictures, channel by channel.

    For what people notice of it, see `Comparison.flip` and the command ``vtray-diff``.

    Parameters
    ----------
    a, b
        Images that were rendered, arrays of pixels, uint8 or uint16 of shape (height, width, 3) or
        with alpha (height, width, 4), or paths of image files. If any has 16 bits per channel, both
        are compared so: of an image that was rendered, its own 16 bits, of others 257 times their
        8. If any is transparent, both are compared on black and on white, and the greater
        difference of each channel counts.

    Returns
    -------
    Comparison
        How they differ.

    Raises
    ------
    DiffError
        They are not pictures with 8 or 16 bits per channel, not of the same size, or a file cannot
        be read.

    Examples
    --------
    >>> print(vtray.compare(image, "before.png"))
    """
    import numpy as np

    (name, first), (other, second) = _take(a, "a"), _take(b, "b")
    check_same_size(first, second, name, other)
    if first.dtype != second.dtype:
        first, second = _deepened(a, first), _deepened(b, second)
    maximum = _maximum_of(first)
    on_black, on_white = (_laid(first, 0), _laid(second, 0)), None
    if 4 in (first.shape[2], second.shape[2]):
        on_white = _laid(first, maximum), _laid(second, maximum)
    steps = _steps(*on_black, on_white)
    counts = np.bincount(steps.ravel(), minlength=maximum + 1)
    levels = np.arange(len(counts))
    total, squares = int(counts @ levels), int(counts @ (levels * levels))
    unequal = np.any(steps, axis=2)
    return Comparison(
        *on_black,
        (name, other),
        int(steps.max(initial=0)),
        total / max(steps.size, 1),
        math.sqrt(squares / max(steps.size, 1)),
        int(unequal.sum()),
        _box(np.asarray(unequal)),
        on_white,
    )


def read_picture(path: Path) -> "Channels":
    """Read an image file, uint8 or uint16, (height, width, 3), or 4 if any of it is transparent.

    Raises
    ------
    DiffError
        The file cannot be read, or is not an image of this kind.
    """
    from PIL import Image as PillowImage

    try:
        with open_input(path) as file, PillowImage.open(file) as image:
            mode, deep = image.mode, is_deep(image)
            lack = lack_of_memory(image.width * image.height * BYTES_PER_PIXEL * (1 + deep))
            if lack:
                message = f"{path}: a picture of {image.width} x {image.height} pixels needs {lack}"
                raise DiffError(message)
            pixels = read_deep(lambda: PillowImage.open(file)) if deep else _read(image)
    except (MemoryError, DiffError):
        raise
    except UnfitFileError as error:
        raise DiffError(f"{path}: {why_unreadable(error, 'picture')}") from None
    except Exception as error:  # a damaged file can raise anything
        other = NOT_READ if path.suffix.lower() in OF_LIGHT else "it is no image, or a damaged one"
        reason = getattr(error, "strerror", None) or other
        message = f"{path}: cannot be read: {reason[:1].lower()}{reason[1:]}"
        raise DiffError(message) from error
    if mode not in MODES or pixels is None:
        kind = f"{mode} with 16, gray or of one transparent colour" if mode in MODES else mode
        message = f"{path}: expected an image of 8 bits per channel, got one of kind {kind}"
        raise DiffError(message)
    return _without_full_alpha(pixels)


def _read(image: "PillowImage.Image") -> "Pixels":
    """Return the pixels of an image of 8 bits per channel."""
    import numpy as np

    return np.asarray(image.convert("RGBA" if image.has_transparency_data else "RGB"))


def check_same_size(a: "Channels", b: "Channels", first: object, second: object) -> None:
    """Raise DiffError if two pictures, of these names, are not of the same size."""
    if a.shape[:2] != b.shape[:2]:
        expected = f"expected an image of {_size(a)} pixels, as {first} is, got {_size(b)}"
        message = f"{second}: {expected}"
        raise DiffError(message)


def _size(pixels: "Channels") -> str:
    return f"{pixels.shape[1]} x {pixels.shape[0]}"


def _take(picture: "Picture", name: str) -> "tuple[str, Channels]":
    """Return the name and the pixels of a picture, as `read_picture` does."""
    import numpy as np

    if isinstance(picture, (str, PathLike)):
        return fspath(picture), read_picture(Path(picture))
    pixels: Any = getattr(picture, "pixels", picture)
    got = f"{type(pixels).__name__}"
    if isinstance(pixels, np.ndarray):
        got = f"{pixels.dtype} {pixels.shape}"
        is_kind = pixels.dtype in (np.uint8, np.uint16)
        if is_kind and pixels.ndim == 3 and pixels.shape[2] in {3, 4}:
            return name, _without_full_alpha(pixels)
    expected = "an Image, a path, or uint8 or uint16 (height, width, 3)"
    message = f"{name}: expected {expected}, got {got}"
    raise DiffError(message)


def _deepened(picture: "Picture", pixels: "Channels") -> "Channels":
    """Return the pixels of a picture with 16 bits per channel: its own ones if it has them."""
    import numpy as np

    if pixels.dtype == np.uint16:
        return pixels
    develop = getattr(picture, "develop", None)
    if develop is not None:
        return _without_full_alpha(develop(16))
    deep: Channels = pixels.astype(np.uint16) * (DEEP // 255)
    return deep


def _maximum_of(pixels: "Channels") -> int:
    """Return the largest value that a channel can have."""
    return 255 if pixels.dtype.itemsize == 1 else DEEP


def _without_full_alpha(pixels: "Channels") -> "Channels":
    """Return pixels without alpha if none of them is transparent."""
    if pixels.shape[2] == 4 and (pixels[..., 3] == _maximum_of(pixels)).all():
        return pixels[..., :3]
    return pixels


def _laid(pixels: "Channels", ground: int) -> "Channels":
    """Return pixels without alpha, those that are transparent laid on a gray."""
    import numpy as np

    if pixels.shape[2] == 3:
        return pixels
    maximum = _maximum_of(pixels)
    wide: Channels = pixels.astype(np.uint16 if maximum == 255 else np.uint32)
    alpha = wide[..., 3:]
    product = wide[..., :3] * alpha + ground * (maximum - alpha)
    laid: Channels = ((product + maximum // 2) // maximum).astype(pixels.dtype)
    return laid


def _steps(
    a: "Channels", b: "Channels", on_white: "tuple[Channels, Channels] | None"
) -> "Channels":
    """Return the differences without sign: on white, too, the greater ones."""
    import numpy as np

    steps = np.where(a > b, a - b, b - a)
    return steps if on_white is None else np.maximum(steps, _steps(*on_white, None))


def _box(unequal: "NDArray[np.bool_]") -> tuple[int, int, int, int] | None:
    """Return left, top, right and bottom of what is true."""
    import numpy as np

    rows, columns = (np.flatnonzero(unequal.any(axis=axis)) for axis in (1, 0))
    if not len(rows):
        return None
    return int(columns[0]), int(rows[0]), int(columns[-1]) + 1, int(rows[-1]) + 1


def _as_png(pixels: "Pixels") -> bytes:
    """Return pixels as a PNG."""
    import io

    from PIL import Image as PillowImage

    buffer = io.BytesIO()
    PillowImage.fromarray(pixels).save(buffer, "PNG")
    return buffer.getvalue()
