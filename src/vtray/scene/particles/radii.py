"""How large particles are: by element, by a column, or by how far they are apart."""

from typing import TYPE_CHECKING, Any, TypeAlias

import numpy as np
from numpy.typing import NDArray

from vtray.base.errors import SceneError
from vtray.scene.checks.given_array import array_of, show_array
from vtray.scene.checks.scene_words import nearest, show
from vtray.scene.particles import elements
from vtray.scene.particles.column_names import column_called

if TYPE_CHECKING:
    from numpy.typing import ArrayLike

    from vtray.scene.particles.particles import Particles

Floats = NDArray[np.float64]
Radii: TypeAlias = "str | float | ArrayLike"

CROWD = 16
"""Particles in a box, on average, twice as many as there are in boxes of two mean distances: with
more, they fill but a part of the space around all."""

MOST_BOXES = 2**19
"""How many boxes there are at most along an axis, so that their numbers fit into 64 bits."""

MARKED = 8
"""Boxes for each particle up to which all of them are marked: in the memory of their numbers, and
for three million particles in 0.05 s, ten times as fast as numbers are sorted."""

_BORDERS = (2.0**1.5, 2.0**2.5)
"""Growth of the number of filled boxes, as they become half as large, between one and two, and two
and three dimensions."""

FILLED = 0.5
"""Radius of particles whose size is not known, in mean distances: as near balls touch."""


def radii_of(particles: "Particles", radii: Radii, place: str) -> Floats | float:
    """Return radii in the unit of the positions, (n,), or one for all.

    Parameters
    ----------
    particles
        The particles.
    radii
        "covalent" or "vdw" for those of the elements, in ångström; a number, an array (n,), or the
        name of a column.
    place
        What messages begin with.

    Raises
    ------
    SceneError
        They are not known, or no numbers ≥ 0.
    """
    if isinstance(radii, str) and radii in elements.RADII:
        if "element" not in particles.columns:
            remedy = "there is no column element; give a number, an array, or the name of a column"
            raise SceneError(f"{place}: {radii} radii are those of elements, and {remedy}")
        return elements.radii_of(particles["element"], radii)
    if isinstance(radii, str) and column_called(radii, particles.columns) not in particles.columns:
        known = [*elements.RADII, *particles.columns]
        close = nearest(radii, known, cutoff=0.6)
        hint = f"; did you mean {close}?" if close else ""
        words = f"expected {', '.join(elements.RADII)}, a number, or a column, got {show(radii)}"
        raise SceneError(f"{place}: {words}{hint}")
    given: Any = radii
    if isinstance(radii, str):
        given, place = particles[radii], f"{place}: column {radii!r}"
    array = array_of(given, place, "expected numbers")
    if array.dtype.kind not in "iuf":
        raise SceneError(f"{place}: expected numbers, got {show_array(given)}")
    found = array.astype(np.float64, copy=False)
    if found.shape not in ((), (len(particles),)):
        words = f"expected one number, or {len(particles)}, one for each particle"
        raise SceneError(f"{place}: {words}, got shape {found.shape}")
    right = np.isfinite(found) & (found >= 0)
    if not right.all():
        first = int(np.flatnonzero(~right.ravel())[0])
        where = f"{place}[{first}]" if found.ndim else place
        raise SceneError(f"{where}: expected a number ≥ 0, got {float(found.ravel()[first])}")
    return found if found.ndim else float(found)


def mean_spacing(particles: "Particles") -> float:
    """Return how far particles are apart on average, in the unit of the positions.

    That is the side of the cube that one of them has in the box around all. Where they lie in a
    plane, or on a line, within that distance, it is the side of a square, or a length, instead.
    Where they fill but a part of the box, such as the surface of a landscape, it is that in the
    small boxes which they do fill.
    """
    positions = particles.positions
    if len(positions) == 0:
        return 1.0
    sides = sorted(
        (float(column.max()) - float(column.min()) for column in positions.T), reverse=True
    )
    count = float(len(positions))
    for power in (3, 2, 1):
        # Each side counts with half a particle more at both of its ends.
        volume = 1.0
        for side in sides[:power]:
            volume *= side
        spacing = _root(volume / count, power)
        if spacing > 0.0 and sides[power - 1] >= spacing:
            return _local_spacing(positions, spacing, sides[0])
    return 1.0


def _local_spacing(positions: NDArray[Any], spacing: float, longest: float) -> float:
    """Return how far particles are apart where they are, if that is less than in the whole box.

    Parameters
    ----------
    positions
        Of all, (n, 3).
    spacing
        How far they would be apart if they filled the box around all.
    longest
        The longest side of that.
    """
    count, side = len(positions), 2.0 * spacing
    filled = filled_boxes(positions, side)
    if count <= CROWD * filled:
        return spacing
    while count > CROWD * filled:
        if side * MOST_BOXES < longest:
            return spacing  # many are at one place
        larger, side = filled, side / 2
        filled = filled_boxes(positions, side)
    # Half as large boxes are twice as many on a line, four times on a surface.
    growth = filled / larger
    power = 1 if growth < _BORDERS[0] else 2 if growth < _BORDERS[1] else 3
    return side / _root(count / filled, power)


def filled_boxes(positions: NDArray[Any], side: float) -> int:
    """Return how many boxes of a grid have particles in them."""
    x, y, z = (np.floor((column - column.min()) / side).astype(np.int64) for column in positions.T)
    wide, deep, high = (int(column.max()) + 1 for column in (x, y, z))
    numbers = (z * deep + y) * wide + x
    if wide * deep * high <= MARKED * len(numbers):
        marks = np.zeros(wide * deep * high, np.bool_)
        marks[numbers] = True
        return int(np.count_nonzero(marks))
    numbers.sort()
    return 1 + int(np.count_nonzero(numbers[1:] != numbers[:-1]))


def _root(value: float, power: int) -> float:
    """Return a root of a number ≥ 0 by Newton's rule, the same on every machine."""
    if value == 0.0 or power == 1:
        return value
    guess = max(value, 1.0)
    while True:
        below = guess * guess if power == 3 else guess
        better = ((power - 1) * guess + value / below) / power
        if not better < guess:
            return guess
        guess = better
