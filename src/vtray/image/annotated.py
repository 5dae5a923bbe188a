"""Pictures with annotations painted onto them."""

from os import PathLike
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from vtray.base.errors import OutputError
from vtray.base.file_name import file_name
from vtray.image.formats.image_format import check_annotated_format
from vtray.image.formats.picture import Picture
from vtray.image.formats.png_file import as_png
from vtray.image.saving import save_pixels


class AnnotatedPicture:
    """A picture with annotations, as `Image.annotated` gives it; it shows itself in notebooks.

    Attributes
    ----------
    pixels : array
        uint8, of the shape of the image's pixels.
    """

    def __init__(self, pixels: NDArray[np.uint8], picture: Picture) -> None:
        self.pixels = pixels
        self._picture = picture

    def __repr__(self) -> str:
        height, width = self.pixels.shape[:2]
        return f"<AnnotatedPicture of {width} x {height} pixels>"

    def save(self, path: str | PathLike[str]) -> None:
        """Write the picture to a file, whole or not at all.

        The file also says how the image was made, as one of `Image.save` does.

        Parameters
        ----------
        path
            The file. Its ending chooses the format: ``.png``, also without an ending, ``.tif``,
            ``.jpg`` or ``.webp``.

        Raises
        ------
        OutputError
            The ending is another, the format cannot hold what is asked for, the file holds arrays
            that the scene was read from, or it cannot be written.
        """
        target = Path(file_name(path, OutputError))
        check_annotated_format(target)
        save_pixels(self.pixels, self._picture, target)

    def _repr_png_(self) -> bytes:
        """Return the picture as a PNG, by which notebooks show it."""
        return as_png(self.pixels)
