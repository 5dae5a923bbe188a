"""Text that fits: broken into lines, so that nothing of it is cut."""

import re
from collections.abc import Callable, Iterator
from typing import TYPE_CHECKING

from vtray.figures.sheet import FigureError

if TYPE_CHECKING:
    from matplotlib.backend_bases import RendererBase
    from matplotlib.text import Text

WORD = re.compile(r"(?:\$(?:\\.|[^$\\])*\$|\\.|[^\s$])+")
"""What is not broken at spaces: a formula between dollars is one word."""


def write(
    text: "Text", words: str, size: float, room: float, renderer: "RendererBase | None" = None
) -> None:
    """Write words in lines that are at most as long as there is room.

    Lines end at spaces; a word that is too long alone is broken anywhere. What cannot be broken, a
    formula or what TeX sets, gets smaller.

    Parameters
    ----------
    text
        What to write in, on a figure, level or upright.
    words
        What to write; its own ends of lines are kept.
    size
        Of the font, in points.
    room
        In pixels.
    renderer
        What draws, None for that of the figure.
    """
    from matplotlib.cbook import is_math_text

    text.set_fontsize(size)
    if not text.get_usetex():
        if not is_math_text(words):  # then no line of it may become a formula either
            words = re.sub(r"(?<!\\)\$", r"\\$", words)

        def length(line: str) -> float:
            text.set_text(line)
            return _length(text, renderer)

        lines = (part for line in words.split("\n") for part in broken(line, length, room))
        words = "\n".join(lines)
    text.set_text(words)
    longest = _length(text, renderer)
    if longest > room:
        text.set_fontsize(max(0.97 * size * room / longest, 0.5))


def longest_word(text: "Text", words: str, renderer: "RendererBase | None" = None) -> float:
    """Return how long the longest of some words is in the font of a text, in pixels."""
    lengths = []
    for word in WORD.findall(words):
        text.set_text(word)
        lengths.append(_length(text, renderer))
    return max(lengths, default=0.0)


def _length(text: "Text", renderer: "RendererBase | None") -> float:
    """Return how long the longest line is, in pixels."""
    try:
        box = text.get_window_extent(renderer)
    except ValueError:
        words = "expected a formula of Matplotlib between dollars, or \\$ for a dollar"
        raise FigureError(f"{words}, got {text.get_text()!r}") from None
    return float(box.height if text.get_rotation() == 90 else box.width)


def broken(line: str, length: Callable[[str], float], room: float) -> Iterator[str]:
    """Break a line, at spaces if that does, so that `length` of no part is above `room`."""
    if length(line) <= room:
        yield line
        return
    current = ""
    for word in WORD.findall(line):
        longer = f"{current} {word}" if current else word
        if length(longer) <= room:
            current = longer
            continue
        if current:
            yield current
        current = word
        while "$" not in current and len(current) > 1 and length(current) > room:
            most = _count(current, length, room)
            yield current[:most]
            current = current[most:]
    yield current


def _count(word: str, length: Callable[[str], float], room: float) -> int:
    """Return how many characters of a word that is too long there is room for, at least one."""
    most = min(max(int(len(word) * room / length(word)), 1), len(word) - 1)
    while most > 1 and length(word[:most]) > room:
        most -= 1
    while most < len(word) - 1 and length(word[: most + 1]) <= room:
        most += 1
    return most
