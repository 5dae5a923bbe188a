"""Bonds as cylinders: whole ones, and halves where they cross the border of the cell."""

from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from vtray.scene.cylinders import Cylinders
from vtray.scene.particles.bonds import Bonds
from vtray.scene.particles.lattice import columns_of, lattice_of
from vtray.scene.particles.made_of import MadeOf, remember
from vtray.scene.particles.shown_bonds import Standing

if TYPE_CHECKING:
    from vtray.scene.particles.particles import Particles

Floats = NDArray[np.float64]
Integers = NDArray[np.int64]
Bytes = NDArray[np.uint8]


def sticks(
    particles: "Particles",
    positions: NDArray[Any],
    rows: Integers,
    bonds: Bonds,
    thick: float,
    radius: Floats | float,
    colors: Bytes,
) -> Cylinders:
    """Return bonds as cylinders, those that cross the border as halves at both of its sides.

    Colours change, and halves end, in the middle of what is seen between the balls.

    Parameters
    ----------
    particles
        All particles.
    positions
        Where they are drawn, (n, 3).
    rows
        Which of them are drawn, (k,).
    bonds
        Those between them.
    thick
        The radius of bonds.
    radius, colors
        Those of the balls that are drawn, (k,) and (k, 3), or one for all.
    """
    crosses = (bonds.shifts != 0).any(axis=1)
    whole, cut = bonds.pairs[~crosses], bonds.pairs[crosses]
    (one, two), (begin, end) = whole.T, cut.T
    near, far = positions[begin], positions[end]
    across = far
    lattice = lattice_of(particles)
    if lattice is not None and len(begin):
        across = np.stack(lattice.moved(columns_of(far), bonds.shifts[crosses].T), axis=1)
    place = _places(len(particles), rows)
    starts, ends = _between_balls(positions[one], positions[two], radius, place[one], place[two])
    way = across - near
    half = (1.0 + _larger_by(way, radius, place[begin], place[end])) / 2 * way
    starts = np.concatenate([starts, near, far])
    ends = np.concatenate([ends, near + half, far - (way - half)])
    joined = np.concatenate([whole, cut, cut])
    indices = np.concatenate([whole, cut[:, [0, 0]], cut[:, [1, 1]]])
    made = _colored(starts, ends, thick, colors, place[indices])
    return remember(made, MadeOf(particles, indices, "bond", joined=joined))


def whole_sticks(
    particles: "Particles",
    positions: NDArray[Any],
    rows: Integers,
    bonds: Standing,
    thick: float,
    radius: Floats | float,
    colors: Bytes,
) -> Cylinders:
    """Return bonds as cylinders, all of them whole, as `sticks` does."""
    near, far = bonds.ends(particles, positions)
    place = _places(len(particles), rows)[bonds.bonds.pairs]
    starts, ends = _between_balls(near, far, radius, *place.T)
    made = _colored(starts, ends, thick, colors, place)
    return remember(made, MadeOf(particles, bonds.bonds.pairs, "bond", bonds.copies))


def _places(count: int, rows: Integers) -> Integers:
    """Return for each of all particles its place among those that are drawn, (count,)."""
    place = np.zeros(count, np.int64)
    place[rows] = np.arange(len(rows))
    return place


def _between_balls(
    starts: NDArray[Any],
    ends: NDArray[Any],
    radius: Floats | float,
    one: Integers,
    two: Integers,
) -> tuple[NDArray[Any], NDArray[Any]]:
    """Return where bonds start and end, so that their middle is that of what is seen of them.

    The end in the larger ball moves. The parameters are as for `_larger_by`.
    """
    way = ends - starts
    share = _larger_by(way, radius, one, two)
    return starts + np.maximum(share, 0.0) * way, ends + np.minimum(share, 0.0) * way


def _colored(
    starts: NDArray[Any], ends: NDArray[Any], thick: float, colors: Bytes, each: Integers
) -> Cylinders:
    """Return cylinders in the colours of the two balls of each, (m, 2), or in one for all."""
    if colors.ndim == 1:
        return Cylinders(starts, ends, thick, colors)
    return Cylinders(starts, ends, thick, colors[each[:, 0]], color_end=colors[each[:, 1]])


def _larger_by(
    way: NDArray[Any], radius: Floats | float, one: Integers, two: Integers
) -> Floats | float:
    """Return by how much balls are larger than others, in parts of their distance, (m, 1).

    Parameters
    ----------
    way
        From each ball to the other, (m, 3).
    radius
        Of all balls that are drawn, (k,), or one for all.
    one, two
        Which balls they are, (m,).
    """
    if isinstance(radius, float):
        return 0.0
    x, y, z = way.T.astype(np.float64)
    length = np.sqrt(x * x + y * y + z * z)
    share = (radius[one] - radius[two]) / np.where(length > 0.0, length, 1.0)
    return np.clip(share, -1.0, 1.0)[:, None]
