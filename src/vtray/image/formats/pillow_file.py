"""The formats of 8 bits a channel that Pillow writes: TIFF, JPEG and WebP.

All three say how the picture was made in the same two tags of Exif, which are TIFF's own.
"""

import io
from typing import BinaryIO

from vtray.base.version import SOFTWARE
from vtray.image.formats.picture import How, Picture

TAG_DESCRIPTION, TAG_SOFTWARE = 0x010E, 0x0131


def write_tiff(picture: Picture, how: How, file: BinaryIO) -> None:
    """Write a TIFF, compressed without loss."""
    _write(picture, how, file, "TIFF", compression="tiff_adobe_deflate")


def write_jpeg(picture: Picture, how: How, file: BinaryIO) -> None:
    """Write a JPEG of high quality, with colour as fine as brightness."""
    _write(picture, how, file, "JPEG", quality=95, subsampling=0)


def write_webp(picture: Picture, how: How, file: BinaryIO) -> None:
    """Write a WebP, compressed without loss."""
    _write(picture, how, file, "WEBP", lossless=True, exact=True)


def _write(picture: Picture, how: How, file: BinaryIO, name: str, **options: object) -> None:
    """Write a picture in a format of Pillow's."""
    from PIL import Image as PillowImage

    exif = PillowImage.Exif()
    exif[TAG_DESCRIPTION], exif[TAG_SOFTWARE] = how.provenance, SOFTWARE
    # In memory first: these writers seek, which a pipe cannot, and hide why a disk takes no more.
    memory = io.BytesIO()
    PillowImage.fromarray(picture.develop(8)).save(memory, name, exif=exif, **options)
    file.write(memory.getbuffer())


def read_exif(file: BinaryIO) -> str | None:
    """Return what a TIFF, JPEG or WebP says of how it was made, None if it says nothing."""
    import logging
    import warnings

    from PIL import Image as PillowImage

    log = logging.getLogger(PillowImage.__name__.partition(".")[0])
    if not log.handlers:  # for what is wrong with a file is ours to say: it would be printed
        log.addHandler(logging.NullHandler())
    with warnings.catch_warnings():
        # Only the head is read, so that many pixels are no danger.
        warnings.simplefilter("ignore")
        with PillowImage.open(file) as image:
            text = image.getexif().get(TAG_DESCRIPTION)
    return text if isinstance(text, str) and text.startswith("{") else None
