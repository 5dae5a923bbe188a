"""Image files: how each format is written."""

from collections.abc import Callable
from pathlib import Path
from typing import BinaryIO

import numpy as np
from numpy.typing import NDArray

from vtray.atomic_file import write_whole
from vtray.image_format import check_format

Pixels = NDArray[np.uint8]


def write_png(pixels: Pixels, file: BinaryIO) -> None:
    """Write pixels, (height, width, 3), as an 8-bit RGB PNG."""
    from PIL import Image as PillowImage

    # Measured on the example scenes: level 1 takes a third of the time of the usual level 6 (15 ms
    # instead of 43 ms), for files a quarter larger.
    PillowImage.fromarray(pixels).save(file, "PNG", compress_level=1)


WRITERS: dict[str, Callable[[Pixels, BinaryIO], None]] = {".png": write_png}
"""How each of the formats is written."""


def write_image(pixels: Pixels, path: Path) -> None:
    """Write pixels, (height, width, 3), in the format that the file's ending names."""
    write = WRITERS[check_format(path)]
    write_whole(path, lambda file: write(pixels, file))
