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

if TYPE_CHECKING:
    import numpy as np
    from matplotlib.figure import Figure
    from numpy.typing import NDArray

    from vtray.figures.subject import HasPixels, Pixels

    Picture: TypeAlias = HasPixels | Pixels | str | PathLike[str]

MODES = ("1", "L", "LA", "P", "PA", "RGB", "RGBA")
"""Pillow's names for images of at most 8 bits per channel, in colours of a monitor."""


BYTES_PER_PIXEL = 4 + 4 + 3
"""A picture as Pillow reads it, as RGB, and as an array."""

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
        Their pixels, uint8, (height, width, 3).
    names
        What they are called: their files, or "a" and "b".
    largest
        The largest difference of a channel, of 255.
    mean
        The mean of the differences of all channels, of 255.
    rmse
        The root of the mean of their squares, of 255.
    differing
        How many pixels are not equal.
    box
        Left, top, right and bottom of the rectangle in which pixels differ, the last two
        exclusive: it is ``a[top:bottom, left:right]``. None if all are equal.
    """

    a: "Pixels" = field(repr=False)
    b: "Pixels" = field(repr=False)
    names: tuple[str, str]
    largest: int
    mean: float
    rmse: float
    differing: int
    box: tuple[int, int, int, int] | None

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
        return 20 * math.log10(255 / self.rmse) if self.rmse else math.inf

    @cached_property
    def flip(self) -> float:
        """Mean FLIP error, as ``vtray-diff`` prints it: 0 for pictures that look equal, at most 1.

        Raises
        ------
        ExtraError
            The package ``flip-evaluator`` is not installed.
        """
        from vtray.figures.flip import flip_error

        return flip_error(self.a, self.b, "Comparison.flip")[0]

    @cached_property
    def difference(self) -> "Pixels":
        """Where the pictures differ, made visible, uint8, (height, width, 3).

        A channel is 0 where both have the same value. Where one is greater by d, it is
        ``64 + 191 * d / largest``: so the least difference can be seen, and the largest is 255.
        """
        import numpy as np

        steps = _steps(self.a, self.b)
        shown = LEAST_SHOWN + (255 - LEAST_SHOWN) * np.arange(256) / max(self.largest, 1)
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
                f"largest      {self.largest} of 255",
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
        return compare_figure([self.a, self.b, self.difference], captions, str(self), dpi)

    def _caption(self) -> str:
        """Say what the difference picture shows."""
        return f"difference, up to {self.largest} of 255" if self.largest else "no difference"

    def _repr_html_(self) -> str:
        """Return pictures, difference and figures as HTML, by which notebooks show them."""
        cells = []
        captions = (*self.names, self._caption())
        for caption, pixels in zip(captions, (self.a, self.b, self.difference), strict=True):
            source = f"data:image/png;base64,{b64encode(_as_png(pixels)).decode()}"
            text = html.escape(caption)
            image = f'<img src="{source}" alt="{text}" style="max-width: 100%">'
            cells.append(f'<figure style="margin: 0; flex: 1">{image}<div>{text}</div></figure>')
        text = html.escape(str(self))
        return f'<div style="display: flex; gap: 8px">{"".join(cells)}</div><pre>{text}</pre>'


def compare(a: "Picture", b: "Picture") -> Comparison:
    """Compare two pictures, channel by channel.

    For what people notice of it, see `Comparison.flip` and the command ``vtray-diff``.

    Parameters
    ----------
    a, b
        Images that were rendered, arrays of pixels, uint8 of shape (height, width, 3) or with
        alpha (height, width, 4), or paths of image files. What is transparent lies on black.

    Returns
    -------
    Comparison
        How they differ.

    Raises
    ------
    DiffError
        They are not pictures with 8 bits per channel, not of the same size, or a file cannot be
        read.

    Examples
    --------
    >>> print(vtray.compare(image, "before.png"))
    """
    import numpy as np

    (name, first), (other, second) = _take(a, "a"), _take(b, "b")
    check_same_size(first, second, name, other)
    steps = _steps(first, second)
    counts = np.bincount(steps.ravel(), minlength=256)
    levels = np.arange(len(counts))
    total, squares = int(counts @ levels), int(counts @ (levels * levels))
    unequal = np.any(steps, axis=2)
    return Comparison(
        first,
        second,
        (name, other),
        int(steps.max(initial=0)),
        total / max(steps.size, 1),
        math.sqrt(squares / max(steps.size, 1)),
        int(unequal.sum()),
        _box(np.asarray(unequal)),
    )


def read_picture(path: Path) -> "Pixels":
    """Read an image file as 8-bit RGB; what is transparent lies on black.

    Raises
    ------
    DiffError
        The file cannot be read, or is not an image of this kind.
    """
    import numpy as np
    from PIL import Image as PillowImage

    try:
        with open_input(path) as file, PillowImage.open(file) as image:
            mode = image.mode
            lack = lack_of_memory(image.width * image.height * BYTES_PER_PIXEL)
            if lack:
                message = f"{path}: a picture of {image.width} x {image.height} pixels needs {lack}"
                raise DiffError(message)
            if not image.has_transparency_data:
                picture = image.convert("RGB")
            else:
                picture = PillowImage.new("RGB", image.size)
                picture.paste(image, mask=image.convert("RGBA").getchannel("A"))
    except (MemoryError, DiffError):
        raise
    except UnfitFileError as error:
        raise DiffError(f"{path}: {why_unreadable(error, 'picture')}") from None
    except Exception as error:  # a damaged file can raise anything
        reason = getattr(error, "strerror", None) or "it is no image, or a damaged one"
        message = f"{path}: cannot be read: {reason[:1].lower()}{reason[1:]}"
        raise DiffError(message) from error
    if mode not in MODES:
        message = f"{path}: expected an image of 8 bits per channel, got one of kind {mode}"
        raise DiffError(message)
    return np.asarray(picture)


def check_same_size(a: "Pixels", b: "Pixels", first: object, second: object) -> None:
    """Raise DiffError if two pictures, of these names, are not of the same size."""
    if a.shape != b.shape:
        expected = f"expected an image of {_size(a)} pixels, as {first} is, got {_size(b)}"
        message = f"{second}: {expected}"
        raise DiffError(message)


def _size(pixels: "Pixels") -> str:
    return f"{pixels.shape[1]} x {pixels.shape[0]}"


def _take(picture: "Picture", name: str) -> "tuple[str, Pixels]":
    """Return the name and the pixels of a picture, uint8, (height, width, 3)."""
    import numpy as np

    if isinstance(picture, (str, PathLike)):
        return fspath(picture), read_picture(Path(picture))
    pixels: Any = getattr(picture, "pixels", picture)
    got = f"{type(pixels).__name__}"
    if isinstance(pixels, np.ndarray):
        got = f"{pixels.dtype} {pixels.shape}"
        if pixels.dtype == np.uint8 and pixels.ndim == 3 and pixels.shape[2] in {3, 4}:
            return name, _on_black(pixels)
    message = f"{name}: expected an Image, a path, or uint8 (height, width, 3), got {got}"
    raise DiffError(message)


def _on_black(pixels: "Pixels") -> "Pixels":
    """Return pixels without alpha, those that are transparent laid on black."""
    import numpy as np

    if pixels.shape[2] == 3:
        return pixels
    product = pixels[..., :3].astype(np.uint16) * pixels[..., 3:]
    return ((product + 127) // 255).astype(np.uint8)


def _steps(a: "Pixels", b: "Pixels") -> "Pixels":
    """Return the differences without sign."""
    import numpy as np

    return np.where(a > b, a - b, b - a)


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
