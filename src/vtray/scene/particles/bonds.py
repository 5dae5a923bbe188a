"""Bonds: which particles are near enough to each other, also across the borders of a cell."""

import math
from collections.abc import Iterator, Sequence
from itertools import product
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from vtray.base.errors import SceneError
from vtray.base.number import number_of
from vtray.scene.particles.elements import NO_ELEMENT, are_anions, are_metals
from vtray.scene.particles.lattice import Lattice, columns_of, lattice_of
from vtray.scene.particles.nearest_image import nearest_shifts
from vtray.scene.particles.pairs import pairs_of
from vtray.scene.particles.radii import radii_of

if TYPE_CHECKING:
    from vtray.scene.particles.particles import Particles
    from vtray.scene.particles.radii import Radii

Floats = NDArray[np.float64]
Integers = NDArray[np.int64]

FACTOR = 1.2
"""How much longer than the sum of two covalent radii a bond may be. It takes in those that heat has
stretched, and hydrogen molecules; hydrogens of one molecule of water are twice as far apart."""

SLICES = 3
"""How many slices a box of the grid has along x: neighbours in a row are one run of these."""

MOST_BOXES = 2**20
"""How many boxes the grid has at most along an axis, so that its numbers fit into 64 bits."""

FEW_BEYOND = 1000
"""Points at each end that may be beyond the grid, where it would be too wide: they count as on its
border, so there must not be many."""

CANDIDATES = 2**17
"""How many pairs are looked at at once; their arrays stay in the cache."""

FEW_BONDS = 100_000
"""So many bonds there may be in any case."""

MOST_BONDS = 64
"""Bonds for each particle, on average, above which lengths cannot be in the unit of the radii."""

MOST_IMAGES = 20_000
"""Images of the cell that are looked at; bonds that reach so many cells are no bonds."""

AHEAD = ((1, 0), (-1, 1), (0, 1), (1, 1))
"""Rows of boxes that come after one, as steps along y and z."""

AROUND = tuple(product((-1, 0, 1), repeat=2))
"""All rows of boxes around one, and itself."""


class Bonds(NamedTuple):
    """Which particles are bound.

    Attributes
    ----------
    pairs
        The two particles of each, as indices, (m, 2).
    shifts
        By how many edges of the cell the second one is to be moved to stand beside the first,
        (m, 3); all 0 where nothing repeats.
    """

    pairs: Integers
    shifts: Integers

    def __len__(self) -> int:
        return len(self.pairs)

    def some(self, chosen: Any) -> "Bonds":  # noqa: ANN401
        """Return those that an index chooses."""
        return Bonds(self.pairs[chosen], self.shifts[chosen])

    def after(self, moves: Integers) -> "Bonds":
        """Return the same bonds after particles have been moved back by whole edges, (n, 3)."""
        ahead = moves[self.pairs[:, 1]] - moves[self.pairs[:, 0]]
        return Bonds(self.pairs, self.shifts + ahead)


