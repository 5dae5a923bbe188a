"""What the scripts of the gallery share: soft light, and their command line.

    python examples/packing.py [OUTPUT] [--small]

OUTPUT is the picture to write, that of the gallery unless said otherwise. `--small` makes a small
picture of few spheres, to try things out.
"""

import argparse
from collections.abc import Callable, Mapping, Sequence
from pathlib import Path
from typing import Protocol

import numpy as np
from numpy.typing import NDArray

import vtray as vt

IMAGES = Path(__file__).resolve().parents[1] / "docs" / "images" / "gallery"
SMALLER = 8
"""How many times smaller a small picture is, in width and height."""


class Picture(Protocol):
    """What a script makes: an image of vtray's or of Pillow's."""

    def save(self, path: Path, /) -> None:
        """Write the picture to a file."""


def even_directions(count: int) -> NDArray[np.float64]:
    """Return unit vectors that are spread evenly over all directions, (count, 3)."""
    k = np.arange(count)
    height = 1 - (2 * k + 1) / count
    turn = k * np.pi * (3 - np.sqrt(5))
    ring = np.sqrt(1 - height**2)
    return np.stack([ring * np.cos(turn), ring * np.sin(turn), height], axis=1)


def lamp(
    center: Sequence[float], radius: float, intensity: float, count: int = 24
) -> list[vt.Light]:
    """Return a round lamp, many lights inside of a sphere: its shadows have soft edges."""
    # The cube root fills the sphere evenly.
    depth = (((np.arange(count) + 0.5) * 0.618034) % 1) ** (1 / 3)
    places = np.asarray(center) + radius * depth[:, None] * even_directions(count)
    return [vt.Light(place, intensity / count) for place in places]


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
