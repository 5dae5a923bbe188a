"""Sets of eight things as bits."""

from vtray.geometry.bits import lowest_bit


def test_lowest_bit_of_all_sets_of_eight() -> None:
    for bits in range(1, 256):
        assert lowest_bit(bits) == (bits & -bits).bit_length() - 1
