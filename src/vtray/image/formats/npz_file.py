"""NumPy's .npz: the arrays of a picture as they are."""

from typing import Any, BinaryIO

from vtray.image.aovs import aov_of
from vtray.image.formats.picture import LONGEST_TEXT, How, Picture

NAME = "provenance"
"""The array, of one text, that says how a picture was made."""


def write_npz(picture: Picture, how: How, file: BinaryIO) -> None:
    """Write light, pixels, alpha unless the background is black, and what else is asked for."""
    import numpy as np

    arrays: dict[str, Any] = {"linear": picture.linear, "pixels": picture.develop(how.bits)}
    if picture.settings.background != "black":
        arrays["alpha"] = picture.alpha
    for name in how.aov:
        arrays[name] = aov_of(picture, name)
    arrays[NAME] = np.array(how.provenance)
    np.savez(file, **arrays)


def read_npz(file: BinaryIO) -> str | None:
    """Return what a .npz file says of how its picture was made, None if it says nothing."""
    from vtray.scene.array_file import read_text

    return read_text(file, NAME, LONGEST_TEXT)
