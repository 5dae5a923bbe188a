"""A picture saved: checked first, with how it was made, and whole or not at all."""

from collections.abc import Collection
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from vtray.image.formats.image_file import write_image, write_picture
from vtray.image.formats.image_format import check_format
from vtray.image.formats.picture import How, Picture
from vtray.image.provenance import describe
from vtray.scene.arrays import check_spares_data
from vtray.scene.light_types import images_of


def save_picture(picture: Picture, path: Path, bits: int | None, aov: Collection[str]) -> None:
    """Write a picture to a file; see `vtray.Image.save`."""
    write_picture(picture, path, _checked(picture, path, bits, aov))


def save_pixels(pixels: NDArray[Any], picture: Picture, path: Path) -> None:
    """Write pixels of 8 bits that were made from a picture, and how that was made."""
    painted = not np.array_equal(pixels, picture.develop(8))
    write_image(pixels, path, _checked(picture, path, None, (), painted=painted))


def _checked(
    picture: Picture,
    path: Path,
    bits: int | None,
    aov: Collection[str],
    *,
    painted: bool = False,
) -> How:
    """Return how a picture is written, if that can be."""
    check_spares_data(path, [*picture.scene.objects, *images_of(picture.scene.lights)])
    height, width = picture.linear.shape[:2]
    how = check_format(path, bits, aov, picture.settings.background, (width, height))
    return how._replace(provenance=describe(picture, how, painted=painted).to_text())
