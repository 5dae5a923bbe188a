"""Sets of things as bits."""

import random

import numpy as np
import pytest

from vtray.base.compiler.compiled import kernel, uncompiled
from vtray.geometry.bits import count_bits, lowest_bit


@kernel
def lowest_and_count(bits: np.uint64) -> tuple[int, int]:
    return lowest_bit(bits), count_bits(bits)


@pytest.mark.usefixtures("compiler")
@pytest.mark.parametrize("kind", [int, np.uint64])
def test_bits_are_those_of_python(kind: type) -> None:
    draw = random.Random(1)
    some = [draw.getrandbits(63) & draw.getrandbits(63) for _ in range(200)]
    for bits in [*range(1, 256), *(1 << k for k in range(63)), *filter(None, some)]:
        expected = (bits & -bits).bit_length() - 1, bits.bit_count()
        assert lowest_and_count(kind(bits)) == expected
        plain = uncompiled(lowest_bit)(kind(bits)), uncompiled(count_bits)(kind(bits))
        assert plain == expected
