"""The triad: the axes of the world as the camera sees them."""

from collections.abc import Mapping
from typing import TYPE_CHECKING, NamedTuple

import numpy as np
from numpy.typing import NDArray

from vtray.base.exact_math import hypotenuse
from vtray.figures.point import point_of
from vtray.figures.sheet import FigureError
from vtray.scene.camera import Camera
from vtray.scene.placing.directions import dot
from vtray.scene.placing.moved import axes_of

if TYPE_CHECKING:
    from numpy.typing import ArrayLike

Floats = NDArray[np.float64]
Rgb = tuple[int, int, int]
Point = tuple[float, float]

WORLD: "Mapping[str, ArrayLike]" = {"x": (1, 0, 0), "y": (0, 1, 0), "z": (0, 0, 1)}

COLORS: tuple[Rgb, ...] = ((214, 39, 40), (34, 150, 60), (40, 100, 220))
"""Red, green and blue, as dark as can be told apart on white and as bright as on black."""


class Arm(NamedTuple):
    """An axis as a camera sees it.

    Attributes
    ----------
    name
        What is written at its tip.
    color
        Its colour.
    across, down
        How far its tip is to the right of, and below where it starts, in parts of its length.
    ahead
        How much farther from the camera, in parts of its length.
    """

    name: str
    color: Rgb
    across: float
    down: float
    ahead: float


def triad(camera: Camera, axes: "bool | Mapping[str, ArrayLike]") -> list[Arm]:
    """Return axes as a camera sees them in the middle of its picture, those that point away first.

    Parameters
    ----------
    camera
        The camera.
    axes
        True for x, y and z; or up to three directions in world space, of any length, by their
        names. False or nothing for none.

    Raises
    ------
    FigureError
        A direction is none.
    """
    if isinstance(axes, (bool, np.bool_)):
        axes = WORLD if axes else {}
    wanted = 'True, False or up to three directions by name, such as {"a": (1, 0, 0)}'
    if not isinstance(axes, Mapping) or len(axes) > len(COLORS):
        message = f"axes: expected {wanted}, got {axes!r}"
        raise FigureError(message)
    arms = []
    for (name, direction), color in zip(axes.items(), COLORS, strict=False):
        way = point_of(direction)
        if not isinstance(name, str) or way is None:
            message = f"axes: expected {wanted}, got {name!r}: {direction!r}"
            raise FigureError(message)
        length = hypotenuse(*way.tolist())
        if not 0.0 < length < np.inf:
            message = f"axes: expected directions of a length above 0, got {name!r}: {direction!r}"
            raise FigureError(message)
        one = (float(way[0]) / length, float(way[1]) / length, float(way[2]) / length)
        arms.append(Arm(name, color, *(dot(one, axis) for axis in axes_of(camera))))
    return sorted(arms, key=lambda arm: -arm.ahead)


ARM = 2.6
"""How long an arrow is that lies in the picture, in sizes of the font, as all lengths below."""

HEAD, WIDE, SHAFT = 0.7, 0.52, 0.15
"""Of an arrow: the length and width of its head, and the width of its shaft."""

DOT = 0.2
"""The radius of an arrow that points at the viewer, or away."""

OCTAGON = (
    *((-1.0, 0.0), (-0.7, -0.7), (0.0, -1.0), (0.7, -0.7)),
    *((1.0, 0.0), (0.7, 0.7), (0.0, 1.0), (-0.7, 0.7)),
)

BESIDE = 0.62
"""From the tip of an arrow to the middle of its name."""

LETTER, CAPITAL = 0.6, 0.75
"""About how wide and how high letters are."""

APART = 0.1
"""So much room between a name and all arrows and other names is enough."""

ALONG = tuple(ARM * k / 8 for k in range(9))
"""Where arrows are looked at."""

TURNS = ((1.0, 0.0), (0.7, 0.7), (0.7, -0.7), (0.0, 1.0), (0.0, -1.0), (-0.7, 0.7), (-0.7, -0.7))
"""Where a name stands by its tip: beyond it or, turned by eighths, ever more beside it."""


def arrow(arm: Arm) -> list[Floats]:
    """Return the convex polygons of an arrow, from where it starts, x right and y down, (n, 2)."""
    shown = hypotenuse(arm.across, arm.down)
    length = ARM * shown
    if length < SHAFT:  # it points at the viewer, or away
        return [DOT * np.array(OCTAGON)]
    along = np.array([arm.across, arm.down]) / shown
    side = np.array([-along[1], along[0]])
    head = min(HEAD, 0.75 * length)
    neck, half = along * (length - head), side * max(WIDE * head / HEAD, 2 * SHAFT) / 2
    # The shaft goes on within the head, so that no seam is seen between them.
    end, thin = neck + along * head / 3, side * SHAFT / 2
    shaft = [-thin, end - thin, end + thin, thin]
    return [np.array(shaft), np.array([neck - half, along * length, neck + half])]


def name_places(arms: list[Arm]) -> list[Point]:
    """Return the middles of the names of arrows, from where these start, x right and y down.

    A name stands beyond the tip of its arrow or, if another arrow or name is in its way, beside it;
    a long one farther away. Names of shorter arrows give way to those of longer ones.
    """
    away = -sum(arm.across for arm in arms), -sum(arm.down for arm in arms)
    lengths = [hypotenuse(arm.across, arm.down) for arm in arms]
    # Names, and points of arrows, which have no letters.
    taken = [((part * arm.across, part * arm.down), "") for arm in arms for part in ALONG]
    places: dict[int, Point] = {}
    for k in sorted(range(len(arms)), key=lambda k: -lengths[k]):
        arm = arms[k]
        # That of one at the viewer stands where no other points.
        across, down = (arm.across, arm.down) if lengths[k] > 0.05 else away
        length = hypotenuse(across, down) or 1.0
        x, y = ARM * arm.across, ARM * arm.down
        turned = [
            (
                x + reach * (across * c - down * s) / length,
                y + reach * (across * s + down * c) / length,
            )
            for reach in (BESIDE, BESIDE + LETTER * (len(arm.name) - 1) / 2)
            for c, s in TURNS
        ]
        gaps = [_gap(place, arm.name, taken) for place in turned]
        places[k] = turned[gaps.index(max(gaps))]
        taken.append((places[k], arm.name))
    return [places[k] for k in range(len(arms))]


def _gap(place: Point, name: str, taken: list[tuple[Point, str]]) -> float:
    """Return how much room is between a name and what is taken, `APART` at the most."""
    gaps = [APART]
    for (x, y), other in taken:
        across = abs(place[0] - x) - LETTER * (len(name) + len(other)) / 2
        gaps.append(max(across, abs(place[1] - y) - CAPITAL * (1 + bool(other)) / 2))
    return min(gaps)


def extent(arms: list[Arm], widths: list[float], height: float) -> tuple[Floats, Floats]:
    """Return the corners of the box around arrows and their names: upper left and lower right.

    Parameters
    ----------
    arms
        The arrows.
    widths, height
        Of their names.
    """
    corners = [point for arm in arms for part in arrow(arm) for point in part]
    for (x, y), width in zip(name_places(arms), widths, strict=True):
        corners += [np.array([x - width / 2, y - height / 2])]
        corners += [np.array([x + width / 2, y + height / 2])]
    return np.min(corners, axis=0), np.max(corners, axis=0)
