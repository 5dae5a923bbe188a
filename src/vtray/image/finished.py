"""A picture as it goes to a file: with what is painted on it, where there is something."""

from collections.abc import Collection, Mapping
from pathlib import Path
from typing import Any

from vtray.image.image import Image


def save_finished(
    image: Image,
    path: Path,
    annotate: Mapping[str, Any],
    bits: int | None = None,
    aov: Collection[str] = (),
) -> None:
    """Write a picture to a file.

    Parameters
    ----------
    image, path
        The picture, and the file.
    annotate
        What is painted on it, as keywords of `Image.annotated`; empty for nothing.
    bits, aov
        As for `Image.save`, where nothing is painted on it.

    Raises
    ------
    FigureError
        It cannot be painted.
    OutputError
        It cannot be written.
    """
    if annotate:
        image.annotated(**annotate).save(path)
    else:
        image.save(path, bits=bits, aov=aov)
