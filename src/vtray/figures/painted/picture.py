"""A picture with annotations painted onto it."""

from collections.abc import Iterator, Sequence
from typing import TYPE_CHECKING

import numpy as np

from vtray.figures.annotations import Annotations, Marks, find_marks, marks_beside
from vtray.figures.brightness_scale import LABEL, BrightnessScale
from vtray.figures.painted.canvas import Canvas
from vtray.figures.painted.layout import MARGIN, MOST_BESIDE, Placed, arranged
from vtray.figures.painted.legend import PaintedLegend
from vtray.figures.painted.letters import check_letters, letters
from vtray.figures.painted.words import Words
from vtray.figures.point_labels import Label
from vtray.figures.sheet import FigureError, check_number
from vtray.figures.subject import Pixels, Subject

if TYPE_CHECKING:
    from vtray.scene.scene import Object

SHARE = 0.035
"""The size of letters in parts of the picture's shorter side."""

LEGIBLE = 11
"""The size that they have at least where there is room, in pixels."""

LEAST = 7
"""The least size with which all is still written, in pixels."""

BAR = 2.8
"""The height of a scale bar with its length and the remark below it, about, in sizes of letters."""

NO_MARKS = Marks("", "", [], [], [], None, [], [])

SMALLER = 0.5
"""How small letters may become for a long legend to take less than that, in their usual size."""


def annotated_pixels(image: Subject, wanted: Annotations, fontsize: float | None = None) -> Pixels:
    """Return a picture with annotations painted onto it.

    Parameters
    ----------
    image
        The picture, which stays as it is.
    wanted
        What to paint.
    fontsize
        The size of letters in pixels; None for one that suits the picture, and is smaller where
        there would be no room.

    Returns
    -------
    array
        Of the shape of the picture's pixels; what no mark covers is as it was.

    Raises
    ------
    FigureError
        Something that is asked for is not right, or there is no room for it.
    """
    marks = _checked(find_marks(image, wanted))
    pixels = image.pixels
    height, width = pixels.shape[:2]
    for some in _more_and_less(marks):
        found = _largest(some, fontsize, width, height)
        if found is not None:
            return _painted(pixels, some, *found)
    remedy = "render it larger, or ask for less"
    if fontsize is not None:
        remedy += ", or give a smaller fontsize"
    message = f"annotations: there is no room in a picture of {width} x {height} pixels; {remedy}"
    raise FigureError(message)


def _largest(
    marks: Marks, fontsize: float | None, width: int, height: int
) -> tuple[list[Placed], int] | None:
    """Return where marks stand, and the largest size of letters with which there is room.

    There is room beside what is shown, for a legend too, unless letters would have to be tiny.
    """
    largest = None
    sizes = [*_sizes(fontsize, width, height)]
    for em in sizes:
        placed = arranged(marks, em, width, height)
        if placed is None:
            continue
        if _leaves_room(placed, em, width):
            return placed, em
        largest = largest or (placed, em)
        if em <= max(LEGIBLE, SMALLER * sizes[0]):
            break
    return largest


def _leaves_room(placed: list[Placed], em: int, width: int) -> bool:
    """Tell whether what is shown has room beside a legend."""
    return not any(_is_on_shown(one, em, width) for one in placed)


def _is_on_shown(one: Placed, em: int, width: int) -> bool:
    """Tell whether a mark is a legend for which there is no room beside what is shown."""
    return isinstance(one.block, PaintedLegend) and _share_of(one, em, width) >= MOST_BESIDE


def share_beside(
    objects: "Sequence[Object]",
    wanted: Annotations,
    size: tuple[int, int],
    brightness: "Sequence[BrightnessScale]" = (),
    fontsize: float | None = None,
) -> float:
    """Return the share of a picture's width that a legend and colour bars take on its right.

    Parameters
    ----------
    objects
        What is shown.
    wanted
        What to paint.
    size
        Width and height of the picture in pixels.
    brightness
        How bright points are that shine.
    fontsize
        As for `annotated_pixels`.

    Raises
    ------
    FigureError
        One of them is not right.
    """
    width, height = size
    marks = _checked(marks_beside(objects, wanted, brightness))
    all_found = (_largest(some, fontsize, width, height) for some in _more_and_less(marks))
    placed, em = next(filter(None, all_found), ([], 0))
    if not placed:
        return 0.0
    return max(_share_of(one, em, width) for one in placed)


