"""The hierarchy itself: every sphere in one leaf, every box around what is below it."""

from typing import Any, NamedTuple

import numpy as np
import pytest
from clouds import CLOUDS, cloud
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra import numpy as arrays_of
from sphere_trees import Built
from sphere_trees import build_spheres as build

from conftest import JIT, compiled_only, once
from vtray.geometry.bvh import build as bvh_build
from vtray.geometry.bvh import key_sort
from vtray.geometry.bvh import split as bvh_split
from vtray.geometry.bvh.tree import (
    COUNT_BITS,
    COUNT_MASK,
    EMPTY,
    EVERYWHERE,
    FRAME,
    LEAF,
    MAX_TREE_DEPTH,
    SIDES,
    STACK,
    WIDTH,
)
from vtray.geometry.rounding import MARGIN

COUNT = 3000 if JIT else 60


class Walk(NamedTuple):
    """What was found on a way through a whole tree."""

    nodes: int
    tree_depth: int
    waiting: int


def walk(built: Built) -> Walk:
    """Visit all nodes as a search that meets everything does; check that boxes contain boxes."""
    child = built.bvh.child.reshape(-1, WIDTH)
    sides = built.bvh.sides.reshape(-1, 6, WIDTH)
    stack, nodes, tree_depth, waiting = [(0, 1)], 0, 0, 1
    slots: list[tuple[int, int]] = []
    boxes: list[np.ndarray] = []
    while stack:
        waiting = max(waiting, len(stack))
        node, level = stack.pop()
        nodes, tree_depth = nodes + 1, max(tree_depth, level)
        assert nodes <= len(child)
        for k, below in enumerate(child[node].tolist()):
            box = sides[node, :, k]
            if below >= 0:
                assert (box[:3] == sides[below, :3].min(axis=1)).all()
                assert (box[3:] == sides[below, 3:].max(axis=1)).all()
                stack.append((below, level + 1))
            elif below != EMPTY:
                first, count = ~below >> COUNT_BITS, ~below & COUNT_MASK
                assert 1 <= count <= LEAF
                slots.append((first, count))
                boxes.append(box)
            else:
                assert (box[:3] > box[3:]).all()
    check_leaves(built, np.array(boxes), slots)
    return Walk(nodes, tree_depth, waiting)


def check_leaves(built: Built, boxes: np.ndarray, slots: list[tuple[int, int]]) -> None:
    """See that boxes of leaves contain their spheres and the margin, and are not far too large."""
    order = sorted(range(len(slots)), key=lambda k: slots[k])
    firsts, counts = np.array(slots)[order].T
    box = boxes[order]
    # They hold all slots once.
    ends = np.cumsum(counts)
    assert firsts.tolist() == [0, *ends[:-1].tolist()]
    assert ends[-1] == len(built.leaves.number)
    data = built.leaves.data.reshape(-1, 4)[: ends[-1]].astype(np.longdouble)
    scale, origin = built.frame
    place = data[:, :3] * scale - np.array(origin, np.longdouble)
    radius = (data[:, 3] * scale)[:, None]
    margin = MARGIN * (np.abs(place).sum(axis=1)[:, None] + radius)
    low = np.minimum.reduceat(place - radius, firsts)
    high = np.maximum.reduceat(place + radius, firsts)
    assert (box[:, :3] <= np.minimum.reduceat(place - radius - 0.99 * margin, firsts)).all()
    assert (box[:, 3:] >= np.maximum.reduceat(place + radius + 0.99 * margin, firsts)).all()
    reach = np.abs(place).max(axis=1) + radius[:, 0]
    is_far = np.maximum.reduceat(reach, firsts) > FRAME
    assert (box[is_far, 3:] == -box[is_far, :3]).all()
    assert (box[is_far, 3:] == np.float32(EVERYWHERE)).all()
    extent = np.abs([low, high]).max(axis=0)
    slack = 2 * np.maximum.reduceat(margin, firsts) + 2.0**-21 * extent + 2.0**-147
    assert (box[:, :3] >= low - slack)[~is_far].all()
    assert (box[:, 3:] <= high + slack)[~is_far].all()


def check(center: np.ndarray, radius: np.ndarray, threads: int = 1) -> Built:
    """Build a tree, and check all that must be true of any tree."""
    built = build(center, radius, threads)
    n = len(center)
    found = walk(built)
    assert found.nodes * WIDTH == len(built.bvh.child)
    assert found.nodes * SIDES == len(built.bvh.sides)
    assert found.nodes <= n // 4 + 1 + n // bvh_build.SMALL
    assert found.tree_depth == built.tree_depth <= STACK // WIDTH
    assert found.waiting <= found.tree_depth * (WIDTH - 1) + 1 <= STACK
    # The slots hold all spheres once.
    number = built.leaves.number
    assert (np.sort(number) == np.arange(n)).all()
    data = built.leaves.data.reshape(-1, 4)
    np.testing.assert_array_equal(data[:, :3], center[number])
    np.testing.assert_array_equal(data[:, 3], np.broadcast_to(radius, n)[number])
    # The frame keeps everything near 1, but for a few.
    scale, origin = built.frame
    assert np.frexp(scale)[0] == 0.5
    is_near = (np.abs(center.astype(float) * scale - np.array(origin)) <= 4).all(axis=1)
    assert np.count_nonzero(~is_near) <= (0 if n < bvh_build.FEWEST else bvh_build.MOST_BEYOND)
    return built


