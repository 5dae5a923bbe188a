"""The picture that a render gives."""

import io
from collections.abc import Mapping
from dataclasses import dataclass, field
from os import PathLike
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from vtray.image_file import write_image, write_png


@dataclass(frozen=True, eq=False)
class Image:
    """A rendered picture.

    Attributes
    ----------
    linear
        Light before exposure, float64, (height, width, 3): the sums of cosine, Lambert
        coefficient, intensity and colour (0 to 255).
    pixels
        Light after exposure, uint8, (height, width, 3).
    stats
        How the picture was made: seconds for ``"build"``, ``"pack"``, ``"compile"``, ``"trace"``
        and ``"develop"``; the number of ``"rays"`` cast; of the hierarchy, its ``"nodes"``, its
        ``"depth"``, and its ``"memory"`` in bytes.
    """

    linear: NDArray[np.float64]
    pixels: NDArray[np.uint8]
    stats: Mapping[str, float] = field(default_factory=dict)

    def save(self, path: str | PathLike[str]) -> None:
        """Write the picture to a file, whole or not at all.

        Parameters
        ----------
        path
            The file. Its ending chooses the format: ``.png``, also without an ending.

        Raises
        ------
        OutputError
            The ending is unknown, or the file cannot be written.
        """
        write_image(self.pixels, Path(path))

    def _repr_png_(self) -> bytes:
        """Return the picture as a PNG, by which notebooks show it."""
        buffer = io.BytesIO()
        write_png(self.pixels, buffer)
        return buffer.getvalue()
