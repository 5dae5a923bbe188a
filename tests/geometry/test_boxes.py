"""What is written in LLVM's language does what NumPy does, to the last bit."""

from typing import Any

import numpy as np
from hypothesis import given
from hypothesis import strategies as st

from conftest import compiled_only
from vtray.base.compiler.compiled import device, uncompiled
from vtray.geometry.bvh.boxes import Bounds, boxes_met, fetch_early, fetch_node
from vtray.geometry.bvh.tree import SIDES, WIDTH, Bvh

NUMBERS = st.sampled_from([0.0, -0.0, 1.0, -1.0, 1e-44, 1e7, -1e7, 3e38, -3e38]) | st.floats(
    -8, 8, width=32
)
FACTORS = st.sampled_from([0.0, 1e-44, 1e30, -1e30]) | st.floats(-8, 8, width=32)
TRIPLES = st.tuples(NUMBERS, NUMBERS, NUMBERS)


@device
def ask(bvh: Any, near: Any, far: Any, limits: Any, entered: Any) -> Any:
    return boxes_met(bvh, SIDES, near, far, limits[0], limits[1], entered)


@device
def fetch(bvh: Any, child: Any) -> Any:
    fetch_node(bvh, child)
    fetch_early(bvh.sides, child)
    return child


def bounds(side: tuple[int, int, int], factor: Any, term: Any) -> Bounds:
    return Bounds(side, tuple(map(np.float32, factor)), tuple(map(np.float32, term)))


@compiled_only
@given(
    st.lists(st.floats(-4, 4, width=32) | NUMBERS, min_size=SIDES, max_size=SIDES),
    st.tuples(FACTORS, FACTORS, FACTORS),
    st.tuples(FACTORS, FACTORS, FACTORS),
    TRIPLES,
    TRIPLES,
    st.tuples(NUMBERS, NUMBERS),
)
def test_eight_boxes_at_once_are_as_numpy_has_them(
    sides: list[float], near: Any, far: Any, first: Any, last: Any, limits: Any
) -> None:
    bvh = Bvh(np.float32([0.0] * SIDES + sides), np.zeros(2 * WIDTH, np.int32))
    arguments = bounds((0, 32, 16), near, first), bounds((24, 8, 40), far, last)
    singles = np.float32(limits[0]), np.float32(limits[1])
    entered, expected = np.zeros((2, WIDTH), np.float32)
    met = ask(bvh, *arguments, singles, entered)
    with np.errstate(over="ignore"):
        assert met == uncompiled(boxes_met)(bvh, SIDES, *arguments, *singles, expected)
    assert entered.tobytes() == expected.tobytes()


def test_what_is_fetched_early_may_be_anything() -> None:
    bvh = Bvh(np.zeros(2 * SIDES, np.float32), np.zeros(2 * WIDTH, np.int32))
    for child in (0, 1, -1, -(2**40), 2**40):
        assert fetch(bvh, child) == child