def find_bonds(
    particles: "Particles",
    factor: float = FACTOR,
    radii: "Radii" = "covalent",
    *,
    cutoff: float | None = None,
    with_sites: bool = False,
) -> Bonds:
    """Return the bonds of particles: those nearer than `factor` times the sum of their radii.

    Distance alone decides, for hydrogens too: with covalent radii, two of them are bound up to
    0.74 Å, as in a hydrogen molecule, and no others come so near to each other. With covalent
    radii, metals that are both bound to anions are not bound to each other: radii are those of
    atoms, and ions of metals are so much smaller that they are near without a bond, as titanium is
    to titanium in rutile. X, which is no element, is then bound to nothing. In a cell that repeats,
    each pair of images counts once, also where the cell is thinner than a bond.

    Parameters
    ----------
    particles
        The particles; those at the same place are not bound.
    factor
        What the sum of two radii is multiplied by, > 0.
    radii
        As for `Scene.add_particles`: "covalent" or "vdw" for those of the elements in ångström, a
        number, an array (n,), or the name of a column.
    cutoff
        How long a bond may be, whatever the radii, in the unit of the positions.
    with_sites
        Whether X is bound with covalent radii, too, as part of a molecule.

    Returns
    -------
    Bonds
        Pairs of indices, the lower one first, and for each how many edges of the cell the second
        particle is to be moved by.

    Raises
    ------
    SceneError
        The radii are not known, an argument is not right, or there are so many bonds that lengths
        must be in another unit.
    """
    if len(particles) == 0:
        return Bonds(np.zeros((0, 2), np.int64), np.zeros((0, 3), np.int64))
    reach = _reach(particles, factor, radii, cutoff)
    longest = 2.0 * float(reach.max())
    points = columns_of(particles.positions)
    lattice = lattice_of(particles)
    moves = None if lattice is None else lattice.outside(points)
    if lattice is not None and moves is not None:
        points = lattice.moved(points, [-moves[:, k] for k in range(3)])
    grid = _Grid.build(points, longest)
    limit = MOST_BONDS * len(particles)
    found = [(one, two, None) for one, two in grid.pairs_within(reach, limit)]
    pairs = [np.stack([one, two], axis=1) for one, two, _ in found]
    shifts = [np.zeros((len(one), 3), np.int64) for one, _, _ in found]
    if lattice is not None:
        # In a cell that is thinner than a bond, few particles may have many.
        limit = max(limit, FEW_BONDS) - sum(map(len, pairs))
        for rows, shift in _images(points, lattice, longest):
            there = [column[rows] for column in points]
            for one, two in grid.pairs_with(lattice.moved(there, shift), reach[rows], reach, limit):
                limit -= len(one)
                pairs.append(np.stack([two, rows[one]], axis=1))
                shifts.append(np.broadcast_to(np.array(shift, np.int64), (len(one), 3)))
    bonds = Bonds(np.concatenate(pairs), np.concatenate(shifts))
    if moves is not None:
        bonds = bonds.after(-moves)
    bonds = _lower_first(bonds)
    if cutoff is None and isinstance(radii, str) and radii == "covalent":
        symbols = particles["element"]
        if not with_sites:
            bonds = bonds.some((symbols != NO_ELEMENT)[bonds.pairs].all(axis=1))
        bonds = bonds.some(~_join_ions(bonds, symbols))
    return bonds


def bonds_between(particles: "Particles", pairs: Any) -> Bonds:  # noqa: ANN401
    """Return bonds that are known, each to the image of its second end that is nearest.

    Parameters
    ----------
    particles
        The particles.
    pairs
        Indices, (m, 2).

    Raises
    ------
    SceneError
        They are no pairs of indices.
    """
    given = pairs_of(pairs, len(particles), "bonds")
    lattice = lattice_of(particles)
    if lattice is None:
        return Bonds(given, np.zeros((len(given), 3), np.int64))
    return Bonds(given, nearest_shifts(lattice, columns_of(particles.positions), given))


def _reach(particles: "Particles", factor: object, radii: "Radii", cutoff: object) -> Floats:
    """Return for each particle its part of how long a bond may be, (n,)."""
    given = factor if cutoff is None else cutoff
    name = "factor" if cutoff is None else "cutoff"
    value = number_of(given)
    if not 0.0 < value < np.inf:
        raise SceneError(f"find_bonds: {name}: expected a number > 0, got {given!r}")
    if cutoff is not None:
        return np.full(len(particles), 0.5 * value)
    found = radii_of(particles, radii, "find_bonds: radii")
    return value * np.broadcast_to(np.asarray(found, np.float64), len(particles))


