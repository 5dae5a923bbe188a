"""Particles with what is known of each: what readers return, and what `add_particles` takes."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from types import MappingProxyType
from typing import TYPE_CHECKING, Any

from vtray.base.errors import SceneError
from vtray.scene.checks.given_array import array_of, show_array
from vtray.scene.particles.column_names import column_called
from vtray.scene.particles.expression import mask
from vtray.scene.particles.pairs import pairs_of

if TYPE_CHECKING:
    from pathlib import Path

    import numpy as np
    from numpy.typing import ArrayLike, NDArray

    Floats = NDArray[np.float64] | NDArray[np.float32]
    Integers = NDArray[np.int64]
else:
    Floats = Integers = Any

POSITION = ("x", "y", "z")
"""What the columns of the positions are called; no other column may have these names."""


@dataclass(frozen=True, eq=False)
class Particles:
    """Particles of one frame: atoms, colloids, stars, points of a scan.

    Arrays may be anything that NumPy makes an array of; they are shared where they are of a dtype
    named below, and never written to.

    Attributes
    ----------
    positions : array (n, 3)
        Places, finite, in the unit of length of the data; float64 or float32 as given, all else
        becomes float64.
    columns : mapping of str to array (n,) or (n, k)
        What is known of each particle, by name. Some names have a meaning where they are there:
        ``element`` (symbols, such as "Fe"), ``radius`` (in the unit of the positions), ``type`` (a
        number or a name), ``color`` (n, 3), and ``velocity``, ``force`` or other vectors (n, 3).
    bonds : array (m, 2) or None
        Which particles are bound, as indices; None where that is not known.
    cell : array (3, 3) or None
        The cell's three edges from `origin`, in rows; None if there is no cell, as where none of
        these has a length. Three numbers are the lengths of edges along x, y and z.
    origin : array (3,)
        The cell's corner; 0 by default.
    periodic : tuple of bool
        For each edge, whether the cell repeats along it; by default, wherever there is a cell.
        Along an edge of no length, such as that of a system in a plane, it never does.
    frame : int
        Which frame of its file this is, from 0.
    time : float or None
        When that was, in the unit of time of the data; None if that is not known.
    source : Path or None
        The file that it was read from.

    Raises
    ------
    SceneError
        An array has the wrong shape, or holds a wrong number. The message names the place.

    Examples
    --------
    >>> water = Particles([(0, 0, 0), (0.76, 0.59, 0), (-0.76, 0.59, 0)], {"element": list("OHH")})
    >>> len(water), list(water.columns)
    (3, ['element'])
    """

    positions: Floats
    columns: "Mapping[str, NDArray[Any]]" = field(default_factory=dict)
    bonds: Integers | None = None
    cell: "NDArray[np.float64] | None" = None
    origin: "NDArray[np.float64]" = (0.0, 0.0, 0.0)  # type: ignore[assignment]
    periodic: tuple[bool, bool, bool] | None = None
    frame: int = 0
    time: float | None = None
    source: "Path | None" = None

    if TYPE_CHECKING:  # what code may give, beside what the attributes hold

        def __init__(
            self,
            positions: ArrayLike,
            columns: Mapping[str, ArrayLike] = ...,
            bonds: ArrayLike | None = None,
            cell: ArrayLike | None = None,
            origin: ArrayLike = (0.0, 0.0, 0.0),
            periodic: Sequence[bool] | NDArray[np.bool_] | None = None,
            frame: int = 0,
            time: float | None = None,
            source: Path | None = None,
        ) -> None: ...

    def __post_init__(self) -> None:
        """Check and convert the arrays."""
        import numpy as np

        positions = _array(self.positions, "positions")
        if positions.ndim != 2 or positions.shape[1] != 3:
            raise SceneError(f"Particles.positions: must have shape (n, 3), got {positions.shape}")
        _check_finite(positions, "positions")
        if not hasattr(self.columns, "items"):
            words = 'must be arrays by their names, as in {"radius": radii}'
            raise SceneError(f"Particles.columns: {words}, got {show_array(self.columns)}")
        columns = {
            str(name): _column(str(name), values, len(positions))
            for name, values in self.columns.items()
        }
        bonds = self.bonds
        if bonds is not None:
            bonds = pairs_of(bonds, len(positions), "Particles.bonds")
        cell = self.cell
        if cell is not None:
            edges = _array(cell, "cell")
            cell = _numbers_of(np.diag(edges) if edges.shape == (3,) else edges, "cell", (3, 3))
        given = (cell is not None,) * 3 if self.periodic is None else self.periodic
        repeats = _three_of_bool(given)
        if cell is not None:
            repeats &= cell.any(axis=1)
            cell = cell if cell.any() else None
        found: dict[str, object] = {
            "positions": positions,
            "columns": MappingProxyType(columns),
            "bonds": bonds,
            "cell": cell,
            "origin": _numbers_of(self.origin, "origin", (3,)),
            "periodic": tuple(repeats.tolist()),
        }
        for name, value in found.items():
            object.__setattr__(self, name, value)

    def __reduce__(self) -> tuple[Any, ...]:
        values = {**vars(self), "columns": dict(self.columns)}
        return type(self), tuple(values[name] for name in self.__dataclass_fields__)

    def __len__(self) -> int:
        return len(self.positions)

    # Neither names nor rows come one by one: `columns` has the former, `select` takes the latter.
    __iter__ = None

    def __contains__(self, name: object) -> bool:
        """Tell whether there is a column of a name, as one asks for it in brackets."""
        if not isinstance(name, str):
            return False
        return name in POSITION or column_called(name, self.columns) in self.columns

    def __getitem__(self, name: str) -> "NDArray[Any]":
        """Return a column, or one of x, y and z.

        Raises
        ------
        SceneError
            There is none of this name.
        """
        given: object = name
        if not isinstance(given, str):
            words = 'rows are chosen by select="index < 5" as they are drawn'
            raise SceneError(f"expected the name of a column, got {show_array(given)}; {words}")
        called = column_called(name, self.columns)
        if called in self.columns:
            return self.columns[called]
        if name in POSITION:
            column: NDArray[Any] = self.positions[:, POSITION.index(name)]
            return column
        known = ", ".join([*POSITION, *self.columns])
        raise SceneError(f"no column {name!r}; there are {known}")

    def select(self, which: "str | ArrayLike") -> "Particles":
        """Return some of the particles.

        Parameters
        ----------
        which
            An expression that says which, such as ``"element == 'O' and z > 3"``; or an array of
            bool with one entry for each, or of indices, each at most once.

        Returns
        -------
        Particles
            With their columns, the bonds among them, and the cell.

        Raises
        ------
        SceneError
            The expression is not understood, or the array is not right.

        Examples
        --------
        >>> water = Particles([(0, 0, 0), (0.76, 0.59, 0), (-0.76, 0.59, 0)], {"element": [*"OHH"]})
        >>> water.select("element == 'H' and x > 0").positions.tolist()
        [[0.76, 0.59, 0.0]]
        """
        import numpy as np

        chosen = self._chosen(which)
        bonds = self.bonds
        if bonds is not None:
            places = np.full(len(self), -1)
            places[chosen] = np.arange(len(chosen))
            bonds = places[bonds]
            bonds = bonds[(bonds >= 0).all(axis=1)]
        columns = {name: values[chosen] for name, values in self.columns.items()}
        return replace(self, positions=self.positions[chosen], columns=columns, bonds=bonds)

    def _chosen(self, which: "str | ArrayLike") -> Integers:
        """Return the indices of some of the particles."""
        import numpy as np

        if isinstance(which, str):
            return np.flatnonzero(mask(self, which))
        count = len(self)
        words = f"expected an expression, {count} of bool, or indices"
        given = array_of(which, "select", words)
        if given.dtype == np.bool_ and given.shape == (count,):
            return np.flatnonzero(given)
        if given.ndim != 1 or (given.size and given.dtype.kind not in "iu"):
            raise SceneError(f"select: {words}, got {show_array(which)}")
        # Before they become integers with a sign, which the largest without one do not fit into.
        wrong = ((given < -count) | (given >= count)).nonzero()[0]
        if len(wrong):
            first = int(wrong[0])
            expected = f"an index from 0 to {count - 1}"
            raise SceneError(f"select[{first}]: expected {expected}, got {given[first]}")
        chosen = given.astype(np.int64) % max(count, 1)
        if len(np.unique(chosen)) < len(chosen):
            raise SceneError("select: expected each index at most once")
        return chosen

    def with_columns(self, **columns: "ArrayLike") -> "Particles":
        """Return the particles with further columns, or with others in their place.

        Raises
        ------
        SceneError
            A column does not have one row for each particle.

        Examples
        --------
        >>> import numpy as np
        >>> particles = Particles(np.zeros((3, 3)), {"type": np.array([1, 2, 2])})
        >>> silica = particles.with_columns(element=np.array(["", "Si", "O"])[particles["type"]])
        >>> silica["element"].tolist()
        ['Si', 'O', 'O']
        """
        return replace(self, columns={**self.columns, **columns})  # type: ignore[dict-item]

    def __repr__(self) -> str:
        parts = [f"{len(self)} particles", *self.columns]
        parts += [f"{len(self.bonds)} bonds"] if self.bonds is not None else []
        parts += ["cell"] if self.cell is not None else []
        return f"Particles({', '.join(parts)})"


def _array(values: object, name: str) -> "NDArray[Any]":
    """Return numbers as an array of doubles, or of floats of 32 bits as they are."""
    import numpy as np

    words = "must be an array of numbers"
    found = array_of(values, f"Particles.{name}", words, POSITION)
    if found.dtype.kind not in "iuf":
        raise SceneError(f"Particles.{name}: {words}, got {show_array(values)}")
    return found if found.dtype in (np.float32, np.float64) else found.astype(np.float64)


def _numbers_of(values: object, name: str, shape: tuple[int, ...]) -> "NDArray[np.float64]":
    """Return finite numbers as an array of a shape."""
    found = _array(values, name).astype(float, copy=False)
    if found.shape != shape:
        raise SceneError(f"Particles.{name}: must have shape {shape}, got {found.shape}")
    _check_finite(found, name)
    return found


def _three_of_bool(given: object) -> "NDArray[np.bool_]":
    """Return for each edge of a cell whether it repeats, (3,)."""
    words = "expected three of True and False, one for each edge"
    found = array_of(given, "Particles.periodic", words)
    if found.shape != (3,) or found.dtype.kind not in "biuf":
        raise SceneError(f"Particles.periodic: {words}, got {show_array(given)}")
    return found.astype(bool)


def _check_finite(array: "NDArray[Any]", name: str) -> None:
    """Raise SceneError if a number is not finite."""
    import numpy as np

    wrong = np.argwhere(~np.isfinite(array))
    if len(wrong):
        place = ", ".join(map(str, wrong[0]))
        value = float(array[tuple(wrong[0])])
        raise SceneError(f"Particles.{name}[{place}]: must be finite, got {value}")


def _column(name: str, given: object, count: int) -> "NDArray[Any]":
    """Return a column; raise SceneError if it does not have one row for each particle."""
    place = f"Particles.columns[{name!r}]"
    if name in POSITION:
        raise SceneError(f"{place}: x, y and z are those of the positions")
    words = f"must have one row for each of {count} positions"
    values = array_of(given, place, words)
    if values.ndim not in (1, 2) or len(values) != count:
        raise SceneError(f"{place}: {words}, got shape {values.shape}")
    return values
