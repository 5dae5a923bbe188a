"""Points of meshes, as PyVista and meshio have them, by objects with the same attributes."""

from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

import vtray
from vtray.base.errors import SceneError
from vtray.scene.particles.from_objects import as_particles

POINTS = np.random.default_rng(1).random((5, 3), np.float32)


class Arrays:
    """Arrays by their names, which are no dictionary, as those of PyVista."""

    def __init__(self, **arrays: Any) -> None:
        self._arrays = arrays

    def keys(self) -> list[str]:
        return [*self._arrays]

    def __getitem__(self, name: str) -> Any:
        return self._arrays[name]


@pytest.mark.parametrize("kind", [Arrays, dict])
def test_points_have_their_arrays(kind: Any) -> None:
    speed, velocity = np.arange(5), -2 * POINTS
    data = kind(Radius=speed + 0.5, Speed=speed, v=velocity, name=np.array([*"abcde"]))
    mesh = SimpleNamespace(points=POINTS, point_data=data, cell_data={"area": [1.0]})
    found = as_particles(mesh)
    assert np.array_equal(found.positions, POINTS)
    assert [*found.columns] == ["radius", "Speed", "v", "name"]
    assert found["radius"].tolist() == [0.5, 1.5, 2.5, 3.5, 4.5]
    assert np.array_equal(found["v"], velocity)
    assert found["name"].tolist() == [*"abcde"]


def test_what_is_not_of_each_point_is_left_out() -> None:
    data = {"tensors": np.zeros((5, 3, 3)), "few": np.zeros(4), "times": np.zeros(5, "M8[s]")}
    assert not as_particles(SimpleNamespace(points=POINTS, point_data=data)).columns


def test_meshes_are_drawn() -> None:
    scene = vtray.Scene()
    drawn = scene.add_particles(SimpleNamespace(points=POINTS, point_data={"radius": np.ones(5)}))
    assert drawn.spheres is not None
    assert np.array_equal(drawn.spheres.center, POINTS)
    assert (drawn.spheres.radius == 1).all()


def test_points_of_a_plane_are_refused() -> None:
    with pytest.raises(SceneError, match=r"must have shape \(n, 3\), got \(5, 2\)"):
        as_particles(SimpleNamespace(points=POINTS[:, :2], point_data={}))
