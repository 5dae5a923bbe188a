"""The memory of doubles, seen as other numbers, is what NumPy sees."""

import numpy as np
import pytest
from numpy.typing import NDArray

from vtray.base.compiler.compiled import kernel
from vtray.geometry.packets.fan_rays import singles_of
from vtray.geometry.packets.packet import integers

pytestmark = pytest.mark.usefixtures("compiler")


@kernel
def read(
    memory: NDArray[np.float64], singles: NDArray[np.float32], numbers: NDArray[np.int64]
) -> tuple[int, int, int, int]:
    """Copy the memory as numbers; return the sizes and steps of the rows."""
    narrow, whole = singles_of(memory), integers(memory)
    for k, single in enumerate(narrow):
        singles[k] = single
    for k in range(whole.size):
        numbers[k] = whole[k]
    narrow[3] = np.float32(0.25)
    whole[4] = 7
    return narrow.size, narrow.strides[0], narrow.itemsize, whole.strides[0]


def test_memory_is_read_and_written() -> None:
    memory = np.random.default_rng(1).normal(size=9)
    expected = memory.copy()
    singles, numbers = np.empty(18, np.float32), np.empty(9, np.int64)
    assert read(memory, singles, numbers) == (18, 4, 4, 8)
    assert singles.tobytes() == numbers.tobytes() == expected.tobytes()
    expected.view(np.float32)[3] = 0.25
    expected.view(np.int64)[4] = 7
    assert memory.tobytes() == expected.tobytes()
