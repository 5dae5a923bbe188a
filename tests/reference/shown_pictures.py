"""Pictures that are made again beside those that the docs show."""

from pathlib import Path

import numpy as np
from PIL import Image


def size_of(picture: Path) -> tuple[int, int]:
    """Return the width and the height of a picture."""
    with Image.open(picture) as opened:
        return opened.size


def assert_same_picture(made: Path, shown: Path, has_fewer_samples: bool) -> None:
    """See that two files show the same, but for other fonts, or sines of another processor.

    With fewer samples, edges are coarser, but of 8 x 8 pixels the mean is nearly the same.
    """
    with Image.open(made) as one, Image.open(shown) as two:
        assert one.size == two.size, f"{shown.name} is another; run `make gallery`"
        pixels, others = (np.asarray(item.convert("RGBA"), float) for item in (one, two))
    if has_fewer_samples:
        assert np.abs(pixels - others).mean() < 1.5, f"{shown.name} is another; run `make gallery`"
        pixels, others = means_of_blocks(pixels), means_of_blocks(others)
    assert np.abs(pixels - others).mean() < 0.5, f"{shown.name} is another; run `make gallery`"


def means_of_blocks(pixels: np.ndarray, side: int = 8) -> np.ndarray:
    """Return the means of blocks of pixels, without those that are cut off by the sides."""
    height, width, channels = pixels.shape
    rows, columns = height // side, width // side
    whole = pixels[: rows * side, : columns * side]
    return whole.reshape(rows, side, columns, side, channels).mean(axis=(1, 3))
