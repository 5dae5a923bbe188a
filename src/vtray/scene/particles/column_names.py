"""What columns are called: the same thing has the same name, whatever a file calls it."""

import re
from collections.abc import Iterable, Mapping, Sequence
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from numpy.typing import NDArray

    Array = NDArray[Any]

_CALLED = {
    "position": ("pos", "positions", "coordinates", "xyz", "center", "centers"),
    "element": ("elements", "species", "symbol", "symbols"),
    "type": ("types", "particle_type", "atom_types"),
    "name": ("names",),
    "radius": ("radii",),
    "diameter": ("diameters",),
    "color": ("colors", "colour", "colours", "rgb"),
    "velocity": ("velocities", "velo", "vel"),
    "force": ("forces", "frc"),
    "charge": ("charges", "q", "mmcharges"),
    "initial_charge": ("initial_charges",),
    "mass": ("masses",),
    "magmom": ("magmoms",),
    "initial_magmom": ("initial_magmoms",),
    "id": ("identifier", "particle_identifier", "atom_id"),
}
"""What each is called by files and libraries, beside its own name, in any case."""

_CANONICAL = {other: name for name, others in _CALLED.items() for other in (name, *others)}

_NUMBERS = ("z", "numbers", "atomic_numbers", "atomic_number", "atomic_num")
"""What columns of atomic numbers are called."""

VECTORS = {
    "velocity": ("vx", "vy", "vz"),
    "force": ("fx", "fy", "fz"),
    "normal": ("nx", "ny", "nz"),
    "color": ("red", "green", "blue"),
}
"""Columns that are one vector where all three are there."""


UNIT = r"\s+([\[(][^\[\]()]*[\])])"
"""A pattern for what follows a name: `` [nm]``; ``c_pe[1]`` has no unit."""

_WITH_UNIT = re.compile(rf"(.*\S){UNIT}")

_AXES = tuple(
    re.compile(
        rf"{axis}|(?:points?|pos(?:ition)?s?|coord(?:inate)?s?)[ ._:-]?[{axis}{number}]"
        rf"|{axis}[ ._-]?(?:pos(?:ition)?|coord(?:inate)?)"
    )
    for number, axis in enumerate("xyz")
)
"""How programs write x, y and z: ``Points:0``, ``x-coordinate``, ``Pos.x``, ``Position X``."""

IMAGES = ("ix", "iy", "iz")
"""Columns that say how many cells away a particle is from where it stands."""

IMAGE = "image"
"""One column of three that says the same."""


def canonical(name: str) -> str:
    """Return what a column is called here; its own name if that is not known."""
    return _CANONICAL.get(name.strip().lower().replace(" ", "_"), name)


def without_unit(name: str) -> tuple[str, str]:
    """Return a name without its unit, and this as it is written; "" if there is none."""
    match = _WITH_UNIT.fullmatch(name)
    return (match[1], match[2]) if match else (name, "")


def components_among(names: Iterable[str]) -> list[str]:
    """Return which columns are x, y and z, in that order; none if that is not clear.

    Those called so go before others that are clear alone: all with the same unit, or none.
    """
    known = list(names)
    called = {name.lower(): name for name in reversed(known)}
    if all(name in called for name in "xyz"):
        return [called[name] for name in "xyz"]
    bare = {name: without_unit(name.strip().lower()) for name in known}
    found = [[name for name in known if axis.fullmatch(bare[name][0])] for axis in _AXES]
    are_clear = all(len(of_axis) == 1 for of_axis in found)
    chosen = [name for of_axis in found for name in of_axis]
    return chosen if are_clear and len({bare[name][1] for name in chosen}) == 1 else []


def column_called(name: str, columns: "Mapping[str, Array]") -> str:
    """Return the name of the column that is meant: as it is called here, or as a file calls it."""
    return name if name in columns else canonical(name)


def name_twice(names: Sequence[str]) -> str | None:
    """Return the first name that comes a second time; None if there is none."""
    return next((name for i, name in enumerate(names) if name in names[:i]), None)


def name_columns(columns: "Mapping[str, Array]") -> "dict[str, Array]":
    """Give columns their names.

    Three that are one vector are joined, and atomic numbers become elements. Where there is no
    radius, half of a diameter is one. Names that are no symbols of elements are a ``type``. Where
    two columns would have one name, the second keeps its own.
    """
    import numpy as np

    from vtray.scene.checks.object_column import MISSING_NAME
    from vtray.scene.particles.elements import symbols_of, symbols_or_none

    named: dict[str, Array] = {}
    has_radius = any(canonical(name) == "radius" for name in columns)
    for name, values in join_vectors(columns).items():
        new, found = canonical(name), values
        if new == "diameter" and not has_radius and values.dtype.kind in "iuf":
            named["radius"] = values / 2
        if name.lower() in _NUMBERS and values.dtype.kind in "iu" and values.ndim == 1:
            new, found = "element", symbols_of(values)
        elif new == "element":
            known = symbols_or_none(values)
            new, found = ("type", values) if known is None else ("element", known)
            if known is not None and not np.isin(values[known != values], MISSING_NAME).all():
                named.setdefault("name", values)
        if new in named:
            new = name if name not in named else f"{name}2"
        named[new] = found
    return named


def join_vectors(columns: "Mapping[str, Array]") -> "dict[str, Array]":
    """Join columns that are one vector, at the place of the first."""
    import numpy as np

    lower = {name.lower(): name for name in columns}
    joined = dict(columns)
    for name, parts in VECTORS.items():
        if name in lower or not all(part in lower for part in parts):
            continue
        theirs = [lower[part] for part in parts]
        if any(
            columns[part].ndim != 1 or columns[part].dtype.kind not in "biuf" for part in theirs
        ):
            continue
        vector = np.stack([columns[part] for part in theirs], axis=1)
        joined = {
            (name if key == theirs[0] else key): (vector if key == theirs[0] else values)
            for key, values in joined.items()
            if key not in theirs[1:]
        }
    return joined
