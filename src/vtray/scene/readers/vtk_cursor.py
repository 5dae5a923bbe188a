"""A place in one of VTK's older files, and the lines and numbers that follow there."""

import re
from typing import TYPE_CHECKING, Any

from vtray.base.errors import SceneError
from vtray.scene.checks.json_tree import short
from vtray.scene.readers.libraries import check_bytes
from vtray.scene.readers.vtk_array import numbers_of_text

if TYPE_CHECKING:
    from numpy.typing import NDArray

    Array = NDArray[Any]

_KINDS = {
    "bit": "u1",
    "char": "i1",
    "signed_char": "i1",
    "unsigned_char": "u1",
    "short": "i2",
    "unsigned_short": "u2",
    "int": "i4",
    "unsigned_int": "u4",
    "vtkidtype": "i4",
    "long": "i8",
    "unsigned_long": "u8",
    "long_long": "i8",
    "unsigned_long_long": "u8",
    "vtktypeint64": "i8",
    "vtktypeuint64": "u8",
    "float": "f4",
    "double": "f8",
}
"""The kinds of numbers, as NumPy has them."""

_BLANKS = re.compile(rb"\s*")

_WORD = re.compile(rb"[^0-9\s.+\-eEnaifNAIF]")
"""A letter that no number has, infinity and NaN among them: each line between arrays has one."""

_EMPTY_LINE = re.compile(rb"\n[ \t\r]*(?:\n|\Z)")


class Cursor:
    """A place in a file, and what follows there."""

    def __init__(self, content: bytes) -> None:
        self.content = content
        self.at = 0
        self.begin = 0  # of the last line
        self.is_text = True

    def raw_line(self) -> str:
        """Read the next line, which may be empty."""
        self.begin = self.at
        end = self.content.find(b"\n", self.at)
        end = len(self.content) if end < 0 else end
        line = self.content[self.at : end]
        self.at = end + 1
        return line[:4096].decode("utf-8", "replace").strip()

    def line(self) -> list[str]:
        """Read the entries of the next line that has some; none at the end of the file."""
        self.at = self._after_blanks()
        return self.raw_line().split()

    def follows(self, word: str) -> bool:
        """Tell whether the next line that has entries begins with a word."""
        at = self._after_blanks()
        return self.content[at : at + len(word)].upper() == word.encode()

    def _after_blanks(self) -> int:
        """Return where the next entry begins."""
        found = _BLANKS.match(self.content, self.at)
        return found.end() if found else len(self.content)

    def skip_lines(self, count: int) -> None:
        """Pass over lines, empty ones too."""
        for _ in range(count):
            if self.at >= len(self.content):
                raise self.wrong("the file ends before all of its texts")
            self.raw_line()

    def skip_to_empty_line(self) -> None:
        """Pass over all lines until an empty one."""
        found = _EMPTY_LINE.search(self.content, self.at - 1)
        self.at = found.end() if found else len(self.content)

    def numbers(self, kind: str, count: int) -> "Array":
        """Read the numbers that follow a line."""
        code = _KINDS.get(kind.lower())
        if code is None:
            raise self.wrong(f"expected a kind of numbers, such as float, got {short(kind)!r}")
        if not self.is_text:
            return self._bytes(code, count, kind.lower() == "bit")
        found = _WORD.search(self.content, self.at)
        end = self.content.rfind(b"\n", 0, found.start()) + 1 if found else len(self.content)
        text = self.content[self.at : max(end, self.at)]
        self.at = max(end, self.at)
        try:
            return numbers_of_text(text, code, count)
        except SceneError as error:
            raise self.wrong(str(error)) from None

    def _bytes(self, code: str, count: int, is_bits: bool) -> "Array":
        """Read numbers that are bytes, the highest first."""
        import numpy as np

        kind = np.dtype(f">{code}")
        size = -(-count // 8) if is_bits else count * kind.itemsize
        left = max(len(self.content) - self.at, 0)
        if left < size:
            raise self.wrong(f"the file ends after {left} of {size} bytes")
        check_bytes(size)
        part = memoryview(self.content)[self.at : self.at + size]
        self.at += size
        found = np.frombuffer(part, kind)
        return np.unpackbits(found, count=count) if is_bits else found.astype(code)

    def whole(self, entries: list[str], at: int) -> int:
        """Return an entry of the last line, a number from 0 on."""
        text = entries[at] if at < len(entries) else ""
        if not (text.isascii() and text.isdigit() and len(text) < 19):
            raise self.wrong(f"expected a whole number as entry {at + 1}, got {short(text)!r}")
        return int(text)

    def entry(self, entries: list[str], at: int) -> str:
        """Return an entry of the last line."""
        if at >= len(entries):
            line = short(" ".join(entries))
            raise self.wrong(f"expected {at + 1} entries, got {len(entries)}: {line!r}")
        return entries[at]

    def wrong(self, problem: str) -> SceneError:
        """Give the error for the last line, with its place."""
        if self.is_text:
            number = self.content.count(b"\n", 0, self.begin) + 1
            return SceneError(f"line {number}: {problem}")
        return SceneError(f"byte {self.begin}: {problem}")
