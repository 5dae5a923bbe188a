"""Pictures of skies: .exr, .hdr, .png and .jpg, read by OpenImageIO, and arrays of NumPy.

What a picture says of itself is looked at before room is made for its pixels.
"""

import io
import re
from pathlib import Path
from typing import TYPE_CHECKING, Any

from vtray.base.errors import SceneError, why_unreadable
from vtray.base.extras import need
from vtray.base.input_file import is_given, open_input
from vtray.base.memory import lack_of_memory
from vtray.scene.checks.json_tree import short

if TYPE_CHECKING:
    from numpy.typing import NDArray

    Array = NDArray[Any]

NAME = "image"
"""The array of a .npz file."""

ENDINGS = (".exr", ".hdr", ".png", ".jpg", ".jpeg", ".npy", ".npz")

_ARRAYS = (".npy", ".npz")

_BYTES = 64
"""Of memory for a pixel, as it is read, checked, and turned into a table."""

_BEGINNINGS = {
    ".exr": rb"\x76\x2f\x31\x01",
    ".hdr": rb"#\?(RADIANCE|RGBE)",
    ".png": rb"\x89PNG\r\n\x1a\n",
    ".jpg": rb"\xff\xd8\xff",
    ".jpeg": rb"\xff\xd8\xff",
}


def read_sky(path: Path) -> "Array":
    """Read the light of a sky from a file.

    Numbers of .exr and .hdr files are light; whole numbers of others are divided by the largest
    there can be, 255 or 65535, so that they show as they are.

    Returns
    -------
    array
        Floats of any size and shape, unchecked.

    Raises
    ------
    SceneError
        If it cannot be read; the message follows the name of the file.
    ExtraError
        If OpenImageIO is not installed.
    """
    ending = path.suffix
    if ending not in ENDINGS:
        raise SceneError(f"expected a name that ends with {', '.join(ENDINGS)}")
    if ending in _ARRAYS:
        return _read_array(path)
    try:
        with open_input(path) as file:
            beginning = file.read(16)
            size = file.seek(0, io.SEEK_END)
    except (OSError, ValueError, MemoryError) as error:
        raise SceneError(why_unreadable(error, f"{ending} file")) from None
    if is_given(path) or not re.match(_BEGINNINGS[ending], beginning):
        problem = "holds something else" if size else "is empty"
        raise SceneError(f"{problem}; expected a {ending} file")
    return _read_picture(path)


def _read_array(path: Path) -> "Array":
    """Read the array of a .npy file, or the one called `image` of a .npz file."""
    from vtray.scene.files.array_file import read_arrays

    def check(arrays: dict[str, Any], others: list[str]) -> None:
        if NAME not in arrays:
            found = ", ".join(others) or "none"
            raise SceneError(f"expected an array {NAME}, got {short(found, 100)}")
        _check_room(*arrays[NAME].shape[:2])

    arrays, _ = read_arrays(path, (NAME,), alone=NAME, check=check)
    return arrays[NAME]


def _read_picture(path: Path) -> "Array":
    """Read a picture by OpenImageIO."""
    import numpy as np

    oiio: Any = need("OpenImageIO", "sky", f"{path}: reading it")
    settings = oiio.ImageSpec()
    settings.attribute("oiio:UnassociatedAlpha", 1)
    picture = oiio.ImageInput.open(str(path), settings)
    if picture is None:
        raise _damaged(oiio.geterror())
    try:
        found = picture.spec()
        _check_room(found.height, found.width)
        channels = _colors_of(list(found.channelnames))
        kind = {"uint8": "uint8", "uint16": "uint16"}.get(str(found.format), "float")
        read = picture.read_image(0, 0, 0, found.nchannels, kind)
        if read is None or picture.has_error:
            raise _damaged(picture.geterror())
    finally:
        picture.close()
    pixels: Array = np.reshape(read, (found.height, found.width, found.nchannels))[..., channels]
    if kind == "float":
        return pixels
    # One step of double precision, the same everywhere.
    return pixels / float(np.iinfo(pixels.dtype).max)


def _colors_of(names: list[str]) -> list[int]:
    """Return which channels are red, green and blue; one that is alone is all three."""
    if all(name in names for name in "RGB"):
        return [names.index(name) for name in "RGB"]
    if "Y" in names and not {"RY", "BY"} & set(names):
        return 3 * [names.index("Y")]
    shown = short(", ".join(names), 100)
    raise SceneError(f"has the channels {shown}; expected R, G and B, or Y alone")


def _check_room(*sides: int) -> None:
    """Raise SceneError if a picture does not fit into memory."""
    pixels = 1
    for side in sides:
        pixels *= side
    lack = lack_of_memory(_BYTES * pixels)
    if lack:
        shown = " x ".join(map(str, sides[::-1]))
        raise SceneError(f"{shown} pixels are too large to hold in memory: they need {lack}")


def _damaged(why: str) -> SceneError:
    """Give the error for a file that is damaged."""
    return SceneError(f"is damaged or cut short ({short(why.strip(), 100)}); write it again")