def _images(
    points: Sequence[Floats], lattice: Lattice, longest: float
) -> Iterator[tuple[Integers, tuple[int, int, int]]]:
    """Give which points have an image near the points, and by how many edges that is moved.

    Of two images that are opposite, one: the other shows the same bonds from their other ends.
    """
    fractions = lattice.fractions(points)
    low = [float(column.min()) for column in fractions]
    high = [float(column.max()) for column in fractions]
    margins = [longest / height for height in lattice.heights]
    most = [
        int(np.floor(margins[k] + high[k] - low[k])) if lattice.periodic[k] else 0 for k in range(3)
    ]
    if math.prod(2 * count + 1 for count in most) > MOST_IMAGES:
        raise _too_many()
    steps = [range(-count, count + 1) for count in most]
    least = [float(column.min()) - longest for column in points]
    most_ = [float(column.max()) + longest for column in points]
    for shift in product(*steps):
        if shift <= (0, 0, 0):
            continue
        near = np.ones(len(points[0]), np.bool_)
        for k in range(3):
            if shift[k]:
                near &= fractions[k] >= low[k] - margins[k] - shift[k]
                near &= fractions[k] <= high[k] + margins[k] - shift[k]
        rows = np.flatnonzero(near)
        moved = lattice.moved([column[rows] for column in points], shift)
        inside = np.ones(len(rows), np.bool_)
        for column, first, last in zip(moved, least, most_, strict=True):
            inside &= (column >= first) & (column <= last)
        if inside.any():
            yield rows[inside], (shift[0], shift[1], shift[2])


def _join_ions(bonds: Bonds, symbols: NDArray[Any]) -> NDArray[np.bool_]:
    """Tell which bonds are those of two metals that are both bound to anions, (m,)."""
    one, two = bonds.pairs.T
    metals, anions = are_metals(symbols), are_anions(symbols)
    ions = np.zeros(len(symbols), np.bool_)
    ions[one[metals[one] & anions[two]]] = True
    ions[two[metals[two] & anions[one]]] = True
    both: NDArray[np.bool_] = ions[one] & ions[two]
    return both


def _lower_first(bonds: Bonds) -> Bonds:
    """Return the same bonds, each from the particle with the lower index."""
    turned = bonds.pairs[:, 0] > bonds.pairs[:, 1]
    pairs = np.where(turned[:, None], bonds.pairs[:, ::-1], bonds.pairs)
    shifts = np.where(turned[:, None], -bonds.shifts, bonds.shifts)
    return Bonds(pairs, shifts)


