"""Colours as people write them: names, hex digits, integers from 0 to 255, floats from 0 to 1.

They become the format's integers from 0 to 255 without any other change. A float is rounded to the
nearest of these, the middle between two up: 0.5 becomes 128.
"""

import functools
import math
import re
from collections.abc import Sequence
from typing import TYPE_CHECKING, Any, TypeAlias

from vtray.base.errors import SceneError
from vtray.scene.vectors import Color

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

    Bytes = NDArray[np.uint8]
    AnyColor: TypeAlias = str | Color | Sequence[float] | NDArray[Any]

Rgb = tuple[int, int, int]


def show(found: object) -> str:
    """Write a value for a message."""
    from vtray.scene.checks import scene_words

    return scene_words.show(found)


# Matplotlib's own names, beside those of CSS: single letters, and the colours of its cycle.
_LETTERS = {
    "b": (0, 0, 255),
    "g": (0, 128, 0),
    "r": (255, 0, 0),
    "c": (0, 191, 191),
    "m": (191, 0, 191),
    "y": (191, 191, 0),
    "k": (0, 0, 0),
    "w": (255, 255, 255),
}
_CYCLE = {
    "tab:blue": (31, 119, 180),
    "tab:orange": (255, 127, 14),
    "tab:green": (44, 160, 44),
    "tab:red": (214, 39, 40),
    "tab:purple": (148, 103, 189),
    "tab:brown": (140, 86, 75),
    "tab:pink": (227, 119, 194),
    "tab:gray": (127, 127, 127),
    "tab:olive": (188, 189, 34),
    "tab:cyan": (23, 190, 207),
}
_OTHER_NAMES = {
    **_LETTERS,
    **_CYCLE,
    "tab:grey": _CYCLE["tab:gray"],
    **{f"c{number}": rgb for number, rgb in enumerate(_CYCLE.values())},
}
_HEX = re.compile(r"#([0-9a-f]{3}|[0-9a-f]{6})", re.ASCII)
_HEX_WITH_ALPHA = re.compile(r"#([0-9a-f]{4}|[0-9a-f]{8})", re.ASCII)

WORDS = 'a name such as "red", a text such as "#ff8000", or three numbers'
"""What a colour is, to follow the word "expected"."""


def to_rgb(color: "AnyColor", place: str = "color") -> Rgb:
    """Return a colour as the format's numbers.

    Parameters
    ----------
    color
        A name of CSS, such as "tomato", or one of Matplotlib's single letters, "tab:blue" and "C0";
        hexadecimal digits, "#f80" or "#ff8000"; three integers from 0 to 255; three floats from 0
        to 1; or a `Color`. Capitals make no difference.
    place
        What the colour is called in messages.

    Returns
    -------
    tuple of int
        Red, green and blue, from 0 to 255. A float times 255 is rounded to the nearest integer, the
        middle between two up.

    Raises
    ------
    SceneError
        If it is no colour, has a fourth number for transparency, or is a triple of the integers 0
        and 1, which may be meant as either kind of numbers.

    Examples
    --------
    >>> to_rgb("orange"), to_rgb((1.0, 0.5, 0.0))
    ((255, 165, 0), (255, 128, 0))
    """
    if isinstance(color, Color):
        return int(color.r), int(color.g), int(color.b)
    if isinstance(color, str):
        return _named(str(color), place)
    numbers = _numbers(color, place)
    if all(isinstance(number, int) for number in numbers):
        return _of_integers(numbers, place, sure=_is_bytes(color))
    return _of_floats(numbers, place)


def is_name(text: str) -> bool:
    """Tell whether a text is the name of a colour, or its hexadecimal digits."""
    return _found(text.strip().lower()) is not None


def _is_bytes(color: object) -> bool:
    """Tell whether a colour is of NumPy's uint8, whose numbers go from 0 to 255 for sure."""
    parts = color if isinstance(color, (list, tuple)) else [color]
    return all(str(getattr(part, "dtype", "")) == "uint8" for part in parts)


