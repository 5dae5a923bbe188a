"""How texts are compressed, as the endings of their names say."""

import contextlib
import os
from collections.abc import Iterator
from typing import Any, BinaryIO

from vtray.base.errors import SceneError
from vtray.scene.checks.json_tree import short

PACKINGS = (".gz", ".bz2", ".xz")
"""What follows the ending of a text that is compressed."""


def packing_of(path: str) -> str:
    """Return the ending that says how a file is compressed; "" if it is not."""
    ending = os.path.splitext(path)[1].lower()
    return ending if ending in PACKINGS else ""


@contextlib.contextmanager
def unpacking(file: BinaryIO, packing: str) -> Iterator[BinaryIO]:
    """Give what is in a file that may be compressed.

    Raises
    ------
    SceneError
        It cannot be unpacked.
    """
    if not packing:
        yield file
        return
    import bz2
    import gzip
    import lzma
    import zlib

    openers: dict[str, Any] = {".gz": gzip.open, ".bz2": bz2.open, ".xz": lzma.open}
    try:
        with openers[packing](file) as stream:
            yield stream
    except (EOFError, gzip.BadGzipFile, zlib.error, lzma.LZMAError) as error:
        words = short(str(error), 100)
    except OSError as error:
        if error.errno is not None:
            raise
        words = short(str(error), 100)  # what bz2 raises
    else:
        return
    raise SceneError(f"expected a {packing} file, which cannot be unpacked ({words})")
