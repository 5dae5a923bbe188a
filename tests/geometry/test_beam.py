"""A beam misses no box that one of its rays meets, and leaves out what is clearly away."""

from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from machine_code import instructions_in

from conftest import compiled_only, once
from vtray.base.compiler.compiled import Kernel
from vtray.base.compiler.object_code import compile_object
from vtray.geometry.bvh.boxes import Bounds
from vtray.geometry.bvh.nodes import OUTSIDE
from vtray.geometry.bvh.tree import SIDES, WIDTH, Bvh
from vtray.geometry.packets import beam as beams
from vtray.geometry.packets.beam import Beam, beam_margin, lower_limit, make_beam, upper_limit

Vec = tuple[float, float, float]
Box = tuple[Any, Any]

NO_OFFSET = (0.0, 0.0, 0.0)
COORDINATES = st.integers(-8, 8).map(lambda k: k / 4) | st.floats(-3, 3, width=32)
COMPONENTS = (
    st.sampled_from([0.0, -0.0, 1e-320, -1e-320, 1e-31, -1e-31, 1e-30, 1e-12, -1e-12, 1.0, -1.0])
    | st.floats(-1, 1)
    | st.floats(-1e-9, 1e-9)
)
WIDTHS = st.sampled_from([0.0, 5e-324, 1e-320, 1e-17, 1e-6, 0.3]) | st.floats(0, 0.5)


def vectors(part: st.SearchStrategy[float]) -> st.SearchStrategy[Vec]:
    return st.tuples(part, part, part)


ENTERED = np.zeros(WIDTH, np.float32)


def children_met(bvh: Bvh, node: int, beam: Beam, start: float, end: float) -> int:
    """Return a bit for each child that a beam may meet with s between two bounds."""
    limits = np.float32(lower_limit(beam, start)), np.float32(upper_limit(beam, end))
    return beams.children_met(bvh, node, in_singles(beam), *limits, ENTERED)


def in_singles(beam: Beam) -> Beam:
    """Return a beam as it is in kernels; to Python, all their numbers are of double precision."""
    near, far = (
        Bounds(bounds.side, *(tuple(map(np.float32, three)) for three in bounds[1:]))
        for bounds in (beam.near, beam.far)
    )
    return Beam(near, far, beam.ahead)


def ask(bvh: Any, node: Any, beam: Any, start: Any, end: Any, entered: Any) -> Any:
    return beams.children_met(bvh, node, beam, start, end, entered)


@compiled_only
def test_boxes_of_a_node_are_tested_side_by_side() -> None:
    beam = make_beam(NO_OFFSET, NO_OFFSET, (1.0, 1.0, 1.0), (1.0, 1.0, 1.0), 0.0)
    bvh = node_of([((-1.0,) * 3, (1.0,) * 3)])
    limits = np.float32(0.0), np.float32(1.0)
    code = compile_object(ask, (bvh, 0, in_singles(beam), *limits, ENTERED), Kernel._options).code
    # Of x86-64 and of aarch64: several numbers of single precision are compared at once.
    assert instructions_in(code) & {"mulps", "vmulps", "fcmge", "fcmgt"}


def node_of(boxes: list[Box]) -> Bvh:
    """Return a node whose children have these boxes, the last of which stands for all others."""
    sides = np.empty((6, WIDTH), np.float32)
    for k in range(WIDTH):
        low, high = boxes[min(k, len(boxes) - 1)]
        sides[:3, k], sides[3:, k] = low, high
    return Bvh(np.tile(sides.reshape(-1), 2), np.zeros(2 * WIDTH, np.int32))


def first_meeting(apex: Vec, way: Vec, low: Vec, high: Vec) -> float:
    """Return the least s >= 0 at which a ray is in a box, infinite if it is nowhere."""
    enter, leave = np.longdouble(0), np.longdouble(np.inf)
    for start, step, near, far in zip(apex, way, low, high, strict=True):
        if step == 0:
            if not near <= start <= far:
                return np.inf
            continue
        bounds = [(np.longdouble(side) - start) / np.longdouble(step) for side in (near, far)]
        enter, leave = max(enter, min(bounds)), min(leave, max(bounds))
    return float(enter) if enter <= leave else np.inf


