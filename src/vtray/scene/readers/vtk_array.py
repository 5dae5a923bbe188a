"""Arrays of VTK's XML files as they are written: as text, or as bytes in blocks.

References
----------
https://docs.vtk.org/en/latest/vtk_file_formats/vtkxml_file_format.html
"""

import binascii
from collections.abc import Callable
from typing import TYPE_CHECKING, Any, NamedTuple

from vtray.base.errors import SceneError
from vtray.base.extras import need
from vtray.scene.checks.json_tree import short
from vtray.scene.readers.libraries import check_bytes, told

if TYPE_CHECKING:
    from numpy.typing import NDArray

    Array = NDArray[Any]

KINDS = {
    "Int8": "i1",
    "UInt8": "u1",
    "Int16": "i2",
    "UInt16": "u2",
    "Int32": "i4",
    "UInt32": "u4",
    "Int64": "i8",
    "UInt64": "u8",
    "Float32": "f4",
    "Float64": "f8",
}
"""The kinds of numbers, as NumPy has them."""

TIMES = ("TimeValue", "TIME")
"""What an array with the time is called."""

_COPIES = 2
"""How many copies of an array are in memory at once."""

_ROOM = 1 << 28
"""Bytes that unpacking LZMA may take beside what it gives."""


class Part(NamedTuple):
    """Points of a file, or of a part of it.

    Attributes
    ----------
    positions
        Of shape (n, 3).
    columns
        What is known of each point, by the names of the file.
    time
        The time; None if that is not known.
    """

    positions: "Array"
    columns: "dict[str, Array]"
    time: float | None


class Coding(NamedTuple):
    """How the bytes of a file are written.

    Attributes
    ----------
    order
        The order of bytes, as NumPy has it: "<" or ">".
    word
        The kind of the numbers before each array, which tell its size: "u4" or "u8".
    compressor
        VTK's name of what the blocks are compressed by; "" if they are not.
    """

    order: str
    word: str
    compressor: str


