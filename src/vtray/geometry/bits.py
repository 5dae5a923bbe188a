"""Sets of things as the bits of an integer."""

import numpy as np

from vtray.base.compiler.compiled import written_in_llvm


@written_in_llvm("vtray.geometry.bits_in_llvm:write_lowest_bit")
def lowest_bit(bits: int | np.uint64) -> int:
    """Return the place of the lowest bit that is set; one must be."""
    return (int(bits) & -int(bits)).bit_length() - 1


@written_in_llvm("vtray.geometry.bits_in_llvm:write_count_bits")
def count_bits(bits: int | np.uint64) -> int:
    """Return how many bits are set."""
    return int(bits).bit_count()