def columns(name: str, count: int, seed: int = 0) -> tuple[np.ndarray, np.ndarray]:
    """Return centres and radii of a cloud."""
    spheres = cloud(name, count, seed)
    return np.ascontiguousarray(spheres.center), np.atleast_1d(np.array(spheres.radius, float))


def assert_equal_trees(one: Built, two: Built) -> None:
    """Compare two trees."""
    assert one[2:] == two[2:]
    np.testing.assert_array_equal(one.bvh.child, two.bvh.child)
    np.testing.assert_array_equal(one.bvh.sides, two.bvh.sides)
    assert (one.leaves.number == two.leaves.number).all()
    assert (one.leaves.data == two.leaves.data).all()


@once
@pytest.mark.parametrize("name", CLOUDS)
@pytest.mark.parametrize("count", [1, 2, 3, 8, 9, 64, COUNT])
def test_tree(name: str, count: int) -> None:
    check(*columns(name, count))


@compiled_only
@pytest.mark.parametrize("name", CLOUDS)
def test_large_tree(name: str) -> None:
    check(*columns(name, 20_000, 3))


@once
@pytest.mark.parametrize("name", CLOUDS)
def test_is_the_same_for_any_number_of_threads(name: str, monkeypatch: pytest.MonkeyPatch) -> None:
    # Small tasks, so that a small cloud takes all paths of a large one.
    monkeypatch.setattr(bvh_build, "SMALL", 16)
    monkeypatch.setattr(bvh_build, "CHUNK", 100 if JIT else 7)
    monkeypatch.setattr(key_sort, "SMALL", 32)
    points = columns(name, COUNT, 1)
    expected = check(*points)
    for threads in (2, 3, 7):
        assert_equal_trees(build(*points, threads), expected)


@compiled_only
@pytest.mark.parametrize("name", ["uniform", "float32", "one_point", "cluster_and_outlier"])
def test_is_the_same_for_any_number_of_threads_above_all_limits(name: str) -> None:
    points = columns(name, 100_000, 1)
    assert len(points[0]) > max(key_sort.SMALL, bvh_build.CHUNK)
    expected = build(*points, 1)
    assert_equal_trees(build(*points, 2), expected)
    assert_equal_trees(build(*points, 7), expected)


def test_bits_of_one_sphere() -> None:
    built = check(np.array([[1.0, 2.0, 3.0]]), np.array([0.5]))
    assert built.tree_depth == 1
    assert built.largest == 3.0
    assert built.frame == (1.0, (1.0, 2.0, 3.0))
    assert built.bvh.child[0] == ~(0 << COUNT_BITS | 1)
    assert (built.bvh.child[1:WIDTH] == EMPTY).all()
    assert_near = np.testing.assert_allclose
    assert_near(built.bvh.sides[::WIDTH], [-0.5] * 3 + [0.5] * 3, rtol=2.0**-22)


def test_space_of_boxes_far_from_the_origin() -> None:
    center = np.random.default_rng(3).uniform(-50, 50, (100, 3))
    near, far = check(center, np.array([0.2])), check(center + 1e6, np.array([0.2]))
    assert far.frame.scale == near.frame.scale == 2.0**-6
    assert far.largest > 1e6
    # No more than the digits of doubles allow: places are rounded, too.
    assert check(center + 1e15, np.array([0.2])).frame.scale == 2.0**-26


def test_spheres_at_one_point_or_without_size() -> None:
    for place in ((0.0, 0.0, 0.0), (-5e-324, 0.0, 5e-324), (1.7e308, -1.7e308, 0.0)):
        check(np.array([place] * COUNT), np.zeros(1))
        check(np.array([place] * 20), np.full(20, 1.7e308))


def test_depth_is_bounded(monkeypatch: pytest.MonkeyPatch) -> None:
    if not JIT:
        monkeypatch.setattr(bvh_split, "MAX_TREE_DEPTH", 2)
    # A thousand scales, which halve from one to the next: most splits take off few points. What
    # is symmetric has its middle at 0, where no scale is lost to rounding.
    random = np.random.default_rng(2)
    scales = 2.0 ** -np.arange(0, 1060, 1 if JIT else 50)
    half = (scales[:, None, None] * random.uniform(0.5, 1, (len(scales), 6, 3))).reshape(-1, 3)
    built = check(np.concatenate([half, -half]), np.zeros(1))
    assert (MAX_TREE_DEPTH if JIT else 2) < built.tree_depth <= STACK // WIDTH


COORDINATES = st.sampled_from([0.0, 1.0, -1.0, 5e-324, 1e-300, 1e-9, 1e9, 1e300, -1e300]) | (
    st.floats(-2, 2) | st.floats(allow_nan=False, allow_infinity=False)
)


@given(st.data(), st.integers(1, 60 if JIT else 20))
def test_tree_of_any_numbers(data: st.DataObject, count: int) -> None:
    draw = data.draw
    center = draw(arrays_of.arrays(np.float64, (count, 3), elements=COORDINATES))
    sizes: Any = COORDINATES.map(abs)
    radius = draw(arrays_of.arrays(np.float64, draw(st.sampled_from([1, count])), elements=sizes))
    check(center, radius)