def _numbers(color: Any, place: str) -> list[Any]:  # noqa: ANN401
    """Return the three numbers of a colour: all integers, or all integers and floats."""
    found = color.tolist() if hasattr(color, "tolist") else color
    if not isinstance(found, (list, tuple)):
        raise SceneError(f"{place}: expected {WORDS}, got {show(found)}")
    numbers = [item.tolist() if hasattr(item, "tolist") else item for item in found]
    plain = all(type(item) in (int, float) for item in numbers)
    if plain and len(numbers) == 4:
        raise SceneError(f"{place}: {ALPHA}, got {show(found)}; leave out the fourth")
    if not plain or len(numbers) != 3:
        raise SceneError(f"{place}: expected {WORDS}, got {show(found)}")
    return numbers


ALPHA = "expected three numbers, as colours have no alpha (opacity=... lets light through)"


def _of_integers(numbers: list[int], place: str, *, sure: bool) -> Rgb:
    for number in numbers:
        if not 0 <= number <= 255:
            words = f"expected integers from 0 to 255, got {show(number)}"
            raise SceneError(f"{place}: {words} in {show(tuple(numbers))}")
    if max(numbers) == 1 and not sure:
        raise SceneError(f"{place}: {ambiguous(numbers)}")
    red, green, blue = numbers
    return red, green, blue


def ambiguous(numbers: Sequence[int]) -> str:
    """Say why integers 0 and 1 are no colour."""
    floats = ", ".join(f"{float(number)}" for number in numbers)
    integers = ", ".join(f"{255 * number}" for number in numbers)
    given = ", ".join(map(str, numbers))
    return (
        f"({given}) may mean floats from 0 to 1 or integers from 0 to 255; "
        f"write ({floats}) or ({integers})"
    )


def _of_floats(numbers: list[float], place: str) -> Rgb:
    for number in numbers:
        if not 0 <= number <= 1:
            shown = show(tuple(numbers))
            words = f"expected floats from 0 to 1, or integers from 0 to 255, got {show(number)}"
            raise SceneError(f"{place}: {words} in {shown}")
    red, green, blue = (math.floor(255 * float(number) + 0.5) for number in numbers)
    return red, green, blue


def _named(name: str, place: str) -> Rgb:
    """Return the colour of a name or of hexadecimal digits."""
    text = name.strip().lower()
    found = _found(text)
    if found is None:
        from PIL import ImageColor

        names = [*ImageColor.colormap, *_OTHER_NAMES]
        raise SceneError(f"{place}: {_unknown(text, name, names)}")
    return found


@functools.lru_cache(maxsize=4096)
def _found(text: str) -> Rgb | None:
    """Return the colour of a name or of hexadecimal digits in small letters, if it is one."""
    if text in _OTHER_NAMES:
        return _OTHER_NAMES[text]
    digits = _hex_digits(text)
    if digits is None:
        from PIL import ImageColor

        names = ImageColor.colormap
        found = names.get(text) or names.get(text.replace(" ", ""))
        # Pillow keeps names as the digits they stand for, and some as integers once they were used.
        if isinstance(found, tuple):
            return found[0], found[1], found[2]
        digits = _hex_digits(found.lower()) if isinstance(found, str) else None
    if digits is None:
        return None
    red, green, blue = bytes.fromhex(digits)
    return red, green, blue


def _hex_digits(text: str) -> str | None:
    """Return six hexadecimal digits, None if a text has no such."""
    match = _HEX.fullmatch(text)
    if match is None:
        return None
    digits = match[1]
    return digits if len(digits) == 6 else "".join(2 * digit for digit in digits)


def _unknown(text: str, name: str, names: list[str]) -> str:
    """Say why a text is no colour."""
    if _HEX_WITH_ALPHA.fullmatch(text):
        short = text[:4] if len(text) == 5 else text[:7]
        return f'{ALPHA}, got {show(name)}; write "{short}"'
    from vtray.scene.checks.scene_words import nearest

    close = nearest(text, names, cutoff=0.7)
    hint = f"; did you mean {close}?" if close else ""
    return f"expected {WORDS}, got {show(name)}{hint}"