@once
@given(
    vectors(COORDINATES),
    vectors(WIDTHS),
    vectors(COMPONENTS),
    vectors(WIDTHS),
    st.lists(
        st.tuples(vectors(COORDINATES), vectors(COORDINATES | WIDTHS)), min_size=1, max_size=8
    ),
    st.integers(0, 2**32 - 1),
)
def test_no_box_is_missed(
    near: Vec, starts: Vec, low: Vec, widths: Vec, corners: list[tuple[Vec, Vec]], seed: int
) -> None:
    far = tuple(a + b for a, b in zip(near, starts, strict=True))
    high = tuple(a + b for a, b in zip(low, widths, strict=True))
    boxes = [(np.minimum(*corner), np.maximum(*corner)) for corner in corners]
    bvh = node_of(boxes)
    random = np.random.default_rng(seed)
    inside = random.uniform(0, 1, (2, 20, 3))
    inside[:, :8] = np.round(inside[:, :8])
    ways = np.clip(np.array(low) + inside[0] * widths, low, high)
    # From a point, as in perspective and for shadows, and from a box, as in an orthographic view.
    points = np.broadcast_to(near, ways.shape)
    places = np.clip(np.array(near) + inside[1] * starts, near, far)
    one = make_beam(near, near, low, high, beam_margin(near, NO_OFFSET))
    assert_all_met(one, bvh, boxes, points, ways)
    many = make_beam(near, far, low, high, beam_margin(near, NO_OFFSET))
    assert_all_met(many, bvh, boxes, places, ways)
    assert_all_met(many, bvh, boxes, places[::-1], ways)


def assert_all_met(
    beam: Beam, bvh: Bvh, boxes: list[Box], starts: np.ndarray, ways: np.ndarray
) -> None:
    """Check that a beam meets the boxes that rays from some starts into some directions meet."""
    for end in (1.0, 3.0, np.inf):
        met = children_met(bvh, 1, beam, 0.0, end)
        for start, way in zip(starts, ways, strict=True):
            for k in range(len(boxes)):
                s = first_meeting(start, way, *np.float32(boxes[k]))
                # Far beyond the boxes' frame only the margin's share of a step is promised.
                if s <= min(end, 1e12):
                    assert met >> k & 1
                    assert float(ENTERED[k]) + beam.ahead <= s


AWAY = [
    ((0.0, 0.0, 1.0), (0.0, 0.0, 1.0)),
    ((0.6, 0.0, 0.8), (0.6, 0.0, 0.8)),
    ((-0.1, -0.1, 1.0), (0.1, 0.1, 1.0)),
    ((-0.1, 0.05, 0.9), (0.1, 0.1, 1.0)),
    ((-0.5, -1e-320, 0.1), (-0.4, 1e-320, 0.2)),
    ((-1.0, -1.0, -1.0), (-0.9, -0.9, -0.9)),
]


@pytest.mark.parametrize(("low", "high"), AWAY)
@pytest.mark.parametrize("apex", [(0.0, 0.0, 0.0), (0.5, -1.0, 2.0)])
def test_boxes_that_are_clearly_away_are_left_out(apex: Vec, low: Vec, high: Vec) -> None:
    middle = (np.array(low) + high) / 2
    across = np.cross(middle, (0.3, 0.5, -0.2))
    across *= 1.5 / np.linalg.norm(across)
    places = [2 * middle, -2 * middle, 2 * middle + across, 2 * middle - across, 9 * middle]
    boxes = [(tuple(p + apex - 0.01), tuple(p + apex + 0.01)) for p in places]
    beam = make_beam(apex, apex, low, high, beam_margin(apex, NO_OFFSET))
    assert children_met(node_of(boxes), 0, beam, 0.0, 3.0) == 0b00001
    assert children_met(node_of(boxes), 1, beam, 0.0, np.inf) == 0b11110001
    assert children_met(node_of(boxes), 0, beam, 3.0, np.inf) == 0b11110000
    assert children_met(node_of(boxes), 0, beam, 0.0, 1.0) == 0


@pytest.mark.parametrize("distance", [1e2, 1e5, 1e8])
@pytest.mark.parametrize("way", [(0.6, 0.0, 0.8), (-0.48, 0.64, 0.6), (0.0, 0.0, 1.0)])
def test_boxes_beside_a_beam_from_far_away_are_left_out(distance: float, way: Vec) -> None:
    apex = tuple(-distance * np.array(way))
    across = np.cross(way, (0.3, 0.5, -0.2))
    across *= 0.04 / np.linalg.norm(across)
    places = [np.zeros(3), across, -across, 2 * np.array(way), -2 * np.array(way) + across]
    boxes = [(tuple(p - 0.01), tuple(p + 0.01)) for p in places]
    beam = make_beam(apex, apex, way, way, beam_margin(apex, NO_OFFSET))
    assert children_met(node_of(boxes), 0, beam, 0.0, np.inf) == 0b01001
    assert children_met(node_of(boxes), 0, beam, 0.0, distance + 1) == 0b00001
    assert children_met(node_of(boxes), 0, beam, distance + 1, np.inf) == 0b01000


def test_sides_of_an_empty_child_are_not_met() -> None:
    nothing = (OUTSIDE,) * 3, (-OUTSIDE,) * 3
    for low, high in AWAY:
        beam = make_beam(NO_OFFSET, NO_OFFSET, low, high, beam_margin(NO_OFFSET, NO_OFFSET))
        assert children_met(node_of([nothing]), 0, beam, 0.0, np.inf) == 0
    assert len(node_of([nothing]).sides) == 2 * SIDES
