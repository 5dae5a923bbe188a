"""The options for what is painted onto a picture: a title, axes, a scale bar, colour bars."""

import argparse
import math
import re
from collections.abc import Mapping, Sequence
from types import MappingProxyType
from typing import Any, NamedTuple

from vtray.base.number import number_in
from vtray.commands.command import Parser
from vtray.commands.setting_options import with_values_of
from vtray.commands.values import wrong

WITH_VALUE = ("--scale-bar", "--color-bar", "--boundary")
"""Options whose value follows an equals sign, so that a file after them is none; or is a word."""

KEYWORDS = ("title", "time", "axes", "scalebar", "colorbar", "legend")
"""The keywords of `vtray.Image.annotated` that options give; data alone have a legend."""

_POINT = re.compile(r"([^:,]*),([^:,]*),([^:,]*):(.+)", re.DOTALL)
"""A place and a text, as ``--label`` has them."""


class PointLabel(NamedTuple):
    """A text at a point in world space."""

    text: str
    point: tuple[float, float, float]


def _label(text: str) -> PointLabel | str:
    """Return the value of ``--label``: a text at a point, or the name of a column."""
    found = _POINT.fullmatch(text)
    if found is None:
        return text
    x, y, z = (number_in(part.strip()) for part in found.groups()[:3])
    if not (math.isfinite(x) and math.isfinite(y) and math.isfinite(z)):
        raise wrong("x,y,z:TEXT such as 0,0,1.5:top, or the name of a column", text)
    return PointLabel(found[4], (x, y, z))


def labels_of(options: argparse.Namespace) -> tuple[list[PointLabel], list[str]]:
    """Return the texts at points that options ask for, and the columns that label particles."""
    given: list[PointLabel | str] = options.label or []
    points = [label for label in given if isinstance(label, PointLabel)]
    return points, [label for label in given if isinstance(label, str)]


def with_values(arguments: Sequence[str]) -> list[str]:
    """Return arguments in which each of `WITH_VALUE` has one, "" where none was given."""
    return with_values_of(arguments, WITH_VALUE)


def add_annotations(parser: Parser) -> None:
    """Add what is painted onto the picture."""
    group = parser.add_argument_group("on the picture")
    group.add_argument("--title", metavar="TEXT", help="write a title at the top")
    group.add_argument(
        "--time",
        metavar="TEXT",
        help='write "t = TEXT" below it, such as "2 ps"; of movies, {time} and {frame} in both '
        "texts are those of the frame",
    )
    group.add_argument(
        "--axes", action="store_const", const=True, help="show how x, y and z lie, in a corner"
    )
    group.add_argument(
        "--label",
        metavar="X,Y,Z:TEXT",
        type=_label,
        action="append",
        help="write a text at a point, or of data a COLUMN at all that are drawn; may be repeated",
    )
    group.add_argument(
        "--scale-bar", metavar="UNIT", dest="scalebar", help="show a scale bar, =nm for its unit"
    )
    group.add_argument(
        "--color-bar",
        metavar="TEXT",
        dest="colorbar",
        help="show what values colours stand for, and how bright points shine; =TEXT to write "
        "above that, =TEXT;TEXT of several",
    )


def value_of(options: argparse.Namespace, name: str) -> Any:  # noqa: ANN401
    """Return the value of an option of `KEYWORDS`, None if it was not given.

    That of a bar without one is True, and for several bars, texts stand between semicolons.
    """
    value = getattr(options, name, None)
    if name == "colorbar" and value is not None and ";" in value:
        return [text.strip() for text in value.split(";")]
    return True if value == "" and name in ("scalebar", "colorbar") else value


def annotations_of(
    options: argparse.Namespace, of_data: Mapping[str, Any] = MappingProxyType({})
) -> dict[str, Any]:
    """Return what to call `vtray.Image.annotated` with; empty if nothing is asked for.

    Parameters
    ----------
    options
        The options.
    of_data
        What data add to these: their ``legend``, and ``labels``.
    """
    given = {name: value_of(options, name) for name in KEYWORDS}
    found = {name: value for name, value in given.items() if value is not None}
    if options.label:
        found["labels"] = labels_of(options)[0]
    for name, value in of_data.items():
        found[name] = [*found["labels"], *value] if name == "labels" else value
    return found
