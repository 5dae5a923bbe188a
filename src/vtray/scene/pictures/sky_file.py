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
from vtray.scene.checks.json_tree import short
from vtray.scene.pictures.picture_file import ARRAYS, check_room, read_image_array

if TYPE_CHECKING:
    from numpy.typing import NDArray

    Array = NDArray[Any]

ENDINGS = (".exr", ".hdr", ".png", ".jpg", ".jpeg", *ARRAYS)

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
    if ending in ARRAYS:
        return read_image_array(path, _BYTES)
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
        check_room(found.width, found.height, _BYTES)
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


def _damaged(why: str) -> SceneError:
    """Give the error for a file that is damaged."""
    return SceneError(f"is damaged or cut short ({short(why.strip(), 100)}); write it again")
