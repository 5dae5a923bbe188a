"""Image files: pictures written whole or not at all."""

from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from vtray.base.atomic_file import write_whole
from vtray.base.errors import OutputError
from vtray.image.formats.image_format import find_format, needs_package
from vtray.image.formats.picture import How, Picture

Pixels = NDArray[np.uint8]

USUAL = How()
"""Pixels of 8 bits that no render has made."""


def write_picture(picture: Picture, path: Path, how: How) -> None:
    """Write a picture in the format that the file's ending names.

    Raises
    ------
    OutputError
        If the file cannot be written; what was there before is unchanged.
    """
    form = find_format(path)
    try:
        write_whole(path, lambda file: form.write(picture, how, file))
    except ModuleNotFoundError as error:
        raise OutputError(needs_package(path, error.name or "more")) from error


def write_image(pixels: Pixels, path: Path, how: How = USUAL) -> None:
    """Write pixels, (height, width, 3 or 4), in a format for pixels alone."""
    write_picture(_Plain(pixels), path, how)


class _Plain:
    """Pixels alone, for those formats that hold nothing else."""

    def __init__(self, pixels: Pixels) -> None:
        self._pixels = pixels

    def develop(self, bits: int) -> NDArray[Any]:  # noqa: ARG002
        return self._pixels

    def __getattr__(self, name: str) -> Any:  # noqa: ANN401
        message = f"there are only pixels, no {name}; write a .png file instead"
        raise OutputError(message)