class _Grid(NamedTuple):
    """Points sorted into the boxes of a grid, row by row along x.

    Attributes
    ----------
    points
        Their coordinates in the order of the boxes, three columns.
    order
        Which points these are.
    keys
        The numbers of their slices, ascending.
    low, high
        Where the grid begins and ends. A few points may be beyond.
    sides
        The sides of its slices.
    counts
        How many there are along x and y, with empty ones around.
    longest
        How far a pair may be apart.
    """

    points: list[Floats]
    order: Integers
    keys: Integers
    low: list[float]
    high: list[float]
    sides: list[float]
    counts: tuple[int, int]
    longest: float

    @classmethod
    def build(cls, points: Sequence[Floats], longest: float) -> "_Grid":
        """Sort points."""
        ends = [_ends(column, MOST_BOXES * longest) for column in points]
        low, high = ([end[k] for end in ends] for k in range(2))
        extents = [end - start for start, end in ends]
        sides = [max(longest, extent / MOST_BOXES) for extent in extents]
        sides = [max(sides[0] / SLICES, extents[0] / MOST_BOXES), *sides[1:]]
        across, down = (int(extent / side) + 1 for extent, side in zip(extents[:2], sides[:2]))  # noqa: B905
        grid = cls(
            [],
            np.zeros(0, np.int64),
            np.zeros(0, np.int64),
            low,
            high,
            sides,
            (across + 4 * SLICES + 2, down + 4),
            longest,
        )
        keys = grid._keys(points)
        order = np.argsort(keys, kind="stable")
        return grid._replace(
            points=[column[order] for column in points], order=order, keys=keys[order]
        )

    def _keys(self, points: Sequence[Floats]) -> Integers:
        """Return the numbers of the slices that points are in."""
        # What is beyond counts as just outside: what is bound stays in boxes side by side.
        x, y, z = (
            np.floor((column.clip(low - self.longest, high + self.longest) - low) / side).astype(
                np.int64
            )
            for column, low, high, side in zip(points, self.low, self.high, self.sides, strict=True)
        )
        across, down = self.counts
        # Empty boxes before the first, so that steps to neighbours never lead to another row.
        return ((z + 2) * down + (y + 2)) * across + (x + 2 * SLICES + 1)

    def pairs_within(self, reach: Floats, limit: int) -> Iterator[tuple[Integers, Integers]]:
        """Give the pairs of its own points that are bound, each once."""
        mine, numbers = reach[self.order], np.arange(len(self.keys))
        across, down = self.counts
        last = np.searchsorted(self.keys, self.keys + SLICES, side="right")
        runs = [(numbers + 1, last)]
        for dy, dz in AHEAD:
            runs.append(self._run(self.keys + (dz * down + dy) * across))
        for first, end in runs:
            for one, two in self._bound(self.points, mine, mine, first, end, limit):
                limit -= len(one)
                yield self.order[one], self.order[two]

    def pairs_with(
        self, others: Sequence[Floats], their_reach: Floats, reach: Floats, limit: int
    ) -> Iterator[tuple[Integers, Integers]]:
        """Give the pairs of other points and its own that are bound."""
        keys, mine = self._keys(others), reach[self.order]
        across, down = self.counts
        for dy, dz in AROUND:
            first, end = self._run(keys + (dz * down + dy) * across)
            for one, two in self._bound(others, their_reach, mine, first, end, limit):
                yield one, self.order[two]

    def _run(self, keys: Integers) -> tuple[Integers, Integers]:
        """Return where the points begin and end that are in slices or beside them."""
        first = np.searchsorted(self.keys, keys - SLICES, side="left")
        return first, np.searchsorted(self.keys, keys + SLICES, side="right")

    def _bound(
        self,
        points: Sequence[Floats],
        reach: Floats,
        mine: Floats,
        first: Integers,
        end: Integers,
        limit: int,
    ) -> Iterator[tuple[Integers, Integers]]:
        """Give which of the points are bound to which of its own in runs, some at a time."""
        lengths = np.maximum(end - first, 0)
        total = np.cumsum(lengths)
        begin, square = 0, self.longest * self.longest
        while begin < len(total):
            done = total[begin - 1] if begin else 0
            stop = max(int(np.searchsorted(total, done + CANDIDATES, side="right")), begin + 1)
            count = lengths[begin:stop]
            one = np.repeat(np.arange(begin, stop), count)
            two = np.arange(len(one)) + np.repeat(
                first[begin:stop] - (total[begin:stop] - count - done), count
            )
            begin = stop
            distance = np.zeros(len(one))
            for theirs, own in zip(points, self.points, strict=True):
                apart = theirs[one] - own[two]
                with np.errstate(over="ignore"):
                    apart *= apart
                distance += apart
            near = np.flatnonzero(distance <= square)
            one, two, distance = one[near], two[near], distance[near]
            length = reach[one] + mine[two]
            with np.errstate(over="ignore"):
                bound = (distance <= length * length) & (distance > 0.0)
            limit -= int(np.count_nonzero(bound))
            if limit < 0:
                raise _too_many()
            yield one[bound], two[bound]


def _ends(column: Floats, most: float) -> tuple[float, float]:
    """Return where coordinates begin and end, without a few where they would reach too far."""
    low, high = float(column.min()), float(column.max())
    if high - low > most:
        few = min(len(column) // 8, FEW_BEYOND)
        last = len(column) - 1 - few
        ordered = np.partition(column, [few, last])
        low, high = float(ordered[few]), float(ordered[last])
    return low, high


def _too_many() -> SceneError:
    """Give the error for bonds that are far longer than the particles are apart."""
    words = f"there are more than {MOST_BONDS} bonds for each particle"
    remedy = "radii of elements are in ångström; give the longest bond, or a shorter one"
    return SceneError(f"bonds: {words}; {remedy}")
