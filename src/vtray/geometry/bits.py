"""Sets of up to eight things as the bits of an integer."""

from vtray.base.compiler.compiled import device

_SPREAD = 0b10111
"""Times a power of two up to 128, the three highest of its low eight bits are like no other's."""

_PLACES = sum(k << (((1 << k) * _SPREAD & 0xFF) >> 5) * 4 for k in range(8))
"""The exponent of each power, four bits for each, in the order of those three bits."""


@device
def lowest_bit(bits: int) -> int:
    """Return the place of the lowest of eight bits that is set; one must be.

    Without a branch, which processors would often guess wrong.

    References
    ----------
    Leiserson, Prokop, Randall, "Using de Bruijn Sequences to Index a 1 in a Computer Word", 1998.
    """
    lowest = bits & -bits
    return _PLACES >> ((lowest * _SPREAD & 0xFF) >> 5) * 4 & 7
