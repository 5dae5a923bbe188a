"""Pictures that surfaces show: those that Pillow reads, and arrays of NumPy.

What a picture says of itself is looked at before room is made for its pixels.
"""

from pathlib import Path
from typing import TYPE_CHECKING, Any

from vtray.base.errors import SceneError, why_unreadable
from vtray.base.input_file import open_input
from vtray.base.memory import lack_of_memory
from vtray.scene.checks.json_tree import short

if TYPE_CHECKING:
    from numpy.typing import NDArray

    Array = NDArray[Any]

NAME = "image"
"""The array of a .npz file."""

ARRAYS = (".npy", ".npz")
"""How the names of files of arrays end."""

_BYTES = 16
"""Of memory for a pixel, as it is read, checked and packed."""


def read_picture(path: Path) -> "Array":
    """Read the colours of a picture from a file, turned as the camera was held.

    Returns
    -------
    array
        Of a picture, (height, width, 4) of uint8; of a file of arrays, of any size and shape,
        unchecked.

    Raises
    ------
    SceneError
        If it cannot be read; the message follows the name of the file.
    """
    if path.suffix in ARRAYS:
        return read_image_array(path, _BYTES)
    from PIL import Image, UnidentifiedImageError

    try:
        with open_input(path) as file, Image.open(file) as picture:
            check_room(*picture.size, _BYTES)
            return _colors_of(picture)
    except (UnidentifiedImageError, SyntaxError):
        kinds = "a picture such as .png or .jpg, or an array as .npz or .npy"
        raise SceneError(f"holds no picture that can be read; expected {kinds}") from None
    except Image.DecompressionBombError as error:
        remedy = "make it smaller, or give it as an array"
        raise SceneError(f"{short(str(error), 100)}; {remedy}") from None
    except (OSError, ValueError, MemoryError) as error:
        if isinstance(error, OSError) and error.errno is None:
            raise SceneError(f"is damaged or cut short ({short(str(error), 100)})") from None
        raise SceneError(why_unreadable(error, "picture")) from None


def check_room(width: int, height: int, each: int) -> None:
    """Raise SceneError if a picture of so many bytes each pixel does not fit into memory."""
    lack = lack_of_memory(width * height * each)
    if lack:
        shown = f"{width} x {height} pixels"
        raise SceneError(f"{shown} are too large to hold in memory: they need {lack}")


def read_image_array(path: Path, each: int) -> "Array":
    """Read the array of a .npy file, or the one called `image` of a .npz file.

    Parameters
    ----------
    path
        The file.
    each
        Of memory for a pixel, how many bytes.
    """
    from vtray.scene.array_file import read_arrays

    def check(arrays: dict[str, Any], others: list[str]) -> None:
        if NAME not in arrays:
            found = ", ".join(others) or "none"
            raise SceneError(f"expected an array {NAME}, got {short(found, 100)}")
        height, width = (*arrays[NAME].shape, 1, 1)[:2]
        check_room(width, height, each)

    arrays, _ = read_arrays(path, (NAME,), alone=NAME, check=check)
    return arrays[NAME]


def _colors_of(picture: Any) -> "Array":  # noqa: ANN401
    """Return the colours of a picture of Pillow."""
    import numpy as np
    from PIL import Image, ImageOps

    upright = ImageOps.exif_transpose(picture)
    if upright.mode.startswith("I"):  # 16 bits of grey, which Pillow would clip to 8
        grey = np.asarray(upright).clip(0, 65535) // 257
        upright = Image.fromarray(grey.astype(np.uint8))
    return np.asarray(upright.convert("RGBA"))
