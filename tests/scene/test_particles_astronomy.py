"""Objects of yt and pynbody, by what they look like."""

from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

import vtray
from vtray.base.errors import SceneError
from vtray.scene.particles.from_objects import as_particles

POINTS = np.arange(15.0).reshape(5, 3)


class Quantity:
    """Numbers with a unit, as yt gives them."""

    def __init__(self, numbers: Any, units: str) -> None:
        self.numbers, self.units = np.array(numbers, np.float64), units

    def __len__(self) -> int:
        return len(self.numbers)

    def __array__(self, *_: Any, **__: Any) -> Any:
        return self.numbers

    def to(self, units: str) -> Any:
        """Return the numbers in another unit, which is twice as large."""
        return Quantity(self.numbers / 2, units)


class Region:
    """What is chosen of a data set of yt, which reads a field when it is asked for."""

    def __init__(self, data: Any, fields: Any) -> None:
        self.ds, self.fields = data, fields
        self.field_data: dict[Any, Any] = {}

    def __getitem__(self, field: Any) -> Any:
        self.field_data[field] = self.fields[field]
        return self.fields[field]


def yt_data(*kinds: str) -> Any:
    """Return a data set of yt, and all data of it."""
    fields: dict[Any, Any] = {}
    for kind in kinds:
        rows = POINTS[:2] if kind == "star" else POINTS[2:]
        fields[kind, "particle_position"] = Quantity(rows, "code_length")
        fields[kind, "particle_mass"] = Quantity(rows[:, 0], "g")
        fields[kind, "density"] = Quantity(rows[:, 1], "g/cm**3")
        fields[kind, "cells"] = Quantity(np.ones((2, 2, 2)), "")
    fields["grid", "density"] = Quantity(np.ones((2, 2, 2)), "")
    data = SimpleNamespace(
        particle_types_raw=(*kinds, "grid") if kinds else None,
        derived_field_list=[*fields],
        domain_left_edge=Quantity([-2, -4, -6], "cm"),
        domain_width=Quantity([4, 8, 12], "cm"),
        periodicity=(True, False, True),
    )
    data.all_data = lambda: Region(data, fields)
    return data


def test_data_sets_of_yt() -> None:
    found = as_particles(yt_data("star", "gas"))
    assert found["type"].tolist() == ["gas"] * 3 + ["star"] * 2
    assert found.positions.tolist() == [*POINTS[2:].tolist(), *POINTS[:2].tolist()]
    assert found["mass"].tolist() == [6, 9, 12, 0, 3]
    assert set(found.columns) == {"type", "mass"}
    assert (found.cell.tolist(), found.origin.tolist()) == (
        np.diag([2.0, 4.0, 6.0]).tolist(),
        [-1, -2, -3],
    )
    assert found.periodic == (True, False, True)


def test_what_is_chosen_of_data_of_yt() -> None:
    region = yt_data("star", "gas").all_data()
    for name in ("density", "cells"):
        region["gas", name]  # a program asks for it
    region["grid", "density"]
    found = as_particles(region)
    assert np.array_equal(found["density"], [7, 10, 13, np.nan, np.nan], equal_nan=True)
    assert set(found.columns) == {"type", "mass", "density"}
    assert found.cell is None
    drawn = vtray.Scene().add_particles(region, select="type == 'star'")
    assert drawn.indices.tolist() == [3, 4]
    assert "type" not in as_particles(yt_data("gas")).columns


def test_data_of_yt_without_particles() -> None:
    for data in (yt_data(), yt_data().all_data()):
        with pytest.raises(
            SceneError, match="^add_particles: the data set of yt has no particles; "
        ):
            vtray.Scene().add_particles(data)


class Snapshot:
    """A snapshot of pynbody, or a part of one: rows of arrays."""

    def __init__(self, arrays: Any, kinds: Any, rows: Any = None, loadable: Any = None) -> None:
        self.arrays, self.kinds = arrays, np.array(kinds)
        self.rows = np.arange(len(kinds)) if rows is None else rows
        self.loadable = {} if loadable is None else loadable

    def __len__(self) -> int:
        return len(self.rows)

    def keys(self) -> list[str]:
        """Return what is read, and known of all these."""
        return [name for name, of in self.arrays.items() if not np.isnan(of[self.rows]).any()]

    def loadable_keys(self) -> list[str]:
        """Return what is in the file."""
        return [*self.loadable]

    def families(self) -> list[Any]:
        """Return the families that there are, in the order of all."""
        names = ("dm", "gas", "star")
        return [SimpleNamespace(name=name) for name in names if name in self.kinds[self.rows]]

    def get_index_list(self, other: Any) -> Any:
        """Return where these are in another."""
        return np.flatnonzero(np.isin(other.rows, self.rows))

    def __getitem__(self, key: Any) -> Any:
        if isinstance(key, str):
            if key in self.loadable:
                self.arrays[key] = self.loadable[key]
            return self.arrays[key][self.rows]
        rows = self.rows[self.kinds[self.rows] == key.name]
        return Snapshot(self.arrays, self.kinds, rows, self.loadable)


GAS_FIRST = ["gas", "gas", "dm", "star", "star"]


def test_snapshots_of_pynbody() -> None:
    arrays = {
        "pos": POINTS,
        "x": POINTS[:, 0],
        "rho": np.array([1, 2, np.nan, np.nan, np.nan]),
        "cubes": np.zeros((5, 2, 2)),
    }
    later = {"vel": -POINTS, "mass": np.arange(5.0), "temp": np.ones(5)}
    found = as_particles(Snapshot(arrays, GAS_FIRST, loadable=later))
    assert found.positions.tolist() == POINTS.tolist()
    assert found["type"].tolist() == GAS_FIRST
    assert (found["velocity"].tolist(), found["mass"].tolist()) == (
        (-POINTS).tolist(),
        [0, 1, 2, 3, 4],
    )
    assert np.array_equal(found["rho"], [1, 2, np.nan, np.nan, np.nan], equal_nan=True)
    assert set(found.columns) == {"type", "velocity", "mass", "rho"}


def test_families_of_pynbody() -> None:
    snapshot = Snapshot({"pos": POINTS}, GAS_FIRST)
    found = as_particles(snapshot[SimpleNamespace(name="star")])
    assert (found.positions.tolist(), dict(found.columns)) == (POINTS[3:].tolist(), {})


@pytest.mark.parametrize(
    ("snapshot", "message"),
    [
        (
            Snapshot({}, GAS_FIRST),
            "the snapshot of pynbody has no places; expected its array 'pos'",
        ),
        (
            Snapshot({"pos": POINTS}, GAS_FIRST, np.zeros(0, int)),
            "the snapshot of pynbody has no p",
        ),
    ],
)
def test_snapshots_of_pynbody_without_places(snapshot: Any, message: str) -> None:
    with pytest.raises(SceneError, match=f"^{message}"):
        as_particles(snapshot)
