"""Lines of a text file of any length: one by one, skipped fast, or many at once."""

from codecs import BOM_UTF8
from collections.abc import Iterator
from typing import BinaryIO

from vtray.base.errors import SceneError

STEP = 1 << 22
"""Bytes that are read at a time, at the most."""

LEAST_STEP = 1 << 12
"""Bytes that are read at a time, at the least, if so many lines are wanted."""

USUAL = 48
"""Bytes of a line, as long as none is known."""

LONGEST = 1 << 20
"""Bytes of a line, at the most: what has longer ones is no text of numbers."""


class Lines:
    """Reads a file line by line.

    Parameters
    ----------
    file
        In which any place can be sought.

    Attributes
    ----------
    number
        How many lines were read so far, which is the number of the last one, from 1.
    """

    def __init__(self, file: BinaryIO) -> None:
        self._file = file
        self._length = USUAL
        self.number = 0

    def next(self) -> str | None:
        """Return the next line without its end; None at the end of the file.

        Raises
        ------
        SceneError
            The line is no text.
        """
        line = self._file.readline(LONGEST)
        if not line:
            return None
        self.number += 1
        if len(line) == LONGEST:
            raise self._too_long(self.number)
        if self.number == 1:
            line = line.removeprefix(BOM_UTF8)
        return text_of(line, self.number).rstrip("\r\n")

    def skip(self, count: int) -> int:
        """Skip lines; return how many there were, which are fewer at the end of the file."""
        left, last = count, b"\n"
        while left and (block := self._read_for(left)):
            block = self._cut(block, left)
            left -= block.count(b"\n")
            last = block[-1:]
        if left and last != b"\n":  # the last line of a file needs no end
            left -= 1
        self.number += count - left
        return count - left

    def blocks(self, count: int) -> Iterator[tuple[bytes, int]]:
        """Give so many lines in blocks, with how many each has; fewer at the end of the file.

        Raises
        ------
        SceneError
            A line is too long for text.
        """
        left, rest = count, b""
        while left and (block := self._read_for(left)):
            whole, end, rest = (rest + self._cut(block, left)).rpartition(b"\n")
            if len(rest) > LONGEST:
                raise self._too_long(self.number + whole.count(b"\n") + len(end) + 1)
            if end:
                lines = whole.count(b"\n") + 1
                left -= lines
                self.number += lines
                yield whole, lines
        if left and rest:
            self.number += 1
            yield rest, 1

    def place(self) -> tuple[int, int]:
        """Return where the reader is, for `go`."""
        return self._file.tell(), self.number

    def go(self, place: tuple[int, int]) -> None:
        """Go to a place where the reader was."""
        offset, self.number = place
        self._file.seek(offset)

    def _read_for(self, count: int) -> bytes:
        """Read about as many bytes as so many lines have, by the length of those before.

        Frames are often far smaller than what can be read at a time.
        """
        block = self._file.read(min(max(count * self._length, LEAST_STEP), STEP))
        self._length = len(block) // (block.count(b"\n") or 1) + 2
        return block

    def _cut(self, block: bytes, most: int) -> bytes:
        """Return what belongs to so many lines, and go back to the end of the last."""
        if block.count(b"\n") < most:
            return block
        import numpy as np

        ends = np.flatnonzero(np.frombuffer(block, np.uint8) == ord("\n"))
        end = int(ends[most - 1]) + 1
        self._file.seek(end - len(block), 1)
        return block[:end]

    @staticmethod
    def _too_long(number: int) -> SceneError:
        return SceneError(f"line {number}: longer than {LONGEST} bytes; expected text")


def text_of(line: bytes, number: int) -> str:
    """Return a line as text; raise SceneError if it is none."""
    try:
        return line.decode()
    except UnicodeDecodeError:
        raise SceneError(f"line {number}: not UTF-8; expected text") from None
