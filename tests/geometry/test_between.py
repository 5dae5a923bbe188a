"""What stands between two points, through hierarchies and in a plain loop over everything."""

from typing import Any

import numpy as np
import pytest
from copied import molecules

import vtray
from conftest import JIT
from vtray.base.compiler.compiled import kernel
from vtray.geometry.between import first_between, is_occluded
from vtray.geometry.packets.stack import Stack, new_stack
from vtray.geometry.queries import NOTHING
from vtray.geometry.ray import Segment
from vtray.geometry.vector import magnitude
from vtray.geometry.world import NO_TREE, World
from vtray.rendering import hierarchy
from vtray.rendering.hierarchy import accelerate
from vtray.rendering.pack import pack
from vtray.scene.placing.bounds import balls_of, box_of


@kernel
def ask(world: World, points: Any, stack: Stack, found: Any) -> None:
    """Set the first thing between each pair of points, and whether there is any, (n, 2)."""
    for k in range(points.shape[0]):
        start = points[k, 0], points[k, 1], points[k, 2]
        end = points[k, 3], points[k, 4], points[k, 5]
        segment = Segment(start, end, 1.0, 1.0, magnitude(start), magnitude(end))
        found[k, 0] = first_between(world, segment, stack)
        found[k, 1] = 1 if is_occluded(world, segment, stack) else 0


@pytest.mark.parametrize("copied", [False, True])
def test_hierarchies_only_leave_out(copied: bool, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(hierarchy, "FEW", 4)
    scene = molecules()
    if not copied:
        scene.objects = [item for item in scene.objects if not isinstance(item, vtray.Copies)]
        numbers = np.random.default_rng(1)
        scene.add_spheres(numbers.uniform(-3, 3, (50, 3)), 0.4)
    packed = pack(scene, accelerate(scene))
    world = packed.arrays.world
    low, high = box_of(balls_of(scene, "test"))
    places = np.random.default_rng(2).uniform(low, high, (400 if JIT else 10, 2, 3))
    points = (places * world.scale - world.origin).reshape(-1, 6)
    found, plain = np.zeros((2, len(points), 2), np.int64)
    ask(world, points, new_stack(), found)
    groups = world.groups._replace(root=np.full_like(world.groups.root, NO_TREE))
    placed = world.places and world.places._replace(root=NO_TREE)
    ask(world._replace(groups=groups, places=placed), points, new_stack(), plain)
    np.testing.assert_array_equal(found, plain)
    np.testing.assert_array_equal(found[:, 1] == 1, found[:, 0] != NOTHING)
    assert (not JIT) or 0.1 < found[:, 1].mean() < 0.95