def share_above(
    title: str, caption: str, size: tuple[int, int], fontsize: float | None = None
) -> float:
    """Return the share of a picture's height that a title and a caption take at its top.

    Parameters
    ----------
    title, caption
        The texts, "" for none.
    size, fontsize
        As for `share_beside`.

    Raises
    ------
    FigureError
        One of them is not right.
    """
    found = _largest(_checked(NO_MARKS._replace(title=title, caption=caption)), fontsize, *size)
    placed, em = found or ([], 0)
    end = max((one.top + one.block.height for one in placed), default=0)
    return (end + round(MARGIN * em)) / size[1]


def share_below(size: tuple[int, int], fontsize: float | None = None) -> float:
    """Return the share of a picture's height that a scale bar takes at its bottom, about."""
    em = next(_sizes(fontsize, *size))
    return (BAR + 2.0 * MARGIN) * em / size[1]


def _share_of(one: Placed, em: int, width: int) -> float:
    """Return the share of a picture's width from a mark and a gap before it to its right edge."""
    return 1.0 - one.left / width + round(MARGIN * em) / width


def _checked(marks: Marks) -> Marks:
    """Return marks whose texts can all be written."""
    bar = marks.scale_bar
    return marks._replace(
        title=check_letters(marks.title, "title", lines=True),
        caption=check_letters(marks.caption, "time"),
        legend=[entry._replace(name=check_letters(entry.name, "legend")) for entry in marks.legend],
        bar_labels=[check_letters(label, "colorbar") for label in marks.bar_labels],
        scale_bar=bar and bar.written(lambda text: check_letters(text, "scalebar")),
        triad=[arm._replace(name=check_letters(arm.name, "axes")) for arm in marks.triad],
        labels=[
            label._replace(text=check_letters(label.text, "labels", lines=True))
            for label in marks.labels
        ],
    )


def _more_and_less(marks: Marks) -> Iterator[Marks]:
    """Give marks, and those for a picture in which there is no room for all of them.

    Bars of brightness that nobody has named are then left out beside those of colours.
    """
    yield marks
    bars = [*zip(marks.scales, marks.bar_labels, strict=True)]
    kept = [bar for bar in bars if not isinstance(bar[0], BrightnessScale) or bar[1] != LABEL]
    if 0 < len(kept) < len(bars):
        scales, labels = zip(*kept, strict=True)
        yield marks._replace(scales=[*scales], bar_labels=[*labels])


def _sizes(fontsize: float | None, width: int, height: int) -> Iterator[int]:
    """Give the sizes of letters to try, in pixels."""
    if fontsize is not None:
        yield max(1, round(check_number("fontsize", fontsize)))
        return
    em = max(LEGIBLE, round(SHARE * min(width, height)))
    while em >= LEAST:
        yield em
        em = min(em - 1, round(0.92 * em))


def free_labels(
    labels: list[Label], marks: list[Placed], em: int, width: int, height: int
) -> list[Placed]:
    """Return the labels that there is room for, and where they stand.

    One that would overlap another mark is left out, and so is one that would overlap another label:
    that of the farther point, or of two at the same distance the one that was given later.

    Parameters
    ----------
    labels
        Those of far points first.
    marks
        What else stands on the picture.
    em
        The size of letters, in pixels.
    width, height
        Of the picture, in pixels.
    """
    taken = np.zeros((height, width), np.bool_)
    for block, left, top in marks:
        taken[top : top + block.height, left : left + block.width] = True
    found = []
    for label in sorted(labels, key=lambda label: label.depth):
        words = Words(label.text.split("\n"), letters(em), "center")
        # Around its point, but within the picture.
        left = round(label.column + 0.5 - words.width / 2)
        top = round(label.row + 0.5 - words.middle)
        left = max(1, min(left, width - words.width - 1))
        top = max(1, min(top, height - words.height - 1))
        rectangle = taken[top : top + words.height, left : left + words.width]
        if not rectangle.any():
            rectangle[...] = True
            found.append(Placed(words, left, top))
    return found[::-1]


def _painted(pixels: Pixels, marks: Marks, placed: list[Placed], em: int) -> Pixels:
    """Return pixels with labels painted on them, and then all else.

    A legend that stands on what is shown has paper behind it, so that its names can be read.
    """
    canvas = Canvas(pixels, em)
    for words, left, top in free_labels(marks.labels, placed, em, canvas.width, canvas.height):
        words.paint(canvas, left, top)
    for one in placed:
        block, left, top = one
        if _is_on_shown(one, em, canvas.width):
            canvas.paper(left, top, block.width, block.height)
        block.paint(canvas, left, top)
    return canvas.pixels
