"""Where the rays of a path end in a drawing."""

from collections.abc import Sequence

from vtray.figures.traced_rays import PathRay
from vtray.geometry.vector import Vec

FAR = 1.3
"""Rays that go on farther than so many camera rays are cut short."""

SHORT = 0.4
"""They are drawn as long as so many."""


def path_ends(path: Sequence[PathRay]) -> list[Vec]:
    """Return where the rays of a path end in a drawing, in world space."""
    ends = []
    for ray in path:
        first = path[0].distance
        length = ray.distance if ray.distance < FAR * first else SHORT * first
        x, y, z = (a + length * b for a, b in zip(ray.origin, ray.direction, strict=True))
        ends.append((x, y, z))
    return ends