class Written(NamedTuple):
    """Bytes of arrays, among others.

    Attributes
    ----------
    content
        The bytes, or their base64.
    start
        Where those of this array begin.
    is_base64
        Whether they are base64.
    """

    content: memoryview
    start: int
    is_base64: bool

    def take(self, count: int) -> tuple[memoryview, "Written"]:
        """Return the next bytes, and what follows what these were encoded with."""
        size = 4 * -(-count // 3) if self.is_base64 else count
        part = self.content[self.start : self.start + size]
        if self.is_base64:
            part = memoryview(_from_base64(part))
        if len(part) < count:
            raise SceneError(f"the file ends after {len(part)} of {count} bytes")
        return part[:count], self._replace(start=self.start + size)


def numbers_of_text(text: str | bytes, kind: str, count: int) -> "Array":
    """Return numbers between blanks.

    Parameters
    ----------
    text
        The numbers alone.
    kind
        As NumPy has it, such as "f4".
    count
        How many there are.

    Raises
    ------
    SceneError
        There are more or less, or one is no number.
    """
    import warnings

    import numpy as np

    check_bytes(_COPIES * 8 * count)
    with warnings.catch_warnings():
        warnings.simplefilter("error")  # what NumPy says of what is no number
        try:
            found = np.fromstring(text, f"{kind[0]}8", sep=" ")
        except (DeprecationWarning, ValueError):
            raise SceneError("expected numbers; some are none") from None
    if len(found) != count:
        raise SceneError(f"expected {count} numbers, got {len(found)}")
    with np.errstate(over="ignore"):  # what is too large for a float is infinite
        values = found.astype(kind, copy=False)
    if kind[0] != "f" and not np.array_equal(values, found):
        raise SceneError(f"expected numbers of {8 * values.itemsize} bits; some are larger")
    return values


def numbers_of_bytes(written: Written, coding: Coding, kind: str, count: int) -> "Array":
    """Return numbers that are written as bytes, as `numbers_of_text` does.

    Raises
    ------
    SceneError
        The size before them is another, the file ends, or they cannot be unpacked.
    ExtraError
        They are compressed by LZ4, and lz4 is not installed.
    """
    import numpy as np

    size = count * np.dtype(kind).itemsize
    check_bytes(_COPIES * size)
    read = _blocks if coding.compressor else _as_they_are
    found = np.frombuffer(read(written, coding, size), coding.order + kind)
    return found.astype(kind)  # in the order of bytes of the machine, and not the file's


def _as_they_are(written: Written, coding: Coding, size: int) -> memoryview:
    """Return the bytes of an array, before which its size stands."""
    import numpy as np

    width = np.dtype(coding.word).itemsize
    (claimed,), body = _words(written, coding, 1)
    _check_size(claimed, size)
    # The size may be encoded apart from the bytes, or as one with them.
    if (
        not written.is_base64
        or len(_from_base64(written.content[written.start : body.start])) == width
    ):
        return body.take(size)[0]
    return written.take(width + size)[0][width:]


def _blocks(written: Written, coding: Coding, size: int) -> bytes:
    """Return the bytes of an array in blocks, each of which is compressed.

    The sizes of all blocks stand before them, in a part of its own.
    """
    (count,), _ = _words(written, coding, 1)
    if count == 0:
        _check_size(0, size)
        return b""
    if count > size:
        raise SceneError(f"claims {count} blocks for {size} bytes; write it again")
    (_, block, last, *sizes), body = _words(written, coding, 3 + count)
    lengths = [block] * (count - 1) + [last or block]
    _check_size(sum(lengths), size)
    unpack = _unpacker(coding.compressor)
    packed, _ = body.take(sum(sizes))
    found, at = [], 0
    for length, there in zip(lengths, sizes, strict=True):
        part = unpack(packed[at : at + there], length)
        if len(part) != length:
            raise SceneError(f"expected blocks of {length} bytes, got one of {len(part)}")
        found.append(part)
        at += there
    return b"".join(found)


def _words(written: Written, coding: Coding, count: int) -> tuple[list[int], Written]:
    """Return the sizes that stand before an array, and what follows."""
    import numpy as np

    kind = np.dtype(coding.order + coding.word)
    part, rest = written.take(count * kind.itemsize)
    return np.frombuffer(part, kind).tolist(), rest


def _check_size(claimed: int, size: int) -> None:
    """Raise SceneError if an array is said to have another size than its numbers take."""
    if claimed != size:
        raise SceneError(f"expected {size} bytes, got {claimed}")


def _unpacker(compressor: str) -> Callable[[memoryview, int], bytes]:
    """Return what unpacks a block that will have so many bytes."""
    import lzma
    import zlib

    def by_zlib(part: memoryview, size: int) -> bytes:
        with told("zlib", "blocks of bytes"):
            return zlib.decompressobj().decompress(part, size)

    def by_lzma(part: memoryview, size: int) -> bytes:
        with told("lzma", "blocks of bytes"):
            return lzma.LZMADecompressor(memlimit=size + _ROOM).decompress(part, size)

    def by_lz4(part: memoryview, size: int) -> bytes:
        block: Any = need("lz4.block", "points", "reading files of VTK compressed by LZ4")
        with told("lz4", "blocks of bytes"):
            found: bytes = block.decompress(part, uncompressed_size=size)
        return found

    known = {
        "vtkZLibDataCompressor": by_zlib,
        "vtkLZMADataCompressor": by_lzma,
        "vtkLZ4DataCompressor": by_lz4,
    }
    if compressor not in known:
        names = ", ".join(known)
        raise SceneError(f"compressor: expected one of {names}, got {short(compressor)!r}")
    return known[compressor]


def _from_base64(text: memoryview) -> bytes:
    """Return what a base64 stands for."""
    try:
        return binascii.a2b_base64(text)
    except binascii.Error as error:
        raise SceneError(f"expected base64 ({error})") from None
