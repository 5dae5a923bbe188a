"""Hierarchies over boxes of any kind of thing, and several hierarchies in one pair of arrays."""

import tracemalloc
from collections.abc import Iterable, Iterator
from typing import Any

import numpy as np
import pytest
from clouds import CLOUDS, cloud
from sphere_trees import build_spheres

from conftest import JIT, compiled_only, once
from vtray.geometry.bvh import build as bvh_build
from vtray.geometry.bvh.build import Tree, build
from vtray.geometry.bvh.join import join_trees
from vtray.geometry.bvh.primitives import GivenBoxes
from vtray.geometry.bvh.tree import EMPTY, EVERYWHERE, WIDTH, Bvh, leaf_range
from vtray.geometry.rounding import MARGIN

COUNT = 2000 if JIT else 60


def leaves_below(bvh: Bvh, root: int) -> Iterator[tuple[np.ndarray, slice]]:
    """Yield box and slots of each leaf of one of the trees."""
    child, sides = bvh.child.reshape(-1, WIDTH), bvh.sides.reshape(-1, 6, WIDTH)
    for k, below in enumerate(child[root].tolist()):
        if below < EMPTY:
            yield sides[root, :, k], slice(*leaf_range(below))
        elif below != EMPTY:
            assert (sides[root, :3, k] == sides[below, :3].min(axis=1)).all()
            assert (sides[root, 3:, k] == sides[below, 3:].max(axis=1)).all()
            yield from leaves_below(bvh, below)


def some_boxes(seed: int, count: int = COUNT) -> tuple[np.ndarray, np.ndarray]:
    """Return low and high corners."""
    random = np.random.default_rng(seed)
    low = random.normal(size=(count, 3)) * (1, 10, 0.1)
    return low, low + random.uniform(0, 1, (count, 3)) * (0.2, 0.001, 3)


def check(tree: Tree, bvh: Bvh, root: int, slot: int, low: np.ndarray, high: np.ndarray) -> None:
    """See that each box is in one leaf, and that the leaves fit their boxes."""
    scale, origin = tree.frame
    seen = []
    for box, slots in leaves_below(bvh, root):
        numbers = tree.numbers[slots.start - slot : slots.stop - slot]
        seen += numbers.tolist()
        inner = (low[numbers] * scale - origin).min(axis=0)
        outer = (high[numbers] * scale - origin).max(axis=0)
        assert (box[:3] <= inner - 0.5 * MARGIN * np.abs(inner)).all()
        assert (box[3:] >= outer + 0.5 * MARGIN * np.abs(outer)).all()
        np.testing.assert_allclose(box, [*inner, *outer], rtol=2e-6, atol=1e-10)
    assert sorted(seen) == list(range(len(low)))


@pytest.mark.parametrize("count", [1, 5, 9, COUNT])
def test_boxes(count: int) -> None:
    low, high = some_boxes(1, count)
    tree = build(GivenBoxes(low, high), 2)
    check(tree, tree.bvh, 0, 0, low, high)
    middle, half = low / 2 + high / 2, high / 2 - low / 2
    assert tree.largest == max(np.abs(middle).max(), half.max())


@pytest.mark.parametrize("axis", range(3))
def test_the_frame_holds_the_longest_side(axis: int) -> None:
    corner = np.ones((1, 3))
    corner[0, axis] = 9
    tree = build(GivenBoxes(-corner, corner), 1)
    assert tree.largest == 9
    assert tree.frame == (1 / 16, (0, 0, 0))


