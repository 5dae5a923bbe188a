"""Kernels reach the items of arrays by indices from 0 on, and from the end by numbers as such."""

from collections.abc import Callable
from typing import Any

import numpy as np
import pytest

from vtray.base.compiler.compiled import Kernel

pytestmark = pytest.mark.usefixtures("compiler")


def item(values: Any, k: int) -> float:
    return values[k]


def item_of_row(rows: Any, k: int) -> float:
    return rows[k, 1]


def set_item(values: Any, k: int) -> float:
    values[k] = 7.0
    return values[k]


def last(values: Any, k: int) -> float:
    return values[-1] + k


def last_of_row(rows: Any, k: int) -> float:
    rows[1, -1] += k
    return rows[1, 1] + rows[k, -2]


@pytest.mark.parametrize("kind", [np.int64, np.int32, np.int8, np.uint16])
@pytest.mark.parametrize("read", [item, item_of_row, set_item, last, last_of_row])
def test_indices_are_as_in_python(read: Callable[[Any, int], float], kind: Any) -> None:
    shape = (3, 2) if "row" in read.__name__ else 6
    plain, compiled = (np.arange(6.0).reshape(shape) for _ in range(2))
    assert Kernel(read)(compiled, kind(2)) == read(plain, 2)
    assert np.array_equal(compiled, plain)


@pytest.mark.parametrize("read", [item, item_of_row, set_item])
def test_nobody_looks_whether_indices_are_below_0(read: Callable[[Any, int], float]) -> None:
    # What comes before a view is memory, too.
    shape = (6, 2) if "row" in read.__name__ else 12
    plain, compiled = (np.arange(12.0).reshape(shape) for _ in range(2))
    assert Kernel(read)(compiled[3:], -1) == read(plain, 2)
    assert np.array_equal(compiled, plain)
