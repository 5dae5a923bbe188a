"""The command line that the scripts of the gallery share.

    python examples/packing.py [OUTPUT] [--small]

OUTPUT is the picture to write, that of the gallery unless said otherwise. `--small` makes a small
picture of few spheres, to try things out.
"""

import argparse
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Protocol

IMAGES = Path(__file__).resolve().parents[1] / "docs" / "images" / "gallery"
SMALLER = 8
"""How many times smaller a small picture is, in width and height."""


class Picture(Protocol):
    """What a script makes: an image of vtray's or of Pillow's."""

    def save(self, path: Path, /) -> None:
        """Write the picture to a file."""


def run(
    draw: Callable[..., Picture],
    name: str,
    size: tuple[int, int],
    small: Mapping[str, int] | None = None,
) -> None:
    """Make the picture that the command line asks for.

    Parameters
    ----------
    draw
        Makes the picture, from its size in pixels and the numbers of `small`.
    name
        The file in the gallery.
    size
        Width and height of the picture there.
    small
        What else makes a picture small: numbers of things.
    """
    parser = argparse.ArgumentParser(description=(draw.__doc__ or "").splitlines()[0])
    parser.add_argument("output", nargs="?", type=Path, default=IMAGES / name)
    parser.add_argument("--small", action="store_true", help="a small picture, to try things out")
    options = parser.parse_args()
    if options.small:
        width, height = size
        picture = draw((width // SMALLER, height // SMALLER), **(small or {}))
    else:
        picture = draw(size)
    picture.save(options.output)
