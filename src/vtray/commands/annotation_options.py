"""The options for what is painted onto a picture: a title, axes, a scale bar, colour bars."""

import argparse
from collections.abc import Sequence
from typing import Any

from vtray.base.errors import OutputError
from vtray.commands.command import Parser

WITH_VALUE = ("--scale-bar", "--color-bar")
"""Options whose value is only what follows an equals sign, so that a file after them is none."""

KEYWORDS = ("title", "time", "axes", "scalebar", "colorbar", "legend")
"""The keywords of `vtray.Image.annotated` that options give; data alone have a legend."""


def with_values(arguments: Sequence[str]) -> list[str]:
    """Return arguments in which each of `WITH_VALUE` has one, "" where none was given."""
    end = arguments.index("--") if "--" in arguments else len(arguments)
    return [
        f"{argument}=" if argument in WITH_VALUE and k < end else argument
        for k, argument in enumerate(arguments)
    ]


def add_annotations(parser: Parser) -> None:
    """Add what is painted onto the picture."""
    group = parser.add_argument_group("on the picture")
    group.add_argument("--title", metavar="TEXT", help="write a title at the top")
    group.add_argument("--time", metavar="TEXT", help='write "t = TEXT" below it, such as "2 ps"')
    group.add_argument(
        "--axes", action="store_const", const=True, help="show how x, y and z lie, in a corner"
    )
    group.add_argument(
        "--scale-bar", metavar="UNIT", dest="scalebar", help="show a scale bar, =nm for its unit"
    )
    group.add_argument(
        "--color-bar",
        metavar="TEXT",
        dest="colorbar",
        help="show what values colours stand for, =TEXT to write above that",
    )


def annotations_of(options: argparse.Namespace) -> dict[str, Any]:
    """Return what to call `vtray.Image.annotated` with; empty if nothing is asked for.

    Raises
    ------
    OutputError
        The file is not one for painted pixels.
    """
    given = {name: getattr(options, name, None) for name in KEYWORDS}
    found = {name: value for name, value in given.items() if value is not None}
    for name in ("scalebar", "colorbar"):
        if found.get(name) == "":
            found[name] = True
    if found and options.pixel is None:
        from vtray.image.formats.image_format import check_plain_format

        check_plain_format(options.output)
        if options.bits not in (None, 8):
            message = (
                f"{options.output}: annotations: expected 8 bits with them, got {options.bits}"
            )
            raise OutputError(message)
    return found
