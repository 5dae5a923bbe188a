"""Which pixels around one eye-dome lighting looks at."""

import pytest

from vtray.image.eye_dome import surroundings


@pytest.mark.parametrize(
    ("radius", "count"), [(0.2, 8), (1, 8), (1.5, 12), (2, 12), (2.13, 16), (5, 16), (64, 16)]
)
def test_as_many_pixels_count_as_the_rules_say(radius: float, count: int) -> None:
    around = surroundings(radius)
    assert len({(x, y) for x, y, _ in around.tolist()}) == len(around) == count
    # At the radius and at half of it, neither less than 1, at the next whole pixels.
    rings = [max(part * radius, 1) for part in (1, 0.5)]
    for _, _, length in around.tolist():
        assert min(abs(length / 1024 - ring) for ring in rings) <= 0.71
