"""How different two pictures look to people, as a command and as a function.

The measure is FLIP: for each pixel, from 0 to 1, how much someone notices who flips between the
two pictures, on a usual monitor at a usual distance (67 pixels per degree). The difference
image shows these errors in magma colours: black where the pictures look equal, over purple and
orange to pale yellow.

References
----------
Andersson et al., "FLIP: A Difference Evaluator for Alternating Images", HPG 2020.
"""

import argparse
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

from vtray.base.number import number_in
from vtray.commands.command import FAILURE, SUCCESS, Parser, print_result, run_command
from vtray.commands.values import wrong
from vtray.figures import comparison
from vtray.figures.comparison import check_same_size, read_picture

if TYPE_CHECKING:
    from vtray.figures.comparison import Channels
    from vtray.image.formats.image_file import Pixels

ALIKE, DIFFERENT = SUCCESS, 2

THRESHOLD = 0.01
"""Up to which mean error two pictures count as alike.

Measured on pictures of 1024 x 1024 pixels: 0.00006 for 319 pixels of speckle at a horizon; in the
room of the benchmarks 0.014 without one of its 64 lights, 0.03 to 0.04 without one of its 4
spheres, 0.03 with every channel one step of 255 brighter. The threshold lies between: above
specks, below a change of the light or of something large. As the error is a mean, an object of a
few pixels may vanish below it (one of 1,000 spheres, often 0.0002), which is why the command also
says how many pixels differ.
"""

LEAST_SHOWN = 0.0001
"""The least error whose digits are shown."""

DIFFERENCE_IMAGE = Path("difference.png")
USAGE = "usage: vtray-diff A.png B.png [-o DIFFERENCE.png] (more: vtray-diff --help)"
EPILOG = f"""\
exit status: {ALIKE} alike, {DIFFERENT} not alike, {FAILURE} something is wrong

The error is FLIP's, which says what people notice, averaged over the image: about 0.0001 for
specks in 300 of a million pixels, 0.03 for a ball missing in a room, or for one step of 255
everywhere. As it is an average, look also at how many pixels differ: images that count as alike
may lack something tiny. Use --threshold 0 to accept only what looks equal.

If one image has 16 bits per channel, both are compared so. Of the same picture, one with 8 bits
then differs by less than 257 of 65535, half of that on average, for which the error is about 0.02.
If one is transparent anywhere, both are compared on black and on white: more of each counts.

The difference image is black where the pictures look equal and bright where they do not.
"""


@dataclass(frozen=True, eq=False)
class Likeness:
    """How alike two pictures of the same size look.

    Attributes
    ----------
    flip
        Mean FLIP error: 0 for pictures that look equal, 1 for the greatest difference there is.
    pixels
        How many pixels each picture has.
    differing
        How many pixels are not equal.
    largest
        The largest difference of a channel, of `maximum`.
    error_map
        The FLIP error of each pixel in magma colours, uint8, (height, width, 3).
    maximum
        The largest value of a channel: 255, or 65535 where one has 16 bits per channel.
    """

    flip: float
    pixels: int
    differing: int
    largest: int
    error_map: "Pixels"
    maximum: int = 255

    def is_alike(self, threshold: float = THRESHOLD) -> bool:
        """Tell whether the pictures look alike: their mean error is at most `threshold`."""
        return self.flip <= threshold

    def __str__(self) -> str:
        """Say it in one line."""
        tiny = 0 < self.flip < LEAST_SHOWN
        flip = f"below {LEAST_SHOWN}" if tiny else f"{self.flip:.4f}"
        scale = "0: equal, 1: as different as can be"
        if not self.differing:
            return f"FLIP 0 ({scale}); all {self.pixels:,} pixels are equal"
        return (
            f"FLIP {flip} ({scale}); {self.differing:,} of {self.pixels:,} pixels differ, "
            f"by at most {self.largest} of {self.maximum}"
        )


def compare(a: "Channels", b: "Channels") -> Likeness:
    """Compare two pictures as people see them.

    Parameters
    ----------
    a, b
        The pixels of both, as for `vtray.compare`, such as `vtray.Image.pixels`.

    Returns
    -------
    Likeness
        The mean error, its map, and how many pixels differ.

    Raises
    ------
    DiffError
        The pictures are not of the same size, or are no pixels of 8 or 16 bits.
    ExtraError
        The package ``flip-evaluator`` is not installed.
    """
    found = comparison.compare(a, b)
    flip, error_map = found.flip_error("vtray-diff")
    counts = found.pixels, found.differing, found.largest
    return Likeness(flip, *counts, error_map, found.maximum)


def run(arguments: Sequence[str]) -> int:
    """Do what the arguments say; return the exit status."""
    return run_command(lambda: _run(_parse(arguments)))


def _parse(arguments: Sequence[str]) -> argparse.Namespace:
    """Return the arguments, checked as far as can be without reading the pictures."""
    from vtray.base.version import __version__

    parser = Parser(
        hint=USAGE,
        prog="vtray-diff",
        description="Say how different two images look to people.",
        epilog=EPILOG,
        formatter=argparse.RawDescriptionHelpFormatter,
    )
    parser.add_argument("a", metavar="A.png", type=Path, help="an image")
    parser.add_argument("b", metavar="B.png", type=Path, help="another image of the same size")
    parser.add_argument(
        "-o",
        "--output",
        metavar="DIFFERENCE.png",
        type=Path,
        help="where to write the difference image, also of images that are alike "
        f"(default: {DIFFERENCE_IMAGE}, and only if they are not alike)",
    )
    parser.add_argument(
        "--threshold",
        metavar="ERROR",
        type=_threshold,
        default=THRESHOLD,
        help="the largest mean error that counts as alike (default: %(default)s)",
    )
    parser.add_argument("-V", "--version", action="version", version=f"vtray-diff {__version__}")
    return parser.parse_args(arguments)


def _threshold(text: str) -> float:
    """Return the value of ``--threshold``."""
    value = number_in(text)
    if not 0.0 <= value <= 1.0:
        raise wrong("a number from 0 to 1", text)
    return value


def _run(options: argparse.Namespace) -> int:
    """Compare the files, print the result, write the difference image if it is wanted."""
    output = options.output or DIFFERENCE_IMAGE
    _check_output(output, options)
    found = compare(*_read_both(options.a, options.b))
    alike = found.is_alike(options.threshold)
    line = str(found)
    try:
        if options.output or not alike:
            _write(found.error_map, output)
            line += f"; see {output}"
    finally:
        print_result(f"{line}\n")
    return ALIKE if alike else DIFFERENT


def _check_output(output: Path, options: argparse.Namespace) -> None:
    """Raise OutputError, before any work is done, if the output cannot be written."""
    from vtray.base.atomic_file import check_spares, check_writable
    from vtray.image.formats.image_format import check_plain_format

    if options.output:
        check_plain_format(output)
        check_writable(output)
    what = "is one of the images to compare"
    check_spares(output, (options.a, options.b), what, "choose another name with -o")


def _read_both(a: Path, b: Path) -> "tuple[Channels, Channels]":
    """Read two image files of the same size."""
    from PIL import Image as PillowImage

    # Pillow takes large images for attacks; here a user has named them.
    PillowImage.MAX_IMAGE_PIXELS = None
    first, second = read_picture(a), read_picture(b)
    check_same_size(first, second, a, b)
    return first, second


def _write(error_map: "Pixels", output: Path) -> None:
    from vtray.image.formats.image_file import write_image

    write_image(error_map, output)