@pytest.mark.parametrize("crowd", [20, 10**9])
@pytest.mark.parametrize("beyond", [-1, bvh_build.MOST_BEYOND])
def test_one_far_away_costs_no_quality(
    crowd: int, beyond: int, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(bvh_build, "MOST_BEYOND", beyond)
    monkeypatch.setattr(bvh_build, "SMALL", 16)
    monkeypatch.setattr(bvh_build, "CROWD", crowd)
    center = np.random.default_rng(5).uniform(size=(COUNT, 3))
    # So far that all others are in few cells, and boxes are still finer than leaves.
    far = 1e5 if JIT else 1e6

    def size_of_leaves(center: np.ndarray) -> float:
        tree = build(GivenBoxes(center, center), 1)
        boxes = np.array([box for box, _ in leaves_below(tree.bvh, 0)], float)
        is_everywhere = boxes[:, 3] == np.float32(EVERYWHERE)
        assert is_everywhere.sum() <= 1
        boxes = boxes[~is_everywhere]
        return float((boxes[:, 3:] - boxes[:, :3]).mean() / tree.frame.scale)

    alone = size_of_leaves(center)
    with_one = size_of_leaves(np.concatenate([center, [[far, 0, 0]]]))
    assert with_one < 1.2 * alone + far * 2.0**-22


def test_boxes_of_spheres_make_the_tree_of_spheres() -> None:
    # Integers, so that centres come back from corners exactly.
    random = np.random.default_rng(3)
    center, radius = (
        random.integers(-999, 999, (COUNT, 3)) * 1.0,
        random.integers(0, 9, COUNT) * 1.0,
    )
    spheres = build_spheres(center, radius, 1)
    tree = build(GivenBoxes(center - radius[:, None], center + radius[:, None]), 1)
    assert tree[2:] == spheres[2:]
    assert (tree.bvh.sides == spheres.bvh.sides).all()
    assert (tree.bvh.child == spheres.bvh.child).all()
    assert (tree.numbers == spheres.leaves.number).all()


def test_boxes_as_large_as_doubles() -> None:
    most = np.finfo(float).max
    tree = build(GivenBoxes(np.full((1, 3), -most), np.full((1, 3), most)), 1)
    sides = tree.bvh.sides.reshape(6, WIDTH)[:, 0]
    assert tree.largest == most
    np.testing.assert_allclose(sides, [-1] * 3 + [1] * 3, rtol=1e-6)


def test_several_trees_stand_in_one_pair_of_arrays() -> None:
    given = [some_boxes(seed, count) for seed, count in ((1, COUNT), (2, 3), (3, COUNT // 2))]
    trees = [build(GivenBoxes(*corners), 1) for corners in given]
    slots = [0, COUNT, COUNT + 3]
    for threads in (1, 2):
        bvh, roots = join_trees([tree.bvh for tree in trees], threads, slots)
        for tree, root, slot, corners in zip(trees, roots.tolist(), slots, given, strict=True):
            check(tree, bvh, root, slot, *corners)
    bvh, roots = join_trees([tree.bvh for tree in trees])
    for tree, root, corners in zip(trees, roots.tolist(), given, strict=True):
        check(tree, bvh, root, 0, *corners)


@once
@pytest.mark.parametrize("name", CLOUDS)
def test_crowds_are_divided_by_all_threads(name: str, monkeypatch: pytest.MonkeyPatch) -> None:
    spheres = cloud(name, COUNT, 2)
    center = np.ascontiguousarray(spheres.center, float)
    radius = np.broadcast_to(np.asarray(spheres.radius, float), COUNT)
    low, high = center - radius[:, None], center + radius[:, None]
    monkeypatch.setattr(bvh_build, "MOST_BEYOND", -1)
    monkeypatch.setattr(bvh_build, "SMALL", 16)
    monkeypatch.setattr(bvh_build, "CHUNK", 100 if JIT else 11)
    whole = build(GivenBoxes(low, high), 1)
    crowds: list[int] = []
    divide = bvh_build._divide_crowd
    monkeypatch.setattr(bvh_build, "CROWD", 20)
    monkeypatch.setattr(bvh_build, "_divide_crowd", lambda *a: (crowds.append(1), divide(*a)))
    trees = [build(GivenBoxes(low, high), threads) for threads in (1, 2, 3)]
    assert crowds or name not in {"one_point", "cluster_and_outlier"}
    for tree in trees:
        assert tree[2:3] + tree[4:] == whole[2:3] + whole[4:]
        assert tree.tree_depth <= whole.tree_depth + 3
        for one, two in zip(
            (tree.numbers, *tree.bvh), (trees[0].numbers, *trees[0].bvh), strict=True
        ):
            assert one.tobytes() == two.tobytes()
        seen = [number for _, s in leaves_below(tree.bvh, 0) for number in tree.numbers[s].tolist()]
        assert sorted(seen) == list(range(COUNT))


def test_zeros_of_two_signs_leave_the_frame_the_same(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(bvh_build, "CHUNK", 10)
    center = np.zeros((40, 3))
    center[:, 0] = np.arange(40)
    center[:10, 1:] = -0.0
    first = build(GivenBoxes(center, center), 1)
    run = bvh_build.run_tasks

    def run_backwards(tasks: Iterable, *arguments: Any, **options: Any) -> None:
        run(list(tasks)[::-1], *arguments, **options)

    monkeypatch.setattr(bvh_build, "run_tasks", run_backwards)
    second = build(GivenBoxes(center, center), 1)
    assert np.array(first.frame.origin).tobytes() == np.array(second.frame.origin).tobytes()


@compiled_only
@pytest.mark.parametrize("name", ["uniform", "one_point", "cluster_and_outlier"])
def test_memory_of_building(name: str) -> None:
    count = 300_000
    spheres = cloud(name, count, 1)
    radius = np.atleast_1d(np.array(spheres.radius, float))
    build_spheres(spheres.center[:70_000], radius[:1], 2)
    tracemalloc.start()
    try:
        built = build_spheres(spheres.center, radius, 2)
        peak = tracemalloc.get_traced_memory()[1]
    finally:
        tracemalloc.stop()
    assert len(built.leaves.number) == count
    assert peak <= 100 * count
